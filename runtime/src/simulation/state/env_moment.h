#pragma once
#include <cstddef>

#include "galactic/sensor_noise.h"
#include "simulation/state/batch_state.h"
#include "simulation/state/model.h"

namespace galactic::simulation {

/// What the luck of an env follows from, of its sensors and its motions: its own number and how
/// many episodes it has begun or, in an episode that the caller has named, that episode alone,
/// wherever it is played.
[[nodiscard]] inline EnvMoment momentOf(const Model& model, const BatchState& state,
                                        std::size_t n) noexcept {
  const Env& env = state.env(n);
  const EnvCounters& counters = state.counters(n);
  EnvMoment moment{.seed = model.options.seed,
                   .env = model.globalEnv(n),
                   .step = env.step,
                   .episode = counters.begun};
  if (counters.is_named) {
    moment.env = 0;
    // No env begins so many.
    moment.episode = ~std::uint64_t{model.starts[env.start].episode};
  }
  return moment;
}

}  // namespace galactic::simulation
