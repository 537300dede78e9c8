// The rectangle of least area against trying every direction.
#include "fit/rectangle_calipers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "fit_shapes.h"

namespace galactic::bake::fit::rectangle_calipers_test {
namespace {

constexpr std::uint32_t kSeed = 20250411;

double areaAt(const std::vector<Vec2d>& points, double x, double y) {
  double lo_u = 1e300;
  double hi_u = -1e300;
  double lo_v = 1e300;
  double hi_v = -1e300;
  for (const Vec2d& p : points) {
    lo_u = std::min(lo_u, p.x * x + p.y * y);
    hi_u = std::max(hi_u, p.x * x + p.y * y);
    lo_v = std::min(lo_v, p.y * x - p.x * y);
    hi_v = std::max(hi_v, p.y * x - p.x * y);
  }
  return (hi_u - lo_u) * (hi_v - lo_v);
}

TEST(RectangleCalipers, FindNoLargerRectangleThanAFineScan) {
  std::mt19937 random(kSeed);
  RecordProperty("seed", static_cast<int>(kSeed));
  constexpr int kSteps = 5000;
  int much_smaller_than_upright = 0;
  constexpr int kRuns = 200;
  for (int run = 0; run < kRuns; ++run) {
    std::vector<Vec2d> points;
    const double stretch = 0.05 + test::uniform(random);
    const double turn = run % 2 == 0 ? 0.02 : 3 * test::uniform(random);
    for (int at = 0; at < 3 + run; ++at) {
      const double a = test::uniform(random);
      const double b = stretch * test::uniform(random);
      points.push_back(
          {a * std::cos(turn) - b * std::sin(turn), a * std::sin(turn) + b * std::cos(turn)});
      // Some repeat nearly.
      if (at % 5 == 0) points.push_back({points.back().x + 1e-17, points.back().y});
    }
    const std::vector<Vec2d> all = points;
    std::vector<Vec2d> polygon;
    convexPolygon(points, polygon);
    const Vec2d side = leastRectangleDirection(polygon, 0);
    EXPECT_NEAR(side.x * side.x + side.y * side.y, 1, 1e-12);
    const double area = areaAt(all, side.x, side.y);
    double best = areaAt(all, 1, 0);
    if (area < 0.9 * best) ++much_smaller_than_upright;
    for (int step = 0; step < kSteps; ++step) {
      const double angle = std::numbers::pi / 2 * step / kSteps;
      best = std::min(best, areaAt(all, std::cos(angle), std::sin(angle)));
    }
    EXPECT_LE(area, best * (1 + 1e-9));
  }
  EXPECT_GT(much_smaller_than_upright, kRuns / 10);
  EXPECT_LT(much_smaller_than_upright, kRuns * 9 / 10);
}

TEST(RectangleCalipers, TakeTheLineOfCollinearPointsAndAnyForOne) {
  std::vector<Vec2d> line{{0, 0}, {3, 4}, {1.5, 2}, {3, 4}};
  std::vector<Vec2d> polygon;
  convexPolygon(line, polygon);
  ASSERT_EQ(polygon.size(), 2U);
  const Vec2d side = leastRectangleDirection(polygon, 1e-4);
  EXPECT_NEAR(std::abs(side.x), 0.6, 1e-12);
  EXPECT_NEAR(std::abs(side.y), 0.8, 1e-12);
  std::vector<Vec2d> point{{2, 2}, {2, 2}};
  convexPolygon(point, polygon);
  EXPECT_EQ(polygon.size(), 1U);
  EXPECT_EQ(leastRectangleDirection(polygon, 1e-4), (Vec2d{1, 0}));
}

TEST(RectangleCalipers, DropCornersOnASide) {
  std::vector<Vec2d> square{{0, 0}, {1, 0}, {2, 0}, {2, 2}, {0, 2}, {0, 1}, {1, 1}};
  std::vector<Vec2d> polygon;
  convexPolygon(square, polygon);
  EXPECT_EQ(polygon.size(), 4U);
}

}  // namespace
}  // namespace galactic::bake::fit::rectangle_calipers_test
