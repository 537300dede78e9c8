// Planes around convex hulls: nothing is beyond them, and what they let through is near.
#include "fit/hull_planes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "column_grid/triangle_interval.h"
#include "common/vec3d.h"
#include "fit/convex_hull.h"
#include "fit_shapes.h"
#include "galactic/bake/oriented_box.h"

namespace galactic::bake::hull_planes_test {
namespace {

using fit::hullPlanes;

constexpr std::uint32_t kSeed = 20251123;
/// Of the hand's sphere, meters.
constexpr double kRadius = 0.015;

/// The distance to the convex hull of points, by its faces: every triangle is looked at.
class HullOracle {
 public:
  explicit HullOracle(const std::vector<Vec3>& points) {
    const fit::ConvexHull hull = fit::convexHull(points);
    EXPECT_EQ(hull.shape, fit::HullShape::kSolid);
    for (const auto& face : hull.faces) {
      for (std::size_t n = 2; n < face.size(); ++n) {
        triangles_.push_back({pointOf(hull.corners[face[0]]), pointOf(hull.corners[face[n - 1]]),
                              pointOf(hull.corners[face[n]])});
      }
    }
  }

  [[nodiscard]] double distance(const Vec3& p) const {
    const Point point{static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
    double least = std::numeric_limits<double>::infinity();
    bool is_inside = true;
    for (const auto& triangle : triangles_) {
      const auto& [a, b, c] = triangle;
      is_inside = is_inside &&
                  dot(widen(p) - vecOf(a), cross(vecOf(b) - vecOf(a), vecOf(c) - vecOf(a))) <= 0;
      least = std::min(least, squaredDistance(point, triangle));
    }
    return is_inside ? 0 : std::sqrt(least);
  }

 private:
  static Point pointOf(const fit::HullCorner& corner) {
    return {corner.rounded.x, corner.rounded.y, corner.rounded.z};
  }
  static Vec3d vecOf(const Point& point) { return {point[0], point[1], point[2]}; }

  std::vector<std::array<Point, 3>> triangles_;
};

double beyond(const std::vector<HullPlane>& planes, const Vec3& p) {
  double most = 0;
  for (const HullPlane& plane : planes) {
    most = std::max(most, static_cast<double>(dot(plane.normal, p) - plane.offset));
  }
  return most;
}

double distanceToBox(const OrientedBox& box, const Vec3& p) {
  const Vec3 local = inverse(box.pose) * p;
  const auto out = [](float at, float half) {
    return std::max(static_cast<double>(std::abs(at)) - static_cast<double>(half), 0.0);
  };
  return std::hypot(out(local.x, box.half_extents.x), out(local.y, box.half_extents.y),
                    out(local.z, box.half_extents.z));
}

TEST(HullPlanes, HaveAllPointsBehindThem) {
  std::mt19937 random(kSeed);
  RecordProperty("seed", static_cast<int>(kSeed));
  std::size_t planes_seen = 0;
  for (int run = 0; run < 40; ++run) {
    const auto points = test::randomPoints(random, run % 4, 5 + 10 * run);
    const OrientedBox box = fitOrientedBox(points, BoxFit::kYaw).box;
    const std::vector<HullPlane> planes = hullPlanes(points, box);
    planes_seen += planes.size();
    EXPECT_LE(planes.size(), 92U);
    for (const HullPlane& plane : planes) {
      EXPECT_NEAR(dot(plane.normal, plane.normal), 1, 1e-6);
      float nearest = std::numeric_limits<float>::infinity();
      for (const Vec3& p : points) {
        const float behind = plane.offset - dot(plane.normal, p);
        ASSERT_GE(behind, 0) << "in the floats of a reader";
        nearest = std::min(nearest, behind);
      }
      EXPECT_LT(nearest, 1e-5F) << "a plane that touches nothing is too far out";
    }
  }
  EXPECT_GT(planes_seen, 1000U);
}

/// The hand's sphere near the boxes of things: what touches the hull is never refused, and most of
/// what touches the box alone is.
TEST(HullPlanes, RefuseWhatTouchesTheBoxAndNotTheHull) {
  std::mt19937 random(kSeed + 1);
  int touching = 0;
  int near_box = 0;
  int let_through = 0;
  for (int run = 0; run < 30; ++run) {
    const auto points = test::randomPoints(random, 1 + run % 3, 200);
    const HullOracle hull(points);
    const OrientedBox box = fitOrientedBox(points, BoxFit::kYaw).box;
    const std::vector<HullPlane> planes = hullPlanes(points, box);
    const Vec3 reach = box.half_extents + Vec3{0.015F, 0.015F, 0.015F};
    for (int n = 0; n < 200; ++n) {
      const Vec3 p = box.pose * Vec3{test::between(random, -1, 1) * reach.x,
                                     test::between(random, -1, 1) * reach.y,
                                     test::between(random, -1, 1) * reach.z};
      if (distanceToBox(box, p) >= kRadius) continue;
      ++near_box;
      const double distance = hull.distance(p);
      const double measured = beyond(planes, p);
      // The hull of the oracle is rounded.
      constexpr double kRounding = 1e-4;
      ASSERT_LE(measured, distance + kRounding);
      touching += distance < kRadius ? 1 : 0;
      let_through += distance >= kRadius && measured < kRadius ? 1 : 0;
    }
  }
  EXPECT_GT(touching, near_box / 10);
  EXPECT_LT(touching, near_box * 9 / 10);
  // The box alone would let all of them through.
  EXPECT_LT(let_through, (near_box - touching) / 4);
}

TEST(HullPlanes, AreNoneAroundABox) {
  const std::vector<Vec3> corners =
      test::moved(test::cuboid({0.08F, 0.03F, 0.05F}), {{0.1F, 0.2F, 0.3F}, test::yawBy(0.4)});
  EXPECT_TRUE(hullPlanes(corners, fitOrientedBox(corners, BoxFit::kYaw).box).empty());
}

TEST(HullPlanes, TakeWhatACylinderLacksOffItsBox) {
  std::vector<Vec3> can;
  for (int n = 0; n < 64; ++n) {
    const double angle = n * std::numbers::pi / 32;
    for (const float y : {0.0F, 0.1F}) {
      can.push_back({static_cast<float>(0.03 * std::cos(angle)), y,
                     static_cast<float>(0.03 * std::sin(angle))});
    }
  }
  const OrientedBox box{{{0, 0.05F, 0}, {}}, {0.03F, 0.05F, 0.03F}};
  const std::vector<HullPlane> planes = hullPlanes(can, box);
  // The corner of the box is 12.4 mm off the can.
  EXPECT_NEAR(beyond(planes, {0.03F, 0.05F, 0.03F}), 0.03 * (std::numbers::sqrt2 - 1), 1e-4);
  EXPECT_EQ(beyond(planes, {0.03F, 0.05F, 0}), 0);
}

}  // namespace
}  // namespace galactic::bake::hull_planes_test
