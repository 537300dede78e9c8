#include <algorithm>

#include "import/affine.h"
#include "robot/robot_parts.h"

namespace galactic::bake {
namespace {

bool mergesWithParent(const SourceLink& link, const RobotRecipe* recipe) {
  if (recipe == nullptr) return false;
  return std::any_of(recipe->spheres.links.begin(), recipe->spheres.links.end(),
                     [&](const RecipeLinkSpheres& rule) {
                       return rule.merge_with_parent && rule.link.name == link.name;
                     });
}

}  // namespace

std::vector<RigidGroup> findRigidGroups(const SourceRobot& robot, const RobotRecipe* recipe,
                                        const std::vector<Affine>& start) {
  std::vector<RigidGroup> groups;
  std::vector<std::size_t> group_of(robot.links.size());
  std::vector<Affine> group_from_link(robot.links.size(), kIdentityAffine);
  for (std::size_t n = 0; n < robot.links.size(); ++n) {
    const SourceLink& link = robot.links[n];
    const bool joins = link.parent >= 0 &&
                       (link.joint_type == JointType::kFixed || mergesWithParent(link, recipe));
    if (joins) {
      const auto parent = static_cast<std::size_t>(link.parent);
      group_of[n] = group_of[parent];
      group_from_link[n] =
          compose(group_from_link[parent], compose(link.parent_from_joint, start[n]));
    } else {
      group_of[n] = groups.size();
      groups.emplace_back().link = static_cast<std::uint32_t>(n);
    }
    groups[group_of[n]].links.push_back(static_cast<std::uint32_t>(n));
    groups[group_of[n]].group_from_link.push_back(group_from_link[n]);
  }
  return groups;
}

}  // namespace galactic::bake
