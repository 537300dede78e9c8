#pragma once
#include "galactic/bake/robot_baker.h"

namespace galactic::bake {

/// The rigid transform as the runtime holds it. Exact to float rounding.
[[nodiscard]] Pose poseOf(const Affine& rigid);

/// Links, limits and start positions of `robot` as the runtime reads them. A joint that mimics
/// another has no position of its own. Joints start at 0, or at their limit nearest to it, those of
/// `recipe` (may be null) included, unless the recipe's start pose says otherwise.
[[nodiscard]] FlatKinematics flattenKinematics(const SourceRobot& robot, const RobotRecipe* recipe);

}  // namespace galactic::bake
