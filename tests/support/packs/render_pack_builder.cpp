#include "support/packs/render_pack_builder.h"

#include <algorithm>
#include <cmath>

#include "support/packs/schema_parts.h"

namespace galactic::test {
namespace {

flatbuffers::Offset<schema::RenderMeshes> buildRenderMeshes(flatbuffers::FlatBufferBuilder& builder,
                                                            const RenderMeshesFields& fields) {
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
  const auto bounds = alignedNumbers(builder, fields.bounds);
  const auto vertices = alignedNumbers(builder, fields.vertices);
  const auto colors = alignedNumbers(builder, fields.colors);
  const auto triangles = alignedNumbers(builder, fields.triangles);
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
  const auto texels = alignedNumbers(builder, fields.texels);
  const auto semantics = builder.CreateVectorOfStrings(fields.semantics);
  return schema::CreateRenderMeshes(builder, model_vector, cluster_vector, bounds, vertices, colors,
                                    triangles, material_vector, texture_vector, texels, semantics);
}

}  // namespace

void addCluster(RenderMeshesFields& fields, const std::array<std::int32_t, 3>& origin,
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
    fields.bound(lane, kCenterRow + axis) = static_cast<float>((low[axis] + high[axis]) / 2);
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

RenderMeshesFields smallRenderMeshes(const std::vector<std::uint32_t>& parts) {
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

flatbuffers::Offset<schema::RenderMeshes> buildRenderMeshesField(
    flatbuffers::FlatBufferBuilder& builder, const RenderMeshesField& field) {
  if (!field) return {};
  return buildRenderMeshes(builder, *field);
}

}  // namespace galactic::test
