#pragma once
#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>

#include <csignal>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "support/file_content.h"

namespace galactic::test {

/// What a program printed and how it ended.
struct ProgramRun {
  /// Exit code; -1 when it was killed by a signal.
  int exit_code = -1;
  std::string out;
  std::string err;
};

/// Which group of processes a program belongs to: a terminal's Ctrl-C goes to all of a group.
enum class ProgramGroup { kOfTest, kOwn };

/// A program that runs in a folder, until somebody waits for it.
class StartedProgram {
 public:
  /// Starts `program` in `folder` with these arguments. Its stdout goes to `out_path` when one is
  /// given.
  StartedProgram(const std::string& program, std::filesystem::path folder,
                 std::vector<std::string> arguments, std::string out_path = {},
                 ProgramGroup group = ProgramGroup::kOfTest)
      : folder_(std::move(folder)), out_path_(std::move(out_path)) {
    const std::string out = out_path_.empty() ? (folder_ / "stdout.txt").string() : out_path_;
    const std::string err = (folder_ / "stderr.txt").string();
    arguments.insert(arguments.begin(), program);
    std::vector<char*> argv;
    argv.reserve(arguments.size() + 1);
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);

    constexpr mode_t kMode = 0600;
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 1, out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, kMode);
    posix_spawn_file_actions_addopen(&actions, 2, err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, kMode);
    posix_spawn_file_actions_addchdir_np(&actions, folder_.c_str());
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    // Whoever runs the tests may have these ignored: nohup, or a shell in the background.
    sigset_t heard;
    sigemptyset(&heard);
    sigaddset(&heard, SIGHUP);
    sigaddset(&heard, SIGINT);
    posix_spawnattr_setsigdefault(&attributes, &heard);
    int flags = POSIX_SPAWN_SETSIGDEF;
    if (group == ProgramGroup::kOwn) {
      flags |= POSIX_SPAWN_SETPGROUP;
      posix_spawnattr_setpgroup(&attributes, 0);
    }
    posix_spawnattr_setflags(&attributes, static_cast<short>(flags));
    const int spawned =
        posix_spawn(&child_, program.c_str(), &actions, &attributes, argv.data(), environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    if (spawned == 0) return;
    child_ = 0;
    ADD_FAILURE() << "cannot start " << program << ": error " << spawned;
  }

  /// Sends it a signal; it may have ended.
  void signal(int number) const {
    if (child_ != 0) ::kill(child_, number);
  }
  /// Sends it to all of its group, which is its own.
  void signalGroup(int number) const {
    if (child_ != 0) ::kill(-child_, number);
  }
  /// 0 where it could not be started.
  [[nodiscard]] pid_t id() const { return child_; }
  /// What it has said on stderr so far.
  [[nodiscard]] std::string errSoFar() const { return fileContent(folder_ / "stderr.txt"); }
  /// Waits for its end.
  [[nodiscard]] ProgramRun wait() const {
    if (child_ == 0) return {};
    int status = 0;
    waitpid(child_, &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1,
            out_path_.empty() ? fileContent(folder_ / "stdout.txt") : std::string(),
            fileContent(folder_ / "stderr.txt")};
  }

 private:
  std::filesystem::path folder_;
  std::string out_path_;
  pid_t child_ = 0;
};

/// Runs `program` in `folder` with these arguments and waits for it. Its stdout goes to `out_path`
/// when one is given.
inline ProgramRun runProgram(const std::string& program, const std::filesystem::path& folder,
                             std::vector<std::string> arguments, const std::string& out_path = {}) {
  return StartedProgram(program, folder, std::move(arguments), out_path).wait();
}

/// The same with redirections as the shell reads them, such as "2>&-" for a closed stderr.
inline ProgramRun runRedirected(const std::string& program, const std::filesystem::path& folder,
                                std::vector<std::string> arguments,
                                const std::string& redirections) {
  arguments.insert(arguments.begin(), {"-c", "exec \"$0\" \"$@\" " + redirections, program});
  return runProgram("/bin/sh", folder, std::move(arguments));
}

}  // namespace galactic::test
