#pragma once
#include <cstdint>
#include <random>
#include <vector>

#include "common/vec3d.h"
#include "galactic/bake/triangle_mesh.h"

namespace galactic::test {

/// `count` points anywhere in `bounds` grown by `margin` meters on every side.
inline std::vector<bake::Vec3d> randomPoints(std::uint32_t seed, const bake::Bounds& bounds,
                                             float margin, int count) {
  std::mt19937 random(seed);
  const auto between = [&](float lo, float hi) {
    const double share = static_cast<double>(random()) * 0x1p-32;
    return static_cast<double>(lo - margin) + share * static_cast<double>(hi - lo + 2 * margin);
  };
  std::vector<bake::Vec3d> points;
  for (int n = 0; n < count; ++n) {
    const double x = between(bounds.min.x, bounds.max.x);
    const double y = between(bounds.min.y, bounds.max.y);
    points.push_back({x, y, between(bounds.min.z, bounds.max.z)});
  }
  return points;
}

}  // namespace galactic::test
