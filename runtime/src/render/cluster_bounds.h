#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "galactic/render_meshes.h"

namespace galactic::render {

/// What a lane of a block of bounds holds.
struct ClusterBounds {
  Vec3 centre;
  Vec3 half_extents;
  float radius = 0;
  Vec3 axis;
  float cutoff = 2;
};

/// The bounds of a cluster, rounded outwards. `positions`: of its vertices as they are drawn,
/// metres, at least one. `triangles`: their corners; empty for a cluster that is seen from both
/// sides, which has no cone.
[[nodiscard]] ClusterBounds boundsOf(std::span<const Vec3> positions,
                                     std::span<const std::array<std::uint8_t, 3>> triangles);

}  // namespace galactic::render
