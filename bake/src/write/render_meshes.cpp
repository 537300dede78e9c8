#include "write/render_meshes.h"

#include <vector>

namespace galactic::bake {
namespace {

Offset<flatbuffers::Vector<Offset<schema::RenderModel>>> modelTables(
    FlatBufferBuilder& builder, const BakedRenderMeshes& meshes) {
  std::vector<Offset<schema::RenderModel>> tables;
  tables.reserve(meshes.models.size());
  for (const RenderModel& model : meshes.models) {
    const schema::Bounds bounds(toSchema(model.bounds_min), toSchema(model.bounds_max));
    tables.push_back(schema::CreateRenderModel(
        builder, model.part, model.step, model.first_cluster, model.cluster_count,
        model.first_block, &bounds, model.source_triangles, model.triangles, model.largest_error));
  }
  return builder.CreateVector(tables);
}

Offset<flatbuffers::Vector<Offset<schema::RenderMaterial>>> materialTables(
    FlatBufferBuilder& builder, const BakedMaterials& baked) {
  std::vector<Offset<schema::RenderMaterial>> tables;
  tables.reserve(baked.materials.size());
  for (const BakedMaterial& material : baked.materials) {
    tables.push_back(schema::CreateRenderMaterialDirect(
        builder, material.name.c_str(), material.color, material.texture, material.alpha_cutoff));
  }
  return builder.CreateVector(tables);
}

Offset<flatbuffers::Vector<Offset<schema::RenderTexture>>> textureTables(
    FlatBufferBuilder& builder, const BakedMaterials& baked) {
  std::vector<Offset<schema::RenderTexture>> tables;
  tables.reserve(baked.textures.size());
  for (const BakedTexture& texture : baked.textures) {
    const schema::Hash128 hash(texture.hash_low, texture.hash_high);
    tables.push_back(schema::CreateRenderTextureDirect(
        builder, texture.name.c_str(), texture.size,
        static_cast<schema::TexelFormat>(texture.format), baked.shared ? 0 : texture.first_byte,
        baked.shared ? &hash : nullptr));
  }
  return builder.CreateVector(tables);
}

}  // namespace

Offset<schema::RenderMeshes> renderMeshesTable(FlatBufferBuilder& builder,
                                               const BakedRenderMeshes& meshes) {
  const auto semantics = builder.CreateVectorOfStrings(meshes.semantics);
  const std::vector<std::uint8_t> none;
  const auto texels = alignedVector<std::uint8_t>(
      builder, meshes.materials.shared ? none : meshes.materials.texels);
  const auto textures = textureTables(builder, meshes.materials);
  const auto materials = materialTables(builder, meshes.materials);
  const auto triangles = alignedVector<std::uint8_t>(builder, meshes.triangles);
  const auto colors = alignedVector<std::uint32_t>(builder, meshes.colors);
  const auto vertices = alignedVector<std::uint16_t>(builder, meshes.vertices);
  const auto bounds = alignedVector<float>(builder, meshes.cluster_bounds);
  const auto clusters = alignedStructs<schema::RenderCluster>(builder, meshes.clusters);
  const auto models = modelTables(builder, meshes);
  return schema::CreateRenderMeshes(builder, models, clusters, bounds, vertices, colors, triangles,
                                    materials, textures, texels, semantics);
}

}  // namespace galactic::bake
