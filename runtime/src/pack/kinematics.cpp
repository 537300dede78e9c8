#include "galactic/kinematics.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace galactic {
namespace {

Quat rotationAbout(const Vec3& axis, float angle) {
  const float sine = std::sin(0.5F * angle);
  return {axis.x * sine, axis.y * sine, axis.z * sine, std::cos(0.5F * angle)};
}

/// Normalizes a quaternion; the identity if it has no direction.
Quat normalized(const Quat& q) {
  const float length = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  if (!(length > 0)) return {};
  const float factor = 1 / length;
  return {q.x * factor, q.y * factor, q.z * factor, q.w * factor};
}

Pose jointPose(const LinkFrame& link, std::span<const float> positions) {
  if (link.type == JointType::kFixed) return {};
  const float* values = positions.data() + link.position;
  const float value = link.multiplier * values[0] + link.offset;
  switch (link.type) {
    case JointType::kFixed:
      break;
    case JointType::kRevolute:
    case JointType::kContinuous:
      return {{}, rotationAbout(link.axis, value)};
    case JointType::kPrismatic:
      return {link.axis * value, {}};
    case JointType::kPlanar: {
      const PlanarDirections directions = planarDirections(link.axis);
      return {directions.first * values[0] + directions.second * values[1],
              rotationAbout(link.axis, values[2])};
    }
    case JointType::kFloating:
      return {{values[0], values[1], values[2]},
              normalized({values[3], values[4], values[5], values[6]})};
  }
  return {};
}

}  // namespace

PlanarDirections planarDirections(const Vec3& axis) noexcept {
  constexpr float kNearlyX = 0.99F;
  const Vec3 start = std::fabs(axis.x) < kNearlyX ? Vec3{1, 0, 0} : Vec3{0, 0, 1};
  const Vec3 across = start - axis * dot(start, axis);
  const Vec3 first = across * (1 / std::sqrt(dot(across, across)));
  return {first, cross(axis, first)};
}

void forwardKinematics(std::span<const LinkFrame> links, const Pose& world_from_root,
                       std::span<const float> positions, std::span<Pose> world_from_link) noexcept {
  assert(world_from_link.size() == links.size());
  for (std::size_t n = 0; n < links.size(); ++n) {
    const LinkFrame& link = links[n];
    const Pose world_from_parent =
        link.parent < 0 ? world_from_root : world_from_link[static_cast<std::size_t>(link.parent)];
    world_from_link[n] = world_from_parent * (link.parent_from_joint * jointPose(link, positions));
  }
}

namespace {

/// A point and a direction as seen from a link's joint, which turns them about its origin.
struct SeenFromJoint {
  /// From the origin of the joint to the point, in the joint's frame, like the direction.
  Vec3 arm;
  Vec3 direction;

  [[nodiscard]] float alongAxis(const Vec3& axis) const { return dot(direction, axis); }
  [[nodiscard]] float aboutAxis(const Vec3& axis) const { return dot(direction, cross(axis, arm)); }
};

/// For each component of a quaternion (x, y, z, w), the angular velocity 2 dq q* / |q|^2.
void addQuaternionMoves(const SeenFromJoint& seen, const float* q, float* moves) {
  const float square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
  if (!(square > 0)) return;
  const Quat back{-q[0], -q[1], -q[2], q[3]};
  constexpr std::array<Quat, 4> kComponents{
      {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
  for (std::size_t n = 0; n < kComponents.size(); ++n) {
    const Quat turn = kComponents[n] * back;
    moves[n] += seen.aboutAxis(Vec3{turn.x, turn.y, turn.z} * (2 / square));
  }
}

void addJointMoves(const LinkFrame& link, const float* values, const SeenFromJoint& seen,
                   float* moves) {
  switch (link.type) {
    case JointType::kFixed:
      return;
    case JointType::kRevolute:
    case JointType::kContinuous:
      moves[0] += link.multiplier * seen.aboutAxis(link.axis);
      return;
    case JointType::kPrismatic:
      moves[0] += link.multiplier * seen.alongAxis(link.axis);
      return;
    case JointType::kPlanar: {
      const PlanarDirections directions = planarDirections(link.axis);
      moves[0] += seen.alongAxis(directions.first);
      moves[1] += seen.alongAxis(directions.second);
      moves[2] += seen.aboutAxis(link.axis);
      return;
    }
    case JointType::kFloating:
      moves[0] += seen.direction.x;
      moves[1] += seen.direction.y;
      moves[2] += seen.direction.z;
      addQuaternionMoves(seen, values + 3, moves + 3);
      return;
  }
}

}  // namespace

void applyTransposedJacobian(std::span<const LinkFrame> links, std::span<const float> positions,
                             std::span<const Pose> frame_from_link, const CarriedPoint& carried,
                             std::span<float> moves) noexcept {
  assert(moves.size() == positions.size());
  std::ranges::fill(moves, 0.0F);
  for (auto n = static_cast<std::int32_t>(carried.link); n >= 0;) {
    const LinkFrame& link = links[static_cast<std::size_t>(n)];
    if (link.type != JointType::kFixed) {
      const Pose& frame_from_here = frame_from_link[static_cast<std::size_t>(n)];
      Quat back = conjugate(frame_from_here.rotation);
      // A joint of several values moves along axes that it does not turn; a single axis turns onto
      // itself.
      if (positionCount(link.type) > 1) back = jointPose(link, positions).rotation * back;
      const SeenFromJoint seen{rotate(back, carried.point - frame_from_here.translation),
                               rotate(back, carried.direction)};
      addJointMoves(link, positions.data() + link.position, seen, moves.data() + link.position);
    }
    n = link.parent;
  }
}

}  // namespace galactic
