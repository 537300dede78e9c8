#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/episodes/comparison.h"
#include "dynamics/options.h"
#include "dynamics/report/side_by_side.h"

namespace galactic::dynamics {

/// What galactic-dynamics is asked to do.
struct Command {
  std::filesystem::path recipe;
  std::vector<std::filesystem::path> packs;
  std::filesystem::path data;
  /// One of the two: what is replayed, or whose actions close the loop ("scripted" or a pack).
  std::filesystem::path recording;
  std::string policy;
  LoopOptions loop;
  std::filesystem::path report;
  SideBySideFiles shown;
  /// 0: all.
  std::uint64_t episodes = 0;
  unsigned threads = 0;
  bool is_quiet = false;
  WorldOptions world;

  [[nodiscard]] ComparisonMode mode() const {
    return policy.empty() ? ComparisonMode::kReplay : ComparisonMode::kClosedLoop;
  }
  /// The pack of a learned policy; empty for others.
  [[nodiscard]] std::filesystem::path policyFile() const;
};

/// Reads the command line into `command`. Returns the exit code where there is nothing to do: help,
/// version, a mistake.
[[nodiscard]] std::optional<int> parseCommandLine(int argc, const char* const* argv,
                                                  Command& command);

}  // namespace galactic::dynamics
