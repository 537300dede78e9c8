#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "galactic/column_grid.h"
#include "galactic/pose.h"

namespace galactic::detail {

/// In which directions a distance is measured.
enum class Directions : std::uint8_t {
  kAll,
  kLevel,  ///< In the horizontal plane alone.
};

/// How far a center is from where it is free no longer, or from where it is free.
struct SignedDistance {
  /// Meters; negative where the center is not free.
  float distance = 0;
  /// The unit vector in which the distance grows fastest; zero at the border itself, and where
  /// nothing is near.
  Vec3 gradient;
};

/// Distances to the places where a grid does not say free: to the edges of its cells and the ends
/// of its spans, as queries see them. A search goes through the cells around a center, the nearer
/// ones first. What spares it most of them is a coarse grid: for each block of 4 x 4 cells, the
/// heights at which all of its columns are free.
class GridDistance {
 public:
  /// Reads all columns. Of the grid it keeps a view.
  explicit GridDistance(const ColumnGrid& grid);

  /// `center`: finite. What is `most` meters away or farther, > 0, is not looked for: then the
  /// distance is `most`, or -`most`. Exact as queries are but for contactMargin() in height, by
  /// which a free center may seem nearer, and rounding. What is outside of the grid is not free.
  /// Neither allocates nor throws.
  [[nodiscard]] SignedDistance at(const Vec3& center, float most,
                                  Directions directions) const noexcept;

  /// Of its own memory.
  [[nodiscard]] std::size_t bytes() const { return blocks_.size() * sizeof(Block); }

 private:
  /// The two longest intervals that are free in all columns of a block.
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
