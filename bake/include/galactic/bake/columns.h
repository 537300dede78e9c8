#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "galactic/bake/triangle_mesh.h"
#include "galactic/error.h"
#include "galactic/pose.h"

namespace galactic::bake {

/// Where the columns of a grid stand. The numbers are floats because the pack stores them as such;
/// positions are computed from them in double.
struct GridFrame {
  float radius = 0;
  float spacing = 0;
  /// Corner of cell (0, 0).
  float min_x = 0;
  float min_z = 0;
  /// Heights between which the grid is built.
  Span heights;
  std::uint32_t columns_x = 0;
  std::uint32_t columns_z = 0;

  [[nodiscard]] double centerX(std::uint32_t i) const {
    return static_cast<double>(min_x) + (i + 0.5) * static_cast<double>(spacing);
  }
  [[nodiscard]] double centerZ(std::uint32_t k) const {
    return static_cast<double>(min_z) + (k + 0.5) * static_cast<double>(spacing);
  }
  [[nodiscard]] std::size_t columnCount() const { return std::size_t{columns_x} * columns_z; }
};

/// The bounds of the scene that a frame was made for: the frame without its padding, to within a
/// cell at the far ends in the plane.
[[nodiscard]] Bounds sceneBounds(const GridFrame& frame);

/// The frame for a scene: its bounds padded by the radius and one cell in the plane (so that the
/// border columns touch nothing), and by the radius and 1 cm in height. Fails with kInvalidInput on
/// a radius under half the spacing, and on more cells than a grid may have.
[[nodiscard]] Result<GridFrame> makeGridFrame(const Bounds& bounds, float radius, float spacing);

/// Free spans of all columns, ascending and disjoint in each column, row by row (i fastest).
struct Columns {
  GridFrame frame;
  /// Prefix sums into spans. Shape: columnCount() + 1.
  std::vector<std::uint32_t> first;
  std::vector<Span> spans;

  [[nodiscard]] std::span<const Span> column(std::size_t index) const {
    return std::span(spans).subspan(first[index], first[index + 1] - first[index]);
  }
  [[nodiscard]] std::size_t index(std::uint32_t i, std::uint32_t k) const {
    return std::size_t{k} * frame.columns_x + i;
  }
};

/// Gaps between blocked intervals up to this wide are closed: below it a gap is float rounding.
inline constexpr float kMergeTolerance = 1e-5F;

}  // namespace galactic::bake
