#pragma once
#include "galactic/object_set.h"
#include "galactic/pose.h"
#include "galactic/scene.h"

namespace galactic::bake {

/// Whether a run that releases the object at `world_from_object` leaves it there. The run lifts the
/// object out of the scene by the least distance that makes its spheres free, at most by its
/// PlacementOptions::most_lift; then the object must sink by no more than that, onto a floor and
/// not onto the end of the grid. The scene must have the object's radii.
[[nodiscard]] bool canBeReleased(const Scene& scene, const ObjectModel& model,
                                 const Pose& world_from_object);

}  // namespace galactic::bake
