#include "layout/render_pools.h"

#include <algorithm>
#include <cmath>

#include "layout/cluster_bounds.h"
#include "layout/render_layout.h"

namespace galactic {
namespace {

using render::ClusterBounds;

constexpr double kMostStored = 65535;
/// More repetitions of an image per vertex step would overflow the integers of a sampler.
constexpr float kMostUvStep = 0.5F;

/// Texture coordinates of a cluster along one axis: minimum and step.
struct UvScale {
  float minimum = 0;
  float step = 0;
  /// Whole images that are left out, because images repeat.
  double offset = 0;

  [[nodiscard]] std::uint16_t stored(float value) const {
    if (step == 0) return 0;
    const double from_minimum = static_cast<double>(value) - offset - static_cast<double>(minimum);
    const double steps = std::round(from_minimum / static_cast<double>(step));
    return static_cast<std::uint16_t>(std::clamp(steps, 0.0, kMostStored));
  }
};

UvScale uvScale(const LatticeCluster& cluster, std::size_t axis) {
  float low = cluster.vertices.front().uv[axis];
  float high = low;
  for (const LatticeVertex& vertex : cluster.vertices) {
    low = std::min(low, vertex.uv[axis]);
    high = std::max(high, vertex.uv[axis]);
  }
  UvScale scale;
  scale.offset = std::floor(static_cast<double>(low));
  scale.minimum = static_cast<float>(static_cast<double>(low) - scale.offset);
  const double range = static_cast<double>(high) - static_cast<double>(low);
  scale.step = std::min(kMostUvStep, static_cast<float>(range / kMostStored));
  return scale;
}

std::array<std::int32_t, 3> originOf(const LatticeCluster& cluster) {
  std::array<std::int32_t, 3> origin = cluster.vertices.front().at;
  for (const LatticeVertex& vertex : cluster.vertices) {
    for (std::size_t n = 0; n < 3; ++n) origin[n] = std::min(origin[n], vertex.at[n]);
  }
  return origin;
}

void appendVertices(const LatticeCluster& cluster, RenderCluster& stored, bool colored,
                    RenderPools& to) {
  const std::size_t first = to.vertices.size() / kVertexRows;
  const std::size_t lanes = wholeLanes(cluster.vertices.size());
  stored.first_vertex = static_cast<std::uint32_t>(first);
  stored.vertex_count = static_cast<std::uint16_t>(cluster.vertices.size());
  const auto origin = originOf(cluster);
  stored.origin_x = origin[0];
  stored.origin_y = origin[1];
  stored.origin_z = origin[2];
  const UvScale u = uvScale(cluster, 0);
  const UvScale v = uvScale(cluster, 1);
  stored.u_minimum = u.minimum;
  stored.u_step = u.step;
  stored.v_minimum = v.minimum;
  stored.v_step = v.step;
  to.vertices.resize(to.vertices.size() + lanes * kVertexRows);
  for (std::size_t n = 0; n < cluster.vertices.size(); ++n) {
    const LatticeVertex& vertex = cluster.vertices[n];
    const auto value = [&](std::size_t row) -> std::uint16_t& {
      return to.vertices[pooledAt(first + n, row, kVertexRows)];
    };
    for (std::size_t axis = 0; axis < 3; ++axis) {
      value(kVertexX + axis) = static_cast<std::uint16_t>(vertex.at[axis] - origin[axis]);
    }
    value(kVertexU) = u.stored(vertex.uv[0]);
    value(kVertexV) = v.stored(vertex.uv[1]);
  }
  if (!colored) return;
  to.colors.resize(first + lanes);
  for (std::size_t n = 0; n < cluster.vertices.size(); ++n) {
    to.colors[first + n] = cluster.vertices[n].color;
  }
}

void appendTriangles(const LatticeCluster& cluster, RenderCluster& stored, RenderPools& to) {
  const std::size_t first = to.triangles.size() / kTriangleRows;
  stored.first_triangle = static_cast<std::uint32_t>(first);
  stored.triangle_count = static_cast<std::uint16_t>(cluster.triangles.size());
  to.triangles.resize(to.triangles.size() + wholeLanes(cluster.triangles.size()) * kTriangleRows);
  for (std::size_t n = 0; n < cluster.triangles.size(); ++n) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      to.triangles[pooledAt(first + n, corner, kTriangleRows)] = cluster.triangles[n][corner];
    }
  }
}

/// Starts the blocks of a model's bounds with unused lanes.
std::size_t appendBlocks(std::size_t clusters, RenderPools::Values<float>& blocks) {
  const std::size_t first_lane = blocks.size() / kBoundsRows;
  blocks.resize(blocks.size() + wholeLanes(clusters) * kBoundsRows);
  for (std::size_t lane = first_lane; lane < blocks.size() / kBoundsRows; ++lane) {
    for (std::size_t row = kHalfExtentRow; row <= kRadiusRow; ++row) {
      blocks[pooledAt(lane, row, kBoundsRows)] = kNoCluster;
    }
  }
  return first_lane;
}

void include(const ClusterBounds& box, bool first, RenderModel& model) {
  Vec3& low = model.bounds_min;
  Vec3& high = model.bounds_max;
  if (first) {
    low = box.low;
    high = box.high;
    return;
  }
  low = {std::min(low.x, box.low.x), std::min(low.y, box.low.y), std::min(low.z, box.low.z)};
  high = {std::max(high.x, box.high.x), std::max(high.y, box.high.y), std::max(high.z, box.high.z)};
}

}  // namespace

RenderMeshes RenderPools::geometry() const {
  RenderMeshes meshes;
  meshes.models = models;
  meshes.clusters = clusters;
  meshes.cluster_bounds = cluster_bounds;
  meshes.vertices = vertices;
  meshes.colors = colors;
  meshes.triangles = triangles;
  return meshes;
}

void appendModel(const LatticeModel& model, const RenderModelFigures& figures, RenderPools& to) {
  RenderModel stored;
  stored.part = figures.part;
  stored.step = static_cast<float>(model.step);
  stored.first_cluster = static_cast<std::uint32_t>(to.clusters.size());
  stored.cluster_count = static_cast<std::uint32_t>(model.clusters.size());
  stored.source_triangles = figures.source_triangles;
  stored.largest_error = figures.largest_error;
  const std::size_t first_lane = appendBlocks(model.clusters.size(), to.cluster_bounds);
  stored.first_block = static_cast<std::uint32_t>(first_lane / kRenderLanes);
  for (std::size_t n = 0; n < model.clusters.size(); ++n) {
    const LatticeCluster& cluster = model.clusters[n];
    RenderCluster& header = to.clusters.emplace_back();
    header.material = cluster.material;
    header.semantic = cluster.semantic;
    header.two_sided = cluster.two_sided ? 1 : 0;
    appendVertices(cluster, header, figures.colored, to);
    appendTriangles(cluster, header, to);
    stored.triangles += header.triangle_count;
    const ClusterBounds bounds = render::boundsOf(cluster, model.step);
    for (std::size_t row = 0; row < kBoundsRows; ++row) {
      to.cluster_bounds[pooledAt(first_lane + n, row, kBoundsRows)] = bounds.rows[row];
    }
    include(bounds, n == 0, stored);
  }
  to.models.push_back(stored);
}

}  // namespace galactic
