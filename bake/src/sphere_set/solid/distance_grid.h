#pragma once
#include <array>
#include <cstddef>
#include <vector>

#include "sphere_set/solid/exterior_solid.h"

namespace galactic::bake::sphere_set {

/// Signed distances to a solid at the nodes of a regular grid around it, for cases in which an
/// estimate can replace a search. Immutable.
class DistanceGrid {
 public:
  /// Covers the solid's bounds and a margin of `margin` meters with about `most_nodes` nodes.
  DistanceGrid(const ExteriorSolid& solid, double margin, double most_nodes, unsigned threads);

  [[nodiscard]] double step() const { return step_; }
  [[nodiscard]] std::size_t nodes() const { return distance_.size(); }
  [[nodiscard]] Vec3d position(std::size_t node) const;
  [[nodiscard]] double distance(std::size_t node) const {
    return static_cast<double>(distance_[node]);
  }

  /// The distance at `p`, interpolated between nodes. Outside the grid, that of the nearest point
  /// in it.
  [[nodiscard]] double at(const Vec3d& p) const;

 private:
  double step_ = 0;
  Vec3d origin_;
  std::array<std::size_t, 3> size_{};
  std::vector<float> distance_;
};

}  // namespace galactic::bake::sphere_set
