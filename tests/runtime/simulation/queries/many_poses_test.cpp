// What a PlanningScene says of many poses and of motions, against what it says of each place and
// what the simulation does.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "runtime/simulation/queries/planned_home.h"

namespace galactic::test::many_poses_test {
namespace {

TEST_F(PlanningSceneInTheSmallHome, SaysOfManyPosesWhatItSaysOfEach) {
  fetchTarget();
  constexpr std::size_t kCount = 1000;
  DrawnPoses drawn(3);
  drawn.add(kCount);
  std::vector<std::uint8_t> free(kCount, 2);
  scene_.areFree(drawn.poses(), free);
  const Pose grip = scene_.rootFromGrip();
  std::size_t count = 0;
  for (std::size_t n = 0; n < kCount; ++n) {
    scene_.setJoints(drawn[n].joints);
    EXPECT_EQ(free[n], scene_.isFree(drawn.bases[n]) ? 1 : 0) << n;
    count += free[n];
  }
  EXPECT_GE(count, kLeastShare * kCount);
  EXPECT_LE(count, (1 - kLeastShare) * kCount);
  look();
  EXPECT_EQ(scene_.rootFromGrip(), grip);
  for (const std::uint32_t threads : {2U, 7U, 0U}) {
    std::vector<std::uint8_t> again(kCount, 2);
    scene_.areFree(drawn.poses(), again, threads);
    EXPECT_EQ(again, free);
  }
  scene_.areFree({}, {});
}

TEST_F(PlanningSceneInTheSmallHome, FindsMotionsFreeOnTheWholeOfWhichItIsFree) {
  constexpr std::size_t kCount = 600;
  // Motions cut corners by less than a radius from one place to the next: the few that differ.
  constexpr std::size_t kMostUnsure = kCount / 100;
  constexpr int kPlaces = 1000;
  const DrawnPoses drawn = freePoses(4, 2 * kCount);
  DrawnPoses from(0);
  DrawnPoses to(0);
  for (std::size_t n = 0; n < kCount; ++n) {
    // Long ones and short ones, some of which end in something.
    const float share = n % 2 == 0 ? 1.0F : 0.2F;
    const BasePlace& begin = drawn.bases[2 * n];
    const BasePlace& end = drawn.bases[2 * n + 1];
    from.bases.push_back(begin);
    to.bases.push_back({begin.position + (end.position - begin.position) * share,
                        begin.yaw + share * (end.yaw - begin.yaw)});
    for (std::size_t k = 0; k < 4; ++k) {
      const float joint = drawn[2 * n].joints[k];
      from.joints.push_back(joint);
      to.joints.push_back(joint + share * (drawn[2 * n + 1].joints[k] - joint));
    }
  }
  std::vector<std::uint8_t> free(kCount, 2);
  scene_.areMotionsFree(from.poses(), to.poses(), free);
  std::size_t unsure = 0;
  std::size_t count = 0;
  std::size_t through = 0;
  for (std::size_t n = 0; n < kCount; ++n) {
    bool all = true;
    for (int place = 0; place <= kPlaces && all; ++place) {
      const float share = static_cast<float>(place) / kPlaces;
      std::vector<float> joints(4);
      for (std::size_t k = 0; k < 4; ++k) {
        const float way = to[n].joints[k] - from[n].joints[k];
        // The shoulder is a continuous joint.
        joints[k] = from[n].joints[k] + share * (k == kShoulder ? wrappedAngle(way) : way);
      }
      scene_.setJoints(joints);
      const Vec3 way = to.bases[n].position - from.bases[n].position;
      const float turn = wrappedAngle(to.bases[n].yaw - from.bases[n].yaw);
      all = scene_.isFree({from.bases[n].position + way * share, from.bases[n].yaw + share * turn});
    }
    unsure += all == (free[n] != 0) ? 0U : 1U;
    count += free[n];
    const bool ends = (scene_.setJoints(from[n].joints), scene_.isFree(from.bases[n])) &&
                      (scene_.setJoints(to[n].joints), scene_.isFree(to.bases[n]));
    through += ends && free[n] == 0 ? 1U : 0U;
    EXPECT_EQ(scene_.isMotionFree(from[n], to[n]), free[n] != 0);
  }
  EXPECT_LE(unsure, kMostUnsure);
  EXPECT_GE(count, kLeastShare * kCount);
  EXPECT_LE(count, (1 - kLeastShare) * kCount);
  EXPECT_GE(through, 20U) << "of these the ends alone say nothing";
  std::vector<std::uint8_t> again(kCount, 2);
  scene_.areMotionsFree(from.poses(), to.poses(), again, 3);
  EXPECT_EQ(again, free);
}

TEST_F(PlanningSceneInTheSmallHome, FindsMotionsFreeThatTheSimulationMakesInOneStep) {
  SimulationOptions options = oneEnv();
  options.continuous_collision = true;
  simulator_ = simulatorOf(home_.world(), options);
  look();
  std::minstd_rand random(6);
  std::uniform_real_distribution<float> number(-1, 1);
  constexpr int kMoves = 600;
  // Both look at places on the way, not at the same ones.
  constexpr int kMostUnsure = kMoves / 100;
  int made = 0;
  int unsure = 0;
  for (int n = 0; n < kMoves; ++n) {
    const EnvState before = state();
    SmallHomeRow row{};
    for (const SmallHomeAction action : {kLift, kShoulder, kArm, kWrist})
      row[action] = number(random);
    row[kForward] = (n / 25) % 2 == 0 ? 1.0F : -1.0F;
    row[kTurn] = n % 25 == 0 ? number(random) : 0.0F;
    std::vector<float> joints = before.joint_positions;
    const std::span<const ControlledJoint> controlled = home_.world().robot().controlledJoints();
    for (std::size_t k = 0; k < controlled.size(); ++k) {
      float& joint = joints[controlled[k].position];
      joint =
          std::clamp(joint + controlled[k].step * row[k], controlled[k].lower, controlled[k].upper);
    }
    const RobotBase& robot_base = *home_.world().robot().base();
    const BasePlace from = scene_.baseOf(before);
    BasePlace to = from;
    to.yaw -= robot_base.turn_step * row[kTurn];
    to.position = to.position + headingOf(to.yaw) * (robot_base.forward_step * row[kForward]);
    const bool is_free = scene_.isMotionFree({from, before.joint_positions}, {to, joints});
    const SimulationStatistics was = simulator_.statistics();
    step(row);
    const SimulationStatistics is = simulator_.statistics();
    const bool is_made = is.refused == was.refused && is.slid == was.slid;
    unsure += is_made == is_free ? 0 : 1;
    made += is_made ? 1 : 0;
  }
  EXPECT_LE(unsure, kMostUnsure);
  EXPECT_GE(made, kLeastShare * kMoves);
  EXPECT_LE(made, (1 - kLeastShare) * kMoves);
}

TEST_F(PlanningSceneInTheSmallHome, MovesBasesAlongTheFloorOnly) {
  const std::vector<float> joints = state().joint_positions;
  const BasePlace here = scene_.baseOf(state());
  BasePlace there = here;
  there.position = there.position + headingOf(there.yaw) * -0.2F;
  EXPECT_TRUE(scene_.isMotionFree({here, joints}, {there, joints}));
  for (const float height : {0.5F, -0.5F, std::nanf("")}) {
    BasePlace off = there;
    off.position.y += height;
    EXPECT_FALSE(scene_.isMotionFree({here, joints}, {off, joints})) << height;
    EXPECT_FALSE(scene_.isMotionFree({off, joints}, {here, joints})) << height;
  }
}

TEST_F(PlanningSceneInTheSmallHome, MovesNothingFreelyWhereRoundingMovesItTooFar) {
  const BasePlace here = scene_.baseOf(state());
  const auto isTurnFree = [&](float start) {
    std::vector<float> joints = state().joint_positions;
    joints[kShoulder] = start;
    std::vector<float> turned = joints;
    turned[kShoulder] += 1;
    return scene_.isMotionFree({here, joints}, {here, turned});
  };
  EXPECT_TRUE(isTurnFree(0));
  // Neighboring floats are 0.06 rad apart here: more than a sphere's radius at the hand.
  EXPECT_FALSE(isTurnFree(9e5F));
}

TEST_F(PlanningSceneInTheSmallHome, CopiesAnswerForThemselves) {
  const BasePlace base = scene_.baseOf(state());
  PlanningScene copy(scene_);
  copy.hold(state().target, base);
  EXPECT_TRUE(copy.isHolding());
  EXPECT_FALSE(scene_.isHolding());
  EXPECT_EQ(copy.rootFromGrip(), scene_.rootFromGrip());
  scene_ = copy;
  EXPECT_TRUE(scene_.isHolding());
  copy.putBack();
  EXPECT_TRUE(scene_.isHolding());
  EXPECT_EQ(scene_.gripFromObject(), (PlanningScene(scene_)).gripFromObject());
}

TEST_F(PlanningSceneInTheSmallHome, RefusesArraysOfOtherLengthsAndJointsThatAreNone) {
  const std::vector<BasePlace> bases(2);
  std::vector<float> joints(8);
  std::vector<std::uint8_t> free(2, 2);
  const RobotPoses both{bases, joints};
  EXPECT_EQ(refusalOf([&] {
              scene_.areFree({bases, std::span(joints).first(7)}, free);
            }),
            "PlanningScene::areFree: \"joints\" has the length 7, expected 8");
  EXPECT_EQ(refusalOf([&] { scene_.areFree(both, std::span(free).first(1)); }),
            "PlanningScene::areFree: \"free\" has the length 1, expected 2");
  EXPECT_EQ(
      refusalOf([&] {
        scene_.areMotionsFree(both, {std::span(bases).first(1), std::span(joints).first(4)}, free);
      }),
      "PlanningScene::areMotionsFree: \"to.bases\" has the length 1, expected 2");
  joints[5] = std::nanf("");
  EXPECT_EQ(refusalOf([&] { scene_.areMotionsFree(both, both, free); }),
            "PlanningScene::areMotionsFree: found from.joints[5] nan, expected a finite number of "
            "at most 1e+06");
  EXPECT_EQ(free, std::vector<std::uint8_t>(2, 2));
  EXPECT_EQ(
      refusalOf([&] {
        static_cast<void>(scene_.isMotionFree({{}, std::span(joints).first(4)}, {{}, joints}));
      }),
      "PlanningScene::isMotionFree: \"to.joints\" has the length 8, expected 4");
}

}  // namespace
}  // namespace galactic::test::many_poses_test
