#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "distance/triangle_tree.h"
#include "sphere_set/solid/box.h"

namespace galactic::bake::sphere_set {

/// Where a ball, the probe, can go around a mesh if it comes from outside.
///
/// The ball is tried at the corners of a voxel grid and spreads from the grid's border. Every point
/// that it reaches is the center of an empty ball, whose radius is the distance to the mesh. The
/// solid is what no empty ball contains. Surfaces need not be closed, and the winding of triangles
/// does not matter.
class ProbeField {
 public:
  /// For the facets of `tree`, all of which lie in `bounds`. The probe's radius is half of
  /// `smallest_radius`, or more if the grid would have too many voxels.
  ProbeField(const TriangleTree& tree, const Box& bounds, double smallest_radius, unsigned threads);

  /// Edge of a voxel, meters.
  [[nodiscard]] double voxel() const { return voxel_; }
  /// Radius of the probe, meters.
  [[nodiscard]] double probe() const { return probe_; }

  /// Distance of `p` to the empty balls near it: negative inside a ball, that is, outside the
  /// solid.
  [[nodiscard]] double excess(const Vec3d& p) const;

 private:
  void chooseGrid(const Box& bounds, double smallest_radius);
  void spread(const TriangleTree& tree);
  void findNearestReached(unsigned threads);
  void nearestInRow(std::size_t y, std::size_t z);
  void nearestInPlane(std::size_t z);
  void nearestAcrossPlanes(std::size_t y);

  [[nodiscard]] std::size_t index(std::size_t x, std::size_t y, std::size_t z) const {
    return (z * size_[1] + y) * size_[0] + x;
  }
  [[nodiscard]] std::array<std::size_t, 3> cellOf(std::size_t index) const {
    return {index % size_[0], index / size_[0] % size_[1], index / size_[0] / size_[1]};
  }
  [[nodiscard]] Vec3d positionOf(std::size_t index) const;

  static constexpr float kUnknown = 0;
  static constexpr float kBlocked = -1;

  double voxel_ = 0;
  double probe_ = 0;
  Vec3d origin_;
  std::array<std::size_t, 3> size_{};
  /// Radius of the empty ball at each voxel that the probe reaches, up to a limit; kBlocked if the
  /// probe does not fit, kUnknown if it did not come near.
  std::vector<float> clearance_;
  /// For each voxel, the index of the nearest reached voxel.
  std::vector<std::uint32_t> nearest_;
};

}  // namespace galactic::bake::sphere_set
