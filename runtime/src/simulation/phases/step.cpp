#include "simulation/phases/step.h"

#include <algorithm>

#include "simulation/phases/episode_start.h"
#include "simulation/phases/hand.h"
#include "simulation/phases/move.h"
#include "simulation/phases/observe.h"
#include "simulation/phases/task.h"
#include "support/thread_clock.h"

namespace galactic::simulation {

void readActions(const ChunkStep& step, std::span<const float> all) noexcept {
  const std::size_t count = step.model.actionCount();
  const std::span<float> actions = step.chunk.actions();
  const std::size_t first = std::min(step.first * count, all.size());
  const std::size_t given = std::min(actions.size(), all.size() - first);
  std::uint32_t nan_count = 0;
  for (std::size_t n = 0; n < given; ++n) {
    const float value = all[first + n];
    const float low = value < -1.0F ? -1.0F : value;
    const float both = low > 1.0F ? 1.0F : low;
    nan_count += value == value ? 0U : 1U;
    actions[n] = value == value ? both : 0.0F;
  }
  std::fill(actions.begin() + static_cast<std::ptrdiff_t>(given), actions.end(), 0.0F);
  if (nan_count == 0) return;
  for (std::size_t n = 0; n < given; ++n) {
    const float value = all[first + n];
    if (value != value) ++step.state.env(step.first + n / count).counters.nan_actions;
  }
}

namespace {

/// Runs the phases, telling `lap` after each of them.
template <class Lap>
void runPhases(const ChunkStep& step, const StepInput& input, const Lap& lap) noexcept {
  readActions(step, input.actions);
  lap(0);
  proposePoses(step);
  lap(1);
  followFloor(step);
  lap(2);
  placeBodies(step);
  lap(3);
  moveRobots(step);
  lap(4);
  useHands(step);
  lap(5);
  judge(step, input.resets);
  lap(6);
  observeAll(step);
  lap(7);
  senseAll(step);
  lap(8);
  renewEpisodes(step);
  resetEpisodes(step, input.resets);
  lap(9);
}

}  // namespace

void stepChunk(const ChunkStep& step, const StepInput& input) noexcept {
  runPhases(step, input, [](std::size_t) {});
}

void stepChunkMeasured(const ChunkStep& step, const StepInput& input,
                       PhaseSeconds& seconds) noexcept {
  double before = detail::threadSeconds();
  // Asking takes as long as a short phase.
  const double asking = detail::threadSeconds() - before;
  before += asking;
  runPhases(step, input, [&](std::size_t phase) {
    const double now = detail::threadSeconds();
    seconds[phase] += std::max(0.0, now - before - asking);
    before = now;
  });
}

}  // namespace galactic::simulation
