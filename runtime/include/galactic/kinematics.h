#pragma once
#include <cstdint>
#include <span>

#include "galactic/pose.h"

namespace galactic {

/// How the joint between a link and its parent moves.
enum class JointType : std::uint8_t {
  kFixed = 0,       ///< No position.
  kRevolute = 1,    ///< One position: angle about the axis, radians, within limits.
  kContinuous = 2,  ///< One position: angle about the axis, radians, without limits.
  kPrismatic = 3,   ///< One position: meters along the axis, within limits.
  kPlanar = 4,      ///< Three positions: meters along planarDirections(axis), angle about the axis.
  kFloating = 5,    ///< Seven positions: translation, meters, and quaternion (x, y, z, w).
};

/// Number of values that a joint of this type takes from the vector of joint positions.
[[nodiscard]] constexpr std::uint32_t positionCount(JointType type) {
  switch (type) {
    case JointType::kFixed:
      return 0;
    case JointType::kRevolute:
    case JointType::kContinuous:
    case JointType::kPrismatic:
      return 1;
    case JointType::kPlanar:
      return 3;
    case JointType::kFloating:
      return 7;
  }
  return 0;
}

/// One link and the joint to its parent. The memory layout is that of a pack.
struct LinkFrame {
  /// Joint frame at position 0 in the parent link's frame.
  Pose parent_from_joint;
  /// Unit axis in the joint frame.
  Vec3 axis{1, 0, 0};
  /// Index of the parent link, smaller than the link's own; -1 for the root.
  std::int32_t parent = -1;
  /// Index of the joint's first value in the vector of joint positions; for a mimic, that of the
  /// joint that it follows; -1 for a fixed joint and for the root.
  std::int32_t position = -1;
  /// joint value = multiplier * position + offset: 1 and 0 unless the joint mimics another.
  float multiplier = 1;
  float offset = 0;
  JointType type = JointType::kFixed;
};

/// The two directions of a planar joint, unit vectors perpendicular to the unit vector `axis`. The
/// first is the component of X perpendicular to the axis, or of Z if the axis is nearly X; the
/// second is axis x first.
struct PlanarDirections {
  Vec3 first;
  Vec3 second;
};
[[nodiscard]] PlanarDirections planarDirections(const Vec3& axis) noexcept;

/// The pose of each link in the world for a vector of joint positions (forward kinematics).
/// `links`: root first, parents before children. `world_from_root`: pose of the root link.
/// `positions`: one value per position of the robot, radians or meters. `world_from_link`: one per
/// link, overwritten. Neither allocates nor throws.
void forwardKinematics(std::span<const LinkFrame> links, const Pose& world_from_root,
                       std::span<const float> positions, std::span<Pose> world_from_link) noexcept;

/// A point that moves with a link, and a direction, both in the frame of the links' poses.
struct CarriedPoint {
  std::uint32_t link = 0;
  Vec3 point;
  Vec3 direction;
};

/// How far a point of a link moves along a direction for each unit of each position: the transposed
/// Jacobian of the point, applied to the direction. `links`, `positions`: as for
/// forwardKinematics(). `frame_from_link`: the result of forwardKinematics(). `moves`: one per
/// position, overwritten, meters per radian or meter, times the direction's length. A quaternion's
/// components count as the rotation that they represent, whatever their length. Neither allocates
/// nor throws.
void applyTransposedJacobian(std::span<const LinkFrame> links, std::span<const float> positions,
                             std::span<const Pose> frame_from_link, const CarriedPoint& carried,
                             std::span<float> moves) noexcept;

}  // namespace galactic
