#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sphere_set/solid/box.h"

namespace galactic::bake::sphere_set {

/// Points sorted into the cells of a regular grid, for range queries. Immutable.
class PointGrid {
 public:
  /// `cell`: edge of the cells, meters; larger if there would be too many cells.
  PointGrid(std::span<const Vec3d> points, double cell);

  /// Calls visit(index, squared distance) for the points within `radius` of `center`, in a fixed
  /// order, until it returns false.
  template <class Visit>
  void visitWithin(const Vec3d& center, double radius, const Visit& visit) const {
    if (sorted_.empty()) return;
    const double limit = radius * radius;
    const Range z = cellsAlong(2, center.z, radius);
    const Range y = cellsAlong(1, center.y, radius);
    const Range x = cellsAlong(0, center.x, radius);
    for (std::size_t k = z.first; k < z.end; ++k) {
      for (std::size_t j = y.first; j < y.end; ++j) {
        // The cells of one row follow each other.
        const std::size_t row = (k * size_[1] + j) * size_[0];
        for (std::uint32_t at = first_[row + x.first]; at < first_[row + x.end]; ++at) {
          const double squared = squaredNorm(sorted_[at].point - center);
          if (squared <= limit && !visit(sorted_[at].index, squared)) return;
        }
      }
    }
  }

  /// Whether any point is within `radius` of `center`.
  [[nodiscard]] bool anyWithin(const Vec3d& center, double radius) const {
    bool found = false;
    visitWithin(center, radius, [&](std::uint32_t, double) {
      found = true;
      return false;
    });
    return found;
  }

 private:
  struct Entry {
    Vec3d point;
    std::uint32_t index = 0;
  };
  /// Cells first to end - 1 along one axis.
  struct Range {
    std::size_t first = 0;
    std::size_t end = 0;
  };

  [[nodiscard]] Range cellsAlong(std::size_t axis, double at, double radius) const;
  [[nodiscard]] std::size_t cellOf(const Vec3d& p) const;

  double cell_ = 0;
  std::array<double, 3> origin_{};
  std::array<std::size_t, 3> size_{1, 1, 1};
  /// First entry of each cell in sorted_, with one more element than cells.
  std::vector<std::uint32_t> first_;
  std::vector<Entry> sorted_;
};

}  // namespace galactic::bake::sphere_set
