#pragma once
#include <cstddef>

#include "galactic/sensor_noise.h"
#include "simulation/state/batch_state.h"
#include "simulation/state/model.h"

namespace galactic::simulation {

/// The moment that seeds the random numbers of an env's sensors and motions. It consists of the
/// env's number and how many episodes it has begun or, in an episode that the caller named, of that
/// episode alone, whichever env plays it.
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
    // No env begins that many episodes, so these moments differ from all others.
    moment.episode = ~std::uint64_t{model.starts[env.start].episode};
  }
  return moment;
}

}  // namespace galactic::simulation
