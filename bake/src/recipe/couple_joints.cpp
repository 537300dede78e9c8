#include <fmt/format.h>

#include <algorithm>

#include "galactic/bake/robot_recipe.h"
#include "support/nearest_name.h"
#include "support/try.h"
#include "urdf/urdf_tree.h"

namespace galactic::bake {
namespace {

/// The link below a joint with a position, by the joint's name.
Result<std::size_t> linkBelow(const RecipeName& joint, const SourceRobot& robot) {
  std::vector<std::string> names;
  for (std::size_t n = 0; n < robot.links.size(); ++n) {
    const SourceLink& link = robot.links[n];
    const bool can_follow = link.parent >= 0 && positionCount(link.joint_type) == 1;
    if (can_follow && link.joint_name == joint.name) return n;
    if (can_follow) names.push_back(link.joint_name);
  }
  return fail(ErrorCode::kInvalidInput, joint.where,
              fmt::format("the robot '{}' has no joint '{}' that turns or slides; {}", robot.name,
                          joint.name, suggestNames(joint.name, names)));
}

/// The joints of a robot as its URDF could state them, in the order of their links.
UrdfModel jointsOf(const SourceRobot& robot) {
  UrdfModel model;
  for (const SourceLink& link : robot.links) {
    UrdfJoint& joint = model.joints.emplace_back();
    joint.name = link.joint_name;
    joint.type = link.joint_type;
    if (!link.mimic) continue;
    joint.mimic = robot.links[link.mimic->link].joint_name;
    joint.multiplier = link.mimic->multiplier;
    joint.offset = link.mimic->offset;
  }
  return model;
}

}  // namespace

Result<void> coupleJoints(const RobotRecipe& recipe, SourceRobot& robot) {
  if (recipe.mimics.empty()) return {};
  UrdfModel model = jointsOf(robot);
  for (const RecipeMimic& mimic : recipe.mimics) {
    ASSIGN_OR_RETURN(const auto follower, linkBelow(mimic.joint, robot));
    RETURN_IF_ERROR(linkBelow(mimic.leader, robot));
    model.joints[follower].mimic = mimic.leader.name;
    model.joints[follower].multiplier = mimic.multiplier;
    model.joints[follower].offset = mimic.offset;
  }
  ASSIGN_OR_RETURN(const auto mimics, resolveMimics(model, recipe.source));
  for (std::size_t n = 0; n < robot.links.size(); ++n) {
    if (!mimics[n]) continue;
    robot.links[n].mimic = Mimic{.link = static_cast<std::uint32_t>(mimics[n]->joint),
                                 .multiplier = mimics[n]->multiplier,
                                 .offset = mimics[n]->offset};
  }
  return {};
}

}  // namespace galactic::bake
