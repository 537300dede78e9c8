// Where a robot will be, beside where the simulation brings it.
#include "scripted/foresight.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "galactic/batch_simulator.h"
#include "scripted_world.h"

namespace galactic::test::foresight_test {
namespace {

constexpr std::uint32_t kDelay = 4;
/// Of sums of a few floats.
constexpr float kRounding = 1e-5F;

TEST(Foresight, IsWhereTheRobotComesToWhereNothingIsInItsWay) {
  RobotPackFields robot = stickRobot();
  robot.base->sideways_step = 0.07F;
  const ScriptedWorld made =
      stickWorld(madeRoom(8, 8).build(), {4, 0, 4}, {1, 0.001F, 1}, {7, 0.001F, 7}, robot);
  SimulationOptions options;
  options.envs = 1;
  options.threads = 1;
  options.noise.action_delay = kDelay;
  BatchSimulator simulator = MemoryPack::opened(BatchSimulator::create(made.world(), options));
  const std::size_t moving = simulator.actionLayout().movingCount();
  std::mt19937 random(5);
  std::uniform_real_distribution<float> any(-1, 1);
  std::vector<float> actions(simulator.actionCount());
  const Vec3 start = simulator.envState(0).world_from_root.translation;
  for (int step = 0; step < 20; ++step) {
    for (std::size_t n = 0; n < moving; ++n) actions[n] = any(random);
    simulator.step(actions);
  }
  const EnvState ahead =
      scripted::foreseen(made.world().robot(), simulator.envState(0), simulator.actionsUnderWay(0));
  const std::vector<float> still(simulator.actionCount());
  for (std::uint32_t step = 0; step < kDelay; ++step) simulator.step(still);
  const EnvState now = simulator.envState(0);
  ASSERT_EQ(simulator.statistics().refused + simulator.statistics().slid, 0U);
  const Vec3 off = ahead.world_from_root.translation - now.world_from_root.translation;
  EXPECT_LT(std::sqrt(dot(off, off)), kRounding);
  const float yaw_off = yawOf(ahead.world_from_root.rotation) - yawOf(now.world_from_root.rotation);
  EXPECT_NEAR(yaw_off, 0, kRounding);
  ASSERT_EQ(ahead.joint_positions.size(), now.joint_positions.size());
  for (std::size_t n = 0; n < now.joint_positions.size(); ++n) {
    EXPECT_NEAR(ahead.joint_positions[n], now.joint_positions[n], kRounding) << n;
  }
  const Vec3 way = now.world_from_root.translation - start;
  EXPECT_GT(std::sqrt(dot(way, way)), 0.1F) << "it drove";
}

}  // namespace
}  // namespace galactic::test::foresight_test
