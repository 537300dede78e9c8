#pragma once
#include <cstdint>

#include "galactic/column_grid.h"
#include "layout/render_mesh_builder.h"

namespace galactic::views {

/// Heights are rounded to multiples of this, so that level ground becomes few triangles; meters.
inline constexpr double kHeightStep = 0.005;

/// The surface of the free space of a grid, seen from inside it, in the world's frame: under each
/// column's spans a floor, above them a ceiling, and walls where a neighboring column is blocked.
/// Where the grid's knowledge ends (its border, its lowest and highest height) there is none.
/// Colors: shades of gray by direction. No triangles where nothing is free.
[[nodiscard]] RenderSurface gridSurface(const ColumnGrid& grid);

}  // namespace galactic::views
