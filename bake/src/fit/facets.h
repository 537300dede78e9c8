#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "fit/convex_hull.h"
#include "fit/vec3d.h"
#include "galactic/vec3.h"

namespace galactic::bake::fit {

/// Faces of a hull that lie in one plane, but for the hull's rounding.
struct Facet {
  /// Outward, unit length: of the corners' sources, which carry the rounding of floats alone.
  Vec3d normal;
  /// Of the hull's faces.
  std::vector<std::uint32_t> faces;
};

/// The planar facets of `hull` (kSolid) of `points`, in the order of their largest faces, largest
/// first. Every face belongs to one.
[[nodiscard]] std::vector<Facet> planarFacets(const ConvexHull& hull, std::span<const Vec3> points);

}  // namespace galactic::bake::fit
