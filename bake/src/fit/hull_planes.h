#pragma once
#include <span>
#include <vector>

#include "galactic/pose.h"
#include "galactic/shapes.h"

namespace galactic::bake::fit {

/// Planes around the convex hull of `points` (meters, finite, at least one), in the frame of the
/// points: of the 92 directions that point from the middle of a cube to the points of a lattice on
/// it, five by five on each face and along the axes of `box`, those whose plane cuts more than
/// 0.1 mm off the box. (The other six are the box's own.) All points lie behind all planes: extents
/// are computed in double precision, for the directions as they are stored, and rounded outward. A
/// sphere of 15 mm that overlaps box and planes is off the hull of a household object by 2 to 5 mm
/// at most, where it may be off by 50 with the box alone.
[[nodiscard]] std::vector<HullPlane> hullPlanes(std::span<const Vec3> points,
                                                const OrientedBox& box);

}  // namespace galactic::bake::fit
