#pragma once
#include <vector>

#include "galactic/column_grid.h"

namespace galactic::pack_tool {

/// A point of the ground plane, world frame, meters.
struct GroundPoint {
  double x = 0;
  double z = 0;
};

/// Where the column of `cell` stands.
[[nodiscard]] GroundPoint columnCenter(const ColumnGrid& grid, ColumnIndex cell);

/// Replaces `spans` by the free spans of `cell`, ascending. The cell must be inside the grid.
void readSpans(const ColumnGrid& grid, ColumnIndex cell, std::vector<Span>& spans);

}  // namespace galactic::pack_tool
