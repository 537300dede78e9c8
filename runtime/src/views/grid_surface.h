#pragma once
#include <cstdint>

#include "galactic/column_grid.h"
#include "layout/render_mesh_builder.h"

namespace galactic::views {

/// Heights are rounded to multiples of this, meters, so that level ground becomes few triangles.
inline constexpr double kHeightStep = 0.005;

/// The surface of the free space of a grid as seen from inside it, in the world frame: each
/// column's spans have a floor below and a ceiling above them, and walls where a neighboring column
/// is blocked. There is no surface at the limits of the grid (its border, its lowest and highest
/// height). Colors: a shade of gray for each direction. No triangles if nothing is free.
[[nodiscard]] RenderSurface gridSurface(const ColumnGrid& grid);

}  // namespace galactic::views
