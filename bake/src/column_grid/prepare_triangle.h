#pragma once
#include <array>

#include "column_grid/scatter.h"

namespace galactic::bake {

/// Prepares a triangle for the vectorised kernel. `corners` in double, relative to the grid's
/// corner (min_x, 0, min_z); `radius` in meters.
[[nodiscard]] ScatterTriangle prepareTriangle(const std::array<std::array<double, 3>, 3>& corners,
                                              float radius);

}  // namespace galactic::bake
