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
  /// The whole vector of cells: layout.cells points into it, unused elements stand around.
  std::span<const std::uint64_t> stored_cells;
  /// Number of overflow spans and end marks, be they codes or heights.
  std::size_t overflow_elements = 0;
};

/// What the cells hold, counted on the way.
struct CellTotals {
  std::uint64_t spans = 0;
  std::uint32_t max_spans_per_column = 0;
};

/// Checks each cell and each overflow span: well-formed, ascending, disjoint, inside the grid's
/// heights, in range. A first pass without branches looks at whole tiles; only a tile that offends
/// is looked at again, to say where and why.
[[nodiscard]] Result<CellTotals> checkCells(const CellBlock& block, const std::string& where);

}  // namespace galactic::detail
