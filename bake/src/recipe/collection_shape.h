#pragma once
#include <vector>

#include "galactic/bake/mesh_import.h"
#include "galactic/bake/object_baker.h"
#include "galactic/error.h"
#include "recipe/collection_import.h"

namespace galactic::bake {

/// The shape of an object in a published collection, in the frame of the object's pack; `up` is the
/// up axis with which its mesh is read. Listed spheres are taken as they are; others are made by
/// publishedSpheres; there may be none. Fails with kInvalidInput if the box has no volume or a
/// listed radius is not in `radii` (meters, ascending).
[[nodiscard]] Result<AuthoredShape> shapeFromCollection(const CollectionObject& object, UpAxis up,
                                                        const std::vector<float>& radii);

/// The spheres that the published simulator makes of an object with this box and technique when it
/// loads the object, in the frame of the mesh file (Z up); none for kListed. The simulator does not
/// look at the mesh. For each radius of the working set, beginning with the largest that fits into
/// the box, it makes:
/// - kBox: a grid through the box for the first radius, the eight corners for each further one,
/// - kUprightCylinder: rings around the vertical axis, from bottom to top for the first radius, at
///   both ends for each further one.
/// Then it moves centers into the box and drops repeated ones. It counts the rings by the extent
/// along x, where the height is meant: a cylinder that is higher than wide lacks the top rings, and
/// a lower one has rings above the top, which coincide after the move. This function does the same,
/// because the published results were made this way.
[[nodiscard]] std::vector<HandSphere> publishedSpheres(const CollectionObject& object,
                                                       const std::vector<float>& radii);

}  // namespace galactic::bake
