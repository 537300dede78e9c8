#include <algorithm>
#include <limits>
#include <optional>
#include <string>

#include "fit/rotation.h"
#include "robot/robot_parts.h"

namespace galactic::bake {
namespace {

constexpr float kUnlimited = std::numeric_limits<float>::max();

Vec3 vectorOf(const std::array<double, 3>& v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

/// The nearest float; some files write limits beyond the range of floats to mean that there are
/// none.
float nearestFloat(double value) {
  constexpr auto kLargest = static_cast<double>(kUnlimited);
  return static_cast<float>(std::clamp(value, -kLargest, kLargest));
}

/// Limits of each value of a joint; only joints with a single value have limits.
PositionLimits positionLimits(const SourceLink& link, const RobotRecipe* recipe) {
  const std::optional<JointLimits> limits = jointLimits(link, recipe);
  if (!limits || positionCount(link.joint_type) != 1) return {-kUnlimited, kUnlimited};
  return {nearestFloat(limits->lower), nearestFloat(limits->upper)};
}

/// The joint's rest position in the robot's file, else 0, or the limit nearest to it.
float startOf(const SourceLink& link, const PositionLimits& limits) {
  return std::clamp(nearestFloat(link.rest.value_or(0)), limits.lower, limits.upper);
}

void addPositions(const SourceLink& link, const RobotRecipe* recipe, LinkFrame& frame,
                  FlatKinematics& flat) {
  const std::uint32_t count = positionCount(link.joint_type);
  if (count == 0) return;
  frame.position = static_cast<std::int32_t>(flat.limits.size());
  for (std::uint32_t n = 0; n < count; ++n) {
    flat.limits.push_back(positionLimits(link, recipe));
    flat.start_positions.push_back(startOf(link, flat.limits.back()));
  }
  // The quaternion of a floating joint starts as the identity.
  if (link.joint_type == JointType::kFloating) flat.start_positions.back() = 1;
}

/// Index of the value of the joint with this name; none if it has no value of its own.
std::optional<std::size_t> positionOf(const SourceRobot& robot, const FlatKinematics& flat,
                                      const std::string& joint) {
  const auto link =
      std::find_if(robot.links.begin(), robot.links.end(),
                   [&](const SourceLink& candidate) { return candidate.joint_name == joint; });
  if (link == robot.links.end() || link->mimic) return std::nullopt;
  const LinkFrame& frame = flat.links[static_cast<std::size_t>(link - robot.links.begin())];
  if (frame.position < 0) return std::nullopt;
  return static_cast<std::size_t>(frame.position);
}

void applyStartPose(const SourceRobot& robot, const RobotRecipe& recipe, FlatKinematics& flat) {
  // The start position must respect the recipe's narrower limits, too.
  for (const RecipeJoint& joint : recipe.joints) {
    const auto position = positionOf(robot, flat, joint.joint.name);
    if (!position) continue;
    float& start = flat.start_positions[*position];
    if (joint.min) start = std::max(start, nearestFloat(*joint.min));
    if (joint.max) start = std::min(start, nearestFloat(*joint.max));
  }
  for (const RecipeStart& start : recipe.start_pose) {
    const auto position = positionOf(robot, flat, start.joint.name);
    if (!position) continue;
    const PositionLimits& limits = flat.limits[*position];
    flat.start_positions[*position] =
        std::clamp(nearestFloat(start.position), limits.lower, limits.upper);
  }
}

}  // namespace

Pose poseOf(const Affine& rigid) {
  const fit::Axes axes{{{rigid[0], rigid[4], rigid[8]},
                        {rigid[1], rigid[5], rigid[9]},
                        {rigid[2], rigid[6], rigid[10]}}};
  return {
      {static_cast<float>(rigid[3]), static_cast<float>(rigid[7]), static_cast<float>(rigid[11])},
      fit::quaternionOf(axes)};
}

FlatKinematics flattenKinematics(const SourceRobot& robot, const RobotRecipe* recipe) {
  FlatKinematics flat;
  for (const SourceLink& link : robot.links) {
    LinkFrame& frame = flat.links.emplace_back();
    frame.parent_from_joint = poseOf(link.parent_from_joint);
    frame.axis = vectorOf(link.axis);
    frame.parent = link.parent;
    frame.type = link.parent < 0 ? JointType::kFixed : link.joint_type;
    if (link.parent >= 0 && !link.mimic) addPositions(link, recipe, frame, flat);
  }
  for (std::size_t n = 0; n < robot.links.size(); ++n) {
    const SourceLink& link = robot.links[n];
    if (!link.mimic || link.parent < 0) continue;
    LinkFrame& frame = flat.links[n];
    frame.position = flat.links[link.mimic->link].position;
    frame.multiplier = nearestFloat(link.mimic->multiplier);
    frame.offset = nearestFloat(link.mimic->offset);
  }
  if (recipe != nullptr) applyStartPose(robot, *recipe, flat);
  return flat;
}

}  // namespace galactic::bake
