#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <span>

#include "galactic/bake/oriented_box.h"

namespace galactic::test {

/// Every point lies in the box by float arithmetic, as a reader computes it, and the box is no
/// looser than its padding: each face has a point near it, unless that side is at its minimum.
inline void expectTightAround(std::span<const Vec3> points, const OrientedBox& box) {
  // Padding, and the float rounding of coordinates up to a few meters.
  constexpr float kSlack = 5e-6F;
  const Pose box_from_object = inverse(box.pose);
  Vec3 lo = box.half_extents;
  Vec3 hi = box.half_extents * -1.0F;
  for (const Vec3& point : points) {
    const Vec3 local = box_from_object * point;
    ASSERT_LE(std::abs(local.x), box.half_extents.x);
    ASSERT_LE(std::abs(local.y), box.half_extents.y);
    ASSERT_LE(std::abs(local.z), box.half_extents.z);
    lo = {std::min(lo.x, local.x), std::min(lo.y, local.y), std::min(lo.z, local.z)};
    hi = {std::max(hi.x, local.x), std::max(hi.y, local.y), std::max(hi.z, local.z)};
  }
  const auto touches = [&](float half, float reached) {
    return half <= bake::kMinHalfExtent || std::abs(reached) >= half - kSlack;
  };
  EXPECT_TRUE(touches(box.half_extents.x, lo.x) && touches(box.half_extents.x, hi.x));
  EXPECT_TRUE(touches(box.half_extents.y, lo.y) && touches(box.half_extents.y, hi.y));
  EXPECT_TRUE(touches(box.half_extents.z, lo.z) && touches(box.half_extents.z, hi.z));
}

/// Whether two boxes are the same bytes.
inline bool sameBytes(const OrientedBox& a, const OrientedBox& b) {
  using Bytes = std::array<std::byte, 10 * sizeof(float)>;
  return std::bit_cast<Bytes>(a) == std::bit_cast<Bytes>(b);
}

}  // namespace galactic::test
