#include "pack_tool/mesh/grid_view.h"

namespace galactic::pack_tool {

GroundPoint columnCenter(const ColumnGrid& grid, ColumnIndex cell) {
  const ColumnGridLayout& layout = grid.layout();
  const double spacing = static_cast<double>(layout.spacing);
  return {static_cast<double>(layout.min_x) + (cell.i + 0.5) * spacing,
          static_cast<double>(layout.min_z) + (cell.k + 0.5) * spacing};
}

void readSpans(const ColumnGrid& grid, ColumnIndex cell, std::vector<Span>& spans) {
  spans.resize(grid.spanCount(cell.i, cell.k));
  grid.spans(cell.i, cell.k, spans);
}

}  // namespace galactic::pack_tool
