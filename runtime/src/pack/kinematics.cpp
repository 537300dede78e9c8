#include "galactic/kinematics.h"

#include <cassert>
#include <cmath>

namespace galactic {
namespace {

Quat rotationAbout(const Vec3& axis, float angle) {
  const float sine = std::sin(0.5F * angle);
  return {axis.x * sine, axis.y * sine, axis.z * sine, std::cos(0.5F * angle)};
}

/// A quaternion of any length as a rotation; none where it has no direction.
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

}  // namespace galactic
