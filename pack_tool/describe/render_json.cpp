#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <utility>

#include "galactic/render_meshes.h"
#include "pack_tool/describe/asset_json.h"
#include "pack_tool/describe/json_parts.h"
#include "view/render_surfaces.h"

namespace galactic::pack_tool {

namespace {

/// "#rrggbbaa", as pages and image editors write it.
std::string colorText(std::uint32_t color) {
  const auto channel = [color](unsigned shift) { return color >> shift & 0xffU; };
  return fmt::format("#{:02x}{:02x}{:02x}{:02x}", channel(0), channel(8), channel(16), channel(24));
}

std::string formatName(TexelFormat format) {
  switch (format) {
    case TexelFormat::kRgba8:
      return "rgba8";
    case TexelFormat::kBc1:
      return "bc1";
  }
  return fmt::format("unknown ({})", static_cast<unsigned>(format));
}

/// What clusters add up to.
struct ClusterSums {
  std::uint64_t clusters = 0;
  std::uint64_t two_sided = 0;
  std::uint64_t vertices = 0;
  std::uint64_t triangles = 0;

  explicit ClusterSums(std::span<const RenderCluster> all) : clusters(all.size()) {
    for (const RenderCluster& cluster : all) {
      if (cluster.two_sided != 0) ++two_sided;
      vertices += cluster.vertex_count;
      triangles += cluster.triangle_count;
    }
  }
};

Json describeModel(const PackFile& pack, const RenderMeshes& meshes, const RenderModel& model) {
  const ClusterSums sums(clustersOf(meshes, model));
  Json json;
  json["name"] = partName(pack, model.part);
  json["bounds"] = {{"min", describePoint(model.bounds_min)},
                    {"max", describePoint(model.bounds_max)}};
  json["step"] = jsonNumber(model.step);
  json["clusters"] = sums.clusters;
  json["two_sided_clusters"] = sums.two_sided;
  json["vertices"] = sums.vertices;
  json["triangles"] = sums.triangles;
  json["source_triangles"] = model.source_triangles;
  json["largest_error"] = jsonNumber(model.largest_error);
  return json;
}

/// As the pack has them: RenderMeshes knows shared textures only where their packs are at hand.
const schema::RenderMeshes* storedMeshes(const PackFile& pack) {
  if (const schema::Scene* scene = pack.root().asset_as_Scene()) return scene->render_meshes();
  if (const schema::ObjectSet* set = pack.root().asset_as_ObjectSet()) return set->render_meshes();
  if (const schema::Robot* robot = pack.root().asset_as_Robot()) return robot->render_meshes();
  return nullptr;
}

Json describeMaterial(const schema::RenderMeshes& stored, const schema::RenderMaterial& material) {
  Json json;
  json["name"] = material.name()->str();
  json["color"] = colorText(material.color());
  json["texture"] = nullptr;
  const auto texture = static_cast<flatbuffers::uoffset_t>(material.texture());
  if (material.texture() >= 0 && texture < stored.textures()->size()) {
    json["texture"] = stored.textures()->Get(texture)->name()->str();
  }
  json["alpha_cutoff"] = jsonNumber(material.alpha_cutoff());
  return json;
}

/// The texels of a shared texture are in a pack of its own, which is named by their hash.
Json describeTexture(const schema::RenderMeshes& stored, const schema::RenderTexture& texture) {
  const auto format = static_cast<TexelFormat>(texture.format());
  const std::span<const std::uint8_t> all(stored.texels()->data(), stored.texels()->size());
  const bool is_shared = texture.shared() != nullptr;
  const auto texels = is_shared
                          ? std::span<const std::uint8_t>()
                          : all.subspan(texture.first_byte(), textureBytes(texture.size(), format));
  return {{"name", texture.name()->str()},
          {"size", texture.size()},
          {"format", formatName(format)},
          {"bytes", texels.size()},
          {"fnv1a_64", is_shared ? Json() : Json(contentHash(std::as_bytes(texels)))},
          {"shared", describeHash(texture.shared())}};
}

}  // namespace

Json describeRenderMeshes(const PackFile& pack) {
  const auto stored = renderMeshesOf(pack);
  if (!stored || !*stored) return nullptr;
  const RenderMeshes& meshes = **stored;
  const schema::RenderMeshes& tables = *storedMeshes(pack);
  const ClusterSums sums(meshes.clusters);
  Json json;
  json["clusters"] = sums.clusters;
  json["two_sided_clusters"] = sums.two_sided;
  json["vertices"] = sums.vertices;
  json["triangles"] = sums.triangles;
  std::uint64_t source_triangles = 0;
  float largest_error = 0;
  for (const RenderModel& model : meshes.models) {
    source_triangles += model.source_triangles;
    largest_error = std::max(largest_error, model.largest_error);
  }
  json["source_triangles"] = source_triangles;
  json["largest_error"] = jsonNumber(largest_error);
  json["colored"] = !meshes.colors.empty();
  json["geometry_bytes"] = meshes.clusters.size_bytes() + meshes.cluster_bounds.size_bytes() +
                           meshes.vertices.size_bytes() + meshes.colors.size_bytes() +
                           meshes.triangles.size_bytes();
  Json textures = Json::array();
  std::uint64_t texture_bytes = 0;
  for (const schema::RenderTexture* texture : *tables.textures()) {
    textures.push_back(describeTexture(tables, *texture));
    texture_bytes += textures.back().at("bytes").get<std::uint64_t>();
  }
  json["texture_bytes"] = texture_bytes;
  json["models"] = Json::array();
  for (const RenderModel& model : meshes.models) {
    json["models"].push_back(describeModel(pack, meshes, model));
  }
  json["materials"] = Json::array();
  for (const schema::RenderMaterial* material : *tables.materials()) {
    json["materials"].push_back(describeMaterial(tables, *material));
  }
  json["textures"] = std::move(textures);
  json["semantics"] = Json::array();
  for (const std::string_view name : meshes.semantics) {
    json["semantics"].push_back(std::string(name));
  }
  return json;
}

Json describeTexture(const PackFile& pack) {
  const schema::SharedTexture* texture = pack.root().asset_as_SharedTexture();
  if (texture == nullptr) return nullptr;
  return {{"name", texture->name()->str()},
          {"size", texture->size()},
          {"format", formatName(static_cast<TexelFormat>(texture->format()))},
          {"bytes", texture->texels()->size()},
          {"xxh3_128", describeHash(texture->hash())}};
}

}  // namespace galactic::pack_tool
