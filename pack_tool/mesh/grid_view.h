#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "galactic/column_grid.h"

namespace galactic::pack_tool {

/// A point of the ground plane, world frame, meters.
struct GroundPoint {
  double x = 0;
  double z = 0;
};

/// Indices of a grid cell: i along x, k along z.
struct Cell {
  std::uint32_t i = 0;
  std::uint32_t k = 0;

  friend bool operator==(const Cell&, const Cell&) = default;
};

/// The cell that `point` lies in, none outside the grid's rectangle or when a coordinate is NaN.
[[nodiscard]] std::optional<Cell> nearestColumn(const ColumnGrid& grid, GroundPoint point);

/// Where the column of `cell` stands.
[[nodiscard]] GroundPoint columnCenter(const ColumnGrid& grid, Cell cell);

/// Replaces `spans` by the free spans of `cell`, ascending. The cell must be inside the grid.
void readSpans(const ColumnGrid& grid, Cell cell, std::vector<Span>& spans);

}  // namespace galactic::pack_tool
