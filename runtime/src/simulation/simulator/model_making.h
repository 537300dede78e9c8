#pragma once
#include "galactic/error.h"
#include "galactic/simulation_options.h"
#include "galactic/world.h"
#include "simulation/state/model.h"

namespace galactic::simulation {

/// See BatchSimulator::create for how it fails. Tries every episode once.
[[nodiscard]] Result<Model> makeModel(const World& world, const SimulationOptions& options);

}  // namespace galactic::simulation
