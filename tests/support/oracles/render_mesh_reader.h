#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "galactic/render_meshes.h"
#include "layout/render_layout.h"

namespace galactic::test {

/// A corner as a renderer computes it.
struct DrawnCorner {
  /// On the lattice of the model.
  std::array<std::int64_t, 3> at{};
  /// Meters.
  std::array<double, 3> position{};
  std::array<double, 2> uv{};
  std::uint32_t color = 0xFFFFFFFF;
};

/// A triangle as a renderer draws it.
struct DrawnTriangle {
  std::array<DrawnCorner, 3> corners;
  std::uint16_t material = 0;
  std::uint16_t semantic = 0;
  bool two_sided = false;
};

/// All triangles of a model, one by one, in double precision.
inline std::vector<DrawnTriangle> drawnTriangles(const RenderMeshes& meshes, std::size_t number) {
  const RenderModel& model = meshes.models[number];
  const double step = static_cast<double>(model.step);
  std::vector<DrawnTriangle> drawn;
  for (std::size_t c = 0; c < model.cluster_count; ++c) {
    const RenderCluster& cluster = meshes.clusters[model.first_cluster + c];
    const auto cornerOf = [&](std::size_t vertex) {
      const std::size_t index = cluster.first_vertex + vertex;
      DrawnCorner corner;
      corner.at = {std::int64_t{cluster.origin_x} + vertexValue(meshes, index, kVertexX),
                   std::int64_t{cluster.origin_y} + vertexValue(meshes, index, kVertexY),
                   std::int64_t{cluster.origin_z} + vertexValue(meshes, index, kVertexZ)};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        corner.position[axis] = step * static_cast<double>(corner.at[axis]);
      }
      corner.uv = {static_cast<double>(cluster.u_minimum) +
                       static_cast<double>(cluster.u_step) * vertexValue(meshes, index, kVertexU),
                   static_cast<double>(cluster.v_minimum) +
                       static_cast<double>(cluster.v_step) * vertexValue(meshes, index, kVertexV)};
      if (!meshes.colors.empty()) corner.color = meshes.colors[index];
      return corner;
    };
    for (std::size_t t = 0; t < cluster.triangle_count; ++t) {
      DrawnTriangle& triangle = drawn.emplace_back();
      triangle.material = cluster.material;
      triangle.semantic = cluster.semantic;
      triangle.two_sided = cluster.two_sided != 0;
      for (std::size_t n = 0; n < 3; ++n) {
        triangle.corners[n] = cornerOf(triangleCorner(meshes, cluster.first_triangle + t, n));
      }
    }
  }
  return drawn;
}

/// What a renderer would stumble over, walking through everything as it does; null when it is safe
/// to draw. A sanitizer sees a read outside the pools.
inline const char* drawingOffence(const RenderMeshes& meshes) {
  std::size_t sum = 0;
  for (std::size_t n = 0; n < meshes.models.size(); ++n) {
    const RenderModel& model = meshes.models[n];
    for (const DrawnTriangle& triangle : drawnTriangles(meshes, n)) {
      if (triangle.material >= meshes.materials.size()) return "a triangle without a material";
      if (triangle.semantic >= meshes.semantics.size()) return "a triangle without a semantic";
      const std::int32_t texture = meshes.materials[triangle.material].texture;
      if (texture >= 0) {
        const auto& texels = meshes.textures[static_cast<std::size_t>(texture)].texels;
        sum += texels.front() + std::size_t{texels.back()};
      }
      for (const DrawnCorner& corner : triangle.corners) {
        if (!(corner.uv[0] >= 0 && corner.uv[0] < 65536)) return "a corner beyond its image";
        if (!(corner.position[0] >= static_cast<double>(model.bounds_min.x) &&
              corner.position[0] <= static_cast<double>(model.bounds_max.x))) {
          return "a corner outside the model";
        }
      }
    }
    for (std::size_t c = 0; c < wholeLanes(model.cluster_count); ++c) {
      const std::size_t lane = model.first_block * kRenderLanes + c;
      const bool is_cluster = boundsValue(meshes, lane, kRadiusRow) >= 0;
      if (is_cluster != (c < model.cluster_count)) return "bounds without a cluster, or none";
    }
  }
  return sum == 0xFFFFFFFF ? "an unlikely sum" : nullptr;
}

}  // namespace galactic::test
