#include <fmt/format.h>

#include <algorithm>

#include "galactic/bake/robot_recipe.h"
#include "robot_description/mimics.h"
#include "support/text/nearest_name.h"
#include "support/try.h"

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

/// The joints that follow others, in the order of their links.
std::vector<JointMimic> mimicsOf(const SourceRobot& robot) {
  std::vector<JointMimic> mimics;
  for (const SourceLink& link : robot.links) {
    JointMimic& mimic =
        mimics.emplace_back(JointMimic{.joint = link.joint_name, .type = link.joint_type});
    if (!link.mimic) continue;
    mimic.leader = robot.links[link.mimic->link].joint_name;
    mimic.multiplier = link.mimic->multiplier;
    mimic.offset = link.mimic->offset;
  }
  return mimics;
}

}  // namespace

Result<void> coupleJoints(const RobotRecipe& recipe, SourceRobot& robot) {
  if (recipe.mimics.empty()) return {};
  std::vector<JointMimic> stated = mimicsOf(robot);
  for (const RecipeMimic& given : recipe.mimics) {
    ASSIGN_OR_RETURN(const auto follower, linkBelow(given.joint, robot));
    RETURN_IF_ERROR(linkBelow(given.leader, robot));
    stated[follower].leader = given.leader.name;
    stated[follower].multiplier = given.multiplier;
    stated[follower].offset = given.offset;
  }
  ASSIGN_OR_RETURN(const auto mimics, resolveMimics(stated, recipe.source));
  for (std::size_t n = 0; n < robot.links.size(); ++n) robot.links[n].mimic = mimics[n];
  return {};
}

}  // namespace galactic::bake
