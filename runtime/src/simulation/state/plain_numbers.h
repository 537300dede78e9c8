#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <span>

#include "galactic/pose.h"

namespace galactic::simulation {

/// Far beyond any world (meters) and any joint; keeps arithmetic on numbers from outside finite.
inline constexpr float kLargestPlain = 1e6F;

inline bool isPlain(float value) { return std::abs(value) <= kLargestPlain; }
inline bool arePlain(std::span<const float> values) {
  return std::ranges::all_of(values, [](float value) { return isPlain(value); });
}
inline bool isPlain(const Vec3& v) { return isPlain(v.x) && isPlain(v.y) && isPlain(v.z); }
inline bool isPlain(const Pose& pose) {
  const Quat& q = pose.rotation;
  const float length = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
  return isPlain(pose.translation) && std::abs(length - 1) < 1e-3F;
}
inline bool isPlain(const RigidTransform& transform) {
  return arePlain(
      std::bit_cast<std::array<float, sizeof(RigidTransform) / sizeof(float)>>(transform));
}

}  // namespace galactic::simulation
