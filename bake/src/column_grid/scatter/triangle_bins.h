#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "galactic/bake/columns.h"
#include "galactic/bake/triangle_mesh.h"

namespace galactic::bake {

/// Rows or columns first to end - 1.
struct IndexRange {
  std::uint32_t first = 0;
  std::uint32_t end = 0;
};

/// Which of `count` centers at (index + 0.5) * spacing lie within [lo, hi]. There may be one more
/// at either end, so that rounding loses none.
[[nodiscard]] IndexRange centersWithin(double lo, double hi, double spacing, std::uint32_t count);

/// The rows and columns of a grid whose centers lie within [lo, hi], world frame.
[[nodiscard]] IndexRange rowsWithin(const GridFrame& frame, double lo, double hi);
[[nodiscard]] IndexRange columnsWithin(const GridFrame& frame, double lo, double hi);

/// For each strip of rows, the triangles within `reach` of it, in mesh order.
class TriangleBins {
 public:
  TriangleBins(const TriangleMesh& mesh, const GridFrame& frame, std::uint32_t rows_per_strip,
               double reach);

  [[nodiscard]] std::uint32_t stripCount() const {
    return static_cast<std::uint32_t>(start_.size() - 1);
  }
  [[nodiscard]] std::span<const std::uint32_t> triangles(std::uint32_t strip) const {
    return std::span(triangles_).subspan(start_[strip], start_[strip + 1] - start_[strip]);
  }

 private:
  std::vector<std::size_t> start_;
  std::vector<std::uint32_t> triangles_;
};

}  // namespace galactic::bake
