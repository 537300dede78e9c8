#pragma once
#include <cmath>
#include <numbers>

namespace galactic {

/// A point in meters, or a direction. The frame is the world's, which is right-handed with Y up,
/// unless a name or a comment says otherwise.
struct Vec3 {
  float x = 0;
  float y = 0;
  float z = 0;

  friend bool operator==(const Vec3&, const Vec3&) = default;
};

/// A closed interval; of heights in meters unless stated otherwise; lo <= hi.
struct Span {
  float lo = 0;
  float hi = 0;

  friend bool operator==(const Span&, const Span&) = default;
};

/// A rotation as a unit quaternion, in Eigen's memory order; text and JSON write (w, x, y, z).
struct Quat {
  float x = 0;
  float y = 0;
  float z = 0;
  float w = 1;

  friend bool operator==(const Quat&, const Quat&) = default;
};

/// A rigid transform a_from_b: rotate, then translate. Meters.
struct Pose {
  Vec3 translation;
  Quat rotation;

  friend bool operator==(const Pose&, const Pose&) = default;
};

[[nodiscard]] constexpr Vec3 operator+(const Vec3& a, const Vec3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}

[[nodiscard]] constexpr Vec3 operator-(const Vec3& a, const Vec3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

[[nodiscard]] constexpr Vec3 operator*(const Vec3& v, float factor) {
  return {v.x * factor, v.y * factor, v.z * factor};
}

[[nodiscard]] constexpr float dot(const Vec3& a, const Vec3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

[[nodiscard]] constexpr Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// The vector `v` turned by the unit quaternion `q`.
[[nodiscard]] constexpr Vec3 rotate(const Quat& q, const Vec3& v) {
  const Vec3 axis{q.x, q.y, q.z};
  const Vec3 twice = cross(axis, v) * 2.0F;
  return v + twice * q.w + cross(axis, twice);
}

/// The rotation that applies `b` first, then `a`.
[[nodiscard]] constexpr Quat operator*(const Quat& a, const Quat& b) {
  return {
      a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
      a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}

/// The opposite rotation of a unit quaternion.
[[nodiscard]] constexpr Quat conjugate(const Quat& q) { return {-q.x, -q.y, -q.z, q.w}; }

/// Radians.
inline constexpr float kFullTurn = 2 * std::numbers::pi_v<float>;

/// The same angle in the range from -pi to pi, radians.
[[nodiscard]] inline float wrappedAngle(float angle) { return std::remainder(angle, kFullTurn); }

/// The angle of (x, y) from +X toward +Y, radians, from -pi to pi. Computed in double and rounded,
/// because the float functions of C libraries differ in their last bits.
[[nodiscard]] inline float angleOf(float y, float x) {
  return static_cast<float>(std::atan2(static_cast<double>(y), static_cast<double>(x)));
}

/// How far a rotation turns about +Y, radians, counter-clockwise seen from above, from -2 pi to 2
/// pi. For an upright rotation, such as that of a robot's root, this is the whole rotation.
[[nodiscard]] inline float yawOf(const Quat& rotation) {
  return 2 * angleOf(rotation.y, rotation.w);
}

/// The upright rotation with this yaw.
[[nodiscard]] inline Quat rotationOfYaw(float yaw) {
  const float half = 0.5F * yaw;
  return {0, std::sin(half), 0, std::cos(half)};
}

/// The point `p` (frame b) in frame a.
[[nodiscard]] constexpr Vec3 operator*(const Pose& a_from_b, const Vec3& p) {
  return rotate(a_from_b.rotation, p) + a_from_b.translation;
}

/// a_from_c.
[[nodiscard]] constexpr Pose operator*(const Pose& a_from_b, const Pose& b_from_c) {
  return {a_from_b * b_from_c.translation, a_from_b.rotation * b_from_c.rotation};
}

/// b_from_a.
[[nodiscard]] constexpr Pose inverse(const Pose& a_from_b) {
  const Quat back = conjugate(a_from_b.rotation);
  return {rotate(back, a_from_b.translation * -1.0F), back};
}

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
