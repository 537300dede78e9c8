// The hull of the fits: every point inside, every edge in two faces, and what fills no volume.
#include "fit/convex_hull.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <new>
#include <random>
#include <utility>
#include <vector>

#include "fit_shapes.h"
#include "support/limited_memory.h"
#include "support/sanitized.h"

namespace galactic::bake::fit::convex_hull_test {
namespace {

constexpr std::uint32_t kSeed = 20250410;

double extentOf(const ConvexHull& hull) {
  double extent = 0;
  for (const HullCorner& corner : hull.corners) {
    extent = std::max(extent, norm(corner.rounded - hull.corners[0].rounded));
  }
  return extent;
}

/// As many different points as a large scan has.
std::vector<Vec3> pointsOnABall() {
  std::mt19937 random(kSeed);
  std::normal_distribution<float> normal;
  std::vector<Vec3> points(100'000);
  for (Vec3& point : points) {
    const Vec3 p{normal(random), normal(random), normal(random)};
    point = p * (1 / std::sqrt(dot(p, p)));
  }
  return points;
}

TEST(ConvexHull, ThrowsWhereMemoryRunsOutAndDoesNotCrash) {
  if (test::kIsSanitized) GTEST_SKIP() << "sanitizers map terabytes";
  const std::vector<Vec3> points = pointsOnABall();
  int thrown = 0;
  for (std::uint64_t megabytes = 1;; megabytes += 3) {
    ASSERT_LT(megabytes, 1024U) << "is never enough";
    try {
      const test::LimitedMemory limit(megabytes << 20U);
      const ConvexHull hull = convexHull(points);
      EXPECT_EQ(hull.shape, HullShape::kSolid);
      EXPECT_GT(hull.corners.size(), points.size() / 2);
      break;
    } catch (const std::bad_alloc&) {
      ++thrown;
    }
  }
  EXPECT_GE(thrown, 5) << "there was memory from the beginning";
}

TEST(ConvexHull, HoldsAllPointsAndClosesAroundThem) {
  std::mt19937 random(kSeed);
  RecordProperty("seed", static_cast<int>(kSeed));
  int corners = 0;
  int points_seen = 0;
  for (int run = 0; run < 40; ++run) {
    const auto points = test::randomPoints(random, run % 4, 5 + 10 * run);
    const ConvexHull hull = convexHull(points);
    ASSERT_EQ(hull.shape, HullShape::kSolid);
    const double tolerance = 2 * kHullRounding * extentOf(hull);
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (const auto& face : hull.faces) {
      ASSERT_GE(face.size(), 3U);
      Vec3d area;
      for (std::size_t at = 0; at < face.size(); ++at) {
        const std::uint32_t next = face[(at + 1) % face.size()];
        ++edges[std::pair(face[at], next)];
        area = area + cross(hull.corners[face[at]].rounded - hull.corners[face[0]].rounded,
                            hull.corners[next].rounded - hull.corners[face[0]].rounded);
      }
      const Vec3d normal = normalized(area);
      for (const Vec3& point : points) {
        EXPECT_LE(dot(widen(point) - hull.corners[face[0]].rounded, normal), tolerance);
      }
    }
    for (const auto& [edge, count] : edges) {
      EXPECT_EQ(count, 1);
      EXPECT_TRUE(edges.contains({edge.second, edge.first}));
    }
    for (const HullCorner& corner : hull.corners) {
      EXPECT_LE(norm(corner.rounded - widen(points[corner.source])), tolerance);
    }
    corners += static_cast<int>(hull.corners.size());
    points_seen += static_cast<int>(points.size());
  }
  // Both kinds of points occur: corners and what lies inside.
  EXPECT_GT(corners, points_seen / 10);
  EXPECT_LT(corners, points_seen * 9 / 10);
}

TEST(ConvexHull, OfAPointALineAndAPlaneHasNoFaces) {
  std::mt19937 random(kSeed);
  for (int run = 0; run < 20; ++run) {
    const Pose pose{
        {test::between(random, -1, 1), test::between(random, -1, 1), test::between(random, -1, 1)},
        test::toQuat(test::randomRotation(random))};
    const Vec3 size{0.2F, 0.1F, 0};
    const std::vector<Vec3> same(5, pose.translation);
    EXPECT_EQ(convexHull(same).shape, HullShape::kPoint);
    EXPECT_EQ(convexHull(same).corners.size(), 1U);
    const auto line = test::moved(test::cuboid({size.x, 0, 0}), pose);
    EXPECT_EQ(convexHull(line).shape, HullShape::kLine);
    EXPECT_EQ(convexHull(line).corners.size(), 2U);
    const ConvexHull plane = convexHull(test::moved(test::cuboid(size), pose));
    EXPECT_EQ(plane.shape, HullShape::kPlane);
    EXPECT_GE(plane.corners.size(), 4U);
    EXPECT_NEAR(std::abs(dot(plane.frame[2], widen(rotate(pose.rotation, {0, 0, 1})))), 1, 1e-6);
    EXPECT_TRUE(plane.faces.empty());
  }
}

/// A plate that is turned keeps its thickness although it is a hundredth of the grid that its
/// length would give.
TEST(ConvexHull, OfAThinTurnedPlateKeepsItsThickness) {
  std::mt19937 random(kSeed);
  for (int run = 0; run < 20; ++run) {
    const Pose pose{{}, test::toQuat(test::randomRotation(random))};
    const auto plate = test::moved(test::cuboid({0.5F, 0.3F, 1e-4F}), pose);
    const ConvexHull hull = convexHull(plate);
    ASSERT_EQ(hull.shape, HullShape::kSolid);
    EXPECT_EQ(hull.corners.size(), 8U);
    EXPECT_GE(hull.faces.size(), 6U);
  }
}

}  // namespace
}  // namespace galactic::bake::fit::convex_hull_test
