#include "pack_tool/mesh/grid_view.h"

#include <cmath>

namespace galactic::pack_tool {

namespace {

/// Index of the cell along one axis, none outside [0, columns).
std::optional<std::uint32_t> cellAlong(double offset, double spacing, std::uint32_t columns) {
  const double index = std::floor(offset / spacing);
  if (!(index >= 0) || !(index < columns)) return std::nullopt;
  return static_cast<std::uint32_t>(index);
}

}  // namespace

std::optional<Cell> nearestColumn(const ColumnGrid& grid, GroundPoint point) {
  const ColumnGridLayout& layout = grid.layout();
  const double spacing = static_cast<double>(layout.spacing);
  const auto i = cellAlong(point.x - static_cast<double>(layout.min_x), spacing, layout.columns_x);
  const auto k = cellAlong(point.z - static_cast<double>(layout.min_z), spacing, layout.columns_z);
  if (!i || !k) return std::nullopt;
  return Cell{*i, *k};
}

GroundPoint columnCenter(const ColumnGrid& grid, Cell cell) {
  const ColumnGridLayout& layout = grid.layout();
  const double spacing = static_cast<double>(layout.spacing);
  return {static_cast<double>(layout.min_x) + (cell.i + 0.5) * spacing,
          static_cast<double>(layout.min_z) + (cell.k + 0.5) * spacing};
}

void readSpans(const ColumnGrid& grid, Cell cell, std::vector<Span>& spans) {
  spans.resize(grid.spanCount(cell.i, cell.k));
  grid.spans(cell.i, cell.k, spans);
}

}  // namespace galactic::pack_tool
