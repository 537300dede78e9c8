#pragma once
#include <cstdint>
#include <vector>

#include "galactic/bake/robot_recipe.h"
#include "galactic/bake/source_robot.h"
#include "galactic/pose.h"

namespace galactic::bake {

/// Links that count as one rigid body.
struct RigidGroup {
  /// The link nearest to the root: the frame of the group.
  std::uint32_t link = 0;
  /// Ascending, `link` first.
  std::vector<std::uint32_t> links;
  /// group_from_link of each of `links`.
  std::vector<Affine> group_from_link;
};

/// The groups of `robot`, by ascending first link: links joined by fixed joints, and those that the
/// recipe (may be null) merges with their parent. Where a merged joint can move, the group has its
/// shape at `start`: the transform joint_from_link of each link at the start positions.
[[nodiscard]] std::vector<RigidGroup> findRigidGroups(const SourceRobot& robot,
                                                      const RobotRecipe* recipe,
                                                      const std::vector<Affine>& start);

}  // namespace galactic::bake
