#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>

#include "galactic/render_meshes.h"
#include "pack_tool/describe/asset_json.h"
#include "pack_tool/describe/json_parts.h"
#include "view/render_surfaces.h"

namespace galactic::pack_tool {

namespace {

Json pointOf(const Vec3& point) {
  return Json::array({jsonNumber(point.x), jsonNumber(point.y), jsonNumber(point.z)});
}

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
  json["bounds"] = {{"min", pointOf(model.bounds_min)}, {"max", pointOf(model.bounds_max)}};
  json["step"] = jsonNumber(model.step);
  json["clusters"] = sums.clusters;
  json["two_sided_clusters"] = sums.two_sided;
  json["vertices"] = sums.vertices;
  json["triangles"] = sums.triangles;
  json["source_triangles"] = model.source_triangles;
  json["largest_error"] = jsonNumber(model.largest_error);
  return json;
}

Json describeMaterial(const RenderMeshes& meshes, const RenderMaterial& material) {
  Json json;
  json["name"] = std::string(material.name);
  json["color"] = colorText(material.color);
  json["texture"] = nullptr;
  const auto texture = static_cast<std::size_t>(material.texture);
  if (material.texture >= 0 && texture < meshes.textures.size()) {
    json["texture"] = std::string(meshes.textures[texture].name);
  }
  json["alpha_cutoff"] = jsonNumber(material.alpha_cutoff);
  return json;
}

Json describeTexture(const RenderTexture& texture) {
  return {{"name", std::string(texture.name)},
          {"size", texture.size},
          {"format", formatName(texture.format)},
          {"bytes", texture.texels.size()},
          {"fnv1a_64", contentHash(std::as_bytes(texture.texels))}};
}

}  // namespace

Json describeRenderMeshes(const PackFile& pack) {
  const auto stored = renderMeshesOf(pack);
  if (!stored || !*stored) return nullptr;
  const RenderMeshes& meshes = **stored;
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
  std::uint64_t texture_bytes = 0;
  for (const RenderTexture& texture : meshes.textures) texture_bytes += texture.texels.size();
  json["texture_bytes"] = texture_bytes;
  json["models"] = Json::array();
  for (const RenderModel& model : meshes.models) {
    json["models"].push_back(describeModel(pack, meshes, model));
  }
  json["materials"] = Json::array();
  for (const RenderMaterial& material : meshes.materials) {
    json["materials"].push_back(describeMaterial(meshes, material));
  }
  json["textures"] = Json::array();
  for (const RenderTexture& texture : meshes.textures) {
    json["textures"].push_back(describeTexture(texture));
  }
  json["semantics"] = Json::array();
  for (const std::string_view name : meshes.semantics) {
    json["semantics"].push_back(std::string(name));
  }
  return json;
}

}  // namespace galactic::pack_tool
