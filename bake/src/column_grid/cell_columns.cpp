#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "column_grid/assemble_columns.h"
#include "column_grid/scatter/triangle_bins.h"
#include "column_grid/triangle_interval.h"

namespace galactic::bake {
namespace {

/// Distance from `at` to the interval [lo, hi]; 0 inside.
double distanceTo(double at, double lo, double hi) { return std::max({lo - at, at - hi, 0.0}); }

/// The padding of a square and of its heights, meters: the merge tolerance, and the error of a
/// query that computes the cell and the code of a center in floats, with three roundings of values
/// up to `size`.
double padOver(double size) {
  return static_cast<double>(kMergeTolerance) +
         2 * static_cast<double>(std::numeric_limits<float>::epsilon()) * size;
}

double padInPlane(const GridFrame& frame) {
  return padOver(static_cast<double>(frame.spacing) * std::max(frame.columns_x, frame.columns_z));
}

double padInHeight(const GridFrame& frame) {
  const auto lo = static_cast<double>(frame.heights.lo);
  const auto hi = static_cast<double>(frame.heights.hi);
  return padOver(std::max({hi - lo, std::abs(lo), std::abs(hi)}));
}

/// Sweeps the ball over the squares around the columns' centers and scatters one triangle.
class CellScatter {
 public:
  CellScatter(const TriangleMesh& mesh, const GridFrame& frame, std::uint32_t index)
      : frame_(frame),
        triangle_(pointsOf(mesh, mesh.triangles[index])),
        half_(static_cast<double>(frame.spacing) / 2 + padInPlane(frame)),
        pad_(padInHeight(frame)) {
    const std::array<Point, 3> corners = pointsOf(mesh, mesh.triangles[index]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto [lo, hi] = std::minmax({corners[0][axis], corners[1][axis], corners[2][axis]});
      min_[axis] = lo;
      max_[axis] = hi;
    }
  }

  /// Adds the blocked heights to the rows of `strip`.
  void scatterInto(ColumnStrip& strip) const {
    const double reach = radius() + half_;
    const IndexRange rows = rowsWithin(frame_, min_[2] - reach, max_[2] + reach);
    const IndexRange columns = columnsWithin(frame_, min_[0] - reach, max_[0] + reach);
    const std::uint32_t end = std::min(rows.end, strip.endRow());
    for (std::uint32_t k = std::max(rows.first, strip.firstRow()); k < end; ++k) {
      for (std::uint32_t i = columns.first; i < columns.end; ++i) addCell(i, k, strip);
    }
  }

 private:
  [[nodiscard]] double radius() const { return static_cast<double>(frame_.radius); }

  void addCell(std::uint32_t i, std::uint32_t k, ColumnStrip& strip) const {
    const double x = frame_.centerX(i);
    const double z = frame_.centerZ(k);
    // The triangle's box bounds what the triangle can block, which is enough for most cells.
    const double dx = distanceTo(x, min_[0] - half_, max_[0] + half_);
    const double dz = distanceTo(z, min_[2] - half_, max_[2] + half_);
    const double rest = radius() * radius() - dx * dx - dz * dz;
    if (rest <= 0) return;
    const double height = std::sqrt(rest) + pad_;
    if (strip.covers(k, i, static_cast<float>(min_[1] - height),
                     static_cast<float>(max_[1] + height))) {
      return;
    }
    const auto heights = touchingHeightsOverCell(triangle_, x, z, half_, radius());
    if (!heights) return;
    strip.add(k, i, static_cast<float>(heights->lo - pad_), static_cast<float>(heights->hi + pad_));
  }

  const GridFrame& frame_;
  CellTriangle triangle_;
  /// Half the edge of a padded square, and the padding of its heights.
  double half_;
  double pad_;
  Point min_{};
  Point max_{};
};

}  // namespace

ExactColumns cellColumns(const TriangleMesh& mesh, const GridFrame& frame, unsigned threads) {
  const double reach =
      static_cast<double>(frame.radius) + static_cast<double>(frame.spacing) + padInPlane(frame);
  const TriangleBins bins(mesh, frame, kRowsPerStrip, reach);
  return assembleColumns(frame, threads, bins.stripCount(),
                         [&](std::uint32_t index, ColumnStrip& strip) {
                           for (const std::uint32_t triangle : bins.triangles(index)) {
                             CellScatter(mesh, frame, triangle).scatterInto(strip);
                           }
                         });
}

}  // namespace galactic::bake
