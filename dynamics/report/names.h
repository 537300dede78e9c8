#pragma once
#include <string_view>

#include "dynamics/episodes/comparison.h"
#include "dynamics/report/moments.h"

namespace galactic::dynamics {

[[nodiscard]] inline std::string_view nameOf(Thing thing) {
  return kThingNames[static_cast<std::size_t>(thing)];
}
[[nodiscard]] inline std::string_view nameOf(MissCause cause) {
  return kMissCauseNames[static_cast<std::size_t>(cause)];
}
[[nodiscard]] inline std::string_view nameOf(InventedCause cause) {
  return kInventedCauseNames[static_cast<std::size_t>(cause)];
}
[[nodiscard]] inline std::string_view nameOf(ComparisonMode mode) {
  return kComparisonModeNames[static_cast<std::size_t>(mode)];
}
[[nodiscard]] inline std::string_view nameOf(ArmDrive arm) {
  return kArmDriveNames[static_cast<std::size_t>(arm)];
}
[[nodiscard]] inline std::string_view nameOf(BaseDrive base) {
  return kBaseDriveNames[static_cast<std::size_t>(base)];
}
[[nodiscard]] inline std::string_view nameOf(MomentKind kind) {
  return kMomentNames[static_cast<std::size_t>(kind)];
}

}  // namespace galactic::dynamics
