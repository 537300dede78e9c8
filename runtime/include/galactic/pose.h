#pragma once
#include "galactic/vec3.h"

namespace galactic {

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

/// First `b`, then `a`.
[[nodiscard]] constexpr Quat operator*(const Quat& a, const Quat& b) {
  return {
      a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
      a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}

/// The opposite rotation of a unit quaternion.
[[nodiscard]] constexpr Quat conjugate(const Quat& q) { return {-q.x, -q.y, -q.z, q.w}; }

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

}  // namespace galactic
