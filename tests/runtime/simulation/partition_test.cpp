// Evaluations: each episode of a world once, and idle envs that count nowhere.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <vector>

#include "batch_trace.h"

namespace galactic::test::partition_test {
namespace {

constexpr std::uint32_t kSteps = 40;

SimulationOptions partition(std::uint32_t envs) {
  SimulationOptions options = optionsFor(envs);
  options.order = EpisodeOrder::kPartition;
  options.task.most_steps = kSteps;
  return options;
}

BatchSimulator made(const BoxWorld& world, const SimulationOptions& options) {
  return BatchSimulator::create(world.world(), options).value();
}

bool isIdle(const BatchSimulator& simulator, std::size_t env) { return simulator.idle()[env] != 0; }

/// How often each episode was played to its end.
using Played = std::map<std::uint32_t, int>;

/// Steps until all envs are idle, at most `most` steps.
Played playAll(BatchSimulator& simulator, std::uint32_t most) {
  Played played;
  for (std::uint32_t step = 0; step < most; ++step) {
    if (std::ranges::count(simulator.idle(), 0) == 0) return played;
    std::vector<std::uint32_t> episodes;
    for (std::size_t env = 0; env < simulator.envCount(); ++env) {
      episodes.push_back(simulator.envObjects(env).episode);
    }
    simulator.step(actionsFor(simulator, 0, step));
    for (std::size_t env = 0; env < simulator.envCount(); ++env) {
      if (simulator.dones()[env] != 0) ++played[episodes[env]];
    }
  }
  ADD_FAILURE() << "not all envs are idle after " << most << " steps";
  return played;
}

class Partition : public ::testing::TestWithParam<std::uint32_t> {};

TEST_P(Partition, PlaysEachEpisodeOnce) {
  const BoxWorld world = furnishedWorld();
  BatchSimulator simulator = made(world, partition(GetParam()));
  const std::size_t playable =
      world.world().episodes().episodes().size() - simulator.skippedEpisodes().size();
  const Played played = playAll(simulator, kSteps * (1 + static_cast<std::uint32_t>(playable)));
  EXPECT_EQ(played.size(), playable);
  for (const auto& [episode, times] : played) EXPECT_EQ(times, 1) << "episode " << episode;
  EXPECT_EQ(simulator.statistics().episodes, playable);
  EXPECT_LE(simulator.statistics().steps, std::uint64_t{kSteps} * playable);
}

// One env for all, fewer than episodes, as many, more.
INSTANTIATE_TEST_SUITE_P(Envs, Partition, ::testing::Values(1U, 2U, 4U, 5U, 6U, 7U, 20U));

TEST(PartitionIdle, NothingOfAnIdleEnvChangesNorCounts) {
  const BoxWorld world = furnishedWorld();
  BatchSimulator simulator = made(world, partition(20));
  playAll(simulator, 2 * kSteps);
  const SimulationStatistics before = simulator.statistics();
  const std::vector<float> seen(simulator.observations().begin(), simulator.observations().end());
  const EnvState state = simulator.envState(3);
  for (std::uint32_t step = 0; step < kSteps; ++step) {
    simulator.step(actionsFor(simulator, 0, 1000 + step));
    ASSERT_EQ(std::ranges::count(simulator.dones(), 0), 20);
    ASSERT_EQ(std::ranges::count(simulator.rewards(), 0.0F), 20);
  }
  EXPECT_TRUE(std::ranges::equal(simulator.observations(), seen));
  EXPECT_EQ(simulator.envState(3).step, state.step);
  EXPECT_EQ(simulator.envState(3).joint_positions, state.joint_positions);
  const SimulationStatistics after = simulator.statistics();
  EXPECT_EQ(after.steps, before.steps);
  EXPECT_EQ(after.refused, before.refused);
  EXPECT_EQ(after.slid, before.slid);
  EXPECT_EQ(after.grasps, before.grasps);
  EXPECT_EQ(after.reward, before.reward);
}

TEST(PartitionTurns, AreNotTakenByChosenEpisodes) {
  const BoxWorld world = furnishedWorld();
  BatchSimulator simulator = made(world, partition(2));
  const std::size_t playable =
      world.world().episodes().episodes().size() - simulator.skippedEpisodes().size();
  // What it plays anyhow, from the start again.
  std::vector<std::int32_t> chosen(2, BatchSimulator::kStays);
  chosen[0] = static_cast<std::int32_t>(simulator.envObjects(0).episode);
  for (std::uint32_t step = 0; step < 3; ++step) {
    simulator.step(actionsFor(simulator, 0, step));
    simulator.reset(chosen);
  }
  const Played played = playAll(simulator, kSteps * (1 + static_cast<std::uint32_t>(playable)));
  EXPECT_EQ(played.size(), playable);
  for (const auto& [episode, times] : played) EXPECT_EQ(times, 1) << "episode " << episode;
}

TEST(PartitionIdle, EndsWithAChosenEpisodeAndNotWithTheNextOne) {
  const BoxWorld world = furnishedWorld();
  BatchSimulator simulator = made(world, partition(10));
  playAll(simulator, 2 * kSteps);
  std::vector<std::int32_t> wanted(10, BatchSimulator::kStays);
  wanted[1] = BatchSimulator::kNextEpisode;
  wanted[2] = 1;
  simulator.reset(wanted);
  EXPECT_TRUE(isIdle(simulator, 0));
  EXPECT_TRUE(isIdle(simulator, 1));
  EXPECT_FALSE(isIdle(simulator, 2));
  EXPECT_EQ(simulator.envState(2).step, 0U);
  simulator.step(actionsFor(simulator, 0, 0));
  EXPECT_EQ(simulator.envState(2).step, 1U);
  EXPECT_EQ(simulator.envState(2).episode, 1U);
}

TEST(PartitionIdle, IsSavedRestoredAndRestarted) {
  const BoxWorld world = furnishedWorld();
  BatchSimulator simulator = made(world, partition(4));
  std::uint32_t step = 0;
  while (std::ranges::count(simulator.idle(), 1) == 0) {
    simulator.step(actionsFor(simulator, 0, step++));
  }
  ASSERT_GT(std::ranges::count(simulator.idle(), 0), 0) << "all at once: expected both states";
  const auto saved = simulator.saveState();
  const Played rest = playAll(simulator, 4 * kSteps);
  const SimulationStatistics ended = simulator.statistics();
  BatchSimulator other = made(world, partition(4));
  ASSERT_TRUE(other.restoreState(saved));
  std::uint64_t again = step;
  while (std::ranges::count(other.idle(), 0) > 0) {
    other.step(actionsFor(other, 0, static_cast<std::uint32_t>(again++ - step)));
  }
  EXPECT_EQ(other.statistics().steps, ended.steps);
  EXPECT_EQ(other.statistics().episodes, ended.episodes);
  EXPECT_FALSE(rest.empty());
  // Envs that come into a run of their own bring no steps with them.
  BatchSimulator young = made(world, partition(4));
  const std::vector<std::uint32_t> all{0, 1, 2, 3};
  ASSERT_TRUE(young.restoreState(simulator.saveState(), all));
  EXPECT_EQ(young.statistics().steps, 0U);
  other.restart(5);
  EXPECT_EQ(std::ranges::count(other.idle(), 1), 0);
}

}  // namespace
}  // namespace galactic::test::partition_test
