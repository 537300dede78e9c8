#pragma once
#include "galactic/error.h"
#include "galactic/simulation_options.h"
#include "galactic/world.h"
#include "simulation/state/model.h"

namespace galactic::simulation {

/// Makes the model of a simulator; tries the start of every episode once. See
/// BatchSimulator::create for how it fails.
[[nodiscard]] Result<Model> makeModel(const World& world, const SimulationOptions& options);

}  // namespace galactic::simulation
