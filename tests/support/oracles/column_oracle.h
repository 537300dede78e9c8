#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "column_grid/triangle_interval.h"
#include "galactic/bake/columns.h"
#include "galactic/bake/triangle_mesh.h"
#include "support/oracles/triangle_corners.h"

namespace galactic::test {

/// The free heights of single columns, computed in double from every triangle that could touch: a
/// sort and a merge of closed-form intervals, nothing shared with the engines but the interval of
/// one triangle. A grid of squares in the ground plane spares it the triangles that are far away.
class ColumnOracle {
 public:
  /// Right for spheres of up to `reach`, meters.
  ColumnOracle(const bake::TriangleMesh& mesh, double reach)
      : triangles_(allCorners(mesh)),
        min_x_(static_cast<double>(mesh.bounds.min.x) - reach),
        min_z_(static_cast<double>(mesh.bounds.min.z) - reach),
        squares_x_(squareCount(static_cast<double>(mesh.bounds.max.x) + reach - min_x_)),
        squares_z_(squareCount(static_cast<double>(mesh.bounds.max.z) + reach - min_z_)),
        squares_(squares_x_ * squares_z_) {
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
      const auto& [a, b, c] = triangles_[t];
      const auto [lo_x, hi_x] = std::minmax({a[0], b[0], c[0]});
      const auto [lo_z, hi_z] = std::minmax({a[2], b[2], c[2]});
      const std::size_t first_x = squareAt(lo_x - reach - min_x_, squares_x_);
      const std::size_t last_x = squareAt(hi_x + reach - min_x_, squares_x_);
      const std::size_t last_z = squareAt(hi_z + reach - min_z_, squares_z_);
      for (std::size_t z = squareAt(lo_z - reach - min_z_, squares_z_); z <= last_z; ++z) {
        for (std::size_t x = first_x; x <= last_x; ++x) {
          squares_[z * squares_x_ + x].push_back(t);
        }
      }
    }
  }

  /// Free heights on the vertical line through (x, z), ascending; gaps of up to `merge` between
  /// blocked heights are closed.
  [[nodiscard]] std::vector<bake::HeightInterval> freeSpans(
      double x, double z, const bake::GridFrame& frame, double radius,
      double merge = static_cast<double>(bake::kMergeTolerance)) const {
    std::vector<bake::HeightInterval> blocked;
    for (const std::uint32_t t : trianglesAt(x, z)) {
      if (const auto found = bake::touchingHeights(triangles_[t], x, z, radius)) {
        blocked.push_back(*found);
      }
    }
    std::sort(blocked.begin(), blocked.end(),
              [](const auto& a, const auto& b) { return a.lo < b.lo; });
    const auto top = static_cast<double>(frame.heights.hi);
    auto reached = static_cast<double>(frame.heights.lo);
    std::vector<bake::HeightInterval> free;
    for (const bake::HeightInterval& interval : blocked) {
      if (std::min(interval.lo, top) - reached > merge) {
        free.push_back({reached, std::min(interval.lo, top)});
      }
      reached = std::max(reached, interval.hi);
    }
    if (top - reached > merge) free.push_back({reached, top});
    return free;
  }

  /// Distance from a point to the nearest triangle within reach of its column; infinite if none.
  [[nodiscard]] double distance(const bake::Point& point) const {
    double least = std::numeric_limits<double>::infinity();
    for (const std::uint32_t t : trianglesAt(point[0], point[2])) {
      least = std::min(least, bake::squaredDistance(point, triangles_[t]));
    }
    return std::sqrt(least);
  }

 private:
  static constexpr double kSquareEdge = 0.1;

  static std::size_t squareCount(double length) {
    return static_cast<std::size_t>(length / kSquareEdge) + 1;
  }

  static std::size_t squareAt(double offset, std::size_t count) {
    const double limit = static_cast<double>(count - 1);
    return static_cast<std::size_t>(std::clamp(std::floor(offset / kSquareEdge), 0.0, limit));
  }

  [[nodiscard]] const std::vector<std::uint32_t>& trianglesAt(double x, double z) const {
    return squares_[squareAt(z - min_z_, squares_z_) * squares_x_ +
                    squareAt(x - min_x_, squares_x_)];
  }

  std::vector<Corners> triangles_;
  double min_x_;
  double min_z_;
  std::size_t squares_x_;
  std::size_t squares_z_;
  /// Per square, the triangles within reach of it.
  std::vector<std::vector<std::uint32_t>> squares_;
};

}  // namespace galactic::test
