#pragma once
#include <array>

#include "layout/render_layout.h"
#include "layout/render_pools.h"

namespace galactic::render {

/// One lane of a block of bounds, by rows, and the box from which it was made.
struct ClusterBounds {
  std::array<float, kBoundsRows> rows{};
  Vec3 low;
  Vec3 high;
};

/// Box, sphere and cone of a cluster, rounded so that they contain every corner and every normal as
/// a renderer computes them. Only one-sided clusters whose normals lie within 84 degrees of their
/// mean get a cone. `step` of the lattice, meters.
[[nodiscard]] ClusterBounds boundsOf(const LatticeCluster& cluster, double step);

}  // namespace galactic::render
