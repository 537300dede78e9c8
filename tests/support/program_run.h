#pragma once
#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace galactic::test {

/// What a program printed and how it ended.
struct ProgramRun {
  /// Exit code; -1 when it was killed by a signal.
  int exit_code = -1;
  std::string out;
  std::string err;
};

/// All bytes of a file; empty when there is none.
inline std::string fileContent(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Runs `program` in `folder` with these arguments and waits for it. Its stdout goes to `out_path`
/// when one is given.
inline ProgramRun runProgram(const std::string& program, const std::filesystem::path& folder,
                             std::vector<std::string> arguments, const std::string& out_path = {}) {
  const std::string out = out_path.empty() ? (folder / "stdout.txt").string() : out_path;
  const std::string err = (folder / "stderr.txt").string();
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
  posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  pid_t child = 0;
  const int spawned = posix_spawn(&child, program.c_str(), &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (spawned != 0) {
    ADD_FAILURE() << "cannot start " << program << ": error " << spawned;
    return {};
  }
  int status = 0;
  waitpid(child, &status, 0);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1,
          out_path.empty() ? fileContent(out) : std::string(), fileContent(err)};
}

}  // namespace galactic::test
