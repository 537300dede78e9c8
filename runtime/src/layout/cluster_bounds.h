#pragma once
#include <array>

#include "layout/render_layout.h"
#include "layout/render_pools.h"

namespace galactic::render {

/// One lane of a block of bounds, by rows, and the box it was made of.
struct ClusterBounds {
  std::array<float, kBoundsRows> rows{};
  Vec3 low;
  Vec3 high;
};

/// Box, sphere and cone of a cluster, rounded so that they hold every corner and every normal as a
/// renderer computes them. The cone is for one-sided clusters whose normals lie within 84 degrees
/// of their mean. `step`: of the lattice, meters.
[[nodiscard]] ClusterBounds boundsOf(const LatticeCluster& cluster, double step);

}  // namespace galactic::render
