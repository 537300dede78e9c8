#pragma once
#include "galactic/column_grid.h"

namespace galactic::simulation {

/// A direction in the ground plane in which something gets free, meters; (0, 0) for none.
struct Push {
  float x = 0;
  float z = 0;
};

/// The kernels of pushOutOfScene(): both do the same operations, and agree bit for bit.
[[nodiscard]] Push pushOutPortable(const ColumnGridLayout& grid, const Vec3& center,
                                   float reach) noexcept;
[[nodiscard]] Push pushOutAvx2(const ColumnGridLayout& grid, const Vec3& center,
                               float reach) noexcept;

/// A sphere that enters a cell goes this far into it, meters.
inline constexpr float kIntoCell = 1e-4F;
/// Cells in each direction that are looked at side by side.
inline constexpr int kCellsAtATime = 2;

}  // namespace galactic::simulation
