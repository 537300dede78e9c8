#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "galactic/error.h"
#include "galactic/render_meshes.h"

namespace galactic::detail {

/// The pools of render meshes, and how many materials and semantics a cluster can refer to.
struct RenderPools {
  std::span<const float> bounds;
  std::span<const std::uint16_t> vertices;
  std::span<const std::uint32_t> colors;
  std::span<const std::uint8_t> triangles;
  std::size_t materials = 0;
  std::size_t semantics = 0;
};

/// The place that a cluster must have: after its predecessor.
struct ClusterPlace {
  std::size_t first_vertex = 0;
  std::size_t first_triangle = 0;
  /// Its lane of the bounds, counted over all blocks.
  std::size_t lane = 0;
};

/// Checks a cluster, its bounds, vertices and triangles, and that all of it lies within the bounds
/// of its model. Errors name only the field of the cluster: ".vertex_count".
[[nodiscard]] Result<void> checkCluster(const RenderCluster& cluster, const RenderModel& model,
                                        const RenderPools& pools, const ClusterPlace& place);

}  // namespace galactic::detail
