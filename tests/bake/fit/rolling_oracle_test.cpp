// Likelihoods of stable poses against dropping the body many times.
#include "rolling_oracle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "fit/stable_poses.h"
#include "fit_shapes.h"

namespace galactic::bake::rolling_oracle_test {
namespace {

constexpr std::uint32_t kSeed = 20250414;
constexpr int kDrops = 20000;
/// Four standard deviations of a share over kDrops drops.
constexpr double kSampling = 4 * 0.5 / 141.4;
/// Corners are rounded to a ten-thousandth of the body's extent.
constexpr double kRounding = 2e-3;

/// The direction in the object's frame that points down in a pose.
Vec3 downOf(const StablePose& pose) { return rotate(conjugate(pose.rotation), {0, -1, 0}); }

/// The pose whose down direction is nearest to a face's normal.
std::size_t poseOf(const std::vector<StablePose>& poses, const test::RollingOracle::Face& face) {
  const Vec3 normal{static_cast<float>(face.normal[0]), static_cast<float>(face.normal[1]),
                    static_cast<float>(face.normal[2])};
  std::size_t best = 0;
  for (std::size_t at = 1; at < poses.size(); ++at) {
    if (dot(downOf(poses[at]), normal) > dot(downOf(poses[best]), normal)) best = at;
  }
  EXPECT_GT(dot(downOf(poses[best]), normal), static_cast<float>(std::cos(kSamePoseAngle)) - 1e-6F);
  return best;
}

TEST(StablePoses, AreAsLikelyAsManyDropsTell) {
  std::mt19937 random(kSeed);
  RecordProperty("seed", static_cast<int>(kSeed));
  constexpr int kBodies = 40;
  int rolled = 0;
  for (int body = 0; body < kBodies; ++body) {
    SCOPED_TRACE(testing::Message() << "body " << body);
    auto points = test::randomPoints(random, body % 4, 5 + body % 8);
    if (body % 5 == 0) {
      // A leaning box: quadrangles, and a base that does not hold it.
      points = test::cuboid({0.05F, 0.2F, 0.07F});
      for (Vec3& point : points) point.x += test::between(random, 0.2, 0.21) * (point.y * 5);
    }
    const std::vector<StablePose> poses = findStablePoses(test::meshOf(points));
    ASSERT_LE(poses.size(), kMaxStablePoses);
    const test::RollingOracle oracle(points);
    std::vector<double> shares(poses.size(), 0);
    for (int drop = 0; drop < kDrops; ++drop) {
      const auto rest = oracle.drop(random);
      shares[poseOf(poses, oracle.faces()[rest.face])] += 1.0 / kDrops;
      if (rest.rolls > 0) ++rolled;
    }
    for (std::size_t at = 0; at < poses.size(); ++at) {
      EXPECT_NEAR(static_cast<double>(poses[at].likelihood), shares[at], kSampling + kRounding);
    }
  }
  EXPECT_GT(rolled, kBodies * kDrops / 10);
  EXPECT_LT(rolled, kBodies * (kDrops / 10) * 9);
}

}  // namespace
}  // namespace galactic::bake::rolling_oracle_test
