#pragma once
#include <memory>
#include <span>
#include <vector>

#include "galactic/render_mesh_builder.h"
#include "galactic/schema/pack_generated.h"

namespace galactic::test {

/// Render meshes for a hand-made pack; nullptr for a pack without.
using RenderMeshesField = std::shared_ptr<const RenderMeshStorage>;

/// A vector in a pack, aligned as the schema says.
template <class T>
auto storedValues(flatbuffers::FlatBufferBuilder& builder,
                  const RenderMeshStorage::Values<T>& values) {
  builder.ForceVectorAlignment(values.size(), sizeof(T), 32);
  return builder.CreateVector(values.data(), values.size());
}

/// The field of a scene, object set or robot.
inline flatbuffers::Offset<schema::RenderMeshes> buildRenderMeshesField(
    flatbuffers::FlatBufferBuilder& builder, const RenderMeshesField& field) {
  if (!field) return {};
  const RenderMeshStorage& meshes = *field;
  std::vector<flatbuffers::Offset<schema::RenderModel>> models;
  for (const RenderModel& m : meshes.models) {
    const schema::Bounds bounds({m.bounds_min.x, m.bounds_min.y, m.bounds_min.z},
                                {m.bounds_max.x, m.bounds_max.y, m.bounds_max.z});
    models.push_back(schema::CreateRenderModel(builder, m.part, m.step, m.first_cluster,
                                               m.cluster_count, m.first_block, &bounds,
                                               m.source_triangles, m.triangles, m.largest_error));
  }
  std::vector<flatbuffers::Offset<schema::RenderMaterial>> materials;
  for (const RenderMeshStorage::Material& m : meshes.materials) {
    materials.push_back(schema::CreateRenderMaterial(builder, builder.CreateString(m.name), m.color,
                                                     m.texture, m.alpha_cutoff));
  }
  std::vector<flatbuffers::Offset<schema::RenderTexture>> textures;
  for (const RenderMeshStorage::Texture& t : meshes.textures) {
    textures.push_back(schema::CreateRenderTexture(builder, builder.CreateString(t.name), t.size,
                                                   static_cast<schema::TexelFormat>(t.format),
                                                   static_cast<std::uint32_t>(t.first_byte)));
  }
  const auto model_vector = builder.CreateVector(models);
  builder.ForceVectorAlignment(meshes.clusters.size(), sizeof(RenderCluster), 32);
  // One memory layout: schema::RenderCluster is the same struct.
  const auto clusters = builder.CreateVectorOfStructs(
      reinterpret_cast<const schema::RenderCluster*>(meshes.clusters.data()),
      meshes.clusters.size());
  const auto bounds = storedValues(builder, meshes.cluster_bounds);
  const auto vertices = storedValues(builder, meshes.vertices);
  const auto colors = storedValues(builder, meshes.colors);
  const auto triangles = storedValues(builder, meshes.triangles);
  const auto material_vector = builder.CreateVector(materials);
  const auto texture_vector = builder.CreateVector(textures);
  const auto texels = storedValues(builder, meshes.texels);
  const auto semantics = builder.CreateVectorOfStrings(meshes.semantics);
  return schema::CreateRenderMeshes(builder, model_vector, clusters, bounds, vertices, colors,
                                    triangles, material_vector, texture_vector, texels, semantics);
}

}  // namespace galactic::test
