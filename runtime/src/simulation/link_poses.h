#pragma once
#include <cstddef>
#include <span>

#include "galactic/batch_simulator.h"
#include "simulation/batch_state.h"
#include "simulation/model.h"

namespace galactic::simulation {

/// The envs [first, first + kLanes) of a batch: where all links of the robot are. `out`: the rows
/// of these envs, links().size() each. `scratch`: frameScratchSize floats, 32-byte aligned.
void linkFrames(const Model& model, BatchState& state, std::size_t first, float* scratch,
                std::span<LinkTransform> out) noexcept;

/// See EnvState.
[[nodiscard]] EnvState envStateOf(const Model& model, const BatchState& state, std::size_t env);

}  // namespace galactic::simulation
