#pragma once
#include <span>
#include <vector>

#include "simulation/chunk.h"

namespace galactic::simulation {

/// The parts of an observation: see BatchSimulator::observationParts.
[[nodiscard]] std::vector<ObservationPart> observationParts(std::size_t joints);

/// Writes the observation of one env.
void observe(const Model& model, const BatchState& state, std::size_t env,
             std::span<float> out) noexcept;

/// The observations of the chunk's envs.
void observeAll(const ChunkStep& step) noexcept;

}  // namespace galactic::simulation
