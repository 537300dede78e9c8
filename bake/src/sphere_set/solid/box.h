#pragma once
#include <algorithm>
#include <cmath>

#include "common/vec3d.h"

namespace galactic::bake::sphere_set {

[[nodiscard]] inline Vec3d least(const Vec3d& a, const Vec3d& b) {
  return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}

[[nodiscard]] inline Vec3d greatest(const Vec3d& a, const Vec3d& b) {
  return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}

/// `value` rounded to the 24 significant bits of a float (Veltkamp's splitting). Does not convert
/// to float and back, because GCC 12 drops that when it vectorizes, and builds would differ.
[[nodiscard]] inline double roundedToFloat(double value) {
  constexpr double kSplitter = 0x1p29 + 1;
  const double scaled = value * kSplitter;
  return scaled - (scaled - value);
}

/// The nearest point that a pack can store. All checks are made for that point.
[[nodiscard]] inline Vec3d asStored(const Vec3d& v) {
  return {roundedToFloat(v.x), roundedToFloat(v.y), roundedToFloat(v.z)};
}

/// A box that is empty until it is grown.
struct Box {
  Vec3d min{HUGE_VAL, HUGE_VAL, HUGE_VAL};
  Vec3d max{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};

  void grow(const Vec3d& p) {
    min = least(min, p);
    max = greatest(max, p);
  }
  /// The box extended by `margin` on every side.
  [[nodiscard]] Box widened(double margin) const {
    const Vec3d m{margin, margin, margin};
    return {min - m, max + m};
  }
  [[nodiscard]] Vec3d size() const { return max - min; }
};

}  // namespace galactic::bake::sphere_set
