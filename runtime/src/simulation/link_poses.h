#pragma once
#include <cstddef>

#include "galactic/batch_simulator.h"
#include "simulation/batch_state.h"
#include "simulation/model.h"
#include "simulation/chunk.h"

namespace galactic::simulation {

/// Where all links of the chunk's robots are; nothing where the run does not want them.
void placeLinks(const ChunkStep& step) noexcept;

/// See EnvState.
[[nodiscard]] EnvState envStateOf(const Model& model, const BatchState& state, std::size_t env);

}  // namespace galactic::simulation
