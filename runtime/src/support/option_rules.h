#pragma once
#include <cstdint>

#include "galactic/simulation_options.h"

namespace galactic {

// Rules that combine several options.

/// The number over all ranks of a batch's first env, for options that checkOptions() lets pass.
[[nodiscard]] constexpr std::uint32_t firstEnvOf(const SimulationOptions& options) {
  return options.rank * options.envs;
}

/// Whether the batch is one of those that share the episodes; checkOptions() refuses others.
[[nodiscard]] constexpr bool isOneOfRanks(const SimulationOptions& options) {
  return options.rank < options.ranks;
}

/// Whether paths along the floor are found before the first step, to targets and goals of episodes.
[[nodiscard]] constexpr bool findsPaths(const SimulationOptions& options) {
  return options.sensors.geodesic || options.task.geodesic_weight != 0;
}

}  // namespace galactic
