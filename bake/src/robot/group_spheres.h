#pragma once
#include <string>
#include <vector>

#include "galactic/bake/robot_baker.h"
#include "galactic/error.h"
#include "rigid_groups.h"

namespace galactic::bake {

/// What the spheres of all groups are made from.
struct SphereTask {
  const SourceRobot& robot;
  /// May be null.
  const RobotRecipe* recipe = nullptr;
  const RobotBakeOptions& options;
  /// What spheres are fitted to, one per link.
  const std::vector<Surface>& surfaces;
  /// Pose of each link at the start positions; the root stands at its height above the ground.
  const std::vector<Pose>& world_from_link;
};

/// The spheres of each group: given by hand, or fitted within the robot's budget. Adds what the
/// user should know to `warnings`.
[[nodiscard]] Result<std::vector<BakedGroup>> makeGroupSpheres(
    const std::vector<RigidGroup>& groups, const SphereTask& task,
    std::vector<std::string>& warnings);

}  // namespace galactic::bake
