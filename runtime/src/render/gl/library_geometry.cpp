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

/// The product of two colors per channel, rounded.
std::uint32_t multiplied(std::uint32_t a, std::uint32_t b) {
  std::uint32_t product = 0;
  for (std::uint32_t shift = 0; shift < 32; shift += 8) {
    product |= ((a >> shift & 0xFFU) * (b >> shift & 0xFFU) + 127) / 255 << shift;
  }
  return product;
}

/// Adds the models of one pack to the geometry of a library.
class Gatherer {
 public:
  Gatherer(const RenderMeshes& meshes, std::span<const std::uint32_t> slots,
           std::uint32_t first_semantic, LibraryGeometry& geometry)
      : meshes_(meshes), slots_(slots), first_semantic_(first_semantic), geometry_(geometry) {}

  void add(const RenderModel& model) {
    ModelClusters placed;
    for (std::size_t wanted = 0; wanted < kDrawClasses; ++wanted) {
      placed.first[wanted] = static_cast<std::uint32_t>(geometry_.bounds.size());
      for (std::uint32_t i = 0; i < model.cluster_count; ++i) {
        const RenderCluster& cluster = meshes_.clusters[model.first_cluster + i];
        const auto found = classOf(cluster, meshes_.materials[cluster.material]);
        if (static_cast<std::size_t>(found) == wanted) addCluster(model, i);
      }
    }
    placed.first[kDrawClasses] = static_cast<std::uint32_t>(geometry_.bounds.size());
    geometry_.models.push_back(placed);
  }

 private:
  void addCluster(const RenderModel& model, std::uint32_t number) {
    const RenderCluster& cluster = meshes_.clusters[model.first_cluster + number];
    geometry_.bounds.push_back(boundsOf(model, number, cluster));
    const auto first = static_cast<std::uint32_t>(geometry_.vertices.size());
    addVertices(model, cluster);
    addTriangles(cluster, first);
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

  void addVertices(const RenderModel& model, const RenderCluster& cluster) {
    const RenderMaterial& material = meshes_.materials[cluster.material];
    const bool textured = material.texture >= 0;
    GpuVertex vertex;
    vertex.texture = textured ? slots_[static_cast<std::size_t>(material.texture)] : kNoTexture;
    vertex.semantic = first_semantic_ + cluster.semantic;
    vertex.alpha_cutoff = material.alpha_cutoff;
    for (std::size_t i = 0; i < cluster.vertex_count; ++i) {
      const std::size_t stored = cluster.first_vertex + i;
      vertex.x = static_cast<float>(cluster.origin_x + vertexRow(stored, 0)) * model.step;
      vertex.y = static_cast<float>(cluster.origin_y + vertexRow(stored, 1)) * model.step;
      vertex.z = static_cast<float>(cluster.origin_z + vertexRow(stored, 2)) * model.step;
      vertex.u = cluster.u_minimum + cluster.u_step * static_cast<float>(vertexRow(stored, 3));
      vertex.v = cluster.v_minimum + cluster.v_step * static_cast<float>(vertexRow(stored, 4));
      vertex.color = textured ? 0xFFFFFFFF : material.color;
      if (!meshes_.colors.empty()) vertex.color = multiplied(vertex.color, meshes_.colors[stored]);
      geometry_.vertices.push_back(vertex);
    }
  }

  void addTriangles(const RenderCluster& cluster, std::uint32_t first_vertex) {
    for (std::size_t i = 0; i < cluster.triangle_count; ++i) {
      const std::size_t stored = cluster.first_triangle + i;
      for (std::size_t corner = 0; corner < kTriangleRows; ++corner) {
        const std::size_t place =
            (stored / kRenderLanes * kTriangleRows + corner) * kRenderLanes + stored % kRenderLanes;
        geometry_.indices.push_back(first_vertex + meshes_.triangles[place]);
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
    geometry.vertex_colors = geometry.vertex_colors || !meshes.colors.empty();
    vertices += meshes.vertices.size() / kVertexRows;
    triangles += meshes.triangles.size() / kTriangleRows;
  }
  geometry.models.reserve(library.modelCount());
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
