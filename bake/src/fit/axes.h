#pragma once
#include <array>
#include <cmath>
#include <cstddef>

#include "common/vec3d.h"

namespace galactic::bake::fit {

/// Three orthonormal directions, right-handed.
using Axes = std::array<Vec3d, 3>;

inline constexpr Axes kIdentityAxes{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

/// Right-handed axes, the third of which is the unit vector `axis`.
[[nodiscard]] inline Axes axesAround(const Vec3d& axis) {
  const Vec3d other = std::abs(axis.x) < 0.6 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  const Vec3d first = normalized(cross(other, axis));
  return {first, cross(axis, first), axis};
}

/// `v` rotated by the angle |turn| (radians) about the direction of `turn` (Rodrigues).
[[nodiscard]] inline Vec3d rotated(const Vec3d& v, const Vec3d& turn) {
  const double angle = norm(turn);
  if (angle <= 0) return v;
  const Vec3d axis = turn * (1 / angle);
  const double cosine = std::cos(angle);
  return v * cosine + cross(axis, v) * std::sin(angle) + axis * (dot(axis, v) * (1 - cosine));
}

}  // namespace galactic::bake::fit
