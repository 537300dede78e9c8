#pragma once
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "column_query_arena.h"
#include "galactic/column_grid.h"

namespace galactic::bench {

/// The published layout, to compare with: as many dense layers of two floats per column as the
/// tallest column has spans, and a search that starts from the layer found last time.
class DenseGrid {
 public:
  /// Bytes that the layers of `grid` take of an arena.
  [[nodiscard]] static std::size_t bytes(const ColumnGrid& grid);

  /// Copies the spans of `grid` into layers in `arena`.
  DenseGrid(const ColumnGrid& grid, Arena& arena);

  /// Distance down to contact, or a negative number when the center is not free. `layer` is the
  /// layer to start from and becomes the one found.
  [[nodiscard]] float distanceDown(Vec3 center, std::int8_t& layer) const {
    const float cell_x = (center.x - min_x_) * inverse_spacing_;
    const float cell_z = (center.z - min_z_) * inverse_spacing_;
    if (!(cell_x >= 0 && cell_z >= 0 && cell_x < columns_x_ && cell_z < columns_z_))
      return kContact;
    const std::size_t column =
        static_cast<std::size_t>(cell_z) * static_cast<std::size_t>(stride_) +
        static_cast<std::size_t>(cell_x);
    const int last = static_cast<int>(layers_.size()) - 1;
    int at = layer < 0 ? 0 : (layer > last ? last : layer);
    Span span = layers_[static_cast<std::size_t>(at)][column];
    const bool upwards = center.y > span.hi;
    while (!(center.y >= span.lo && center.y <= span.hi)) {
      // Between two spans: the search has passed the height that it looks for.
      if (upwards ? center.y < span.lo : center.y > span.hi) return found(layer, at, kContact);
      at += upwards ? 1 : -1;
      if (at < 0 || at > last) return found(layer, at < 0 ? 0 : last, kContact);
      span = layers_[static_cast<std::size_t>(at)][column];
    }
    return found(layer, at, center.y - span.lo);
  }

 private:
  static constexpr float kContact = -1;

  static float found(std::int8_t& layer, int at, float answer) {
    layer = static_cast<std::int8_t>(at);
    return answer;
  }

  float min_x_, min_z_, inverse_spacing_, columns_x_, columns_z_;
  std::uint32_t stride_;
  std::vector<std::span<const Span>> layers_;
};

}  // namespace galactic::bench
