// Steps of a batch on the workload on which the published physics was measured, see
// make_published_world.sh for its worlds:
//
//   GALACTIC_BENCH_WORLD=world.pack batch_steps
//
// GALACTIC_BENCH_HELD_WORLD: the same with the target of each episode in the robot's hand.
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

namespace {

using galactic::BatchSimulator;
using galactic::Result;
using galactic::SimulationOptions;
using galactic::World;

enum class Load : std::int64_t { kRandom = 0, kForward = 1, kHeld = 2 };

constexpr std::uint32_t kEpisodeSteps = 500;
constexpr std::size_t kBatches = 512;
/// Steps before those that are measured.
constexpr std::size_t kWarmUp = 1000;
/// One step in so many is measured phase by phase.
constexpr std::uint32_t kSampled = 16;

/// The workload's actions: one of 512 batches of uniform numbers that only (step, env, action)
/// decide.
class Actions {
 public:
  Actions(std::size_t envs, std::size_t count, Load load)
      : size_(envs * count), count_(count), load_(load) {
    values_.resize(kBatches * size_);
    for (std::size_t step = 0; step < kBatches; ++step) {
      for (std::size_t env = 0; env < envs; ++env) {
        fillRow(std::span(values_).subspan(step * size_ + env * count, count), step, env, load);
      }
    }
  }

  /// `begin`: the envs whose episode begins with this step; their robots do not move in it.
  [[nodiscard]] std::span<const float> batch(std::size_t step, std::span<const std::size_t> begin) {
    for (const std::size_t env : begin_) fillRow(row(step_, env), step_ % kBatches, env, load_);
    step_ = step;
    begin_ = begin;
    for (const std::size_t env : begin_) {
      const std::span<float> first = row(step, env);
      std::fill(first.begin(), first.end(), 0.0F);
      if (load_ == Load::kHeld) first[count_ - 2] = 1;
    }
    return std::span(values_).subspan(step % kBatches * size_, size_);
  }

 private:
  static std::uint64_t mix(std::uint64_t z) {
    z += 0x9E3779B97F4A7C15ULL;
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31U);
  }

  static float uniform(std::size_t step, std::size_t env, std::size_t action) {
    constexpr std::uint64_t kSeed = 1;
    const std::uint64_t hash = mix(mix(mix(mix(kSeed) ^ step) ^ env) ^ action);
    return static_cast<float>(hash >> 40U) * 0x1p-23F - 1;
  }

  [[nodiscard]] std::span<float> row(std::size_t step, std::size_t env) {
    return std::span(values_).subspan(step % kBatches * size_ + env * count_, count_);
  }

  /// The published order of actions is hand, turn, forward, joints, stop; its turn is positive
  /// counter-clockwise.
  static void fillRow(std::span<float> row, std::size_t step, std::size_t env, Load load) {
    const std::size_t joints = row.size() - 4;
    for (std::size_t n = 0; n < joints; ++n) row[n] = uniform(step, env, 3 + n);
    const float forward = uniform(step, env, 2);
    row[joints] = load == Load::kForward ? 0.5F + 0.5F * forward : forward;
    row[joints + 1] = -uniform(step, env, 1);
    row[joints + 2] = load == Load::kHeld ? 1.0F : uniform(step, env, 0);
    row[joints + 3] = 0;
  }

  std::size_t size_;
  std::size_t count_;
  Load load_;
  std::vector<float> values_;
  /// Of the batch given last.
  std::size_t step_ = 0;
  std::span<const std::size_t> begin_;
};

/// Which env begins which episode when: each every 500 steps, evenly spread.
class Resets {
 public:
  Resets(std::size_t envs, std::size_t episodes) : by_phase_(kEpisodeSteps), resets_(envs, -1) {
    for (std::size_t env = 0; env < envs; ++env) {
      const std::size_t offset = env * kEpisodeSteps / envs;
      by_phase_[(kEpisodeSteps - offset) % kEpisodeSteps].push_back(env);
      next_.push_back((env + 1) % episodes);
    }
    episodes_ = episodes;
  }

  [[nodiscard]] std::span<const std::int32_t> at(std::size_t step) {
    for (const std::size_t env : last_) resets_[env] = -1;
    last_ = {};
    if (step > 0) last_ = by_phase_[step % kEpisodeSteps];
    for (const std::size_t env : last_) {
      resets_[env] = static_cast<std::int32_t>(next_[env]);
      next_[env] = (next_[env] + 1) % episodes_;
    }
    return resets_;
  }

  /// The envs that the last call reset.
  [[nodiscard]] std::span<const std::size_t> last() const { return last_; }

 private:
  std::vector<std::vector<std::size_t>> by_phase_;
  std::vector<std::size_t> next_;
  std::vector<std::int32_t> resets_;
  std::span<const std::size_t> last_;
  std::size_t episodes_ = 1;
};

SimulationOptions optionsOf(std::uint32_t envs, std::uint32_t threads) {
  SimulationOptions options;
  options.envs = envs;
  options.threads = threads;
  options.order = galactic::EpisodeOrder::kLinear;
  options.body_transforms = true;
  options.action.release = -0.5F;
  options.task.kind = galactic::TaskKind::kNone;
  options.task.most_steps = 0;
  return options;
}

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
  // Of one env in one step, nanoseconds of the sampled steps' threads.
  const double sampled = static_cast<double>(sum.steps) / kSampled;
  for (const galactic::PhaseTime& phase : simulator.phaseTimes()) {
    state.counters["ns_" + std::string(phase.name)] =
        benchmark::Counter(phase.seconds * 1e9 / sampled);
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(sum.steps - before.steps));
  state.counters["refused"] = per_step(sum.refused - before.refused);
  state.counters["slid"] = per_step(sum.slid - before.slid);
  state.counters["grasps"] = per_step(sum.grasps - before.grasps);
  state.counters["bytes_per_env"] = benchmark::Counter(
      static_cast<double>(simulator.memoryBytes()) / static_cast<double>(simulator.envCount()));
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
  Result<BatchSimulator> simulator =
      BatchSimulator::create(*world, optionsOf(envs, static_cast<std::uint32_t>(state.range(1))));
  if (!simulator) {
    state.SkipWithError(simulator.error().message.c_str());
    return;
  }
  simulator->samplePhases(kSampled);
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
  const auto taken = static_cast<double>(simulator->statistics().steps - before.steps);
  if (state.range(1) != 1) return;
  if (const auto count = instructions.count()) state.counters["instructions"] = *count / taken;
  if (const auto count = cycles.count()) state.counters["cycles"] = *count / taken;
}

}  // namespace

BENCHMARK(stepBatch)
    ->ArgNames({"envs", "threads", "load"})
    ->ArgsProduct({{128, 512, 4096}, {1, 2}, {0, 1, 2}})
    ->UseRealTime()
    ->Unit(benchmark::kMicrosecond);

BENCHMARK_MAIN();
