#pragma once
#include <cstddef>
#include <cstdint>

#include "galactic/render_meshes.h"

namespace galactic {

// The layout of the pools of RenderMeshes, which store rows of eight. For code that writes, checks
// or reads elements one by one; rasterizers read whole rows.

/// Index of element `index` in row `row` of a pool with `rows` rows of eight.
[[nodiscard]] constexpr std::size_t pooledAt(std::size_t index, std::size_t row, std::size_t rows) {
  return (index / kRenderLanes * rows + row) * kRenderLanes + index % kRenderLanes;
}

/// `count` rounded up to whole rows of eight.
[[nodiscard]] constexpr std::size_t wholeLanes(std::size_t count) {
  return (count + kRenderLanes - 1) / kRenderLanes * kRenderLanes;
}

/// A row of RenderMeshes::vertices.
enum VertexRow : std::uint8_t { kVertexX, kVertexY, kVertexZ, kVertexU, kVertexV };

/// Rows of RenderMeshes::cluster_bounds.
enum BoundsRow : std::uint8_t {
  kCenterRow = 0,
  kHalfExtentRow = 3,
  kRadiusRow = 6,
  kConeAxisRow = 7,
  kConeCutoffRow = 10,
};

/// Half extents and radius in the unused lanes of a block of bounds.
inline constexpr float kNoCluster = -1e30F;
/// Cutoff of a cluster without a cone, which never faces away.
inline constexpr float kNoCone = 2.0F;

/// Row `row` (a VertexRow) of vertex `vertex` of the pool.
[[nodiscard]] inline std::uint16_t vertexValue(const RenderMeshes& meshes, std::size_t vertex,
                                               std::size_t row) {
  return meshes.vertices[pooledAt(vertex, row, kVertexRows)];
}

/// Corner 0, 1 or 2 of triangle `triangle` of the pool, as the index of a vertex in its cluster.
[[nodiscard]] inline std::uint8_t triangleCorner(const RenderMeshes& meshes, std::size_t triangle,
                                                 std::size_t corner) {
  return meshes.triangles[pooledAt(triangle, corner, kTriangleRows)];
}

/// Row `row` (a BoundsRow, plus 0, 1, 2 for x, y, z) of lane `lane`, counted over all blocks.
[[nodiscard]] inline float boundsValue(const RenderMeshes& meshes, std::size_t lane,
                                       std::size_t row) {
  return meshes.cluster_bounds[pooledAt(lane, row, kBoundsRows)];
}

}  // namespace galactic
