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

/// How the joint above one of a robot's links follows another: its position is multiplier *
/// (position of the joint `leader`) + offset.
struct JointMimic {
  std::string_view joint{};
  JointType type = JointType::kFixed;
  /// Empty if the joint follows none.
  std::string_view leader{};
  double multiplier = 1;
  /// Radians or meters.
  double offset = 0;
};

/// Resolves chains of joints that follow each other. Returns one entry for each link of a robot, in
/// their order; none if the joint above it mimics no other. Fails with kInvalidInput on unknown
/// joints, on joints without a single position, and on cycles; the place of errors begins with
/// `where`.
[[nodiscard]] Result<std::vector<std::optional<Mimic>>> resolveMimics(
    std::span<const JointMimic> joints, const std::string& where);

}  // namespace galactic::bake
