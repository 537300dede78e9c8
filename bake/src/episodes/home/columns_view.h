#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "galactic/column_grid.h"

namespace galactic::bake {

struct Column {
  std::uint32_t i = 0;
  std::uint32_t k = 0;
};

/// The free spans of a column, ascending: a range that takes no memory where they are few, as they
/// nearly always are.
class ColumnSpans {
 public:
  ColumnSpans(const ColumnGrid& grid, std::uint32_t i, std::uint32_t k)
      : count_(grid.spans(i, k, few_)) {
    if (count_ <= few_.size()) return;
    many_.resize(count_);
    grid.spans(i, k, many_);
  }

  [[nodiscard]] const Span* begin() const { return many_.empty() ? few_.data() : many_.data(); }
  [[nodiscard]] const Span* end() const { return begin() + count_; }

 private:
  std::array<Span, 8> few_;
  std::vector<Span> many_;
  std::size_t count_;
};

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
