#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string_view>

#include "galactic/bake/robot_recipe.h"
#include "support/text/nearest_name.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

tl::unexpected<Error> invalid(const std::string& where, std::string message) {
  return fail(ErrorCode::kInvalidInput, where, std::move(message));
}

/// Checks a recipe against the robot that it is for.
class RecipeCheck {
 public:
  RecipeCheck(const RobotRecipe& recipe, const SourceRobot& robot)
      : recipe_(recipe), robot_(robot) {
    for (const SourceLink& link : robot.links) {
      links_.push_back(link.name);
      if (!link.joint_name.empty() && positionCount(link.joint_type) == 1 && !link.mimic) {
        joints_.push_back(link.joint_name);
      }
    }
  }

  /// Checks that the links exist and that the recipe's statements about them make sense.
  [[nodiscard]] Result<void> checkLinks() const;
  /// Checks the joints. `robot` must have its joints coupled.
  [[nodiscard]] Result<void> checkJoints() const;

 private:
  [[nodiscard]] Result<void> checkLink(const RecipeName& name) const;
  /// The link below a joint whose position can be set.
  [[nodiscard]] Result<const SourceLink*> findJoint(const RecipeName& name) const;
  [[nodiscard]] Result<void> checkJoint(const RecipeJoint& joint) const;
  [[nodiscard]] Result<void> checkLimits(const RecipeLimits& given) const;
  [[nodiscard]] Result<void> checkStart(const RecipeStart& start) const;
  [[nodiscard]] Result<void> checkSpheres(const RecipeLinkSpheres& spheres) const;
  [[nodiscard]] Result<void> checkPair(const RecipeName& a, const RecipeName& b) const;

  const RobotRecipe& recipe_;
  const SourceRobot& robot_;
  std::vector<std::string> links_;
  /// Joints whose position can be set.
  std::vector<std::string> joints_;
};

Result<void> RecipeCheck::checkLink(const RecipeName& name) const {
  if (std::find(links_.begin(), links_.end(), name.name) != links_.end()) return {};
  return invalid(name.where, fmt::format("the robot '{}' has no link '{}'; {}", robot_.name,
                                         name.name, suggestNames(name.name, links_)));
}

Result<const SourceLink*> RecipeCheck::findJoint(const RecipeName& name) const {
  const auto found = std::find_if(robot_.links.begin(), robot_.links.end(), [&](const auto& link) {
    return link.parent >= 0 && link.joint_name == name.name;
  });
  if (found == robot_.links.end()) {
    return invalid(name.where, fmt::format("the robot '{}' has no joint '{}'; {}", robot_.name,
                                           name.name, suggestNames(name.name, joints_)));
  }
  if (found->mimic) {
    return invalid(name.where,
                   fmt::format("joint '{}' mimics '{}' and cannot be set by itself; name that one",
                               name.name, robot_.links[found->mimic->link].joint_name));
  }
  if (positionCount(found->joint_type) != 1) {
    return invalid(name.where, fmt::format("joint '{}' is fixed, planar or floating and has no "
                                           "position to set; {}",
                                           name.name, suggestNames(name.name, joints_)));
  }
  return &*found;
}

Result<void> RecipeCheck::checkJoint(const RecipeJoint& joint) const {
  const auto found = findJoint(joint.joint);
  if (!found) return tl::unexpected(found.error());
  const auto limits = jointLimits(**found, &recipe_);
  if (!limits) return {};
  for (const auto& [value, key] : {std::pair(joint.min, "min"), std::pair(joint.max, "max")}) {
    if (!value || (*value >= limits->lower && *value <= limits->upper)) continue;
    return invalid(joint.joint.where,
                   fmt::format("{} = {} of joint '{}' is outside its limits {} to {}", key, *value,
                               joint.joint.name, limits->lower, limits->upper));
  }
  if (limits->lower == limits->upper) {
    return invalid(joint.joint.where, fmt::format("joint '{}' cannot move: both its limits are {}",
                                                  joint.joint.name, limits->lower));
  }
  return {};
}

Result<void> RecipeCheck::checkLimits(const RecipeLimits& given) const {
  ASSIGN_OR_RETURN(const auto found, findJoint(given.joint));
  if (found->joint_type != JointType::kContinuous) return {};
  return invalid(given.joint.where,
                 fmt::format("joint '{}' is continuous and has no limits; narrow what actions do "
                             "with min and max of its [[joints]]",
                             given.joint.name));
}

Result<void> RecipeCheck::checkStart(const RecipeStart& start) const {
  const auto found = findJoint(start.joint);
  if (!found) return tl::unexpected(found.error());
  std::optional<double> lower;
  std::optional<double> upper;
  if (const auto limits = jointLimits(**found, &recipe_)) {
    lower = limits->lower;
    upper = limits->upper;
  }
  for (const RecipeJoint& joint : recipe_.joints) {
    if (joint.joint.name != start.joint.name) continue;
    if (joint.min) lower = joint.min;
    if (joint.max) upper = joint.max;
  }
  const bool below = lower && start.position < *lower;
  const bool above = upper && start.position > *upper;
  if (!below && !above) return {};
  return invalid(start.joint.where,
                 fmt::format("joint '{}' starts at {}, {} its limit {}", start.joint.name,
                             start.position, below ? "below" : "above", below ? *lower : *upper));
}

Result<void> RecipeCheck::checkSpheres(const RecipeLinkSpheres& spheres) const {
  if (auto checked = checkLink(spheres.link); !checked) return checked;
  if (spheres.merge_with_parent && robot_.links.front().name == spheres.link.name) {
    return invalid(
        spheres.link.where,
        fmt::format("link '{}' is the root and has no parent to merge with", spheres.link.name));
  }
  return {};
}

Result<void> RecipeCheck::checkPair(const RecipeName& a, const RecipeName& b) const {
  if (auto checked = checkLink(a); !checked) return checked;
  if (auto checked = checkLink(b); !checked) return checked;
  if (a.name != b.name) return {};
  return invalid(a.where, fmt::format("link '{}' is paired with itself; name two links", a.name));
}

Result<void> RecipeCheck::checkLinks() const {
  RETURN_IF_ERROR(checkLink(recipe_.end_effector.link));
  if (recipe_.camera) RETURN_IF_ERROR(checkLink(recipe_.camera->link));
  if (recipe_.laser) RETURN_IF_ERROR(checkLink(recipe_.laser->link));
  for (const RecipeLinkSpheres& spheres : recipe_.spheres.links) {
    RETURN_IF_ERROR(checkSpheres(spheres));
  }
  for (const auto& [a, b] : recipe_.ignored_pairs) RETURN_IF_ERROR(checkPair(a, b));
  return {};
}

Result<void> RecipeCheck::checkJoints() const {
  for (const RecipeLimits& limits : recipe_.limits) RETURN_IF_ERROR(checkLimits(limits));
  for (const RecipeJoint& joint : recipe_.joints) RETURN_IF_ERROR(checkJoint(joint));
  for (const RecipeStart& start : recipe_.start_pose) RETURN_IF_ERROR(checkStart(start));
  return {};
}

}  // namespace

std::optional<JointLimits> jointLimits(const SourceLink& link, const RobotRecipe* recipe) {
  if (recipe == nullptr) return link.limits;
  for (const RecipeLimits& given : recipe->limits) {
    if (given.joint.name == link.joint_name) return given.limits;
  }
  return link.limits;
}

Result<void> checkRecipe(const RobotRecipe& recipe, const SourceRobot& robot) {
  if (robot.links.empty()) {
    return invalid(recipe.source, fmt::format("the robot '{}' has no links", robot.name));
  }
  RETURN_IF_ERROR(RecipeCheck(recipe, robot).checkLinks());
  // Copies only the tree.
  SourceRobot coupled;
  coupled.name = robot.name;
  coupled.links = robot.links;
  RETURN_IF_ERROR(coupleJoints(recipe, coupled));
  return RecipeCheck(recipe, coupled).checkJoints();
}

}  // namespace galactic::bake
