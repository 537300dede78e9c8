#pragma once
#include <optional>
#include <vector>

#include "episodes/episode_draft.h"

namespace galactic::bake {

/// Looks for a position of base and arm that brings the grasp point to within kGraspShare of the
/// grasp radius of the object's box: with the base at a place of the floor map about as high as
/// `from`'s floor, and in its part, every sphere free in the scene, and none touching the object.
/// Returns the robot's spheres, or none after some hundred tries.
[[nodiscard]] std::optional<std::vector<BodySphere>> findReach(const DraftHome& home,
                                                               const PlacedObject& object,
                                                               const SupportPlace& from,
                                                               Random& random);

}  // namespace galactic::bake
