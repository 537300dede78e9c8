#pragma once
#include <vector>

#include "galactic/bake/mesh_import.h"
#include "galactic/bake/object_baker.h"
#include "galactic/error.h"
#include "recipe/collection_import.h"

namespace galactic::bake {

/// What a published collection says of an object, in the frame of the object's pack: `up` is the up
/// axis with which its mesh is read. Spheres that are listed are taken as they are; others are made
/// by publishedSpheres; there may be none. Fails with kInvalidInput when the box is without volume
/// or a listed radius is not in `radii` (meters, ascending).
[[nodiscard]] Result<AuthoredShape> shapeFromCollection(const CollectionObject& object, UpAxis up,
                                                        const std::vector<float>& radii);

/// The spheres that the published simulator makes for an object of this box and technique when it
/// loads it, in the frame of the mesh file (Z up); none with kListed. It knows no mesh: for each
/// radius of the working set, from the largest that fits in the box on,
/// - kBox: a grid through the box for the first, the eight corners for each further one,
/// - kUprightCylinder: rings around the vertical axis, between bottom and top for the first, at
///   both ends for each further one.
/// Centers are moved into the box and repeated ones dropped. Its rings are counted along x where
/// the height is meant: for a cylinder higher than wide the top rings are missing, for a lower one
/// there are rings beyond the top, which then fall together. This is kept, since it is what the
/// published results were made with.
[[nodiscard]] std::vector<HandSphere> publishedSpheres(const CollectionObject& object,
                                                       const std::vector<float>& radii);

}  // namespace galactic::bake
