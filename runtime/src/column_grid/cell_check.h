#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "galactic/column_grid.h"
#include "galactic/error.h"

namespace galactic::detail {

/// The cells of one grid and everything that they refer to, with sizes that have been checked.
struct CellBlock {
  ColumnGridLayout layout;
  /// The whole stored vector: layout.cells points into it, with unused elements before and after.
  std::span<const std::uint64_t> stored_cells;
  /// Number of overflow spans and end marks, whether codes or heights.
  std::size_t overflow_elements = 0;
};

/// The counts that the check collects on the way.
struct CellTotals {
  std::uint64_t spans = 0;
  std::uint32_t max_spans_per_column = 0;
};

/// Checks each cell and each overflow span: well-formed, ascending, disjoint, inside the grid's
/// heights, in range. A first pass without branches checks whole tiles; only a tile that fails is
/// checked again, to report where and why.
[[nodiscard]] Result<CellTotals> checkCells(const CellBlock& block, const std::string& where);

}  // namespace galactic::detail
