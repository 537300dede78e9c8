// Plans turned into actions, with a base that does more or less than it is asked to.
#include "scripted/plan_player.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "scripted_world.h"
#include "telescope_robot.h"

namespace galactic::test::plan_player_test {
namespace {

using scripted::Arm;
using scripted::Joints;
using scripted::Plan;
using scripted::PlanPlayer;
using scripted::PlanStep;
using Progress = PlanPlayer::Progress;

constexpr float kPi = std::numbers::pi_v<float>;

/// How a toy base is off: its gains, and how far a whole drive turns it, radians.
struct Wheels {
  float drive_gain = 1;
  float turn_gain = 1;
  float drift = 0;
};

PlanStep turnTo(const BasePlace& place) {
  return {PlanStep::Kind::kTurn, place, place.position, {}};
}

PlanStep driveFrom(const BasePlace& from, const BasePlace& to) {
  return {PlanStep::Kind::kDrive, to, from.position, {}};
}

class APlanPlayer : public testing::Test {
 protected:
  APlanPlayer()
      : pack_(buildPack(telescopeRobot({})), "stick"),
        robot_(MemoryPack::opened(Robot::from(pack_.pack()))),
        arm_(robot_),
        start_(robot_.startPositions().begin(), robot_.startPositions().end()) {
    base_.forward_step = 0.1F;
    base_.turn_step = 0.1F;
  }

  /// The arm stays where it is.
  [[nodiscard]] PlanStep reachAt(const BasePlace& place) const {
    return {PlanStep::Kind::kMoveArm, place, {}, start_};
  }

  /// Plays until nothing is left or nothing goes on, 300 actions at most; the base is at at_ then.
  Progress play(std::vector<PlanStep> steps, const Wheels& wheels) {
    Plan plan;
    plan.steps = std::move(steps);
    PlanPlayer player(std::move(plan));
    std::vector<float> actions(arm_.joints().size() + 4);
    const auto count = static_cast<std::ptrdiff_t>(arm_.joints().size());
    for (actions_ = 0; actions_ < 300; ++actions_) {
      std::ranges::fill(actions, 0.0F);
      EnvState state;
      state.world_from_root = {at_.position, {0, std::sin(at_.yaw / 2), 0, std::cos(at_.yaw / 2)}};
      state.joint_positions = start_;
      const Progress progress =
          player.play(arm_, base_, state, start_,
                      scripted::rowOf({.joints = arm_.joints().size()}, std::span(actions)));
      if (progress != Progress::kActs) return progress;
      const float forward = actions.begin()[count];
      const float turn = actions.begin()[count + 1];
      EXPECT_LE(std::fabs(forward), 1);
      EXPECT_LE(std::fabs(turn), 1);
      // Positive turns are clockwise, and come first.
      at_.yaw -= turn * base_.turn_step * wheels.turn_gain + forward * wheels.drift;
      at_.position =
          at_.position + headingOf(at_.yaw) * (forward * base_.forward_step * wheels.drive_gain);
      farthest_ = std::max(farthest_, std::fabs(at_.position.z));
    }
    return Progress::kActs;
  }

  MemoryPack pack_;
  Robot robot_;
  Arm arm_;
  Joints start_;
  RobotBase base_{};
  BasePlace at_;
  int actions_ = 0;
  /// From the line along X.
  float farthest_ = 0;
};

TEST_F(APlanPlayer, DrivesAnExactBaseToTheMillimeterInAsFewActionsAsPlanned) {
  const BasePlace to{{1.05F, 0, 0}, 0};
  EXPECT_EQ(play({turnTo({{}, 0.25F}), turnTo({{}, 0}), driveFrom({}, to)}, {}), Progress::kDone);
  EXPECT_EQ(actions_, 3 + 3 + 11);
  EXPECT_NEAR(at_.position.x, 1.05F, 1e-4F);
  EXPECT_EQ(at_.position.z, 0);
  EXPECT_NEAR(at_.yaw, 0, 1e-4F);
}

TEST_F(APlanPlayer, KeepsABaseOnItsLineThatDoesNotDriveStraight) {
  for (const float sign : {1.0F, -1.0F}) {
    for (const Wheels wheels : {Wheels{0.8F, 0.9F, 0.02F}, Wheels{1.3F, 1.2F, -0.02F}}) {
      at_ = {};
      farthest_ = 0;
      const BasePlace to{{3 * sign, 0, 0}, 0};
      EXPECT_EQ(play({driveFrom({}, to)}, wheels), Progress::kDone);
      // A quarter of an action at most is left.
      EXPECT_NEAR(at_.position.x, to.position.x, 0.025F * 1.3F) << sign;
      EXPECT_LT(farthest_, 0.015F) << sign;
    }
  }
}

TEST_F(APlanPlayer, SteersABaseBackThatHasBeenPushedAside) {
  // Looking along -X, where yaws wrap around.
  for (const float sign : {1.0F, -1.0F}) {
    at_ = {{0, 0, 0.1F}, sign * kPi};
    EXPECT_EQ(play({driveFrom({}, {{-3, 0, 0}, kPi})}, {}), Progress::kDone);
    EXPECT_NEAR(at_.position.x, -3, 1e-3F);
    EXPECT_NEAR(at_.position.z, 0, 2e-3F);
    EXPECT_NEAR(std::fabs(std::remainder(at_.yaw, 2 * kPi)), kPi, 0.01F);
  }
}

TEST_F(APlanPlayer, TurnsABaseThatLooksElsewhereBeforeItDrives) {
  at_ = {{}, 1.5F};
  EXPECT_EQ(play({driveFrom({}, {{1, 0, 0}, 0})}, {}), Progress::kDone);
  EXPECT_NEAR(at_.position.x, 1, 1e-3F);
  EXPECT_LT(farthest_, 0.05F);
}

TEST_F(APlanPlayer, IsAstrayWhereTheBaseIsFarFromItsLineAndStuckWhereItDoesNotMove) {
  at_ = {{0, 0, 0.2F}, 0};
  EXPECT_EQ(play({driveFrom({}, {{1, 0, 0}, 0})}, {}), Progress::kAstray);
  EXPECT_EQ(actions_, 0);
  at_ = {};
  EXPECT_EQ(play({driveFrom({}, {{1, 0, 0}, 0})}, {0, 0, 0}), Progress::kStuck);
  // One that was planned, and two in vain.
  EXPECT_EQ(actions_, 3);
}

TEST_F(APlanPlayer, IsOffWhereTheArmIsToMoveFromSomewhereElse) {
  for (const BasePlace& place :
       {BasePlace{{0.006F, 0, 0}, 0}, BasePlace{{}, 0.006F}, BasePlace{{0, 0, -0.006F}, 2 * kPi}}) {
    at_ = place;
    EXPECT_EQ(play({reachAt({})}, {}), Progress::kOff);
  }
  for (const BasePlace& place : {BasePlace{}, BasePlace{{0.004F, 0, 0}, 2 * kPi + 0.004F}}) {
    at_ = place;
    EXPECT_EQ(play({reachAt({})}, {}), Progress::kDone);
  }
}

TEST_F(APlanPlayer, TurnsAsFinelyAsTheArmNeedsIt) {
  const BasePlace to{{}, 1.0F};
  at_ = {};
  EXPECT_EQ(play({turnTo(to), reachAt(to)}, {1, 0.8F, 0}), Progress::kDone);
  EXPECT_NEAR(at_.yaw, 1, 0.005F);
  at_ = {};
  EXPECT_EQ(play({turnTo(to)}, {1, 0.8F, 0}), Progress::kDone);
  EXPECT_NEAR(at_.yaw, 1, 0.025F);
}

}  // namespace
}  // namespace galactic::test::plan_player_test
