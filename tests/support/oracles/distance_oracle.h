#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "column_grid/triangle_interval.h"
#include "galactic/bake/triangle_mesh.h"
#include "support/oracles/triangle_corners.h"

namespace galactic::test {

/// Distance to a mesh, computed in double over all triangles that could be nearest: brute force
/// with nothing but a uniform grid of cubes in front, in which each cube lists the triangles within
/// `reach` of it.
class DistanceOracle {
 public:
  /// Answers are right up to `reach`, meters.
  DistanceOracle(const bake::TriangleMesh& mesh, double reach)
      : triangles_(allCorners(mesh)), reach_(reach) {
    const bake::Point lo = toPoint(mesh.bounds.min);
    const bake::Point hi = toPoint(mesh.bounds.max);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      min_[axis] = lo[axis] - reach;
      count_[axis] = static_cast<std::size_t>((hi[axis] - lo[axis] + 2 * reach) / kCubeEdge) + 1;
    }
    start_.assign(count_[0] * count_[1] * count_[2] + 1, 0);
    forEachNear([&](std::size_t cube, std::uint32_t) { ++start_[cube + 1]; });
    for (std::size_t cube = 1; cube < start_.size(); ++cube) start_[cube] += start_[cube - 1];
    near_.resize(start_.back());
    std::vector<std::size_t> next(start_.begin(), start_.end() - 1);
    forEachNear([&](std::size_t cube, std::uint32_t triangle) { near_[next[cube]++] = triangle; });
  }

  /// Distance from `point` to the mesh, or `reach` when it is at least that.
  [[nodiscard]] double distance(const bake::Point& point) const {
    double least = reach_ * reach_;
    std::size_t cube = 0;
    for (std::size_t axis = 3; axis-- > 0;) {
      const double cell = std::floor((point[axis] - min_[axis]) / kCubeEdge);
      if (!(cell >= 0 && cell < static_cast<double>(count_[axis]))) return reach_;
      cube = cube * count_[axis] + static_cast<std::size_t>(cell);
    }
    for (std::size_t n = start_[cube]; n < start_[cube + 1]; ++n) {
      const Corners& corners = triangles_[near_[n]];
      if (squaredDistanceToBox(point, corners) >= least) continue;
      least = std::min(least, bake::squaredDistance(point, corners));
    }
    return std::sqrt(least);
  }

 private:
  static constexpr double kCubeEdge = 0.1;

  static double squaredDistanceToBox(const bake::Point& point, const Corners& corners) {
    double sum = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double a = corners[0][axis];
      const double b = corners[1][axis];
      const double c = corners[2][axis];
      const double outside =
          std::max({std::min({a, b, c}) - point[axis], point[axis] - std::max({a, b, c}), 0.0});
      sum += outside * outside;
    }
    return sum;
  }

  /// Calls `visit` with each cube and each triangle that some point of the cube may be within reach
  /// of: the triangle is within reach of the ball around the cube.
  template <class Visit>
  void forEachNear(const Visit& visit) const {
    const double around = reach_ + kCubeEdge * std::sqrt(3.0) / 2 + 1e-9;
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
      std::array<std::size_t, 3> first{};
      std::array<std::size_t, 3> last{};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto [lo, hi] =
            std::minmax({triangles_[t][0][axis], triangles_[t][1][axis], triangles_[t][2][axis]});
        first[axis] = cubeAt(lo - reach_, axis);
        last[axis] = cubeAt(hi + reach_, axis);
      }
      for (std::size_t z = first[2]; z <= last[2]; ++z) {
        for (std::size_t y = first[1]; y <= last[1]; ++y) {
          for (std::size_t x = first[0]; x <= last[0]; ++x) {
            const bake::Point center = centerOf({x, y, z});
            if (bake::squaredDistance(center, triangles_[t]) > around * around) continue;
            visit((z * count_[1] + y) * count_[0] + x, t);
          }
        }
      }
    }
  }

  [[nodiscard]] std::size_t cubeAt(double coordinate, std::size_t axis) const {
    const double cell = std::floor((coordinate - min_[axis]) / kCubeEdge);
    return static_cast<std::size_t>(std::clamp(cell, 0.0, static_cast<double>(count_[axis] - 1)));
  }

  [[nodiscard]] bake::Point centerOf(const std::array<std::size_t, 3>& cube) const {
    bake::Point center{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      center[axis] = min_[axis] + (static_cast<double>(cube[axis]) + 0.5) * kCubeEdge;
    }
    return center;
  }

  std::vector<Corners> triangles_;
  double reach_;
  bake::Point min_{};
  std::array<std::size_t, 3> count_{};
  /// Prefix sums into near_, one more than cubes.
  std::vector<std::size_t> start_;
  std::vector<std::uint32_t> near_;
};

}  // namespace galactic::test
