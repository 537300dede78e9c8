#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "galactic/bake/source_asset.h"

namespace galactic::bake {

/// Appends the triangles of a simple polygon to `triangles`, with the polygon's winding. `corners`
/// index `positions`; the polygon may be convex or concave, and slightly out of plane. Ear clipping
/// makes corners.size() - 2 triangles. A polygon that crosses itself gets the same number, but
/// there is no right answer to what they should cover. Corners out of range make a fan, and the
/// caller's checks find them.
/// The number of comparisons between corners is quadratic at best and cubic at worst; polygons of
/// meshes are small. It is subtracted from `comparisons_left`; if that runs out, the polygon stays
/// unfinished and the function returns false.
[[nodiscard]] bool triangulatePolygon(std::span<const std::uint32_t> corners,
                                      std::span<const Vec3> positions,
                                      std::uint64_t& comparisons_left,
                                      std::vector<Triangle>& triangles);

}  // namespace galactic::bake
