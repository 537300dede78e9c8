#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "galactic/column_grid.h"

namespace galactic::bake {

struct Column {
  std::uint32_t i = 0;
  std::uint32_t k = 0;
};

/// The free spans of a column, ascending.
[[nodiscard]] inline std::vector<Span> spansOf(const ColumnGrid& grid, std::uint32_t i,
                                               std::uint32_t k) {
  std::vector<Span> spans(grid.spanCount(i, k));
  grid.spans(i, k, spans);
  return spans;
}

/// Where column (i, k) stands: x and z in meters, y 0.
[[nodiscard]] inline Vec3 columnCenter(const ColumnGrid& grid, std::uint32_t i, std::uint32_t k) {
  const ColumnGridLayout& layout = grid.layout();
  return {layout.min_x + (static_cast<float>(i) + 0.5F) * layout.spacing, 0,
          layout.min_z + (static_cast<float>(k) + 0.5F) * layout.spacing};
}

/// The column of the cell in which (x, z) lies; none outside the grid.
[[nodiscard]] inline std::optional<Column> columnAt(const ColumnGrid& grid, float x, float z) {
  const ColumnGridLayout& layout = grid.layout();
  const float cell_x = (x - layout.min_x) * layout.inverse_spacing;
  const float cell_z = (z - layout.min_z) * layout.inverse_spacing;
  // Every comparison is false for NaN.
  const bool inside = cell_x >= 0 && cell_x < static_cast<float>(layout.columns_x) && cell_z >= 0 &&
                      cell_z < static_cast<float>(layout.columns_z);
  if (!inside) return std::nullopt;
  return Column{static_cast<std::uint32_t>(cell_x), static_cast<std::uint32_t>(cell_z)};
}

}  // namespace galactic::bake
