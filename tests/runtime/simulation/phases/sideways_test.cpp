// Robots whose bases drive sideways, too: one action more, and the same rules.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <vector>

#include "runtime/simulation/batch_trace.h"

namespace galactic::test::sideways_test {
namespace {

constexpr float kSidewaysStep = 0.08F;
constexpr double kRounding = 1e-6;
/// Of positions that collisions decide, meters: between columns contact is known to half of their
/// spacing.
constexpr float kBetweenColumns = 0.5F * BoxRoom::kSpacing;
constexpr float kCartRadius = 0.12F;

RobotPackFields sidewaysCart() {
  RobotPackFields robot = cartRobot();
  robot.base->sideways_step = kSidewaysStep;
  return robot;
}

/// One env in an empty room of 3 x 3 m, in its middle unless said otherwise.
BoxWorld roomWith(const RobotPackFields& robot, float yaw, std::vector<Block> blocks = {}) {
  blocks.push_back(plainFloor());
  return {blocks, robot,
          episodesFrom({{.base = {1.5F, 0, 1.5F}, .yaw = yaw, .objects = {{2.8F, 0, 2.8F}}}})};
}

BatchSimulator made(const BoxWorld& world, SimulationOptions options = optionsFor(1)) {
  options.task.kind = TaskKind::kNone;
  return BatchSimulator::create(world.world(), options).value();
}

/// All zeros but one.
std::vector<float> rowOf(const ActionLayout& layout, std::size_t action, float value) {
  std::vector<float> row(layout.count());
  row[action] = value;
  return row;
}

TEST(Sideways, IsAnActionAfterTheTurnWhereARobotHasIt) {
  const BoxWorld world = roomWith(sidewaysCart(), 0);
  const ActionLayout layout = ActionLayout::of(world.world().robot());
  EXPECT_TRUE(layout.drives_sideways);
  EXPECT_EQ(layout.turn(), kCartJoints + 1);
  EXPECT_EQ(layout.sideways(), kCartJoints + 2);
  EXPECT_EQ(layout.hand(), kCartJoints + 3);
  EXPECT_EQ(layout.terminate(), kCartJoints + 4);
  EXPECT_EQ(layout.count(), kCartActions + 1);
  EXPECT_EQ(layout.movingCount(), kCartJoints + 3);
  EXPECT_EQ(made(world).actionCount(), layout.count());

  const BoxWorld ahead_only = roomWith(cartRobot(), 0);
  const ActionLayout without = ActionLayout::of(ahead_only.world().robot());
  EXPECT_FALSE(without.drives_sideways);
  EXPECT_EQ(without.hand(), kCartJoints + 2);
  EXPECT_EQ(without.count(), kCartActions);
  EXPECT_EQ(made(ahead_only).actionCount(), kCartActions);
}

TEST(Sideways, GoesToTheLeftOfWhereTheRobotLooks) {
  for (const float yaw : {0.0F, 0.7F, -2.5F}) {
    const BoxWorld world = roomWith(sidewaysCart(), yaw);
    BatchSimulator simulator = made(world);
    const ActionLayout layout = simulator.actionLayout();
    for (const float side : {1.0F, -0.5F}) {
      const EnvState before = simulator.envState(0);
      simulator.step(rowOf(layout, layout.sideways(), side));
      const EnvState after = simulator.envState(0);
      const Vec3 way = after.world_from_root.translation - before.world_from_root.translation;
      // Ahead is +X of the root, left is -Z.
      const Vec3 left = rotate(before.world_from_root.rotation, {0, 0, -side * kSidewaysStep});
      EXPECT_NEAR(way.x, left.x, kRounding);
      EXPECT_NEAR(way.z, left.z, kRounding);
      EXPECT_EQ(after.world_from_root.rotation, before.world_from_root.rotation);
    }
  }
}

TEST(Sideways, ComesAfterTheTurnAndOnTopOfTheDrive) {
  const BoxWorld world = roomWith(sidewaysCart(), 0.3F);
  BatchSimulator simulator = made(world);
  const ActionLayout layout = simulator.actionLayout();
  std::vector<float> row(layout.count());
  row[layout.turn()] = -1;
  row[layout.forward()] = 0.5F;
  row[layout.sideways()] = -1;
  simulator.step(row);
  const EnvState after = simulator.envState(0);
  const RobotBase& base = *world.world().robot().base();
  const Vec3 way =
      rotate(after.world_from_root.rotation, {0.5F * base.forward_step, 0, kSidewaysStep});
  EXPECT_NEAR(after.world_from_root.translation.x, 1.5F + way.x, kRounding);
  EXPECT_NEAR(after.world_from_root.translation.z, 1.5F + way.z, kRounding);
}

TEST(Sideways, EndsAtWalls) {
  const float wall = 1.2F;
  const BoxWorld world = roomWith(sidewaysCart(), 0, {{{0, 0, 0}, {3, 1, wall}}});
  BatchSimulator simulator = made(world);
  const ActionLayout layout = simulator.actionLayout();
  for (int step = 0; step < 10; ++step) simulator.step(rowOf(layout, layout.sideways(), 1));
  const Vec3 at = simulator.envState(0).world_from_root.translation;
  EXPECT_GE(at.z, wall + kCartRadius - kBetweenColumns);
  EXPECT_LE(at.z, wall + kCartRadius + kSidewaysStep);
  const SimulationStatistics statistics = simulator.statistics();
  EXPECT_GT(statistics.refused + statistics.slid, 0U);
}

TEST(Sideways, PassesThroughNothingWhereMovesAreLookedAtOnTheirWay) {
  RobotPackFields robot = sidewaysCart();
  // From one side of the plate to the other, and clear of it.
  robot.base->sideways_step = 0.6F;
  const float plate = 1.2F;
  const BoxWorld world = roomWith(robot, 0, {{{0, 0, plate - 0.01F}, {3, 1, plate}}});
  for (const bool continuous : {false, true}) {
    SimulationOptions options = optionsFor(1);
    options.continuous_collision = continuous;
    BatchSimulator simulator = made(world, options);
    const ActionLayout layout = simulator.actionLayout();
    simulator.step(rowOf(layout, layout.sideways(), 1));
    const float z = simulator.envState(0).world_from_root.translation.z;
    if (continuous) {
      EXPECT_GE(z, plate + kCartRadius - kBetweenColumns);
    } else {
      EXPECT_NEAR(z, 0.9F, kRounding);
    }
  }
}

TEST(Sideways, TurnsABaseWhoseMotionsAreOff) {
  constexpr std::uint32_t kEnvs = 4000;
  const BoxWorld world = roomWith(sidewaysCart(), 0);
  SimulationOptions options = optionsFor(kEnvs);
  options.noise.motion = 0.2F;
  BatchSimulator simulator = made(world, options);
  const ActionLayout layout = simulator.actionLayout();
  std::vector<float> actions(kEnvs * layout.count());
  for (std::size_t env = 0; env < kEnvs; ++env) {
    actions[env * layout.count() + layout.sideways()] = 0.5F;
  }
  simulator.step(actions);
  double turns = 0;
  double ways = 0;
  const RobotBase& base = *world.world().robot().base();
  for (std::size_t env = 0; env < kEnvs; ++env) {
    const Pose root = simulator.envState(env).world_from_root;
    const double turn =
        2 * std::atan2(static_cast<double>(root.rotation.y), static_cast<double>(root.rotation.w));
    turns += turn * turn;
    const Vec3 way = rotate(conjugate(root.rotation), root.translation - Vec3{1.5F, 0, 1.5F});
    const double off = -static_cast<double>(way.z) / static_cast<double>(kSidewaysStep) - 0.5;
    ways += off * off;
    ASSERT_NEAR(way.x, 0, 1e-5);
  }
  // As a drive ahead of the same length turns it; known to four deviations of a deviation.
  const double share = 0.2 * 0.5;
  const double turned =
      share * static_cast<double>(base.turn_step * kSidewaysStep / base.forward_step);
  constexpr double kDeviationError = 4 / 89.0;
  EXPECT_NEAR(std::sqrt(turns / kEnvs), turned, turned * kDeviationError);
  EXPECT_NEAR(std::sqrt(ways / kEnvs), share, share * kDeviationError);
}

TEST(Sideways, ArrivesLateAndComesBackFromASavedStateAsOtherActionsDo) {
  const BoxWorld world = furnishedWorld(sidewaysCart());
  SimulationOptions options = optionsFor(20);
  options.noise = {.motion = 0.1F, .localization = 0.1F, .action_delay = 2};
  options.sensors.last_actions = 3;
  BatchSimulator first = BatchSimulator::create(world.world(), options).value();
  BatchSimulator second = BatchSimulator::create(world.world(), options).value();
  for (std::uint32_t step = 0; step < 30; ++step) first.step(actionsFor(first, 0, step));
  ASSERT_TRUE(second.restoreState(first.saveState()));
  BatchTrace first_trace(first);
  BatchTrace second_trace(second);
  for (std::uint32_t step = 30; step < 70; ++step) {
    const std::vector<float> actions = actionsFor(first, 0, step);
    first.step(actions);
    second.step(actions);
    first_trace.add(first);
    second_trace.add(second);
  }
  EXPECT_EQ(first_trace.hashes(), second_trace.hashes());
  EXPECT_GT(first.statistics().slid, 0U);
}

}  // namespace
}  // namespace galactic::test::sideways_test
