#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "galactic/render_layout.h"
#include "galactic/render_meshes.h"
#include "galactic/schema/pack_generated.h"

namespace galactic::test {

// Render meshes of hand-made packs. Everything is valid as smallRenderMeshes() makes it; a test
// changes what it wants to be wrong.

struct RenderModelFields {
  std::uint32_t part = 0;
  float step = 0x1p-10F;
  std::uint32_t first_cluster = 0;
  std::uint32_t cluster_count = 0;
  std::uint32_t first_block = 0;
  bool has_bounds = true;
  Vec3 bounds_min;
  Vec3 bounds_max;
  std::uint32_t source_triangles = 0;
  std::uint32_t triangles = 0;
  float largest_error = 0.001F;
};

struct RenderMaterialFields {
  std::string name = "oak";
  std::uint32_t color = 0xFF336699;
  std::int32_t texture = -1;
  float alpha_cutoff = 0;
};

struct RenderTextureFields {
  std::string name = "oak.png";
  std::uint32_t size = 2;
  std::uint8_t format = 0;
  std::uint32_t first_byte = 0;
  /// XXH3-128 of texels in a texture pack, low half first.
  std::optional<std::pair<std::uint64_t, std::uint64_t>> shared{};
};

struct RenderMeshesFields {
  std::vector<RenderModelFields> models;
  std::vector<RenderCluster> clusters;
  std::vector<float> bounds;
  std::vector<std::uint16_t> vertices;
  std::vector<std::uint32_t> colors;
  std::vector<std::uint8_t> triangles;
  std::vector<RenderMaterialFields> materials;
  std::vector<RenderTextureFields> textures;
  std::vector<std::uint8_t> texels;
  std::vector<std::string> semantics;

  [[nodiscard]] float& bound(std::size_t lane, std::size_t row) {
    return bounds[pooledAt(lane, row, kBoundsRows)];
  }
};

/// Appends a cluster of up to 8 vertices and triangles to the last model.
inline void addCluster(RenderMeshesFields& fields, const std::array<std::int32_t, 3>& origin,
                       const std::vector<std::array<std::uint16_t, 3>>& vertices,
                       const std::vector<std::array<std::uint8_t, 3>>& triangles) {
  RenderModelFields& model = fields.models.back();
  const std::size_t lane = model.first_block * kRenderLanes + model.cluster_count;
  ++model.cluster_count;
  model.triangles += static_cast<std::uint32_t>(triangles.size());
  model.source_triangles = 2 * model.triangles;
  RenderCluster cluster;
  cluster.origin_x = origin[0];
  cluster.origin_y = origin[1];
  cluster.origin_z = origin[2];
  cluster.u_minimum = 0.25F;
  cluster.u_step = 0.5F / 65535;
  cluster.first_vertex = static_cast<std::uint32_t>(fields.vertices.size() / kVertexRows);
  cluster.first_triangle = static_cast<std::uint32_t>(fields.triangles.size() / kTriangleRows);
  cluster.vertex_count = static_cast<std::uint16_t>(vertices.size());
  cluster.triangle_count = static_cast<std::uint16_t>(triangles.size());
  cluster.two_sided = 1;
  fields.clusters.push_back(cluster);
  fields.vertices.resize(fields.vertices.size() + kVertexRows * kRenderLanes);
  fields.colors.resize(fields.colors.size() + kRenderLanes);
  fields.triangles.resize(fields.triangles.size() + kTriangleRows * kRenderLanes);
  std::array<double, 3> low{1e9, 1e9, 1e9};
  std::array<double, 3> high{-1e9, -1e9, -1e9};
  for (std::size_t n = 0; n < vertices.size(); ++n) {
    fields.colors[cluster.first_vertex + n] = 0xFFFFFFFF;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      fields.vertices[pooledAt(cluster.first_vertex + n, axis, kVertexRows)] = vertices[n][axis];
      const double at = static_cast<double>(model.step) * (origin[axis] + vertices[n][axis]);
      low[axis] = std::min(low[axis], at);
      high[axis] = std::max(high[axis], at);
    }
  }
  for (std::size_t n = 0; n < triangles.size(); ++n) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      fields.triangles[pooledAt(cluster.first_triangle + n, corner, kTriangleRows)] =
          triangles[n][corner];
    }
  }
  // All of it is a multiple of half a step: exact.
  double squared = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    fields.bound(lane, kCentreRow + axis) = static_cast<float>((low[axis] + high[axis]) / 2);
    fields.bound(lane, kHalfExtentRow + axis) = static_cast<float>((high[axis] - low[axis]) / 2);
    squared += (high[axis] - low[axis]) * (high[axis] - low[axis]) / 4;
  }
  fields.bound(lane, kRadiusRow) = static_cast<float>(std::sqrt(squared) * 1.001);
  fields.bound(lane, kConeCutoffRow) = kNoCone;
  const auto merge = [&](float& least, float& most, std::size_t axis) {
    const bool first = model.cluster_count == 1;
    least = first ? static_cast<float>(low[axis]) : std::min(least, static_cast<float>(low[axis]));
    most = first ? static_cast<float>(high[axis]) : std::max(most, static_cast<float>(high[axis]));
  };
  merge(model.bounds_min.x, model.bounds_max.x, 0);
  merge(model.bounds_min.y, model.bounds_max.y, 1);
  merge(model.bounds_min.z, model.bounds_max.z, 2);
}

/// A model for each part: a two-sided tetrahedron and, textured, a one-sided square that faces up.
inline RenderMeshesFields smallRenderMeshes(const std::vector<std::uint32_t>& parts = {0}) {
  RenderMeshesFields fields;
  fields.materials = {{.name = "oak"}, {.name = "cloth", .texture = 0, .alpha_cutoff = 0.5F}};
  fields.textures = {{}};
  fields.texels.assign(20, 0x80);
  fields.semantics = {"table", "chair"};
  for (const std::uint32_t part : parts) {
    RenderModelFields& model = fields.models.emplace_back();
    model.part = part;
    model.first_cluster = static_cast<std::uint32_t>(fields.clusters.size());
    model.first_block =
        static_cast<std::uint32_t>(fields.bounds.size() / (kBoundsRows * kRenderLanes));
    fields.bounds.resize(fields.bounds.size() + kBoundsRows * kRenderLanes);
    const std::size_t lane = model.first_block * kRenderLanes;
    for (std::size_t n = 0; n < kRenderLanes; ++n) {
      for (std::size_t row = kHalfExtentRow; row <= kRadiusRow; ++row) {
        fields.bound(lane + n, row) = kNoCluster;
      }
    }
    addCluster(fields, {-10, 20, 30}, {{0, 0, 0}, {100, 0, 0}, {0, 100, 0}, {0, 0, 100}},
               {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}});
    addCluster(fields, {200, 20, 30}, {{0, 0, 0}, {0, 0, 64}, {64, 0, 64}, {64, 0, 0}},
               {{0, 1, 2}, {0, 2, 3}});
    RenderCluster& square = fields.clusters.back();
    square.material = 1;
    square.semantic = 1;
    square.two_sided = 0;
    fields.bound(lane + 1, kConeAxisRow + 1) = 1;
    fields.bound(lane + 1, kConeCutoffRow) = 0.001F;
  }
  return fields;
}

template <class T>
auto renderPool(flatbuffers::FlatBufferBuilder& builder, const std::vector<T>& values) {
  builder.ForceVectorAlignment(values.size(), sizeof(T), 32);
  return builder.CreateVector(values);
}

inline flatbuffers::Offset<schema::RenderMeshes> buildRenderMeshes(
    flatbuffers::FlatBufferBuilder& builder, const RenderMeshesFields& fields) {
  std::vector<flatbuffers::Offset<schema::RenderModel>> models;
  for (const RenderModelFields& model : fields.models) {
    const Vec3& lo = model.bounds_min;
    const Vec3& hi = model.bounds_max;
    const schema::Bounds bounds({lo.x, lo.y, lo.z}, {hi.x, hi.y, hi.z});
    models.push_back(schema::CreateRenderModel(
        builder, model.part, model.step, model.first_cluster, model.cluster_count,
        model.first_block, model.has_bounds ? &bounds : nullptr, model.source_triangles,
        model.triangles, model.largest_error));
  }
  const auto model_vector = builder.CreateVector(models);
  std::vector<schema::RenderCluster> clusters;
  for (const RenderCluster& c : fields.clusters) {
    clusters.emplace_back(c.origin_x, c.origin_y, c.origin_z, c.u_minimum, c.v_minimum, c.u_step,
                          c.v_step, c.first_vertex, c.first_triangle, c.vertex_count,
                          c.triangle_count, c.material, c.semantic, c.two_sided, c.reserved);
  }
  builder.ForceVectorAlignment(clusters.size(), sizeof(schema::RenderCluster), 32);
  const auto cluster_vector = builder.CreateVectorOfStructs(clusters);
  const auto bounds = renderPool(builder, fields.bounds);
  const auto vertices = renderPool(builder, fields.vertices);
  const auto colors = renderPool(builder, fields.colors);
  const auto triangles = renderPool(builder, fields.triangles);
  std::vector<flatbuffers::Offset<schema::RenderMaterial>> materials;
  for (const RenderMaterialFields& material : fields.materials) {
    materials.push_back(schema::CreateRenderMaterialDirect(
        builder, material.name.c_str(), material.color, material.texture, material.alpha_cutoff));
  }
  const auto material_vector = builder.CreateVector(materials);
  std::vector<flatbuffers::Offset<schema::RenderTexture>> textures;
  for (const RenderTextureFields& texture : fields.textures) {
    const auto [low, high] = texture.shared.value_or(std::pair<std::uint64_t, std::uint64_t>{});
    const schema::Hash128 shared(low, high);
    textures.push_back(
        schema::CreateRenderTextureDirect(builder, texture.name.c_str(), texture.size,
                                          static_cast<schema::TexelFormat>(texture.format),
                                          texture.first_byte, texture.shared ? &shared : nullptr));
  }
  const auto texture_vector = builder.CreateVector(textures);
  const auto texels = renderPool(builder, fields.texels);
  const auto semantics = builder.CreateVectorOfStrings(fields.semantics);
  return schema::CreateRenderMeshes(builder, model_vector, cluster_vector, bounds, vertices, colors,
                                    triangles, material_vector, texture_vector, texels, semantics);
}

/// Render meshes of a hand-made pack, or none.
using RenderMeshesField = std::optional<RenderMeshesFields>;

inline flatbuffers::Offset<schema::RenderMeshes> buildRenderMeshesField(
    flatbuffers::FlatBufferBuilder& builder, const RenderMeshesField& field) {
  if (!field) return {};
  return buildRenderMeshes(builder, *field);
}

}  // namespace galactic::test
