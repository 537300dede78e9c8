// Oriented boxes of shapes whose box is known, and of what fills no volume.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <vector>

#include "box_checks.h"
#include "fit_shapes.h"
#include "galactic/bake/oriented_box.h"

namespace galactic::bake::oriented_box_shapes_test {
namespace {

constexpr std::uint32_t kSeed = 20250413;
/// Padding, and the rounding of coordinates of a meter.
constexpr float kExact = 4e-6F;

std::array<float, 3> sortedHalves(const OrientedBox& box) {
  std::array<float, 3> halves{box.half_extents.x, box.half_extents.y, box.half_extents.z};
  std::sort(halves.begin(), halves.end());
  return halves;
}

TEST(OrientedBox, RecoversATurnedCuboid) {
  std::mt19937 random(kSeed);
  RecordProperty("seed", static_cast<int>(kSeed));
  for (int run = 0; run < 50; ++run) {
    const Pose pose{{test::between(random, -1, 1), 0.3F, test::between(random, -1, 1)},
                    test::toQuat(test::randomRotation(random))};
    const auto points = test::moved(test::cuboid({0.05F, 0.3F, 0.1F}), pose);
    const BoxFitResult fit = fitOrientedBox(points, BoxFit::kMinimum);
    test::expectTightAround(points, fit.box);
    const auto halves = sortedHalves(fit.box);
    EXPECT_NEAR(halves[0], 0.05F, kExact);
    EXPECT_NEAR(halves[1], 0.1F, kExact);
    EXPECT_NEAR(halves[2], 0.3F, kExact);
    // Of 24 equal rotations the nearest to none turns by 62.8 degrees at most.
    EXPECT_GE(fit.box.pose.rotation.w, 0.853F);
  }
}

TEST(OrientedBox, KeepsTheNamesOfTheAxesOfAYawedCuboid) {
  for (const double yaw : {-0.7, -0.3, 0.0, 0.2, 0.75}) {
    const auto points = test::moved(test::cuboid({0.05F, 0.3F, 0.1F}), {{}, test::yawBy(yaw)});
    for (const BoxFit way : {BoxFit::kYaw, BoxFit::kMinimum}) {
      const OrientedBox box = fitOrientedBox(points, way).box;
      EXPECT_NEAR(box.half_extents.x, 0.05F, kExact);
      EXPECT_NEAR(box.half_extents.y, 0.3F, kExact);
      EXPECT_NEAR(box.half_extents.z, 0.1F, kExact);
      EXPECT_NEAR(2 * std::asin(static_cast<double>(box.pose.rotation.y)), yaw, 1e-5);
    }
  }
}

TEST(OrientedBox, OfTheAxesIsTheBounds) {
  const std::vector<Vec3> points{{1, 2, 3}, {1.5F, 2.25F, 2}, {1.25F, 2.5F, 2.5F}};
  const BoxFitResult fit = fitOrientedBox(points, BoxFit::kAxisAligned);
  EXPECT_EQ(fit.used, BoxFit::kAxisAligned);
  EXPECT_EQ(fit.box.pose.rotation, Quat{});
  EXPECT_EQ(fit.box.pose.translation, (Vec3{1.25F, 2.25F, 2.5F}));
  EXPECT_NEAR(fit.box.half_extents.x, 0.25F, kExact);
  EXPECT_NEAR(fit.box.half_extents.y, 0.25F, kExact);
  EXPECT_NEAR(fit.box.half_extents.z, 0.5F, kExact);
  EXPECT_EQ(fit.volume, fit.axis_aligned_volume);
}

TEST(OrientedBox, OfATurnedRectangleHasTheLeastThickness) {
  std::mt19937 random(kSeed);
  for (int run = 0; run < 20; ++run) {
    const Pose pose{{}, test::toQuat(test::randomRotation(random))};
    const auto points = test::moved(test::cuboid({0.2F, 0.1F, 0}), pose);
    const BoxFitResult fit = fitOrientedBox(points, BoxFit::kMinimum);
    test::expectTightAround(points, fit.box);
    const auto halves = sortedHalves(fit.box);
    EXPECT_EQ(halves[0], kMinHalfExtent);
    EXPECT_NEAR(halves[1], 0.1F, kExact);
    EXPECT_NEAR(halves[2], 0.2F, kExact);
  }
}

TEST(OrientedBox, OfALineLiesAlongIt) {
  const std::vector<std::vector<Vec3>> lines{{{0, 0, 0}, {0.3F, 0.2F, 0.1F}, {0.6F, 0.4F, 0.2F}},
                                             {{0.1F, 0.2F, 0.3F}, {-0.4F, 0.1F, 0.7F}},
                                             {{1, 1, 1}, {1, 1.5F, 1}, {1, 1.25F, 1}}};
  for (const auto& line : lines) {
    const BoxFitResult fit = fitOrientedBox(line, BoxFit::kMinimum);
    test::expectTightAround(line, fit.box);
    const auto halves = sortedHalves(fit.box);
    EXPECT_EQ(halves[0], kMinHalfExtent);
    EXPECT_EQ(halves[1], kMinHalfExtent);
    const Vec3 along = line[1] - line[0];
    EXPECT_GT(halves[2], 0.49F * std::sqrt(dot(along, along)));
  }
}

TEST(OrientedBox, OfOnePointIsTheSmallestCube) {
  for (const BoxFit way : {BoxFit::kYaw, BoxFit::kMinimum, BoxFit::kAxisAligned}) {
    for (const std::size_t count : {1U, 7U}) {
      const std::vector<Vec3> points(count, Vec3{0.1F, -0.2F, 0.3F});
      const BoxFitResult fit = fitOrientedBox(points, way);
      EXPECT_EQ(fit.box.pose.translation, points[0]);
      EXPECT_EQ(fit.box.pose.rotation, Quat{});
      EXPECT_EQ(fit.box.half_extents, (Vec3{kMinHalfExtent, kMinHalfExtent, kMinHalfExtent}));
    }
  }
}

TEST(OrientedBox, OfAnUprightPlateTurnsWithIt) {
  const std::vector<Vec3> plate{{0, 0, 0}, {0.3F, 0, 0.4F}, {0.3F, 1, 0.4F}, {0, 1, 0}};
  const BoxFitResult fit = fitOrientedBox(plate, BoxFit::kYaw);
  test::expectTightAround(plate, fit.box);
  EXPECT_EQ(fit.used, BoxFit::kYaw);
  const auto halves = sortedHalves(fit.box);
  EXPECT_LT(halves[0], kMinHalfExtent + kExact);
  EXPECT_NEAR(halves[1], 0.25F, kExact);
}

TEST(OrientedBox, HoldsPointsFarFromTheOriginInFloatArithmetic) {
  std::mt19937 random(kSeed);
  for (int run = 0; run < 20; ++run) {
    auto points = test::randomPoints(random, run % 4, 200);
    for (Vec3& point : points) point = point + Vec3{300, -20, 500};
    for (const BoxFit way : {BoxFit::kYaw, BoxFit::kMinimum, BoxFit::kAxisAligned}) {
      const OrientedBox box = fitOrientedBox(points, way).box;
      const Pose box_from_object = inverse(box.pose);
      for (const Vec3& point : points) {
        const Vec3 local = box_from_object * point;
        ASSERT_LE(std::abs(local.x), box.half_extents.x);
        ASSERT_LE(std::abs(local.y), box.half_extents.y);
        ASSERT_LE(std::abs(local.z), box.half_extents.z);
        // In another order of operations, which rounds otherwise.
        const auto along = [&](const Vec3& axis) {
          const Vec3 turned = rotate(box.pose.rotation, axis);
          return std::abs(dot(turned, point) - dot(turned, box.pose.translation));
        };
        ASSERT_LE(along({1, 0, 0}), box.half_extents.x);
        ASSERT_LE(along({0, 1, 0}), box.half_extents.y);
        ASSERT_LE(along({0, 0, 1}), box.half_extents.z);
      }
    }
  }
}

}  // namespace
}  // namespace galactic::bake::oriented_box_shapes_test
