#include "simulation/phases/action_delay.h"

#include <limits>

#include "simulation/state/env_moment.h"
#include "simulation/state/episode_draws.h"

namespace galactic::simulation {

void beginDelay(BatchState& state, std::size_t n) noexcept {
  // A hand holds still at a number that depends on what it holds, and at none in any case.
  constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();
  for (std::size_t step = 0; step < state.keptSteps(); ++step) {
    const std::span<EnvRow> kept = state.keptActions(n, step);
    for (std::size_t a = 0; a < kept.size(); ++a) {
      kept[a].values[n % kChunk] = a + kSwitches < kept.size() ? 0 : kNothing;
    }
  }
}

void delayActions(const ChunkStep& step) noexcept {
  const std::size_t kept_steps = step.state.keptSteps();
  if (kept_steps == 0) return;
  const std::span<const EnvRow> asked = step.chunk.actions();
  const std::span<EnvRow> arrived = step.chunk.arrived();
  for (std::size_t e = 0; e < kChunk; ++e) {
    const EnvMoment moment = momentOf(step.model, step.state, step.first + e);
    const std::size_t delay = drawnIn(moment, step.model.options.noise.action_delay, kDelayDraw);
    const std::span<EnvRow> kept = step.state.keptActions(step.first, moment.step);
    const std::span<const EnvRow> due =
        delay == 0 ? asked : step.state.keptActions(step.first, moment.step + kept_steps - delay);
    for (std::size_t a = 0; a < asked.size(); ++a) {
      // With the longest delay, what is due makes room for what is asked for now.
      arrived[a].values[e] = due[a].values[e];
      kept[a].values[e] = asked[a].values[e];
    }
  }
}

std::span<const EnvRow> arrivedOf(const ChunkStep& step) noexcept {
  return step.state.keptSteps() == 0 ? step.chunk.actions() : step.chunk.arrived();
}

}  // namespace galactic::simulation
