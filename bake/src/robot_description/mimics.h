#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "galactic/bake/source_robot.h"
#include "galactic/error.h"
#include "galactic/kinematics.h"

namespace galactic::bake {

/// What is said of the joint above one of a robot's links: that its position is multiplier * (that
/// of the joint `leader`)
/// + offset.
struct JointMimic {
  std::string_view joint{};
  JointType type = JointType::kFixed;
  /// Empty: the joint follows none.
  std::string_view leader{};
  double multiplier = 1;
  /// Radians or meters.
  double offset = 0;
};

/// Chains of them resolved: one entry for each of all links of a robot, in their order; none where
/// the joint above it mimics nothing. Fails with kInvalidInput on unknown joints, on those without
/// a single position, and on circles; `where` begins the place of errors.
[[nodiscard]] Result<std::vector<std::optional<Mimic>>> resolveMimics(
    std::span<const JointMimic> joints, const std::string& where);

}  // namespace galactic::bake
