#include "render/gl/library_geometry.h"

#include <cstddef>

#include "render/gl/library_textures.h"

namespace galactic::render::gl {
namespace {

DrawClass classOf(const RenderCluster& cluster, const RenderMaterial& material) {
  const bool two_sided = cluster.two_sided != 0;
  if (material.alpha_cutoff > 0) {
    return two_sided ? DrawClass::kMaskedTwoSided : DrawClass::kMaskedOneSided;
  }
  return two_sided ? DrawClass::kTwoSided : DrawClass::kOneSided;
}

/// Adds the clusters of one library to its geometry.
class Gatherer {
 public:
  Gatherer(const RenderMeshes& meshes, std::span<const std::uint32_t> slots,
           std::uint32_t first_semantic, LibraryGeometry& geometry)
      : meshes_(meshes), slots_(slots), first_semantic_(first_semantic), geometry_(geometry) {}

  void add(const RenderModel& model) {
    ModelClusters placed;
    for (std::size_t wanted = 0; wanted < kDrawClasses; ++wanted) {
      placed.first[wanted] = static_cast<std::uint32_t>(geometry_.clusters.size());
      for (std::uint32_t i = 0; i < model.cluster_count; ++i) {
        const RenderCluster& cluster = meshes_.clusters[model.first_cluster + i];
        const auto found = classOf(cluster, meshes_.materials[cluster.material]);
        if (static_cast<std::size_t>(found) == wanted) addCluster(model, i);
      }
    }
    placed.first[kDrawClasses] = static_cast<std::uint32_t>(geometry_.clusters.size());
    geometry_.models.push_back(placed);
  }

 private:
  void addCluster(const RenderModel& model, std::uint32_t number) {
    const RenderCluster& cluster = meshes_.clusters[model.first_cluster + number];
    const RenderMaterial& material = meshes_.materials[cluster.material];
    const bool textured = material.texture >= 0;
    geometry_.bounds.push_back(boundsOf(model, number, cluster));
    addVertices(cluster);
    geometry_.clusters.push_back(
        {.origin_x = cluster.origin_x,
         .origin_y = cluster.origin_y,
         .origin_z = cluster.origin_z,
         .step = model.step,
         .u_minimum = cluster.u_minimum,
         .v_minimum = cluster.v_minimum,
         .u_step = cluster.u_step,
         .v_step = cluster.v_step,
         .color = textured ? 0xFFFFFFFF : material.color,
         .texture = textured ? slots_[static_cast<std::size_t>(material.texture)] : kNoTexture,
         .alpha_cutoff = material.alpha_cutoff,
         .semantic = first_semantic_ + cluster.semantic});
  }

  GpuBounds boundsOf(const RenderModel& model, std::uint32_t number,
                     const RenderCluster& cluster) const {
    GpuBounds bounds;
    const std::size_t block = model.first_block + number / kRenderLanes;
    for (std::size_t row = 0; row < kBoundsRows; ++row) {
      bounds.rows[row] =
          meshes_
              .cluster_bounds[(block * kBoundsRows + row) * kRenderLanes + number % kRenderLanes];
    }
    bounds.first_index = static_cast<std::uint32_t>(geometry_.indices.size());
    bounds.index_count = 3U * cluster.triangle_count;
    return bounds;
  }

  void addVertices(const RenderCluster& cluster) {
    const auto first = static_cast<std::uint32_t>(geometry_.vertices.size());
    const auto low = static_cast<std::uint16_t>(geometry_.clusters.size() & 0xFFFFU);
    for (std::size_t i = 0; i < cluster.vertex_count; ++i) {
      const std::size_t stored = cluster.first_vertex + i;
      geometry_.vertices.push_back(
          {.x = vertexRow(stored, 0),
           .y = vertexRow(stored, 1),
           .z = vertexRow(stored, 2),
           .cluster = low,
           .u = vertexRow(stored, 3),
           .v = vertexRow(stored, 4),
           .color = meshes_.colors.empty() ? 0xFFFFFFFF : meshes_.colors[stored]});
    }
    for (std::size_t i = 0; i < cluster.triangle_count; ++i) {
      const std::size_t stored = cluster.first_triangle + i;
      for (std::size_t corner = 0; corner < kTriangleRows; ++corner) {
        const std::size_t place =
            (stored / kRenderLanes * kTriangleRows + corner) * kRenderLanes + stored % kRenderLanes;
        geometry_.indices.push_back(first + meshes_.triangles[place]);
      }
    }
  }

  std::uint16_t vertexRow(std::size_t vertex, std::size_t row) const {
    return meshes_.vertices[(vertex / kRenderLanes * kVertexRows + row) * kRenderLanes +
                            vertex % kRenderLanes];
  }

  const RenderMeshes& meshes_;
  std::span<const std::uint32_t> slots_;
  std::uint32_t first_semantic_;
  LibraryGeometry& geometry_;
};

}  // namespace

LibraryGeometry gatherGeometry(const RenderLibrary& library,
                               std::span<const std::vector<std::uint32_t>> texture_slots) {
  LibraryGeometry geometry;
  std::size_t clusters = 0;
  std::size_t vertices = 0;
  std::size_t triangles = 0;
  for (const RenderMeshes& meshes : library.packs()) {
    clusters += meshes.clusters.size();
    vertices += meshes.vertices.size() / kVertexRows;
    triangles += meshes.triangles.size() / kTriangleRows;
  }
  geometry.models.reserve(library.modelCount());
  geometry.clusters.reserve(clusters);
  geometry.bounds.reserve(clusters);
  geometry.vertices.reserve(vertices);
  geometry.indices.reserve(3 * triangles);
  for (std::uint32_t model = 0; model < library.modelCount(); ++model) {
    const std::uint32_t pack = library.entry(model).pack;
    Gatherer(library.packs()[pack], texture_slots[pack], library.firstSemantic(pack), geometry)
        .add(library.model(model));
  }
  return geometry;
}

}  // namespace galactic::render::gl
