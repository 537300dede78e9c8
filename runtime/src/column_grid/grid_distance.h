#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "galactic/column_grid.h"
#include "galactic/pose.h"

namespace galactic::detail {

/// The directions in which a distance is measured.
enum class Directions : std::uint8_t {
  kAll,
  kLevel,  ///< In the horizontal plane only.
};

/// How far a free center is from the nearest place that is not free, or the other way round.
struct SignedDistance {
  /// Meters; negative where the center is not free.
  float distance = 0;
  /// The unit vector in which the distance grows fastest; zero on the border itself, and if nothing
  /// is near.
  Vec3 gradient;
};

/// Distances to the places that are not free in a grid: to the edges of its cells and the ends of
/// its spans, as queries see them. A search visits the cells around a center, the nearer ones
/// first. A coarse grid spares it most of them: for each block of 4 x 4 cells, it stores the
/// heights at which all of the block's columns are free.
class GridDistance {
 public:
  /// Reads all columns. Keeps a reference to the grid.
  explicit GridDistance(const ColumnGrid& grid);

  /// `center` must be finite, and `most` positive. Nothing that is `most` meters away or farther is
  /// searched for: the distance is then `most`, or -`most`. As exact as queries, except for
  /// rounding and for contactMargin() in height, which can make things look nearer to a free
  /// center. Outside of the grid, nothing is free. Neither allocates nor throws.
  [[nodiscard]] SignedDistance at(const Vec3& center, float most,
                                  Directions directions) const noexcept;

  /// Bytes of memory that it owns.
  [[nodiscard]] std::size_t bytes() const { return blocks_.size() * sizeof(Block); }

 private:
  /// The two longest intervals of heights that are free in all columns of a block.
  using Block = std::array<Span, 2>;
  class Search;

  [[nodiscard]] Block commonSpans(std::uint32_t block_i, std::uint32_t block_k) const;

  ColumnGrid grid_;
  std::uint32_t blocks_x_ = 0;
  std::uint32_t blocks_z_ = 0;
  /// Row by row.
  std::vector<Block> blocks_;
};

}  // namespace galactic::detail
