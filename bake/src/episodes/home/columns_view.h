#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "galactic/column_grid.h"

namespace galactic::bake {

/// The free spans of a column, ascending: a range that allocates no memory if there are few, as is
/// nearly always the case.
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

/// The center of column (i, k): x and z in meters, y 0.
[[nodiscard]] inline Vec3 columnCenter(const ColumnGrid& grid, std::uint32_t i, std::uint32_t k) {
  const ColumnGridLayout& layout = grid.layout();
  return {layout.min_x + (static_cast<float>(i) + 0.5F) * layout.spacing, 0,
          layout.min_z + (static_cast<float>(k) + 0.5F) * layout.spacing};
}

}  // namespace galactic::bake
