// What the actions do to base and joints.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>

#include "motion_batch.h"
#include "support/homes/random_robot.h"

namespace galactic::test::motion_move_test {
namespace {

using namespace galactic::simulation;

/// Some operations on floats of a few meters or radians.
constexpr double kRounding = 4e-6;
/// What the kernels promise for sine and cosine.
constexpr double kSineTolerance = 1.2e-7;

double asDouble(float value) { return static_cast<double>(value); }

/// The smallest turn that takes one angle to the other.
double turnBetween(double from, double to) {
  return std::remainder(to - from, 2 * std::numbers::pi);
}

MotionRobot smallRobot() { return {buildPack(smallRobotPack()), {}}; }

/// Elbow, lift, forward, turn.
struct Action {
  float elbow = 0;
  float lift = 0;
  float forward = 0;
  float turn = 0;
};

MotionBatch movedBy(const MotionRobot& robot, const Action& action, float yaw = 0) {
  MotionBatch batch(robot);
  for (std::size_t env = 0; env < MotionBatch::kEnvs; ++env) {
    batch.x[env] = 1;
    batch.y[env] = 0.5F;
    batch.z[env] = 2;
    batch.yaw[env] = yaw;
    batch.variable(0, env) = 0.25F;
    batch.variable(1, env) = 0.25F;
    batch.action(env, 0) = action.elbow;
    batch.action(env, 1) = action.lift;
    batch.action(env, 2) = action.forward;
    batch.action(env, 3) = action.turn;
  }
  batch.move(motionKernels());
  return batch;
}

TEST(Move, LeavesEverythingWhereItIsWithoutActions) {
  const MotionRobot robot = smallRobot();
  const MotionBatch batch = movedBy(robot, {}, 0.75F);
  EXPECT_EQ(batch.moved_x, batch.x);
  EXPECT_EQ(batch.moved_y, batch.y);
  EXPECT_EQ(batch.moved_z, batch.z);
  EXPECT_EQ(batch.moved_yaw, batch.yaw);
  EXPECT_EQ(batch.movedVariable(0, 3), 0.25F);
  EXPECT_EQ(batch.movedVariable(1, 3), 0.25F);
}

TEST(Move, DrivesForwardAlongTheHeading) {
  const MotionRobot robot = smallRobot();
  const MotionBatch ahead = movedBy(robot, {.forward = 1});
  EXPECT_FLOAT_EQ(ahead.moved_x[0], 1.1F);
  EXPECT_FLOAT_EQ(ahead.moved_z[0], 2);
  EXPECT_FLOAT_EQ(ahead.moved_y[0], 0.5F);
  // A quarter turn counter-clockwise seen from above, from +X towards -Z.
  const MotionBatch left = movedBy(robot, {.forward = 1}, std::numbers::pi_v<float> / 2);
  EXPECT_NEAR(left.moved_x[0], 1, kRounding);
  EXPECT_FLOAT_EQ(left.moved_z[0], 1.9F);
  const MotionBatch back = movedBy(robot, {.forward = -0.5F});
  EXPECT_FLOAT_EQ(back.moved_x[0], 0.95F);
}

TEST(Move, TurnsClockwiseSeenFromAboveForPositiveTurns) {
  const MotionRobot robot = smallRobot();
  const MotionBatch batch = movedBy(robot, {.turn = 1});
  EXPECT_FLOAT_EQ(batch.moved_yaw[0], -0.05F);
  EXPECT_EQ(batch.moved_x[0], 1);
  EXPECT_EQ(batch.moved_z[0], 2);
}

TEST(Move, TurnsBeforeItDrives) {
  const MotionRobot robot = smallRobot();
  const MotionBatch batch = movedBy(robot, {.forward = 1, .turn = 1});
  EXPECT_NEAR(batch.moved_x[0], 1 + 0.1 * std::cos(0.05), kRounding);
  // Clockwise from +X is towards +Z.
  EXPECT_NEAR(batch.moved_z[0], 2 + 0.1 * std::sin(0.05), kRounding);
}

TEST(Move, KeepsJointsWithinTheLimitsOfTheirActions) {
  const MotionRobot robot = smallRobot();
  EXPECT_FLOAT_EQ(movedBy(robot, {.elbow = 1, .lift = -1}).movedVariable(0, 0), 0.45F);
  EXPECT_FLOAT_EQ(movedBy(robot, {.elbow = 1, .lift = -1}).movedVariable(1, 0), 0.2F);
  MotionBatch batch(robot);
  for (int step = 0; step < 10; ++step) {
    batch.action(0, 0) = 1;
    batch.action(0, 1) = -1;
    batch.action(1, 0) = -1;
    batch.action(1, 1) = 1;
    batch.move(motionKernels());
    for (std::size_t env = 0; env < 2; ++env) {
      batch.variable(0, env) = batch.movedVariable(0, env);
      batch.variable(1, env) = batch.movedVariable(1, env);
    }
  }
  EXPECT_EQ(batch.variable(0, 0), 1.5F);
  EXPECT_EQ(batch.variable(1, 0), 0);
  EXPECT_EQ(batch.variable(0, 1), -0.5F);
  EXPECT_EQ(batch.variable(1, 1), 0.5F);
}

/// What one step makes of a joint, in double precision.
void expectJointMoved(const MotionRobot& robot, MotionBatch& batch, std::size_t v,
                      std::size_t env) {
  constexpr float kPi = 3.14159265F;
  const MotionVariable& variable = robot.model.variables[v];
  const float moved = batch.movedVariable(v, env);
  if (variable.action < 0) {
    ASSERT_EQ(moved, batch.variable(v, env));
    return;
  }
  const float action = batch.action(env, static_cast<std::size_t>(variable.action));
  const double sum = asDouble(batch.variable(v, env)) + asDouble(variable.step) * asDouble(action);
  if (variable.wraps) {
    ASSERT_GE(moved, -kPi);
    ASSERT_LT(moved, kPi);
    ASSERT_NEAR(turnBetween(sum, asDouble(moved)), 0, kRounding);
    return;
  }
  ASSERT_GE(moved, variable.lower);
  ASSERT_LE(moved, variable.upper);
  ASSERT_NEAR(asDouble(moved), std::clamp(sum, asDouble(variable.lower), asDouble(variable.upper)),
              kRounding);
}

TEST(Move, DoesWhatItDoesInDoublePrecision) {
  constexpr std::uint32_t kSeed = 511;
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  constexpr float kPi = 3.14159265F;
  Tally wraps;
  Tally drives_sideways;
  for (int n = 0; n < 200; ++n) {
    const MotionRobot robot{buildPack(RandomRobotMaker(random).robot()), {1}};
    for (const MotionVariable& variable : robot.model.variables) wraps.add(variable.wraps);
    const RobotBase& base = robot.model.base;
    drives_sideways.add(base.sideways_step > 0);
    MotionBatch batch(robot);
    batch.draw(random);
    batch.move(motionKernels());
    for (std::size_t env = 0; env < MotionBatch::kEnvs; ++env) {
      for (std::size_t v = 0; v < robot.model.variables.size(); ++v) {
        expectJointMoved(robot, batch, v, env);
      }
      const std::size_t joints = robot.model.controlled.size();
      const double yaw = asDouble(batch.yaw[env]) -
                         asDouble(base.turn_step) * asDouble(batch.action(env, joints + 1));
      const double drive = asDouble(base.forward_step) * asDouble(batch.action(env, joints));
      const double left = base.sideways_step > 0 ? asDouble(base.sideways_step) *
                                                       asDouble(batch.action(env, joints + 2))
                                                 : 0;
      ASSERT_GE(batch.moved_yaw[env], -kPi);
      ASSERT_LT(batch.moved_yaw[env], kPi);
      ASSERT_NEAR(turnBetween(yaw, asDouble(batch.moved_yaw[env])), 0, kRounding);
      // To the left is a quarter turn further.
      ASSERT_NEAR(batch.moved_x[env],
                  asDouble(batch.x[env]) + drive * std::cos(yaw) - left * std::sin(yaw), kRounding);
      ASSERT_NEAR(batch.moved_z[env],
                  asDouble(batch.z[env]) - drive * std::sin(yaw) - left * std::cos(yaw), kRounding);
      ASSERT_EQ(batch.moved_y[env], batch.y[env]);
    }
  }
  wraps.expectBothSides();
  drives_sideways.expectBothSides();
}

TEST(Move, KeepsTurningInOneDirectionForEver) {
  const MotionRobot robot = smallRobot();
  MotionBatch batch(robot);
  double yaw = 0;
  for (int step = 0; step < 100000; ++step) {
    batch.action(0, 3) = 1;
    batch.move(motionKernels());
    yaw -= 0.05;
    const double moved = asDouble(batch.moved_yaw[0]);
    // Rounding adds up, in a step by half a unit in the last place of pi at most.
    ASSERT_NEAR(turnBetween(yaw, moved), 0, 1e-6 + 1.5e-7 * step);
    batch.yaw[0] = batch.moved_yaw[0];
  }
}

TEST(Move, KnowsSineAndCosineOfAllAnglesUpToAThousandRadians) {
  constexpr std::uint32_t kSeed = 512;
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  const MotionRobot robot = smallRobot();
  MotionBatch batch(robot);
  double worst = 0;
  for (int round = 0; round < 50000; ++round) {
    const float range = round % 2 == 0 ? 3.2F : 1000;
    for (float& yaw : batch.yaw) yaw = uniformIn(random, -range, range);
    if (round % 16 == 0) batch.yaw[0] = 1.57079633F * static_cast<float>(round / 128);
    batch.place(motionKernels());
    for (std::size_t env = 0; env < MotionBatch::kEnvs; ++env) {
      const RigidTransform& root = batch.body(env, 0);
      const double yaw = asDouble(batch.yaw[env]);
      worst = std::max({worst, std::abs(asDouble(root.x_axis.x) - std::cos(yaw)),
                        std::abs(asDouble(root.z_axis.x) - std::sin(yaw)),
                        std::abs(asDouble(root.x_axis.z) + std::sin(yaw))});
    }
  }
  std::printf("worst error %.3g\n", worst);
  EXPECT_LT(worst, kSineTolerance);
}

}  // namespace
}  // namespace galactic::test::motion_move_test
