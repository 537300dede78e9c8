#include "simulation/phases/action_delay.h"

#include <limits>

#include "simulation/state/env_moment.h"
#include "simulation/state/episode_draws.h"

namespace galactic::simulation {
namespace {

void letArrive(const ChunkStep& step) {
  const std::span<const EnvRow> asked = step.chunk.actions();
  const std::span<EnvRow> arrived = step.chunk.arrived();
  for (std::size_t e = 0; e < kChunk; ++e) {
    const EnvMoment moment = momentOf(step.model, step.state, step.first + e);
    const std::size_t delay = drawnIn(moment, step.model.options.noise.action_delay, kDelayDraw);
    const std::size_t asked_in = moment.step + step.state.keptSteps() - delay;
    const std::span<const EnvRow> due =
        delay == 0 ? asked : step.state.keptActions(step.first, asked_in);
    for (std::size_t a = 0; a < asked.size(); ++a) arrived[a].values[e] = due[a].values[e];
  }
}

void keep(const ChunkStep& step) {
  const std::span<const EnvRow> asked = step.chunk.actions();
  for (std::size_t e = 0; e < kChunk; ++e) {
    const std::size_t n = step.first + e;
    // An action for an idle env belongs to none of its steps.
    if (step.state.idle()[n] != 0) continue;
    const std::span<EnvRow> kept = step.state.keptActions(n, step.state.env(n).step);
    for (std::size_t a = 0; a < asked.size(); ++a) kept[a].values[e] = asked[a].values[e];
  }
}

}  // namespace

void beginDelay(const Model& model, BatchState& state, std::size_t n) noexcept {
  // The hand actions that leave a hand alone depend on whether it holds something; NaN always does.
  constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();
  const std::size_t moving = model.actionLayout().movingCount();
  for (std::size_t step = 0; step < state.keptSteps(); ++step) {
    const std::span<EnvRow> kept = state.keptActions(n, step);
    for (std::size_t a = 0; a < kept.size(); ++a) {
      kept[a].values[n % kChunk] = a < moving ? 0 : kNothing;
    }
  }
}

void keepActions(const ChunkStep& step) noexcept {
  if (step.state.keptSteps() == 0) return;
  // Read first: at the longest delay, the current actions overwrite those that are due.
  if (step.model.options.noise.delaysActions()) letArrive(step);
  keep(step);
}

std::span<const EnvRow> arrivedOf(const ChunkStep& step) noexcept {
  return step.model.options.noise.delaysActions() ? step.chunk.arrived() : step.chunk.actions();
}

std::vector<float> actionsUnderWay(const Model& model, const BatchState& state, std::size_t n) {
  const EnvMoment moment = momentOf(model, state, n);
  const std::size_t delay = drawnIn(moment, model.options.noise.action_delay, kDelayDraw);
  std::vector<float> actions;
  actions.reserve(delay * model.actionCount());
  for (std::size_t ago = delay; ago > 0; --ago) {
    for (const EnvRow& action : state.keptActions(n, moment.step + state.keptSteps() - ago)) {
      actions.push_back(action.values[n % kChunk]);
    }
  }
  return actions;
}

}  // namespace galactic::simulation
