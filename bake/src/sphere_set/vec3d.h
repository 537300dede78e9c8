#pragma once
#include <algorithm>
#include <cmath>

#include "galactic/vec3.h"

namespace galactic::bake::sphere_fit {

/// A point or direction in the object's frame, metres.
struct Vec3d {
  double x = 0;
  double y = 0;
  double z = 0;
};

[[nodiscard]] inline Vec3d toVec3d(const Vec3& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

[[nodiscard]] inline Vec3 toVec3(const Vec3d& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

[[nodiscard]] inline Vec3d operator+(const Vec3d& a, const Vec3d& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}

[[nodiscard]] inline Vec3d operator-(const Vec3d& a, const Vec3d& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

[[nodiscard]] inline Vec3d operator*(const Vec3d& v, double factor) {
  return {v.x * factor, v.y * factor, v.z * factor};
}

[[nodiscard]] inline double dot(const Vec3d& a, const Vec3d& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

[[nodiscard]] inline Vec3d cross(const Vec3d& a, const Vec3d& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

[[nodiscard]] inline double squaredLength(const Vec3d& v) { return dot(v, v); }

[[nodiscard]] inline double length(const Vec3d& v) { return std::sqrt(squaredLength(v)); }

[[nodiscard]] inline Vec3d least(const Vec3d& a, const Vec3d& b) {
  return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}

[[nodiscard]] inline Vec3d greatest(const Vec3d& a, const Vec3d& b) {
  return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}

/// `value` rounded to the 24 significant bits of a float (Veltkamp's splitting). Not by a
/// conversion to float and back: GCC 12 drops that where it vectorises it, and builds would differ.
[[nodiscard]] inline double roundedToFloat(double value) {
  constexpr double kSplitter = 0x1p29 + 1;
  const double scaled = value * kSplitter;
  return scaled - (scaled - value);
}

/// The nearest point that a pack can store. Whatever is checked is checked there.
[[nodiscard]] inline Vec3d asStored(const Vec3d& v) {
  return {roundedToFloat(v.x), roundedToFloat(v.y), roundedToFloat(v.z)};
}

/// A box that holds nothing until it is grown.
struct Box {
  Vec3d min{HUGE_VAL, HUGE_VAL, HUGE_VAL};
  Vec3d max{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};

  void grow(const Vec3d& p) {
    min = least(min, p);
    max = greatest(max, p);
  }
  /// The box with `margin` more on every side.
  [[nodiscard]] Box widened(double margin) const {
    const Vec3d m{margin, margin, margin};
    return {min - m, max + m};
  }
  [[nodiscard]] Vec3d size() const { return max - min; }
};

}  // namespace galactic::bake::sphere_fit
