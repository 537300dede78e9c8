#pragma once
#include "simulation/collision/heights_over_floor.h"
#include "simulation/state/model.h"

namespace galactic::simulation {

/// Maps each floor of each scene on which episodes start, with the threads of the model's options,
/// and stores in each start the number of its map. `heights`: of the robot's sphere centers at the
/// starts. The maps do not depend on the number of threads.
void mapFloors(const HeightsOverFloor& heights, Model& model);

}  // namespace galactic::simulation
