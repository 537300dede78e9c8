// The ways along the floor as a part of the observation and of the reward.
#include "sensors/geodesic.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "galactic/batch_simulator.h"
#include "support/homes/box_world.h"

namespace galactic::test::geodesic_test {
namespace {

using testing::HasSubstr;

/// A wall in the middle, with a gap at large z.
std::vector<Block> walls() { return {plainFloor(), {{1.4375F, 0, 0}, {1.5625F, 2, 2.25F}}}; }

/// Left of the wall; the target stands on the floor a meter ahead of it, the goal (see
/// episodesFrom) is at (1.5, 1.5), in the wall.
EpisodePackFields episode(const Vec3& target, const Vec3& goal, float turn = 0) {
  EpisodePackFields fields = episodesFrom({{{0.75F, 0, 0.75F}, turn, {target}}});
  fields.episodes[0].goal = {goal, {}};
  return fields;
}

SimulationOptions options() {
  SimulationOptions options;
  options.envs = 1;
  options.threads = 1;
  options.sensors.geodesic = true;
  return options;
}

std::span<const float> waysOf(const BatchSimulator& batch) {
  const ObservationPart& part = batch.observationParts().back();
  EXPECT_EQ(part.name, "geodesic");
  EXPECT_EQ(part.size, 6U);
  return batch.observations().subspan(part.first, part.size);
}

/// Half a cell of the floor plan, twice, and the field's own error.
constexpr float kNear = 0.12F;

TEST(Geodesic, TellsLengthAndDirectionOfTheWays) {
  const BoxWorld world(walls(), cartRobot(), episode({0.75F, 0.05F, 2.25F}, {2.25F, 0.05F, 0.75F}));
  const BatchSimulator batch = BatchSimulator::create(world.world(), options()).value();
  const std::span<const float> ways = waysOf(batch);
  // To the right, which is +Z.
  EXPECT_NEAR(ways[0], 1.5F, kNear);
  EXPECT_NEAR(ways[1], 0, 0.1F);
  EXPECT_NEAR(ways[2], -1, 0.02F);
  // Around the end of the wall, from which the robot keeps 12 cm.
  const float around = 2 * std::hypot(0.55F, 1.65F) + 0.4F;
  EXPECT_NEAR(ways[3], around, 0.25F);
  EXPECT_GT(ways[3], 3.2F);
  EXPECT_LT(ways[5], -0.8F);
  EXPECT_GT(ways[4], 0.1F);
}

TEST(Geodesic, TurnsWithTheBase) {
  // Looking along +Z.
  const BoxWorld world(walls(), cartRobot(),
                       episode({0.75F, 0.05F, 2.25F}, {0.75F, 0.05F, 0.25F}, -1.5707963F));
  const BatchSimulator batch = BatchSimulator::create(world.world(), options()).value();
  const std::span<const float> ways = waysOf(batch);
  EXPECT_NEAR(ways[1], 1, 0.02F);
  EXPECT_NEAR(ways[2], 0, 0.1F);
  EXPECT_NEAR(ways[3], 0.5F, kNear);
  EXPECT_NEAR(ways[4], -1, 0.02F);
}

TEST(Geodesic, SaysThatThereIsNoWay) {
  std::vector<Block> blocks = walls();
  blocks[1].max.z = 3;
  const BoxWorld world(blocks, cartRobot(), episode({0.75F, 0.05F, 2.25F}, {2.25F, 0.05F, 0.75F}));
  const BatchSimulator batch = BatchSimulator::create(world.world(), options()).value();
  const std::span<const float> ways = waysOf(batch);
  EXPECT_GT(ways[0], 1);
  EXPECT_EQ(ways[3], -1);
  EXPECT_EQ(ways[4], 0);
  EXPECT_EQ(ways[5], 0);
}

/// Takes the target, which is in reach, and lets it go where the robot is after `turns`.
std::vector<float> afterCarrying(const BoxWorld& world, int turns, std::vector<float>* held) {
  SimulationOptions some = options();
  some.task.kind = TaskKind::kNone;
  some.task.most_steps = 0;
  BatchSimulator batch = BatchSimulator::create(world.world(), some).value();
  std::vector<float> actions(kCartActions, 0);
  const std::size_t hand = kCartJoints + 2;
  actions[0] = 1;
  actions[hand] = 1;
  for (int step = 0; step < 6 && batch.envState(0).held < 0; ++step) batch.step(actions);
  EXPECT_EQ(batch.envState(0).held, 0);
  held->assign(waysOf(batch).begin(), waysOf(batch).end());
  actions[0] = 0;
  actions[kCartJoints + 1] = 1;
  for (int turn = 0; turn < turns; ++turn) batch.step(actions);
  actions[kCartJoints + 1] = 0;
  actions[hand] = 0;
  batch.step(actions);
  EXPECT_LT(batch.envState(0).held, 0);
  const std::span<const float> ways = waysOf(batch);
  return {ways.begin(), ways.end()};
}

TEST(Geodesic, KnowsNoWayOnTheStoreyBelow) {
  // A deck of 1 m, over the floor on which the episode begins, that a robot is put on.
  const BoxWorld world({plainFloor(), {{2, 0.95F, 0}, {3, 1, 3}}}, cartRobot(),
                       episode({0.75F, 0.05F, 2.25F}, {2.5F, 0.05F, 1.5F}));
  BatchSimulator batch = BatchSimulator::create(world.world(), options()).value();
  const std::vector<float> actions(batch.actionCount());
  const auto stand = [&](float height) {
    const EnvState now = batch.envState(0);
    const FollowedState there{.world_from_root = {{2.5F, height, 0.75F}, {}},
                              .joint_positions = now.joint_positions,
                              .objects = now.objects};
    batch.follow(actions, std::span(&there, 1));
  };
  stand(0);
  EXPECT_GT(waysOf(batch)[3], 0.5F);
  stand(1);
  EXPECT_EQ(waysOf(batch)[0], -1);
  EXPECT_EQ(waysOf(batch)[3], -1);
}

TEST(Geodesic, FollowsTheTargetIntoTheHandAndSaysWhenItIsElsewhere) {
  const BoxWorld world({plainFloor()}, cartRobot(),
                       episode({1.45F, 0.2F, 0.75F}, {2.25F, 0.05F, 2.25F}));
  std::vector<float> held;
  const std::vector<float> back = afterCarrying(world, 0, &held);
  EXPECT_EQ(held[0], 0);
  EXPECT_EQ(held[1], 0);
  EXPECT_EQ(held[2], 0);
  EXPECT_GT(held[3], 1);
  EXPECT_GT(back[0], 0.4F);
  const std::vector<float> away = afterCarrying(world, 30, &held);
  EXPECT_EQ(away[0], -1);
  EXPECT_EQ(away[1], 0);
  EXPECT_GT(away[3], 1);
}

TEST(Geodesic, PaysForTheWayThatIsBehind) {
  const BoxWorld world(walls(), cartRobot(),
                       episode({0.75F, 0.05F, 2.25F}, {2.25F, 0.05F, 0.75F}, -1.5707963F));
  SimulationOptions plain = options();
  plain.task.most_steps = 0;
  SimulationOptions shaped = plain;
  shaped.task.geodesic_weight = 2;
  BatchSimulator without = BatchSimulator::create(world.world(), plain).value();
  BatchSimulator with = BatchSimulator::create(world.world(), shaped).value();
  float before = waysOf(with)[0];
  float paid = 0;
  const float first = before;
  for (int step = 0; step < 12; ++step) {
    std::vector<float> actions(kCartActions, 0);
    actions[kCartJoints] = step < 8 ? 1.0F : -0.5F;
    without.step(actions);
    with.step(actions);
    const float now = waysOf(with)[0];
    ASSERT_NEAR(with.rewards()[0], without.rewards()[0] + 2 * (before - now), 1e-4F);
    paid += with.rewards()[0] - without.rewards()[0];
    before = now;
  }
  EXPECT_NEAR(paid, 2 * (first - before), 1e-4F);
  EXPECT_GT(paid, 0.5F);
}

TEST(Geodesic, PaysNothingInTheStepInWhichTheWayBeginsToLeadToTheGoal) {
  const BoxWorld world({plainFloor()}, cartRobot(),
                       episode({1.45F, 0.2F, 0.75F}, {2.25F, 0.05F, 2.25F}));
  SimulationOptions plain = options();
  plain.task.most_steps = 0;
  SimulationOptions shaped = plain;
  shaped.task.geodesic_weight = 2;
  BatchSimulator without = BatchSimulator::create(world.world(), plain).value();
  BatchSimulator with = BatchSimulator::create(world.world(), shaped).value();
  const auto step = [&](const std::vector<float>& actions) {
    without.step(actions);
    with.step(actions);
    return with.rewards()[0] - without.rewards()[0];
  };
  std::vector<float> actions(kCartActions, 0);
  actions[0] = 1;
  actions[kCartJoints + 2] = 1;
  const float to_target = waysOf(with)[0];
  float paid = 0;
  for (int n = 0; n < 6 && with.envState(0).held < 0; ++n) paid = step(actions);
  ASSERT_EQ(with.envState(0).held, 0);
  const float to_goal = waysOf(with)[3];
  EXPECT_GT(std::fabs(to_goal - to_target), 0.5F);
  EXPECT_EQ(paid, 0);
  // From then on the way to the goal counts.
  actions[0] = 0;
  actions[kCartJoints] = 1;
  paid = step(actions);
  EXPECT_NEAR(paid, 2 * (to_goal - waysOf(with)[3]), 1e-4F);
  EXPECT_GT(std::fabs(paid), 0.01F);
}

TEST(Geodesic, IsRefusedBeforeItFillsTheMemory) {
  const BoxWorld world(walls(), cartRobot(), episode({0.75F, 0.05F, 2.25F}, {2.25F, 0.05F, 0.75F}));
  const auto motion =
      simulation::makeMotionModel(world.world().robot(), world.world().startPositionIndices());
  const sensors::StandingRobot robot(world.world().robot(), motion.value(),
                                     simulation::motionKernels());
  std::vector<sensors::Errand> errands;
  for (int n = 0; n < 700; ++n) {
    const float x = 0.1F * static_cast<float>(n % 30);
    const float z = 0.1F * static_cast<float>(n / 30);
    errands.push_back({0, {0.75F, 0, 0.75F}, {x, 0.1F, z}, {0.5F, 0.1F, 0.5F}});
  }
  const auto made = sensors::Geodesic::make(world.world(), robot, {}, errands, 1, 1);
  ASSERT_FALSE(made);
  EXPECT_THAT(made.error().message,
              HasSubstr("MB, more than geodesic-megabytes, which is 1; give a"));
  const auto enough = sensors::Geodesic::make(world.world(), robot, {}, errands, 8, 2);
  ASSERT_TRUE(enough);
  // Goals share their field.
  EXPECT_LE(enough->fieldCount(), 701U);
  EXPECT_GT(enough->fieldCount(), 600U);
}

TEST(Geodesic, PlansAFloorOnceWhateverStartsDoNotLieOnIt) {
  const BoxWorld world(walls(), cartRobot(), episode({0.75F, 0.05F, 2.25F}, {2.25F, 0.05F, 0.75F}));
  const auto motion =
      simulation::makeMotionModel(world.world().robot(), world.world().startPositionIndices());
  const sensors::StandingRobot robot(world.world().robot(), motion.value(),
                                     simulation::motionKernels());
  constexpr Vec3 kTarget{0.75F, 0.05F, 2.25F};
  constexpr Vec3 kGoal{2.25F, 0.05F, 0.75F};
  // In the wall: the robot in its start pose can only stand two or three cells aside.
  std::vector<sensors::Errand> aside;
  for (int n = 0; n < 10; ++n) {
    aside.push_back({0, {1.5F, 0, 0.5F + 0.15F * static_cast<float>(n)}, kTarget, kGoal});
  }
  const auto beside_wall = sensors::Geodesic::make(world.world(), robot, {}, aside, 1, 1);
  ASSERT_TRUE(beside_wall);
  EXPECT_EQ(beside_wall->fieldCount(), 2U);
  EXPECT_GT(beside_wall->toGoal(9, {0.75F, 0, 0.75F}).distance, 3);
  // Where there is no floor, there is nothing to keep.
  const std::vector<sensors::Errand> nowhere(1000, {0, {0.75F, 1.5F, 0.75F}, kTarget, kGoal});
  const auto none = sensors::Geodesic::make(world.world(), robot, {}, nowhere, 1, 1);
  ASSERT_TRUE(none);
  EXPECT_EQ(none->bytes(), 0U);
  EXPECT_LT(none->toGoal(999, {0.75F, 0, 0.75F}).distance, 0);
}

TEST(Geodesic, IsTheSameForAnyNumberOfThreads) {
  const BoxWorld world(walls(), cartRobot(), episode({0.75F, 0.05F, 2.25F}, {2.25F, 0.05F, 0.75F}));
  SimulationOptions some = options();
  some.envs = 40;
  BatchSimulator one = BatchSimulator::create(world.world(), some).value();
  some.threads = 3;
  BatchSimulator three = BatchSimulator::create(world.world(), some).value();
  const std::vector<float> actions(some.envs * kCartActions, 0.4F);
  for (int step = 0; step < 20; ++step) {
    one.step(actions);
    three.step(actions);
    ASSERT_TRUE(std::ranges::equal(one.observations(), three.observations()));
  }
}

}  // namespace
}  // namespace galactic::test::geodesic_test
