#pragma once
#include <optional>
#include <vector>

#include "episodes/episode_draft.h"

namespace galactic::bake {

/// Looks for a position of base and arm in which the grasp point is within kGraspShare of the grasp
/// radius of the object's box: the base at a place of the floor map about as high as `from`'s
/// floor, in its part, every sphere free in the scene, none touching the object. Returns the
/// robot's spheres, or none after some hundred tries.
[[nodiscard]] std::optional<std::vector<BodySphere>> findReach(const DraftHome& home,
                                                               const PlacedObject& object,
                                                               const SupportPlace& from,
                                                               Random& random);

}  // namespace galactic::bake
