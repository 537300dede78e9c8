#pragma once
#include <array>
#include <cstddef>
#include <vector>

#include "sphere_set/solid/exterior_solid.h"

namespace galactic::bake::sphere_set {

/// Signed distances to a solid at the nodes of a regular grid around it: where an estimate will do
/// in place of a search. Immutable.
class DistanceGrid {
 public:
  /// Over the solid's bounds and `margin` meters around them, about `most_nodes` nodes.
  DistanceGrid(const ExteriorSolid& solid, double margin, double most_nodes, unsigned threads);

  [[nodiscard]] double step() const { return step_; }
  [[nodiscard]] std::size_t nodes() const { return distance_.size(); }
  [[nodiscard]] Vec3d position(std::size_t node) const;
  [[nodiscard]] double distance(std::size_t node) const {
    return static_cast<double>(distance_[node]);
  }

  /// Interpolated between the nodes around `p`; of the nearest place where `p` is beyond the grid.
  [[nodiscard]] double at(const Vec3d& p) const;

 private:
  double step_ = 0;
  Vec3d origin_;
  std::array<std::size_t, 3> size_{};
  std::vector<float> distance_;
};

}  // namespace galactic::bake::sphere_set
