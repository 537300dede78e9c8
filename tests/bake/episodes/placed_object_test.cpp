#include "episodes/home/placed_object.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "double_pose.h"
#include "support/oracles/box_oracle.h"

namespace galactic::bake::placed_object_test {
namespace {

using test::PlacedBox;
using test::Point;
using test::uniform;

constexpr std::uint32_t kSeed = 11;
/// Rounding of floats over a meter.
constexpr double kRounding = 1e-5;

double between(double low, double high, std::mt19937& random) {
  return low + (high - low) * uniform(random);
}

Quat randomQuat(std::mt19937& random) {
  const auto [w, x, y, z] = test::randomRotation(random);
  return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z),
          static_cast<float>(w)};
}

/// A model with a turned box off its origin, in a stable pose of any rotation.
struct RandomObject {
  explicit RandomObject(std::mt19937& random) {
    const auto number = [&](double low, double high) {
      return static_cast<float>(between(low, high, random));
    };
    model.box.pose = {{number(-0.1, 0.1), number(-0.1, 0.1), number(-0.1, 0.1)},
                      randomQuat(random)};
    model.box.half_extents = {number(0.01, 0.15), number(0.01, 0.15), number(0.01, 0.15)};
    stable = {randomQuat(random), number(0, 0.2), 1};
    spot = {.x = number(-0.3, 0.3),
            .z = number(-0.3, 0.3),
            .surface = number(0.3, 0.9),
            .yaw = number(0, 6.2)};
  }

  [[nodiscard]] PlacedObject placed() const { return placeObject(model, 0, stable, spot); }

  ObjectModel model;
  StablePose stable;
  Spot spot;
};

TEST(PlacedObject, FootprintContainsTheBoxAndNoMoreThanItsRectangle) {
  std::mt19937 random(kSeed);
  for (int n = 0; n < 300; ++n) {
    const RandomObject object(random);
    const PlacedObject placed = object.placed();
    const PlacedBox box(object.model.box, placed.pose);
    const Footprint& print = placed.footprint;
    double most_along = 0;
    double most_across = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const Point p = box.at((corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 1 : -1,
                             (corner & 4) != 0 ? 1 : -1);
      const double dx = p[0] - static_cast<double>(print.x);
      const double dz = p[2] - static_cast<double>(print.z);
      const double along_x = static_cast<double>(print.along_x);
      const double along_z = static_cast<double>(print.along_z);
      most_along = std::max(most_along, std::abs(dx * along_x + dz * along_z));
      most_across = std::max(most_across, std::abs(dz * along_x - dx * along_z));
    }
    EXPECT_NEAR(most_along, static_cast<double>(print.half_length), kRounding);
    EXPECT_NEAR(most_across, static_cast<double>(print.half_width), kRounding);
    EXPECT_NEAR(box.bottom(), static_cast<double>(print.heights.lo), kRounding);
    EXPECT_NEAR(box.top(), static_cast<double>(print.heights.hi), kRounding);
    EXPECT_FLOAT_EQ(placed.pose.translation.y, object.spot.surface + object.stable.height);
  }
}

TEST(PlacedObject, GapIsPositiveOnlyBetweenBoxesThatAreApartAndNeverMoreThanTheirDistance) {
  std::mt19937 random(kSeed);
  int apart = 0;
  constexpr int kPairs = 400;
  for (int n = 0; n < kPairs; ++n) {
    const PlacedObject a = RandomObject(random).placed();
    const RandomObject other(random);
    const PlacedObject b = other.placed();
    // As boxes of their own: the rectangles drawn up, which the gap is about.
    const auto solid = [](const Footprint& print) {
      const float middle = (print.heights.lo + print.heights.hi) / 2;
      const float half_height = (print.heights.hi - print.heights.lo) / 2;
      const float half_yaw = std::atan2(-print.along_z, print.along_x) / 2;
      return PlacedBox(
          {{}, {print.half_length, half_height, print.half_width}},
          {{print.x, middle, print.z}, {0, std::sin(half_yaw), 0, std::cos(half_yaw)}});
    };
    const double distance = solid(a.footprint).distanceTo(solid(b.footprint));
    const auto gap = static_cast<double>(gapBetween(a.footprint, b.footprint));
    EXPECT_LE(gap, distance + kRounding);
    // Alternating projections come near slowly where boxes just overlap.
    constexpr double kUndecided = 2e-3;
    if (std::abs(gap) > kUndecided) {
      EXPECT_EQ(gap > 0, distance > kUndecided) << gap;
    }
    if (gap > 0) ++apart;
  }
  EXPECT_GT(apart, kPairs / 10);
  EXPECT_LT(apart, kPairs * 9 / 10);
}

TEST(PlacedObject, TouchesSpheresThatAreNearerThanTheirRadius) {
  std::mt19937 random(kSeed);
  int touching = 0;
  constexpr int kCases = 2000;
  for (int n = 0; n < kCases; ++n) {
    const RandomObject object(random);
    const PlacedObject placed = object.placed();
    const PlacedBox box(object.model.box, placed.pose);
    BodySphere sphere;
    sphere.radius = 0.05F;
    const Point center =
        box.at(between(-2, 2, random), between(-2, 2, random), between(-2, 2, random));
    sphere.center = test::floatOf(center);
    const double distance = test::distance(center, box.nearest(center));
    EXPECT_NEAR(static_cast<double>(distanceToBox(placed, sphere.center)), distance, kRounding);
    if (std::abs(distance - 0.05) < kRounding) continue;
    const bool expected = distance < 0.05;
    EXPECT_EQ(touches(placed, {&sphere, 1}), expected);
    if (expected) ++touching;
  }
  EXPECT_GT(touching, kCases / 10);
  EXPECT_LT(touching, kCases * 9 / 10);
}

}  // namespace
}  // namespace galactic::bake::placed_object_test
