#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "column_grid/assemble_columns.h"
#include "column_grid/scatter/scatter.h"
#include "column_grid/scatter/triangle_bins.h"
#include "column_grid/triangle_interval.h"
#include "galactic/bake/column_engines.h"

namespace galactic::bake {
namespace {

using Corners = std::array<Point, 3>;

/// Floats are too inaccurate for larger triangles, which reach far from their own first corner.
/// These are computed in double, column by column. Meters.
constexpr double kMostInFloats = 32;

/// The columns' centers relative to the grid's corner: x as a sum of two floats, so that
/// differences to a triangle's corner lose nothing, and z in double.
struct Centers {
  std::vector<float> x_high;
  std::vector<float> x_low;
  std::vector<double> z;

  explicit Centers(const GridFrame& frame) {
    for (std::uint32_t i = 0; i < frame.columns_x + ColumnStrip::kPadding; ++i) {
      const double x = frame.centerX(i) - static_cast<double>(frame.min_x);
      x_high.push_back(static_cast<float>(x));
      x_low.push_back(static_cast<float>(x - static_cast<double>(x_high.back())));
    }
    for (std::uint32_t k = 0; k < frame.columns_z; ++k) {
      z.push_back(frame.centerZ(k) - static_cast<double>(frame.min_z));
    }
  }
};

/// The extent in x of the part of a triangle between two values of z; lo > hi if that part is
/// empty.
HeightInterval extentBetween(const Corners& corners, double min_z, double max_z) {
  HeightInterval extent{std::numeric_limits<double>::infinity(),
                        -std::numeric_limits<double>::infinity()};
  const auto include = [&](double x) {
    extent.lo = std::min(extent.lo, x);
    extent.hi = std::max(extent.hi, x);
  };
  for (std::size_t i = 0; i < 3; ++i) {
    const Point& a = corners[i];
    const Point& b = corners[(i + 1) % 3];
    if (a[2] >= min_z && a[2] <= max_z) include(a[0]);
    for (const double z : {min_z, max_z}) {
      if ((a[2] < z) == (b[2] < z)) continue;
      include(a[0] + (z - a[2]) / (b[2] - a[2]) * (b[0] - a[0]));
    }
  }
  return extent;
}

/// Scatters the triangles of a mesh into strips of one grid.
class MeshScatter {
 public:
  MeshScatter(const TriangleMesh& mesh, const GridFrame& frame)
      : mesh_(mesh), frame_(frame), centers_(frame), kernels_(fastestScatter()) {}

  /// Adds the blocked heights of triangle `index` to the rows of `strip`.
  void operator()(std::uint32_t index, ColumnStrip& strip) const {
    const Corners corners = cornersInGrid(index);
    const double r = static_cast<double>(frame_.radius);
    const auto [min_x, max_x] = std::minmax({corners[0][0], corners[1][0], corners[2][0]});
    const auto [min_z, max_z] = std::minmax({corners[0][2], corners[1][2], corners[2][2]});
    const IndexRange rows = rowRange(min_z - r, max_z + r);
    const IndexRange columns = columnRange(min_x - r, max_x + r);
    const ScatterBlock box{.first_row = std::max(rows.first, strip.firstRow()),
                           .end_row = std::min(rows.end, strip.endRow()),
                           .first_column = columns.first,
                           .end_column = columns.end};
    const auto [min_y, max_y] = std::minmax({corners[0][1], corners[1][1], corners[2][1]});
    if (std::max({max_x - min_x, max_y - min_y, max_z - min_z}) > kMostInFloats) {
      addInDouble(corners, box, strip);
      return;
    }
    const ScatterTriangle triangle = prepareTriangle(corners, frame_.radius);
    const ScatterTarget target = targetOf(strip);
    // The box of a small triangle is hardly bigger than the triangle grown by the radius. For a
    // large triangle, each row takes only the columns that it needs.
    const double small = 4 * r + 8 * static_cast<double>(frame_.spacing);
    if (max_x - min_x < small || max_z - min_z < small) {
      scatter(triangle, box, target);
      return;
    }
    for (std::uint32_t row = box.first_row; row < box.end_row; ++row) {
      const IndexRange run = runInRow(corners, row);
      scatter(triangle, {row, row + 1, run.first, run.end}, target);
    }
  }

 private:
  /// The columns of a row that a triangle may touch.
  [[nodiscard]] IndexRange runInRow(const Corners& corners, std::uint32_t row) const {
    const double r = static_cast<double>(frame_.radius);
    const HeightInterval x = extentBetween(corners, centers_.z[row] - r, centers_.z[row] + r);
    return columnRange(x.lo - r, x.hi + r);
  }

  void addInDouble(const Corners& corners, const ScatterBlock& box, ColumnStrip& strip) const {
    for (std::uint32_t row = box.first_row; row < box.end_row; ++row) {
      const IndexRange run = runInRow(corners, row);
      for (std::uint32_t column = run.first; column < run.end; ++column) {
        const double x = static_cast<double>(centers_.x_high[column]) +
                         static_cast<double>(centers_.x_low[column]);
        const auto heights =
            touchingHeights(corners, x, centers_.z[row], static_cast<double>(frame_.radius));
        if (!heights) continue;
        strip.add(row, column, static_cast<float>(heights->lo), static_cast<float>(heights->hi));
      }
    }
  }

  /// The corners of a triangle relative to the grid's corner in the ground plane.
  [[nodiscard]] Corners cornersInGrid(std::uint32_t index) const {
    Corners corners = pointsOf(mesh_, mesh_.triangles[index]);
    for (Point& corner : corners) {
      corner[0] -= static_cast<double>(frame_.min_x);
      corner[2] -= static_cast<double>(frame_.min_z);
    }
    return corners;
  }

  [[nodiscard]] IndexRange rowRange(double lo, double hi) const {
    return centersWithin(lo, hi, static_cast<double>(frame_.spacing), frame_.columns_z);
  }
  [[nodiscard]] IndexRange columnRange(double lo, double hi) const {
    return centersWithin(lo, hi, static_cast<double>(frame_.spacing), frame_.columns_x);
  }

  [[nodiscard]] ScatterTarget targetOf(ColumnStrip& strip) const {
    return {.lo = strip.lo(),
            .hi = strip.hi(),
            .first_row = strip.firstRow(),
            .stride = strip.stride(),
            .x_high = centers_.x_high.data(),
            .x_low = centers_.x_low.data(),
            .z = centers_.z.data(),
            .strip = &strip};
  }

  void scatter(const ScatterTriangle& triangle, const ScatterBlock& block,
               const ScatterTarget& target) const {
    if (block.first_column >= block.end_column) return;
    const bool narrow = block.end_column - block.first_column <= kNarrowColumns;
    (narrow ? kernels_.narrow : kernels_.wide)(triangle, block, frame_.radius, target);
  }

  const TriangleMesh& mesh_;
  const GridFrame& frame_;
  Centers centers_;
  ScatterFunctions kernels_;
};

}  // namespace

ExactColumns exactColumns(const TriangleMesh& mesh, const GridFrame& frame, Coverage coverage,
                          unsigned threads) {
  if (coverage == Coverage::kCell) return cellColumns(mesh, frame, threads);
  const TriangleBins bins(mesh, frame, kRowsPerStrip, static_cast<double>(frame.radius));
  const MeshScatter scatter(mesh, frame);
  return assembleColumns(frame, threads, bins.stripCount(),
                         [&](std::uint32_t index, ColumnStrip& strip) {
                           for (const std::uint32_t triangle : bins.triangles(index)) {
                             scatter(triangle, strip);
                           }
                         });
}

}  // namespace galactic::bake
