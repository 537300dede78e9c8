#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "fit/convex_hull.h"
#include "fit/vec3d.h"
#include "galactic/pose.h"

namespace galactic::bake::fit {

/// Faces of a hull that lie in one plane, but for the hull's rounding: indices of faces.
using Facet = std::vector<std::uint32_t>;

/// The planar facets of `hull` (kSolid), in the order of their largest faces, largest first. Every
/// face belongs to one.
[[nodiscard]] std::vector<Facet> planarFacets(const ConvexHull& hull);

/// The outward unit normal of a facet of the hull of `points`: of the corners' sources, which carry
/// the rounding of floats alone; of the rounded corners where the hull's rounding decided which
/// corners there are, so that the plane of their sources cuts through the body.
[[nodiscard]] Vec3d facetNormal(const ConvexHull& hull, std::span<const Vec3> points,
                                const Facet& facet);

}  // namespace galactic::bake::fit
