#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "galactic/error.h"
#include "galactic/kinematics.h"

namespace galactic::bake {

/// What is said of one of a robot's joints: that its position is multiplier * (that of the joint
/// `leader`)
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

/// A joint whose mimic chain is resolved.
struct ResolvedMimic {
  /// Index into all joints of one that mimics nothing.
  std::size_t joint = 0;
  double multiplier = 1;
  double offset = 0;
};

/// One entry for each of all joints of a robot; none where it mimics nothing. Fails with
/// kInvalidInput on unknown joints, on those without a single position, and on circles; `where`
/// begins the place of errors.
[[nodiscard]] Result<std::vector<std::optional<ResolvedMimic>>> resolveMimics(
    std::span<const JointMimic> joints, const std::string& where);

}  // namespace galactic::bake
