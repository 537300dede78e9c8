#pragma once
#include "galactic/object_set.h"
#include "galactic/pose.h"
#include "galactic/scene.h"

namespace galactic::bake {

/// Whether a run that releases the object at `world_from_object` leaves it there: lifted out of the
/// scene by as little as possible, at most by the run's PlacementOptions::most_lift, its spheres
/// are free, and what they sink to, a floor and not the end of the grid, is no farther away than
/// that. The scene's radii must be the object's.
[[nodiscard]] bool canBeReleased(const Scene& scene, const ObjectModel& model,
                                 const Pose& world_from_object);

}  // namespace galactic::bake
