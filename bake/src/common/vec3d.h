#pragma once
#include <cmath>
#include <cstddef>
#include <numbers>

#include "galactic/pose.h"

namespace galactic::bake {

/// A point or direction in double precision. Fits compute with it and round once, at the end.
struct Vec3d {
  double x = 0;
  double y = 0;
  double z = 0;

  friend constexpr bool operator==(const Vec3d&, const Vec3d&) = default;
};

[[nodiscard]] constexpr Vec3d widen(const Vec3& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

[[nodiscard]] constexpr Vec3 narrow(const Vec3d& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

[[nodiscard]] constexpr Vec3d operator+(const Vec3d& a, const Vec3d& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}

[[nodiscard]] constexpr Vec3d operator-(const Vec3d& a, const Vec3d& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

[[nodiscard]] constexpr Vec3d operator-(const Vec3d& v) { return {-v.x, -v.y, -v.z}; }

[[nodiscard]] constexpr Vec3d operator*(const Vec3d& v, double factor) {
  return {v.x * factor, v.y * factor, v.z * factor};
}

[[nodiscard]] constexpr double dot(const Vec3d& a, const Vec3d& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

[[nodiscard]] constexpr Vec3d cross(const Vec3d& a, const Vec3d& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

[[nodiscard]] constexpr double squaredNorm(const Vec3d& v) { return dot(v, v); }

[[nodiscard]] inline double norm(const Vec3d& v) { return std::sqrt(squaredNorm(v)); }

/// `v` at unit length; `fallback` if `v` is zero.
[[nodiscard]] inline Vec3d normalized(const Vec3d& v, const Vec3d& fallback = {1, 0, 0}) {
  const double length = norm(v);
  return length > 0 ? v * (1 / length) : fallback;
}

/// Direction number `index` of `count` directions that are spread evenly over the sphere on a
/// Fibonacci spiral.
[[nodiscard]] inline Vec3d evenDirection(std::size_t index, std::size_t count) {
  const double golden_angle = std::numbers::pi * (3 - std::sqrt(5.0));
  const double z = 1 - (2 * static_cast<double>(index) + 1) / static_cast<double>(count);
  const double ring = std::sqrt(1 - z * z);
  const double turn = golden_angle * static_cast<double>(index);
  return {ring * std::cos(turn), ring * std::sin(turn), z};
}

}  // namespace galactic::bake
