#pragma once
#include <cstddef>

#include "simulation/phases/chunk.h"

namespace galactic::simulation {

/// Lays out in the model the parts of an observation that its options ask for: see
/// BatchSimulator::observationParts. `laser_size`: elements of a laser scan, 0 without a laser.
void layOutObservation(std::size_t laser_size, Model& model);

/// Writes the observations, except for sensed parts, of the envs of the chunk that begins at
/// `first`.
void observe(const Model& model, BatchState& state, std::size_t first) noexcept;

/// Writes the sensed parts of the observations of some envs.
void sense(const Model& model, BatchState& state, EnvRange envs) noexcept;

}  // namespace galactic::simulation
