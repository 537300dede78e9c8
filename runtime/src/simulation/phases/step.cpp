#include "simulation/phases/step.h"

#include <algorithm>

#include "simulation/phases/action_delay.h"
#include "simulation/phases/episode_start.h"
#include "simulation/phases/hand.h"
#include "simulation/phases/move.h"
#include "simulation/phases/observe.h"
#include "simulation/phases/robot_noise.h"
#include "simulation/phases/task.h"
#include "support/threads/thread_clock.h"

namespace galactic::simulation {

void readActions(const ChunkStep& step, std::span<const float> all) noexcept {
  const std::size_t count = step.model.actionCount();
  const std::size_t first = std::min(step.first * count, all.size());
  std::span<const float> given = all.subspan(first, std::min(kChunk * count, all.size() - first));
  if (given.size() < kChunk * count) {
    const std::span<float> padded = step.chunk.givenActions();
    const auto rest = std::ranges::copy(given, padded.begin()).out;
    std::fill(rest, padded.end(), 0.0F);
    given = padded;
  }
  const bool has_nan = step.model.kernels.read({.from = given.data(),
                                                .count = count,
                                                .to = step.chunk.actions().front().values,
                                                .envs = kChunk});
  // Prefetch the actions of the next chunk.
  constexpr std::size_t kFloatsOfLine = 16;
  const std::span<const float> next = all.subspan(std::min(first + kChunk * count, all.size()));
  for (std::size_t n = 0; n < std::min(kChunk * count, next.size()); n += kFloatsOfLine) {
    __builtin_prefetch(next.data() + n);
  }
  if (!has_nan) return;
  for (std::size_t n = 0; n < given.size(); ++n) {
    if (given[n] != given[n]) ++step.state.counters(step.first + n / count).nan_actions;
  }
}

namespace {

/// See finishStep(). Calls `lap` after each phase.
template <class Lap>
void runLastPhases(const ChunkStep& step, std::span<const std::int32_t> resets,
                   const Lap& lap) noexcept {
  judge(step, resets);
  lap(Phase::kTask);
  followOdometry(step);
  observe(step.model, step.state, step.first);
  lap(Phase::kObserve);
  sense(step.model, step.state, {step.first, kChunk});
  lap(Phase::kSense);
  renewEpisodes(step);
  resetEpisodes(step, resets);
  lap(Phase::kRenew);
}

/// Runs the phases, and calls `lap` after each of them.
template <class Lap>
void runPhases(const ChunkStep& step, const StepInput& input, const Lap& lap) noexcept {
  step.state.prefetchBounds(step.first);
  readActions(step, input.actions);
  keepActions(step);
  lap(Phase::kActions);
  proposePoses(step);
  lap(Phase::kPropose);
  followFloor(step);
  lap(Phase::kFloor);
  placeBodies(step);
  lap(Phase::kKinematics);
  moveRobots(step);
  lap(Phase::kCollide);
  useHands(step);
  lap(Phase::kHands);
  runLastPhases(step, input.resets, lap);
}

}  // namespace

void finishStep(const ChunkStep& step, std::span<const std::int32_t> resets) noexcept {
  runLastPhases(step, resets, [](Phase) {});
}

void stepChunk(const ChunkStep& step, const StepInput& input) noexcept {
  runPhases(step, input, [](Phase) {});
}

void stepChunkMeasured(const ChunkStep& step, const StepInput& input,
                       PhaseSeconds& seconds) noexcept {
  double before = detail::threadSeconds();
  // Reading the clock takes as long as a short phase.
  const double asking = detail::threadSeconds() - before;
  before += asking;
  runPhases(step, input, [&](Phase phase) {
    const double now = detail::threadSeconds();
    seconds[static_cast<std::size_t>(phase)] += std::max(0.0, now - before - asking);
    before = now;
  });
}

}  // namespace galactic::simulation
