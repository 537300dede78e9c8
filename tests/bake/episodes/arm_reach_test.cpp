#include "episodes/home/arm_reach.h"

#include <gtest/gtest.h>

#include <random>

#include "made_world.h"
#include "support/oracles/box_oracle.h"

namespace galactic::test::arm_reach_test {
namespace {

using bake::ArmReach;
using bake::ArmSample;

Robot robotOf(const MemoryPack& pack) { return MemoryPack::opened(Robot::from(pack.pack())); }

TEST(ArmReach, SamplesAreForwardKinematicsWithinTheLimits) {
  const MemoryPack pack(buildPack(stickRobot()), "stick");
  const Robot robot = robotOf(pack);
  const ArmReach reach(robot);
  ASSERT_GT(reach.samples().size(), 10000U);
  float last = -1;
  for (const ArmSample& sample : reach.samples()) {
    const std::span<const float> positions = reach.positions(sample);
    for (const ControlledJoint& joint : robot.controlledJoints()) {
      ASSERT_GE(positions[joint.position], joint.lower);
      ASSERT_LE(positions[joint.position], joint.upper);
    }
    // Two links of 0.4 m, in closed form.
    const auto lift = static_cast<double>(positions[1]);
    const double both = lift + static_cast<double>(positions[2]);
    const double out = 0.4 * (std::cos(lift) + std::cos(both));
    EXPECT_NEAR(static_cast<double>(sample.distance), std::abs(out), 1e-5);
    EXPECT_NEAR(static_cast<double>(sample.grasp_point.y),
                0.7 + 0.4 * (std::sin(lift) + std::sin(both)), 1e-5);
    ASSERT_GE(sample.grasp_point.y, last);
    last = sample.grasp_point.y;
  }
  EXPECT_LE(reach.farthest(), 0.8001F);
  EXPECT_GT(reach.farthest(), 0.79F);
}

TEST(ArmReach, StaysWithinWideLimitsOnOneSideOfZero) {
  for (const auto& [lower, upper] : {std::pair(1.0F, 100.0F), std::pair(-30.0F, -2.0F)}) {
    RobotPackFields fields = stickRobot();
    ControlledJoint& lift = fields.controlled_joints.front();
    fields.limits[lift.position] = {lower, upper};
    fields.start_positions[lift.position] = lower;
    lift.lower = lower;
    lift.upper = upper;
    const MemoryPack pack(buildPack(fields), "stick");
    const ArmReach reach(robotOf(pack));
    ASSERT_GT(reach.samples().size(), 1000U);
    for (const ArmSample& sample : reach.samples()) {
      ASSERT_GE(reach.positions(sample)[lift.position], lower);
      ASSERT_LE(reach.positions(sample)[lift.position], upper);
    }
  }
}

TEST(ArmReach, CoversWhatIsInsideItsRangeAndNothingOutside) {
  const MemoryPack pack(buildPack(stickRobot()), "stick");
  const ArmReach reach(robotOf(pack));
  std::mt19937 random(5);
  int covered = 0;
  constexpr int kPoints = 4000;
  // A cell's diagonal: cells on the border count as a whole.
  constexpr double kCell = 0.071;
  for (int n = 0; n < kPoints; ++n) {
    const double distance = 1.1 * uniform(random);
    const double height = -0.3 + 2.0 * uniform(random);
    const double from_shoulder = std::hypot(distance, height - 0.7);
    const bool covers = reach.covers(static_cast<float>(distance), static_cast<float>(height));
    if (from_shoulder > 0.8 + kCell) {
      EXPECT_FALSE(covers) << distance << ", " << height;
    }
    // Forwards, away from the folded arm and from the base's own sphere.
    if (from_shoulder < 0.75 && from_shoulder > 0.3 && distance > 0.3 && height > 0) {
      EXPECT_TRUE(covers) << distance << ", " << height;
    }
    if (covers) ++covered;
  }
  EXPECT_GT(covered, kPoints / 10);
  EXPECT_LT(covered, kPoints * 9 / 10);
  EXPECT_FALSE(reach.covers(-0.1F, 0.7F));
  EXPECT_FALSE(reach.covers(0.5F, std::numeric_limits<float>::quiet_NaN()));
}

TEST(ArmReach, FindsTheSamplesBetweenTwoHeights) {
  const MemoryPack pack(buildPack(stickRobot()), "stick");
  const ArmReach reach(robotOf(pack));
  std::size_t expected = 0;
  for (const ArmSample& sample : reach.samples()) {
    if (sample.grasp_point.y >= 0.6F && sample.grasp_point.y < 0.8F) ++expected;
  }
  EXPECT_EQ(reach.between(0.6F, 0.8F).size(), expected);
  EXPECT_GT(expected, reach.samples().size() / 10);
  EXPECT_TRUE(reach.between(5, 6).empty());
}

TEST(ArmReach, LeavesOutSamplesInWhichTheRobotTouchesItself) {
  RobotPackFields fields = stickRobot();
  // The forearm's sphere reaches the base's where the arm hangs down.
  fields.spheres[0].center.y = 0.45F;
  const MemoryPack pack(buildPack(fields), "stick");
  const MemoryPack plain(buildPack(stickRobot()), "stick");
  EXPECT_LT(ArmReach(robotOf(pack)).samples().size(), ArmReach(robotOf(plain)).samples().size());
}

TEST(ArmReach, DoesNotCountLinksThatOverlapAtTheStart) {
  // The base's sphere reaches the upper arm's in every position, as those of neighbors do.
  RobotPackFields robot = stickRobot();
  robot.spheres[0].center = {0, 0.7F, 0};
  robot.spheres[1].center = {0.1F, 0, 0};
  const MemoryPack pack(buildPack(robot), "stick");
  const ArmReach reach(robotOf(pack));
  EXPECT_GT(reach.samples().size(), 10000U);
}

}  // namespace
}  // namespace galactic::test::arm_reach_test
