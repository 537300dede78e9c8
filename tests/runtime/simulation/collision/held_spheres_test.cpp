#include "simulation/collision/held_spheres.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "support/oracles/resting_oracle.h"

namespace galactic::test::held_spheres_test {
namespace {

using simulation::HeldSpheres;
using simulation::holdSpheres;
using simulation::paddedToLanes;
using simulation::RadiusRange;
using simulation::SphereBatch;

constexpr float kRadii[] = {0.015F, 0.05F, 0.12F};

TEST(HeldSpheres, StandInLanesRadiusByRadius) {
  std::mt19937 random(424);
  std::vector<SetSphere> spheres;
  for (std::uint32_t n = 0; n < 11; ++n)
    spheres.push_back({{0.01F * static_cast<float>(n), 0, 0.1F}, 2});
  for (std::uint32_t n = 0; n < 8; ++n)
    spheres.push_back({{0, 0.02F * static_cast<float>(n), 0.2F}, 0});
  HeldSpheres room(spheres.size(), kRadii);
  const Pose pose{{1, 2, 3}, randomQuat(random)};
  const SphereBatch batch = holdSpheres(
      ObjectModel{.name = "thing", .box = {}, .spheres = spheres, .stable_poses = {}}, pose, room);
  ASSERT_EQ(batch.ranges.size(), 2U);
  EXPECT_EQ(batch.ranges[0].radius, 0.12F);
  EXPECT_EQ(batch.ranges[0].first, 0U);
  EXPECT_EQ(batch.ranges[0].count, 11U);
  EXPECT_EQ(batch.ranges[1].radius_index, 0U);
  EXPECT_EQ(batch.ranges[1].first, 16U);
  EXPECT_EQ(batch.ranges[1].count, 8U);
  std::size_t sphere = 0;
  for (const RadiusRange& range : batch.ranges) {
    for (std::uint32_t n = 0; n < paddedToLanes(range.count); ++n) {
      const std::size_t from = sphere + std::min(n, range.count - 1);
      const Vec3 expected = pose * spheres[from].center;
      EXPECT_NEAR(batch.x[range.first + n], expected.x, 1e-6F);
      EXPECT_NEAR(batch.y[range.first + n], expected.y, 1e-6F);
      EXPECT_NEAR(batch.z[range.first + n], expected.z, 1e-6F);
    }
    sphere += range.count;
  }
  EXPECT_TRUE(holdSpheres(ObjectModel{}, pose, room).ranges.empty());
}

}  // namespace
}  // namespace galactic::test::held_spheres_test
