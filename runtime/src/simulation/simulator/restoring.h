#pragma once
#include <cstddef>

#include "simulation/simulator/saved_state.h"
#include "simulation/state/batch_state.h"
#include "simulation/state/model.h"

namespace galactic::simulation {

/// Env `n` goes on from `saved`, whose parts have to be as long as `model` wants them.
void restoreEnv(const Model& model, BatchState& state, std::size_t n, const SavedEnv& saved);

}  // namespace galactic::simulation
