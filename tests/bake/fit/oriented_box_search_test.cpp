// Oriented boxes against an exhaustive search that knows nothing of hulls.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <thread>
#include <vector>

#include "box_checks.h"
#include "fit_shapes.h"
#include "galactic/bake/oriented_box.h"
#include "support/oracles/box_oracle.h"

namespace galactic::bake::oriented_box_search_test {
namespace {

constexpr std::uint32_t kSeed = 20250412;
/// How far above the best of the search a box of least volume may be.
constexpr double kNearOptimum = 1.01;
/// The volume that padding by a micrometer adds to boxes of a few centimeters.
constexpr double kPaddingShare = 1 + 5e-4;

TEST(MinimumBox, IsWithinOnePerCentOfAnExhaustiveSearch) {
  std::mt19937 random(kSeed);
  RecordProperty("seed", static_cast<int>(kSeed));
  constexpr int kRuns = 60;
  constexpr int kStarts = 60;
  int axis_aligned_is_wasteful = 0;
  double worst = 0;
  for (int run = 0; run < kRuns; ++run) {
    SCOPED_TRACE(testing::Message() << "run " << run);
    auto points = test::randomPoints(random, run % 4, 6 + 3 * run);
    // A third stands upright with straight sides: there the axis-aligned box is the best.
    if (run % 3 == 0) points = test::cuboid({0.1F, 0.05F, test::between(random, 0.02, 0.3)});
    const BoxFitResult fit = fitOrientedBox(points, BoxFit::kMinimum);
    test::expectTightAround(points, fit.box);
    const double best = test::BoxOracle(points).bestVolume(kSeed + 1, kStarts);
    EXPECT_LE(fit.volume, best * kNearOptimum);
    EXPECT_LE(fit.volume, fit.axis_aligned_volume);
    EXPECT_LE(fit.volume, fit.pca_volume);
    EXPECT_EQ(fit.used, BoxFit::kMinimum);
    worst = std::max(worst, fit.volume / best);
    if (fit.axis_aligned_volume > 1.05 * fit.volume) ++axis_aligned_is_wasteful;
  }
  RecordProperty("worst_ratio", std::to_string(worst));
  EXPECT_GT(axis_aligned_is_wasteful, kRuns / 10);
  EXPECT_LT(axis_aligned_is_wasteful, kRuns * 9 / 10);
}

/// Many corners: the search runs on fewer points than the hull has.
TEST(MinimumBox, OfManyCornersIsWithinOnePerCentOfAnExhaustiveSearch) {
  std::mt19937 random(kSeed);
  for (int run = 0; run < 3; ++run) {
    const auto points = test::randomPoints(random, 2, 1500);
    const BoxFitResult fit = fitOrientedBox(points, BoxFit::kMinimum);
    test::expectTightAround(points, fit.box);
    EXPECT_LE(fit.volume, test::BoxOracle(points).bestVolume(kSeed, 20) * kNearOptimum);
    EXPECT_LE(fit.volume, std::min(fit.axis_aligned_volume, fit.pca_volume));
  }
}

TEST(YawBox, HasNoLargerFootprintThanAScanOfAllYaws) {
  std::mt19937 random(kSeed);
  constexpr int kRuns = 60;
  constexpr int kSteps = 3000;
  int turned = 0;
  for (int run = 0; run < kRuns; ++run) {
    // Upright prisms: the least volume is that of a yaw.
    std::vector<Vec3> points;
    for (const Vec3& p : test::randomPoints(random, run % 4, 5 + run)) {
      points.push_back({p.x, -0.2F, p.z});
      points.push_back({p.x, 0.1F, p.z});
    }
    if (run % 3 == 0) points = test::cuboid({0.2F, 0.3F, 0.1F});
    const BoxFitResult fit = fitOrientedBox(points, BoxFit::kYaw);
    test::expectTightAround(points, fit.box);
    EXPECT_LE(fit.volume, fit.axis_aligned_volume);
    if (fit.used != BoxFit::kYaw) continue;
    EXPECT_EQ(fit.box.pose.rotation.x, 0);
    EXPECT_EQ(fit.box.pose.rotation.z, 0);
    const test::BoxOracle oracle(points);
    double best = fit.axis_aligned_volume;
    for (int step = 0; step < kSteps; ++step) {
      const double half = std::numbers::pi / 4 * step / kSteps;
      best = std::min(best, oracle.volumeAt({std::cos(half), 0, std::sin(half), 0}));
    }
    EXPECT_LE(fit.volume, best * kPaddingShare);
    if (fit.box.pose.rotation.w < 0.999F) ++turned;
  }
  EXPECT_GT(turned, kRuns / 10);
  EXPECT_LT(turned, kRuns * 9 / 10);
}

/// Cuboids that lean: some little enough to keep their yaw.
TEST(YawBox, GivesWayToTheMinimumWhereThatSavesMoreThanItsShare) {
  std::mt19937 random(kSeed);
  constexpr int kRuns = 100;
  int gave_way = 0;
  for (int run = 0; run < kRuns; ++run) {
    const double lean = 0.06 * test::uniform(random);
    const Quat tilt{static_cast<float>(std::sin(lean / 2)), 0, 0,
                    static_cast<float>(std::cos(lean / 2))};
    const Pose pose{{}, test::yawBy(6 * test::uniform(random)) * tilt};
    const auto points = test::moved(test::cuboid({0.1F, 0.15F, 0.08F}), pose);
    const BoxFitResult yaw = fitOrientedBox(points, BoxFit::kYaw);
    const BoxFitResult least = fitOrientedBox(points, BoxFit::kMinimum);
    if (yaw.used == BoxFit::kMinimum) {
      ++gave_way;
      EXPECT_TRUE(test::sameBytes(yaw.box, least.box));
    } else {
      EXPECT_EQ(yaw.used, BoxFit::kYaw);
      EXPECT_GE(least.volume, yaw.volume * (1 - kMinimumBoxSaving));
      EXPECT_EQ(yaw.box.pose.rotation.x, 0);
    }
  }
  EXPECT_GT(gave_way, kRuns / 10);
  EXPECT_LT(gave_way, kRuns * 9 / 10);
}

TEST(OrientedBox, IsTheSameBytesForAnyOrderAndOnAnyThread) {
  std::mt19937 random(kSeed);
  const auto points = test::randomPoints(random, 2, 400);
  std::vector<Vec3> repeated = points;
  repeated.insert(repeated.end(), points.rbegin(), points.rend());
  for (const BoxFit fit : {BoxFit::kYaw, BoxFit::kMinimum, BoxFit::kAxisAligned}) {
    const BoxFitResult first = fitOrientedBox(points, fit);
    std::vector<BoxFitResult> others(4);
    std::vector<std::thread> threads;
    for (std::size_t at = 0; at < others.size(); ++at) {
      threads.emplace_back(
          [&, at] { others[at] = fitOrientedBox(at % 2 == 0 ? points : repeated, fit); });
    }
    for (std::thread& thread : threads) thread.join();
    for (const BoxFitResult& other : others) {
      EXPECT_TRUE(test::sameBytes(first.box, other.box));
      EXPECT_EQ(first.volume, other.volume);
      EXPECT_EQ(first.pca_volume, other.pca_volume);
    }
  }
}

}  // namespace
}  // namespace galactic::bake::oriented_box_search_test
