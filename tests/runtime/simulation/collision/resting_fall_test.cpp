// How far spheres sink onto resting objects, against bisection in double precision.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "simulation/collision/resting_objects.h"
#include "support/homes/resting_bodies.h"
#include "support/oracles/resting_oracle.h"
#include "support/sanitized.h"

namespace galactic::test::resting_fall_test {
namespace {

using simulation::RestingObjects;

/// How far a sphere sinks, by halving the interval between the last free and the first overlapping
/// of many small steps.
double fallByBisection(const std::vector<Body>& bodies, const Vec3& center, double radius) {
  constexpr double kDeepest = 2;
  double best = std::numeric_limits<double>::infinity();
  for (const Body& body : bodies) {
    const BoxSolid solid = body.solid();
    const auto overlaps_at = [&](double depth) {
      Point3 point = toPoint3(center);
      point[1] -= depth;
      return solid.distance(point) < radius;
    };
    // The distance along the line is convex: its least value by golden section.
    double lo = 0;
    double hi = kDeepest;
    for (int n = 0; n < 200; ++n) {
      const double a = lo + (hi - lo) / 3;
      const double b = hi - (hi - lo) / 3;
      Point3 at_a = toPoint3(center);
      Point3 at_b = at_a;
      at_a[1] -= a;
      at_b[1] -= b;
      (solid.distance(at_a) < solid.distance(at_b) ? hi : lo) =
          solid.distance(at_a) < solid.distance(at_b) ? b : a;
    }
    if (overlaps_at(0)) return 0;
    if (!overlaps_at(lo)) continue;
    double free = 0;
    double blocked = lo;
    for (int n = 0; n < 60; ++n) {
      const double middle = (free + blocked) / 2;
      (overlaps_at(middle) ? blocked : free) = middle;
    }
    best = std::min(best, free);
  }
  return best;
}

TEST(RestingObjects, FallIsThatOfBisection) {
  /// A sphere that grazes a box along an edge may sink much further on either side of rounding.
  constexpr double kGraze = 1e-4;
  constexpr double kTolerance = 2e-5;
  std::mt19937 random(410);
  const Room room{.x = {0, 2}, .z = {0, 2}};
  Tally tally;
  for (int round = 0; round < (kIsSanitized ? 4 : 40); ++round) {
    const std::vector<Body> bodies = randomBodies(room, 25, random);
    const RestingObjects objects = restingAt(bodies);
    for (int n = 0; n < 50; ++n) {
      Vec3 center = randomCenter(bodies, room, random);
      center.y += 0.3F;
      const float radius = kRadii[random() % 3];
      const auto r = static_cast<double>(radius);
      const double smaller = fallByBisection(bodies, center, r - kGraze);
      const double larger = fallByBisection(bodies, center, r + kGraze);
      const bool grazes = !(smaller - larger < 0.01) && smaller != larger;
      if (grazes) continue;
      const double expected = fallByBisection(bodies, center, r);
      const auto found = static_cast<double>(objects.fall(center, radius));
      tally.add(std::isfinite(found));
      if (std::isinf(expected)) {
        ASSERT_TRUE(std::isinf(found));
        continue;
      }
      ASSERT_NEAR(found, expected, kTolerance);
    }
  }
  tally.expectBothSides();
}

TEST(RestingObjects, FallIsExactOnSmallCases) {
  const Body cube{{{}, {0.25F, 0.25F, 0.25F}}, {{1, 1, 1}, {}}};
  const RestingObjects objects = restingAt({cube});
  const float infinity = std::numeric_limits<float>::infinity();
  EXPECT_FLOAT_EQ(objects.fall({1, 2, 1}, 0.0625F), 0.6875F);
  EXPECT_FLOAT_EQ(objects.fall({1, 1.3125F, 1}, 0.0625F), 0);
  // Overlapping, beside, under.
  EXPECT_EQ(objects.fall({1, 1.25F, 1}, 0.0625F), 0);
  EXPECT_EQ(objects.fall({1.4F, 2, 1}, 0.0625F), infinity);
  EXPECT_EQ(objects.fall({1, 0.5F, 1}, 0.0625F), infinity);
  // Over an edge, 3-4-5: the ball touches where it is 0.03 beside and 0.04 above.
  EXPECT_NEAR(objects.fall({1.28F, 2, 1}, 0.05F), 1 - 0.25F - 0.04F, 1e-6);
  // Over a corner: 0.02, 0.02 beside.
  EXPECT_NEAR(objects.fall({1.27F, 2, 1.27F}, 0.03F), 1 - 0.25F - 0.01F, 1e-6);
}

}  // namespace
}  // namespace galactic::test::resting_fall_test
