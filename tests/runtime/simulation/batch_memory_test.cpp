// A step does not allocate, and the memory of a batch is what it says.
#include <gtest/gtest.h>

#include <cstdio>
#include <new>

#include "batch_trace.h"
#include "counted_new.h"

namespace galactic::test::batch_memory_test {
namespace {

TEST(BatchMemory, IsNotAllocatedInAStep) {
  const BoxWorld world = furnishedWorld();
  for (const std::uint32_t threads : {1U, 3U}) {
    SimulationOptions options = optionsFor(64, threads);
    options.noise.action_delay = {0, 1};
    auto simulator = BatchSimulator::create(world.world(), options).value();
    std::vector<std::vector<float>> actions;
    actions.reserve(300);
    for (std::uint32_t step = 0; step < 300; ++step) {
      actions.push_back(actionsFor(simulator, 0, step));
    }
    std::vector<std::int32_t> resets(64, -1);
    // The first step of a batch with several threads starts them.
    simulator.step(actions.front());
    const std::uint64_t before = allocationCount();
    for (std::size_t step = 0; step < actions.size(); ++step) {
      resets[step % 64] = static_cast<std::int32_t>(step % 9) - 2;
      simulator.step(actions[step], resets);
      resets[step % 64] = -1;
    }
    EXPECT_EQ(allocationCount(), before);
    // Everything that a step may do was among them.
    const SimulationStatistics seen = simulator.statistics();
    EXPECT_GT(seen.slid, 100U);
    EXPECT_GT(seen.refused, 0U);
    EXPECT_GT(seen.grasps, 0U);
    EXPECT_GT(seen.drops + seen.restored, 0U);
    EXPECT_GT(seen.episodes, 0U);
  }
}

TEST(BatchMemory, ThatLacksWhileStatesAreSetLeavesAllEnvsAsTheyWere) {
  const BoxWorld world = furnishedWorld();
  constexpr std::uint32_t kEnvs = 3;
  auto from = BatchSimulator::create(world.world(), optionsFor(kEnvs)).value();
  for (std::uint32_t step = 0; step < 5; ++step) from.step(actionsFor(from, 0, step));
  const std::vector<std::uint32_t> envs{0, 1, 2};
  std::vector<EnvState> states;
  for (const std::uint32_t env : envs) states.push_back(from.envState(env));
  auto simulator = BatchSimulator::create(world.world(), optionsFor(kEnvs)).value();
  // Makes what all calls share.
  ASSERT_TRUE(simulator.setStates({}, {}).has_value());
  const std::vector<std::byte> before = simulator.saveState();
  const auto isSet = [&](std::uint64_t allocations) {
    const FailingAllocation failing(allocations);
    try {
      return simulator.setStates(envs, states).has_value();
    } catch (const std::bad_alloc&) {
      return false;
    }
  };
  std::uint64_t allocations = 0;
  while (!isSet(allocations)) {
    ASSERT_EQ(simulator.saveState(), before) << "after " << allocations << " allocations";
    ASSERT_LT(++allocations, 10'000U);
  }
  EXPECT_GT(allocations, 3 + 2 * kEnvs);
  EXPECT_NE(simulator.saveState(), before);
}

TEST(BatchMemory, IsWhatTheBatchSaysForEachEnv) {
  const BoxWorld world = furnishedWorld();
  struct Measured {
    std::uint64_t said = 0;
    std::uint64_t taken = 0;
  };
  const auto measure = [&](std::uint32_t envs) {
    SimulationOptions options = optionsFor(envs);
    options.noise.action_delay = 20;
    const std::uint64_t before = allocatedBytes();
    const auto simulator = BatchSimulator::create(world.world(), options).value();
    return Measured{simulator.memoryBytes(), allocatedBytes() - before};
  };
  const Measured small = measure(256);
  const Measured large = measure(1024);
  const std::uint64_t said = (large.said - small.said) / 768;
  const std::uint64_t taken = (large.taken - small.taken) / 768;
  std::printf("bytes of an env: said %llu, taken %llu\n", static_cast<unsigned long long>(said),
              static_cast<unsigned long long>(taken));
  EXPECT_EQ(said * 768, large.said - small.said);
  // Bookkeeping of vectors is not in the sum.
  EXPECT_GE(taken, said);
  EXPECT_LE(taken, said + said / 8);
}

TEST(BatchMemory, SaysWhatAllEnvsShare) {
  const BoxWorld world = furnishedWorld();
  const auto measure = [&](std::uint32_t envs, bool geodesic) {
    SimulationOptions options = optionsFor(envs);
    options.sensors.geodesic = geodesic;
    const std::uint64_t before = allocatedBytes();
    const auto simulator = BatchSimulator::create(world.world(), options).value();
    EXPECT_LE(simulator.sharedBytes(), allocatedBytes() - before - simulator.memoryBytes());
    return simulator.sharedBytes();
  };
  const std::size_t maps = measure(4, false);
  // Two bytes for each of 48 x 48 cells of two columns, five planes and three radii, at least.
  EXPECT_GE(maps, 2U * 48 * 48 * 5 * 3);
  EXPECT_EQ(measure(64, false), maps);
  EXPECT_GT(measure(4, true), maps);
}

}  // namespace
}  // namespace galactic::test::batch_memory_test
