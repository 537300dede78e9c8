#pragma once
#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>

#include <filesystem>
#include <string>
#include <vector>

#include "support/pack_tool_fixture.h"

namespace galactic::test {

/// What a program printed and how it ended.
struct ProgramRun {
  /// Exit code; -1 when it was killed by a signal.
  int exit_code = -1;
  std::string out;
  std::string err;
};

/// Runs galactic-pack in `folder` with these arguments and waits for it.
inline ProgramRun runPackTool(const ScratchFolder& folder, std::vector<std::string> arguments,
                              const std::string& out_path = {}) {
  const std::string out = out_path.empty() ? (folder.path() / "stdout.txt").string() : out_path;
  const std::string err = (folder.path() / "stderr.txt").string();
  arguments.insert(arguments.begin(), GALACTIC_PACK);
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);

  constexpr mode_t kMode = 0600;
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 1, out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, kMode);
  posix_spawn_file_actions_addopen(&actions, 2, err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, kMode);
  posix_spawn_file_actions_addchdir_np(&actions, folder.path().c_str());
  pid_t child = 0;
  const int spawned = posix_spawn(&child, GALACTIC_PACK, &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (spawned != 0) {
    ADD_FAILURE() << "cannot start " << GALACTIC_PACK << ": error " << spawned;
    return {};
  }
  int status = 0;
  waitpid(child, &status, 0);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1,
          out_path.empty() ? readBytes(out) : std::string(), readBytes(err)};
}

}  // namespace galactic::test
