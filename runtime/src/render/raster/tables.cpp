#include "render/raster/tables.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>

#include "galactic/pose.h"

namespace galactic::render {
namespace {

std::uint32_t leastAlpha(float cutoff) {
  if (!(cutoff > 0)) return 0;
  return static_cast<std::uint32_t>(std::ceil(std::min(cutoff, 1.0F) * 255.0F));
}

std::uint32_t colorKind(std::span<const std::uint32_t> colors) {
  constexpr std::uint32_t kWhite = 0xFFFFFFFF;
  std::uint32_t kind = 0;
  for (const std::uint32_t color : colors) {
    const std::uint32_t red = color & 0xFFU;
    if (color != (0xFF000000U | red << 16U | red << 8U | red)) return kHasColors;
    if (color != kWhite) kind = kHasLight;
  }
  return kind;
}

}  // namespace

PackTables packTables(const RenderMeshes& meshes) {
  return {.clusters = meshes.clusters.data(),
          .cluster_bounds = meshes.cluster_bounds.data(),
          .vertices = meshes.vertices.data(),
          .colors = meshes.colors.empty() ? nullptr : meshes.colors.data(),
          .triangles = meshes.triangles.data()};
}

std::vector<std::uint32_t> colorKinds(const RenderMeshes& meshes) {
  std::vector<std::uint32_t> kinds;
  if (meshes.colors.empty()) return kinds;
  kinds.reserve(meshes.clusters.size());
  for (const RenderCluster& cluster : meshes.clusters) {
    kinds.push_back(colorKind(meshes.colors.subspan(cluster.first_vertex, cluster.vertex_count)));
  }
  return kinds;
}

std::uint32_t textureKind(std::uint32_t size, std::size_t base) {
  return static_cast<std::uint32_t>(std::countr_zero(size)) | static_cast<std::uint32_t>(base)
                                                                  << 8U;
}

std::vector<SurfaceTexels> surfacesOf(const RenderMeshes& meshes,
                                      const std::vector<SurfaceTexels>& textures) {
  std::vector<SurfaceTexels> surfaces;
  surfaces.reserve(meshes.materials.size());
  for (const RenderMaterial& material : meshes.materials) {
    SurfaceTexels surface{.texels = material.color, .kind = kFlatSurface};
    if (material.texture >= 0) surface = textures[static_cast<std::size_t>(material.texture)];
    surface.least_alpha = leastAlpha(material.alpha_cutoff);
    surfaces.push_back(surface);
  }
  return surfaces;
}

ModelTables modelTables(const RenderLibrary& library, std::uint32_t number) {
  const RenderModel& model = library.model(number);
  const Vec3 center = (model.bounds_min + model.bounds_max) * 0.5F;
  const Vec3 half = (model.bounds_max - model.bounds_min) * 0.5F;
  // Enlarged by a millionth, because the center is rounded.
  const auto wider = [](float half_extent, float at) {
    return half_extent + 1e-6F * (half_extent + std::abs(at));
  };
  return {
      .step = model.step,
      .first_cluster = model.first_cluster,
      .cluster_count = model.cluster_count,
      .first_block = model.first_block,
      .center = {center.x, center.y, center.z},
      .half_extents = {wider(half.x, center.x), wider(half.y, center.y), wider(half.z, center.z)}};
}

}  // namespace galactic::render
