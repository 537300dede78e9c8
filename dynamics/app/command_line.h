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

/// The parsed command line of galactic-dynamics.
struct Command {
  std::filesystem::path recipe;
  std::vector<std::filesystem::path> packs;
  std::filesystem::path data;
  /// Exactly one of these is set: the recording to replay, or the policy that closes the loop
  /// ("scripted" or a pack).
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

/// Reads the command line into `command`. Returns the exit code if there is nothing more to do:
/// after help, version or a mistake.
[[nodiscard]] std::optional<int> parseCommandLine(int argc, const char* const* argv,
                                                  Command& command);

}  // namespace galactic::dynamics
