#pragma once
#include "simulation/collision/heights_over_floor.h"
#include "simulation/state/model.h"

namespace galactic::simulation {

/// Maps each floor of each scene on which episodes start, with the threads of the model's options,
/// and tells the starts which map is theirs. `heights`: of the robot's sphere centers at the
/// starts. The maps are the same with any number of threads.
void mapFloors(const HeightsOverFloor& heights, Model& model);

}  // namespace galactic::simulation
