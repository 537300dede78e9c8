#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "galactic/bake/source_asset.h"

namespace galactic::bake {

/// Appends the triangles of a simple polygon (`corners` index `positions`; convex or concave; it
/// may be slightly out of plane) to `triangles`, with the polygon's winding: corners.size() - 2 of
/// them by ear clipping. A polygon that crosses itself gets as many triangles, whose union is then
/// a matter of taste. Corners out of range make a fan, for the caller's checks to find. The number
/// of comparisons between corners is quadratic at best and cubic at worst; polygons of meshes are
/// small. They are taken from `comparisons_left`: false, and an unfinished polygon, where it does
/// not suffice.
[[nodiscard]] bool triangulatePolygon(std::span<const std::uint32_t> corners,
                                      std::span<const Vec3> positions,
                                      std::uint64_t& comparisons_left,
                                      std::vector<Triangle>& triangles);

}  // namespace galactic::bake
