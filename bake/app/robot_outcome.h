#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "bake_run.h"
#include "galactic/bake/robot_baker.h"

namespace galactic::bake {

/// What became of one robot.
struct RobotOutcome {
  std::filesystem::path input;
  std::filesystem::path output;
  BakedRobot robot;
  /// Where each mesh was found, for -v.
  std::vector<std::string> resolutions;
  double import_seconds = 0;
  double seconds = 0;
  /// Size of the pack; 0 for a dry run.
  std::uint64_t pack_bytes = 0;
};

/// Prints what was baked: links and joints, a line per group of links, self-collision pairs,
/// warnings.
void printRobotTable(const RobotOutcome& outcome, Verbosity verbosity);

/// The robot's entry of the report.
[[nodiscard]] Json robotReport(const RobotOutcome& outcome);

}  // namespace galactic::bake
