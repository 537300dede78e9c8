#pragma once
#include <cstddef>

#include "galactic/batch_simulator.h"
#include "simulation/state/batch_state.h"
#include "simulation/state/model.h"

namespace galactic::simulation {

/// See EnvState.
[[nodiscard]] EnvObjects envObjectsOf(const Model& model, const BatchState& state,
                                      std::size_t env) noexcept;
[[nodiscard]] EnvState envStateOf(const Model& model, const BatchState& state, std::size_t env);

}  // namespace galactic::simulation
