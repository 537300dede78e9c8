// Boxes against an oracle in double precision that shares no code with them.
#include "simulation/collision/resting_box.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "support/oracles/resting_oracle.h"
#include "support/sanitized.h"

namespace galactic::test::resting_box_test {
namespace {

using simulation::nearestPoint;
using simulation::overlapShifts;
using simulation::RestingBox;
using simulation::restingBox;
using simulation::squaredDistance;

/// Floats of a few meters are a micrometer apart.
constexpr double kRounding = 1e-5;

TEST(RestingBox, NearestPointLiesOnTheBoxAsFarAsTheDistance) {
  std::mt19937 random(411);
  Tally inside;
  for (int n = 0; n < 20000; ++n) {
    const Body body = randomBody({.x = {0, 1}, .z = {0, 1}, .most = 0.3F}, random);
    const RestingBox box = body.resting();
    const Point3 at = body.solid().at(
        {2.4 * uniform(random) - 1.2, 2.4 * uniform(random) - 1.2, 2.4 * uniform(random) - 1.2});
    const Vec3 point{static_cast<float>(at[0]), static_cast<float>(at[1]),
                     static_cast<float>(at[2])};
    const Vec3 nearest = nearestPoint(box, point);
    const double distance = body.solid().distance(toPoint3(point));
    const Vec3 offset = nearest - point;
    EXPECT_NEAR(std::sqrt(static_cast<double>(dot(offset, offset))), distance, kRounding);
    EXPECT_LT(body.solid().distance(toPoint3(nearest)), kRounding);
    EXPECT_NEAR(std::sqrt(static_cast<double>(squaredDistance(box, point))), distance, kRounding);
    EXPECT_TRUE(distance > 0 || nearest == point);
    inside.add(distance == 0);
  }
  inside.expectBothSides();
}

TEST(RestingBox, OverlapsAnotherExactlyOverTheIntervalOfShifts) {
  std::mt19937 random(412);
  const Room room{.x = {0, 0.3F}, .z = {0, 0.3F}, .least = 0.03F, .most = 0.15F};
  Tally meets;
  for (int n = 0; n < (kIsSanitized ? 2000 : 20000); ++n) {
    const Body moving = randomBody(room, random);
    const Body fixed = randomBody(room, random);
    const std::optional<Span> shifts = overlapShifts(moving.resting(), fixed.resting());
    meets.add(shifts.has_value());
    const auto overlap_at = [&](double shift) {
      BoxSolid shifted = moving.solid();
      shifted.shiftUp(shift);
      return boxesOverlap(shifted, fixed.solid());
    };
    if (!shifts) {
      for (int step = -32; step <= 32; ++step) ASSERT_FALSE(overlap_at(step / 16.0)) << n;
      continue;
    }
    const auto lo = static_cast<double>(shifts->lo);
    const auto hi = static_cast<double>(shifts->hi);
    ASSERT_FALSE(overlap_at(lo - kRounding)) << n;
    ASSERT_FALSE(overlap_at(hi + kRounding)) << n;
    if (hi - lo < 0.001) continue;  // a graze
    ASSERT_TRUE(overlap_at(lo + kRounding)) << n;
    ASSERT_TRUE(overlap_at((lo + hi) / 2)) << n;
    ASSERT_TRUE(overlap_at(hi - kRounding)) << n;
  }
  meets.expectBothSides();
}

TEST(RestingBox, ShiftsOfBoxesWithParallelAxesAreExact) {
  const RestingBox fixed = restingBox({{}, {0.5F, 0.25F, 0.5F}}, {{0, 1, 0}, {}});
  const RestingBox over = restingBox({{}, {0.25F, 0.125F, 0.25F}}, {{0.5F, 2, 0}, {}});
  EXPECT_EQ(overlapShifts(over, fixed), (Span{-1.375F, -0.625F}));
  const RestingBox beside = restingBox({{}, {0.25F, 0.125F, 0.25F}}, {{0.875F, 2, 0}, {}});
  EXPECT_EQ(overlapShifts(beside, fixed), std::nullopt);
}

}  // namespace
}  // namespace galactic::test::resting_box_test
