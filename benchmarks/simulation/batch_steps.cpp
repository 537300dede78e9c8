// Steps of a batch on the workload on which the published physics was measured, see
// make_published_world.sh for its worlds:
//
//   GALACTIC_BENCH_WORLD=world.pack batch_steps
//
// GALACTIC_BENCH_HELD_WORLD: the same with the target of each episode in the robot's hand.
// load: 0 random, 1 driving ahead, 2 held. published_slide: the workload's own rule.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "galactic/batch_simulator.h"
#include "galactic/world.h"
#include "hardware_counters.h"
#include "published_workload.h"

namespace {

using galactic::BatchSimulator;
using galactic::Result;
using galactic::SimulationOptions;
using galactic::World;
using galactic::published_workload::Actions;
using galactic::published_workload::Load;
using galactic::published_workload::Resets;

/// Steps before those that are measured.
constexpr std::size_t kWarmUp = 1000;
/// Steps that are measured phase by phase, after the others: to ask for the time takes some 50
/// microseconds of a step of 128 envs.
constexpr std::uint32_t kSampled = 100;

const World* worldFrom(const char* variable) {
  const char* path = std::getenv(variable);
  if (path == nullptr) return nullptr;
  static std::vector<std::pair<std::string, World>> opened;
  for (const auto& [known, world] : opened) {
    if (known == variable) return &world;
  }
  const std::filesystem::path file(path);
  Result<World> world = World::open(std::span(&file, 1));
  if (!world) {
    std::fprintf(stderr, "%s: %s\n", world.error().where.c_str(), world.error().message.c_str());
    std::exit(2);
  }
  opened.reserve(2);
  opened.emplace_back(variable, std::move(*world));
  return &opened.back().second;
}

void report(benchmark::State& state, const BatchSimulator& simulator,
            const galactic::SimulationStatistics& before) {
  const galactic::SimulationStatistics sum = simulator.statistics();
  const auto taken = static_cast<double>(sum.steps - before.steps);
  const auto per_step = [&](std::uint64_t count) {
    return benchmark::Counter(static_cast<double>(count) / taken);
  };
  state.SetItemsProcessed(static_cast<std::int64_t>(sum.steps - before.steps));
  state.counters["refused"] = per_step(sum.refused - before.refused);
  state.counters["slid"] = per_step(sum.slid - before.slid);
  state.counters["grasps"] = per_step(sum.grasps - before.grasps);
  state.counters["bytes_per_env"] = benchmark::Counter(
      static_cast<double>(simulator.memoryBytes()) / static_cast<double>(simulator.envCount()));
}

/// Of one env in one step, nanoseconds of all threads.
void reportPhases(benchmark::State& state, const BatchSimulator& simulator) {
  const double steps = static_cast<double>(simulator.envCount()) * kSampled;
  for (const galactic::PhaseTime& phase : simulator.phaseTimes()) {
    state.counters["ns_" + std::string(phase.name)] =
        benchmark::Counter(phase.seconds * 1e9 / steps);
  }
}

void stepBatch(benchmark::State& state) {
  const auto load = static_cast<Load>(state.range(2));
  const World* world =
      worldFrom(load == Load::kHeld ? "GALACTIC_BENCH_HELD_WORLD" : "GALACTIC_BENCH_WORLD");
  if (world == nullptr) {
    state.SkipWithError("set GALACTIC_BENCH_WORLD (and GALACTIC_BENCH_HELD_WORLD)");
    return;
  }
  const auto envs = static_cast<std::uint32_t>(state.range(0));
  SimulationOptions options = galactic::published_workload::optionsOf(envs, state.range(3) != 0);
  options.threads = static_cast<std::uint32_t>(state.range(1));
  Result<BatchSimulator> simulator = BatchSimulator::create(*world, options);
  if (!simulator) {
    state.SkipWithError(simulator.error().message.c_str());
    return;
  }
  Actions actions(envs, simulator->actionCount(), load);
  Resets resets(envs, world->episodes().episodes().size());
  std::size_t step = 0;
  const auto take = [&] {
    const std::span<const float> batch = actions.batch(step, resets.last());
    simulator->step(batch, resets.at(step));
    ++step;
  };
  // Robots that drive ahead reach the walls first.
  while (step < kWarmUp) take();
  const galactic::SimulationStatistics before = simulator->statistics();
  const HardwareCounter instructions(PERF_COUNT_HW_INSTRUCTIONS);
  const HardwareCounter cycles(PERF_COUNT_HW_CPU_CYCLES);
  instructions.start();
  cycles.start();
  for (auto _ : state) take();
  instructions.stop();
  cycles.stop();
  report(state, *simulator, before);
  // Of the calling thread only.
  if (state.range(1) == 1) {
    const auto taken = static_cast<double>(simulator->statistics().steps - before.steps);
    if (const auto count = instructions.count()) state.counters["instructions"] = *count / taken;
    if (const auto count = cycles.count()) state.counters["cycles"] = *count / taken;
  }
  simulator->samplePhases(1);
  for (std::uint32_t n = 0; n < kSampled; ++n) take();
  reportPhases(state, *simulator);
}

}  // namespace

BENCHMARK(stepBatch)
    ->ArgNames({"envs", "threads", "load", "published_slide"})
    ->ArgsProduct({{128, 512, 4096, 16384}, {1, 2}, {0, 1, 2}, {0}})
    ->ArgsProduct({{128, 512, 4096}, {1}, {0, 1, 2}, {1}})
    ->UseRealTime()
    ->Unit(benchmark::kMicrosecond);

BENCHMARK_MAIN();
