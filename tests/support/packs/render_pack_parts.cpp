#include "support/packs/render_pack_parts.h"

namespace galactic::test {

RenderMeshesFields fieldsOf(const RenderMeshStorage& meshes) {
  RenderMeshesFields fields;
  for (const RenderModel& m : meshes.models) {
    fields.models.push_back({.part = m.part,
                             .step = m.step,
                             .first_cluster = m.first_cluster,
                             .cluster_count = m.cluster_count,
                             .first_block = m.first_block,
                             .bounds_min = m.bounds_min,
                             .bounds_max = m.bounds_max,
                             .source_triangles = m.source_triangles,
                             .triangles = m.triangles,
                             .largest_error = m.largest_error});
  }
  fields.clusters.assign(meshes.clusters.begin(), meshes.clusters.end());
  fields.bounds.assign(meshes.cluster_bounds.begin(), meshes.cluster_bounds.end());
  fields.vertices.assign(meshes.vertices.begin(), meshes.vertices.end());
  fields.colors.assign(meshes.colors.begin(), meshes.colors.end());
  fields.triangles.assign(meshes.triangles.begin(), meshes.triangles.end());
  for (const RenderMeshStorage::Material& m : meshes.materials) {
    fields.materials.push_back({m.name, m.color, m.texture, m.alpha_cutoff});
  }
  for (const RenderMeshStorage::Texture& t : meshes.textures) {
    fields.textures.push_back({t.name, t.size, static_cast<std::uint8_t>(t.format),
                               static_cast<std::uint32_t>(t.first_byte)});
  }
  fields.texels.assign(meshes.texels.begin(), meshes.texels.end());
  fields.semantics = meshes.semantics;
  return fields;
}

}  // namespace galactic::test
