#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/world.h"

namespace galactic::dynamics {

/// What galactic-dynamics is asked to do.
struct Command {
  std::filesystem::path recipe;
  std::vector<std::filesystem::path> packs;
  std::filesystem::path data;
  std::filesystem::path recording;
  std::filesystem::path report;
  /// 0: all.
  std::uint64_t episodes = 0;
  unsigned threads = 0;
  WorldOptions world;
};

/// Reads the command line into `command`. Returns the exit code where there is nothing to do: help,
/// version, a mistake.
[[nodiscard]] std::optional<int> parseCommandLine(int argc, const char* const* argv,
                                                  Command& command);

}  // namespace galactic::dynamics
