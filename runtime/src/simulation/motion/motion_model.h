#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "galactic/error.h"
#include "galactic/pose.h"
#include "galactic/robot.h"
#include "simulation/collision/sphere_batch.h"

namespace galactic::simulation {

/// A joint position that changes during a run; all others keep the robot's start position, and the
/// links that they move are folded into constants.
struct MotionVariable {
  /// Index into the robot's joint positions.
  std::uint32_t position = 0;
  /// Limits of the position, radians or meters.
  float lower = 0;
  float upper = 0;
  /// The farthest move of one action; 0 for a position that only episodes set.
  float step = 0;
  /// Index of its action; -1 for none.
  std::int32_t action = -1;
  /// Whether the angle is kept in [-pi, pi): it has no limits and is periodic (isPeriodic()).
  bool wraps = false;
};

/// Whether a whole turn more or less of a position changes nothing: it is that of a continuous
/// joint, and no joint that follows it slides or turns by a fractional multiple.
[[nodiscard]] bool isPeriodic(const Robot& robot, std::uint32_t position);

/// The nearest value that the variable may take.
[[nodiscard]] inline float within(const MotionVariable& variable, float value) {
  return variable.wraps ? wrappedAngle(value) : std::clamp(value, variable.lower, variable.upper);
}

enum class NodeMotion : std::uint8_t { kTurns, kSlides };

/// A frame that a variable moves: about its own X axis (kTurns), or along it (kSlides). Frames are
/// turned so that every joint's axis is X, which leaves one column of the rotation as it is.
struct MotionNode {
  /// Index of the node it is attached to, smaller than its own; -1 for the robot's root.
  std::int32_t parent = -1;
  std::uint32_t variable = 0;
  NodeMotion motion = NodeMotion::kTurns;
  /// joint value = multiplier * variable + offset.
  float multiplier = 1;
  float offset = 0;
  /// parent_from_node at joint value 0: the node's axes and origin in the parent's frame, meters.
  Vec3 x_axis{1, 0, 0};
  Vec3 y_axis{0, 1, 0};
  Vec3 z_axis{0, 0, 1};
  Vec3 origin;
};

/// A frame that is fixed to a node: its axes and origin in the node's frame, meters.
struct FixedFrame {
  /// -1 for the robot's root.
  std::int32_t node = -1;
  Vec3 x_axis{1, 0, 0};
  Vec3 y_axis{0, 1, 0};
  Vec3 z_axis{0, 0, 1};
  Vec3 origin;
};

/// A sphere of the robot.
struct BodySphere {
  /// -1 for the robot's root.
  std::int32_t node = -1;
  /// In the node's frame, meters.
  Vec3 center;
};

/// A robot as the batch simulation moves it: the part of its kinematic tree that changes, its
/// spheres in the order of a SphereBatch, and where its gripper and links are.
struct MotionModel {
  std::vector<MotionVariable> variables;
  /// Parents before children.
  std::vector<MotionNode> nodes;
  /// Shape: paddedToLanes of each range, in the order of `ranges`; padded with copies.
  std::vector<BodySphere> spheres;
  std::vector<RadiusRange> ranges;
  /// The spheres, as indices into `spheres` without padding, link by link as the robot has them.
  std::vector<std::uint32_t> spheres_by_link;
  /// Origin at the grasp point, axes of the end effector's link.
  FixedFrame grip;
  /// The frame of each link of the robot.
  std::vector<FixedFrame> links;
  /// Variables of the controlled joints, in the order of the actions.
  std::vector<std::uint32_t> controlled;
  RobotBase base;
  float grasp_radius = 0;
};

/// Makes the model; everything that does not change is folded into constants. `also_variable`:
/// joint positions that episodes set besides those that actions move. Fails with kUnsupported if a
/// variable belongs to a planar or floating joint, and with kInvalidInput if the robot has no end
/// effector, base or sphere.
[[nodiscard]] Result<MotionModel> makeMotionModel(const Robot& robot,
                                                  std::span<const std::uint32_t> also_variable);

}  // namespace galactic::simulation
