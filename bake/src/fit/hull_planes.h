#pragma once
#include <span>
#include <vector>

#include "galactic/pose.h"
#include "galactic/shapes.h"

namespace galactic::bake::fit {

/// Planes around the convex hull of `points` (meters, finite, at least one), in the frame of the
/// points. The candidates are the 92 directions from the center of a cube along the axes of `box`
/// to the points of a lattice on the cube, five by five on each face. (The six face normals are
/// left out, as the box has these planes.) Those whose plane cuts more than 0.1 mm off the box are
/// kept. All points lie behind all planes: extents are computed in double precision, for the
/// directions as stored, and rounded outward. A sphere of 15 mm that overlaps box and planes is at
/// most 2 to 5 mm off the hull of a household object; with the box alone, it may be 50 mm off.
[[nodiscard]] std::vector<HullPlane> hullPlanes(std::span<const Vec3> points,
                                                const OrientedBox& box);

}  // namespace galactic::bake::fit
