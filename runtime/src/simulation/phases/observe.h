#pragma once
#include <cstddef>

#include "simulation/phases/chunk.h"

namespace galactic::simulation {

/// Says in the model what its options make parts of an observation: see
/// BatchSimulator::observationParts. `laser_size`: elements of a scan of its laser, 0 without one.
void layOutObservation(std::size_t laser_size, Model& model);

/// Writes the observations of the envs of a chunk, whose first one is `first`, but for their
/// sensors.
void observe(const Model& model, BatchState& state, std::size_t first) noexcept;

/// Writes those of the sensors of some envs.
void sense(const Model& model, BatchState& state, EnvRange envs) noexcept;

}  // namespace galactic::simulation
