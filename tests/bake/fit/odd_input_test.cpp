// Whatever the points are, there is a box around them and a way to rest.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "fit/stable_poses.h"
#include "fit_shapes.h"
#include "galactic/bake/oriented_box.h"

namespace galactic::bake::odd_input_test {
namespace {

constexpr std::uint32_t kSeed = 20250416;

constexpr int kKinds = 8;

/// A point of a small integer lattice, of a few on a plane, of a leaf, of a needle, of a speck, of
/// next to nothing, of a building, or of a rod.
Vec3 oddPoint(std::mt19937& random, int kind, const Pose& pose) {
  const Vec3 p{test::between(random, -1, 1), test::between(random, -1, 1),
               test::between(random, -1, 1)};
  const auto step = [&](unsigned count) { return static_cast<float>(random() % count); };
  switch (kind) {
    case 0:
      return {step(4), step(4), step(4)};
    case 1:
      return {step(3) * 0.1F, step(2) * 0.1F, 0};
    case 2:
      return pose * Vec3{p.x, p.y, p.z * 1e-6F};
    case 3:
      return pose * Vec3{p.x, p.y * 1e-6F, p.z * 1e-7F};
    case 4:
      return p * 1e-5F;
    case 5:
      return p * 1e-30F;
    case 6:
      return p * 700.0F;
    default:
      return pose * Vec3{p.x, p.y * 1e-3F, p.z * 1e-3F};
  }
}

void expectBoxed(const std::vector<Vec3>& points, const OrientedBox& box) {
  const Pose box_from_object = inverse(box.pose);
  for (const Vec3& point : points) {
    const Vec3 local = box_from_object * point;
    EXPECT_LE(std::abs(local.x), box.half_extents.x);
    EXPECT_LE(std::abs(local.y), box.half_extents.y);
    EXPECT_LE(std::abs(local.z), box.half_extents.z);
  }
  for (const float half : {box.half_extents.x, box.half_extents.y, box.half_extents.z}) {
    EXPECT_GE(half, kMinHalfExtent);
  }
}

void expectResting(const std::vector<StablePose>& poses) {
  ASSERT_FALSE(poses.empty());
  double sum = 0;
  for (const StablePose& pose : poses) {
    EXPECT_TRUE(std::isfinite(pose.height));
    const Vec3 axis{pose.rotation.x, pose.rotation.y, pose.rotation.z};
    EXPECT_NEAR(dot(axis, axis) + pose.rotation.w * pose.rotation.w, 1, 1e-6F);
    sum += static_cast<double>(pose.likelihood);
  }
  EXPECT_LE(sum, 1 + 1e-5);
  if (poses.size() < kMaxStablePoses) {
    EXPECT_NEAR(sum, 1, 1e-5);
  }
}

TEST(OddInput, HasABoxAroundItAndAWayToRest) {
  std::mt19937 random(kSeed);
  RecordProperty("seed", static_cast<int>(kSeed));
  constexpr int kRuns = 400;
  int without_thickness = 0;
  for (int run = 0; run < kRuns; ++run) {
    SCOPED_TRACE(testing::Message() << "run " << run);
    const Pose pose{{test::between(random, -1, 1), 0, 0},
                    test::toQuat(test::randomRotation(random))};
    std::vector<Vec3> points;
    const std::size_t count = 1 + random() % 40;
    while (points.size() < count) {
      points.push_back(oddPoint(random, run % kKinds, pose));
      if (random() % 3 == 0) points.push_back(points.back());
    }
    expectBoxed(points, fitOrientedBox(points, BoxFit::kYaw).box);
    const BoxFitResult least = fitOrientedBox(points, BoxFit::kMinimum);
    expectBoxed(points, least.box);
    EXPECT_LE(least.volume, least.axis_aligned_volume);
    EXPECT_LE(least.volume, least.pca_volume);
    const Vec3& half = least.box.half_extents;
    if (std::min({half.x, half.y, half.z}) <= kMinHalfExtent) ++without_thickness;
    expectResting(findStablePoses(test::meshOf(points)));
  }
  EXPECT_GT(without_thickness, kRuns / 10);
  EXPECT_LT(without_thickness, kRuns * 9 / 10);
}

}  // namespace
}  // namespace galactic::bake::odd_input_test
