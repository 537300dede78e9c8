// Joints as the planning of motions sees them.
#include "scripted/arm.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "scripted_world.h"

namespace galactic::test::arm_test {
namespace {

using scripted::Arm;
using scripted::Joints;

constexpr float kUnlimited = std::numeric_limits<float>::max();
constexpr float kTurn = 6.28318531F;

/// The stick with a shoulder that turns all round, which its recipe lets move from `lower` to
/// `upper`.
RobotPackFields turningStick(float lower, float upper) {
  RobotPackFields robot = stickRobot();
  robot.links[1].type = JointType::kContinuous;
  robot.limits[0] = {-kUnlimited, kUnlimited};
  robot.controlled_joints[0] = {0, 0.2F, lower, upper};
  return robot;
}

/// What an arm makes of its shoulder.
struct Shoulder {
  bool wraps = false;
  float difference = 0;
  float moved = 0;
};

Shoulder shoulderOf(const RobotPackFields& fields) {
  const MemoryPack pack(buildPack(fields), "stick");
  const Robot robot = MemoryPack::opened(Robot::from(pack.pack()));
  const Arm arm(robot);
  const Joints start(robot.startPositions().begin(), robot.startPositions().end());
  Joints from = start;
  Joints to = start;
  from[0] = 1.9F;
  to[0] = -1.9F;
  Joints moved = from;
  arm.move(0, 1.5F, moved);
  return {arm.joints()[0].wraps, arm.difference(0, from, to), moved[0]};
}

TEST(Arm, TakesTheShorterWayRoundWhereNobodyLimitsAJoint) {
  const Shoulder free = shoulderOf(turningStick(-kUnlimited, kUnlimited));
  EXPECT_TRUE(free.wraps);
  EXPECT_NEAR(free.difference, kTurn - 3.8F, 1e-5F);
  EXPECT_NEAR(free.moved, 3.4F - kTurn, 1e-5F);
}

TEST(Arm, StaysWithinTheLimitsThatARecipeGivesToAContinuousJoint) {
  const Shoulder limited = shoulderOf(turningStick(-2, 2));
  EXPECT_FALSE(limited.wraps);
  EXPECT_NEAR(limited.difference, -3.8F, 1e-5F);
  EXPECT_EQ(limited.moved, 2);
  // On one side only, and wider than a turn.
  for (const auto& [lower, upper] : {std::pair{-2.0F, kUnlimited}, std::pair{-8.0F, 8.0F}}) {
    const Shoulder shoulder = shoulderOf(turningStick(lower, upper));
    EXPECT_FALSE(shoulder.wraps);
    EXPECT_NEAR(shoulder.difference, -3.8F, 1e-5F);
    EXPECT_NEAR(shoulder.moved, 3.4F, 1e-5F);
  }
}

TEST(Arm, TakesNoTurnForNothingThatMovesAnotherLinkByAPartOfIt) {
  for (const float multiplier : {0.5F, 2.0F}) {
    RobotPackFields robot = turningStick(-kUnlimited, kUnlimited);
    // The elbow follows the shoulder.
    robot.links[3].position = 0;
    robot.links[3].multiplier = multiplier;
    EXPECT_EQ(shoulderOf(robot).wraps, multiplier == 2.0F);
  }
}

}  // namespace
}  // namespace galactic::test::arm_test
