#include "column_query_dense.h"

#include <algorithm>

namespace galactic::bench {
namespace {

/// Where a column has fewer spans than layers: above any height.
constexpr Span kNoSpan{3e38F, 3e38F};

std::size_t layerCount(const ColumnGrid& grid) {
  std::size_t most = 1;
  for (std::uint32_t k = 0; k < grid.columnsZ(); ++k) {
    for (std::uint32_t i = 0; i < grid.columnsX(); ++i) most = std::max(most, grid.spanCount(i, k));
  }
  return most;
}

std::size_t columnCount(const ColumnGrid& grid) {
  return std::size_t{grid.columnsX()} * grid.columnsZ();
}

}  // namespace

std::size_t DenseGrid::bytes(const ColumnGrid& grid) {
  return layerCount(grid) * Arena::roomFor(columnCount(grid) * sizeof(Span));
}

DenseGrid::DenseGrid(const ColumnGrid& grid, Arena& arena)
    : min_x_(grid.layout().min_x),
      min_z_(grid.layout().min_z),
      inverse_spacing_(grid.layout().inverse_spacing),
      columns_x_(static_cast<float>(grid.columnsX())),
      columns_z_(static_cast<float>(grid.columnsZ())),
      stride_(grid.columnsX()) {
  std::vector<std::span<Span>> layers(layerCount(grid));
  for (auto& layer : layers) layer = arena.take<Span>(columnCount(grid));
  std::vector<Span> column(layers.size());
  for (std::uint32_t k = 0; k < grid.columnsZ(); ++k) {
    for (std::uint32_t i = 0; i < grid.columnsX(); ++i) {
      std::fill(column.begin(), column.end(), kNoSpan);
      grid.spans(i, k, column);
      const std::size_t index = std::size_t{k} * stride_ + i;
      for (std::size_t n = 0; n < layers.size(); ++n) layers[n][index] = column[n];
    }
  }
  layers_.assign(layers.begin(), layers.end());
}

}  // namespace galactic::bench
