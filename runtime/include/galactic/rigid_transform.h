#pragma once
#include "galactic/pose.h"

namespace galactic {

/// A rigid transform as a matrix: the axes and the origin of one frame in another, meters. Faster
/// to apply than a Pose.
struct RigidTransform {
  Vec3 x_axis{1, 0, 0};
  Vec3 y_axis{0, 1, 0};
  Vec3 z_axis{0, 0, 1};
  Vec3 origin;
};

[[nodiscard]] constexpr RigidTransform rigidTransform(const Pose& pose) {
  return {rotate(pose.rotation, {1, 0, 0}), rotate(pose.rotation, {0, 1, 0}),
          rotate(pose.rotation, {0, 0, 1}), pose.translation};
}

/// The direction `v` (frame b) in frame a.
[[nodiscard]] constexpr Vec3 rotate(const RigidTransform& a_from_b, const Vec3& v) {
  return a_from_b.x_axis * v.x + a_from_b.y_axis * v.y + a_from_b.z_axis * v.z;
}

/// The point `p` (frame b) in frame a.
[[nodiscard]] constexpr Vec3 operator*(const RigidTransform& a_from_b, const Vec3& p) {
  return rotate(a_from_b, p) + a_from_b.origin;
}

/// a_from_c.
[[nodiscard]] constexpr RigidTransform operator*(const RigidTransform& a_from_b,
                                                 const RigidTransform& b_from_c) {
  return {rotate(a_from_b, b_from_c.x_axis), rotate(a_from_b, b_from_c.y_axis),
          rotate(a_from_b, b_from_c.z_axis), a_from_b * b_from_c.origin};
}

/// b_from_a.
[[nodiscard]] constexpr RigidTransform inverse(const RigidTransform& a_from_b) {
  const Vec3& x = a_from_b.x_axis;
  const Vec3& y = a_from_b.y_axis;
  const Vec3& z = a_from_b.z_axis;
  const Vec3& o = a_from_b.origin;
  return {{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}, {-dot(x, o), -dot(y, o), -dot(z, o)}};
}

}  // namespace galactic
