#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <map>
#include <span>
#include <string_view>
#include <utility>

#include "galactic/bake/render_baker.h"
#include "layout/render_layout.h"

namespace galactic::bake {
namespace {

std::span<const std::uint8_t> texelsOf(const BakedMaterials& materials,
                                       const BakedTexture& texture) {
  return std::span(materials.texels)
      .subspan(texture.first_byte, textureBytes(texture.size, texture.format));
}

/// Finds textures with given texels by a hash.
class TextureIndex {
 public:
  explicit TextureIndex(const BakedMaterials& materials) : materials_(materials) {
    for (const BakedTexture& texture : materials.textures) {
      add(texelsOf(materials, texture));
    }
  }

  /// The index of the texture with these texels, or -1.
  [[nodiscard]] std::int32_t find(const BakedTexture& texture,
                                  std::span<const std::uint8_t> texels) const {
    const auto [begin, end] = by_hash_.equal_range(hashOf(texels));
    for (auto at = begin; at != end; ++at) {
      const BakedTexture& candidate = materials_.textures[at->second];
      if (candidate.size == texture.size && candidate.format == texture.format &&
          std::ranges::equal(texelsOf(materials_, candidate), texels)) {
        return static_cast<std::int32_t>(at->second);
      }
    }
    return -1;
  }

  void add(std::span<const std::uint8_t> texels) { by_hash_.emplace(hashOf(texels), count_++); }

 private:
  static std::uint64_t hashOf(std::span<const std::uint8_t> texels) {
    return XXH3_64bits(texels.data(), texels.size());
  }

  const BakedMaterials& materials_;
  std::multimap<std::uint64_t, std::uint32_t> by_hash_;
  std::uint32_t count_ = 0;
};

/// Adds the textures of `more` and returns their new indices.
std::vector<std::int32_t> appendTextures(BakedMaterials& materials, const BakedMaterials& more) {
  constexpr std::size_t kAlignment = 32;
  TextureIndex index(materials);
  std::vector<std::int32_t> moved;
  moved.reserve(more.textures.size());
  for (const BakedTexture& texture : more.textures) {
    const auto texels = texelsOf(more, texture);
    std::int32_t at = index.find(texture, texels);
    if (at < 0) {
      at = static_cast<std::int32_t>(materials.textures.size());
      materials.texels.resize((materials.texels.size() + kAlignment - 1) / kAlignment * kAlignment);
      BakedTexture copy = texture;
      copy.first_byte = static_cast<std::uint32_t>(materials.texels.size());
      materials.texels.insert(materials.texels.end(), texels.begin(), texels.end());
      materials.textures.push_back(std::move(copy));
      index.add(texels);
    }
    moved.push_back(at);
  }
  return moved;
}

/// Adds the names of `more` and returns their new indices.
std::vector<std::uint16_t> appendNames(std::vector<std::string>& names,
                                       const std::vector<std::string>& more) {
  std::map<std::string, std::uint16_t, std::less<>> numbers;
  for (std::size_t n = 0; n < names.size(); ++n) {
    numbers.emplace(names[n], static_cast<std::uint16_t>(n));
  }
  std::vector<std::uint16_t> moved;
  moved.reserve(more.size());
  for (const std::string& name : more) {
    const auto [at, fresh] = numbers.emplace(name, static_cast<std::uint16_t>(names.size()));
    if (fresh) names.push_back(name);
    moved.push_back(at->second);
  }
  return moved;
}

constexpr std::uint32_t kWhite = 0xFFFFFFFF;

template <class Values>
void appendAll(Values& to, const Values& more) {
  to.insert(to.end(), more.begin(), more.end());
}

void appendColors(BakedRenderMeshes& meshes, const BakedRenderMeshes& more) {
  if (meshes.colors.empty() && more.colors.empty()) return;
  const auto fill = [](const BakedRenderMeshes& from) {
    RenderPools::Values<std::uint32_t> colors = from.colors;
    if (!colors.empty() || from.vertices.empty()) return colors;
    colors.resize(from.vertices.size() / kVertexRows);
    for (const RenderCluster& cluster : from.clusters) {
      std::fill_n(colors.begin() + cluster.first_vertex, cluster.vertex_count, kWhite);
    }
    return colors;
  };
  meshes.colors = fill(meshes);
  appendAll(meshes.colors, fill(more));
}

}  // namespace

std::uint32_t append(BakedMaterials& materials, const BakedMaterials& more) {
  const auto first = static_cast<std::uint32_t>(materials.materials.size());
  const std::vector<std::int32_t> textures = appendTextures(materials, more);
  for (const BakedMaterial& material : more.materials) {
    BakedMaterial& copy = materials.materials.emplace_back(material);
    if (copy.texture >= 0) copy.texture = textures[static_cast<std::size_t>(copy.texture)];
  }
  materials.source_bytes += more.source_bytes;
  appendAll(materials.warnings, more.warnings);
  return first;
}

void append(BakedRenderMeshes& meshes, const BakedRenderMeshes& more, std::uint32_t part) {
  const auto first_material = static_cast<std::uint16_t>(append(meshes.materials, more.materials));
  const std::vector<std::uint16_t> semantics = appendNames(meshes.semantics, more.semantics);
  const auto first_cluster = static_cast<std::uint32_t>(meshes.clusters.size());
  const auto first_vertex = static_cast<std::uint32_t>(meshes.vertices.size() / kVertexRows);
  const auto first_triangle = static_cast<std::uint32_t>(meshes.triangles.size() / kTriangleRows);
  const auto first_block =
      static_cast<std::uint32_t>(meshes.cluster_bounds.size() / kBoundsRows / kRenderLanes);
  for (const RenderModel& model : more.models) {
    RenderModel& copy = meshes.models.emplace_back(model);
    copy.part = part++;
    copy.first_cluster += first_cluster;
    copy.first_block += first_block;
  }
  for (const RenderCluster& cluster : more.clusters) {
    RenderCluster& copy = meshes.clusters.emplace_back(cluster);
    copy.first_vertex += first_vertex;
    copy.first_triangle += first_triangle;
    copy.material = static_cast<std::uint16_t>(copy.material + first_material);
    copy.semantic = semantics[cluster.semantic];
  }
  appendColors(meshes, more);
  appendAll(meshes.cluster_bounds, more.cluster_bounds);
  appendAll(meshes.vertices, more.vertices);
  appendAll(meshes.triangles, more.triangles);
  meshes.source_vertices += more.source_vertices;
  meshes.source_bytes += more.source_bytes;
}

RenderBakeStatistics& RenderBakeStatistics::operator+=(const RenderBakeStatistics& more) {
  source_triangles += more.source_triangles;
  triangles += more.triangles;
  source_vertices += more.source_vertices;
  vertices += more.vertices;
  clusters += more.clusters;
  two_sided_triangles += more.two_sided_triangles;
  source_bytes += more.source_bytes;
  bytes += more.bytes;
  source_texture_bytes += more.source_texture_bytes;
  texture_bytes += more.texture_bytes;
  largest_error = std::max(largest_error, more.largest_error);
  return *this;
}

RenderMeshes BakedRenderMeshes::view() const {
  RenderMeshes meshes = geometry();
  meshes.materials.reserve(materials.materials.size());
  for (const BakedMaterial& material : materials.materials) {
    meshes.materials.push_back({.name = material.name,
                                .color = material.color,
                                .texture = material.texture,
                                .alpha_cutoff = material.alpha_cutoff});
  }
  meshes.textures.reserve(materials.textures.size());
  for (const BakedTexture& texture : materials.textures) {
    meshes.textures.push_back({.name = texture.name,
                               .size = texture.size,
                               .format = texture.format,
                               .texels = texelsOf(materials, texture)});
  }
  meshes.semantics.assign(semantics.begin(), semantics.end());
  return meshes;
}

std::uint64_t BakedRenderMeshes::storedBytes() const {
  return clusters.size() * sizeof(RenderCluster) + cluster_bounds.size() * sizeof(float) +
         vertices.size() * sizeof(std::uint16_t) + colors.size() * sizeof(std::uint32_t) +
         triangles.size() + materials.texels.size();
}

RenderBakeStatistics BakedRenderMeshes::statistics() const {
  RenderBakeStatistics figures;
  for (const RenderModel& model : models) {
    figures.source_triangles += model.source_triangles;
    figures.triangles += model.triangles;
    figures.largest_error = std::max(figures.largest_error, model.largest_error);
  }
  for (const RenderCluster& cluster : clusters) {
    figures.vertices += cluster.vertex_count;
    if (cluster.two_sided != 0) figures.two_sided_triangles += cluster.triangle_count;
  }
  figures.clusters = clusters.size();
  figures.source_vertices = source_vertices;
  figures.source_bytes = source_bytes;
  figures.bytes = storedBytes() - materials.texels.size();
  figures.source_texture_bytes = materials.source_bytes;
  figures.texture_bytes = materials.texels.size();
  return figures;
}

}  // namespace galactic::bake
