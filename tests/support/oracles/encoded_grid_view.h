#pragma once
#include "galactic/bake/columns.h"
#include "galactic/column_grid.h"
#include "layout/column_cell.h"

namespace galactic::test {

/// An encoded grid as the runtime would see it in a pack; valid as long as `grid`.
inline ColumnGrid viewOf(const bake::EncodedGrid& grid) {
  ColumnGridLayout layout;
  layout.radius = grid.frame.radius;
  layout.spacing = grid.frame.spacing;
  layout.inverse_spacing = 1 / grid.frame.spacing;
  layout.min_x = grid.frame.min_x;
  layout.min_z = grid.frame.min_z;
  layout.heights = grid.frame.heights;
  layout.quantum = grid.quantum;
  layout.inverse_quantum = 1 / grid.quantum;
  layout.columns_x = grid.frame.columns_x;
  layout.columns_z = grid.frame.columns_z;
  layout.tiles_x = tileCount(grid.frame.columns_x, kTileColumnsX);
  layout.cells = grid.cells.data();
  layout.tile_base = grid.tile_base.empty() ? nullptr : grid.tile_base.data();
  layout.overflow_codes = grid.overflow_codes.empty() ? nullptr : grid.overflow_codes.data();
  layout.overflow_spans = grid.overflow_spans.data();
  return ColumnGrid(layout);
}

}  // namespace galactic::test
