#include "render/soft/soft_scene.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>

#include "galactic/pose.h"
#include "render/soft/bc1.h"

namespace galactic::render {
namespace {

/// From a base to the last texel of a texture: what a 32-bit number of bytes can tell.
constexpr std::uintptr_t kFarthest = 0x7FFFFFFF;

std::uint32_t leastAlpha(float cutoff) {
  if (!(cutoff > 0)) return 0;
  return static_cast<std::uint32_t>(std::ceil(std::min(cutoff, 1.0F) * 255.0F));
}

std::uint32_t kindOf(std::uint32_t size, std::size_t base) {
  return static_cast<std::uint32_t>(std::countr_zero(size)) | static_cast<std::uint32_t>(base)
                                                                  << 8U;
}

PackTables tablesOf(const RenderMeshes& meshes) {
  return {.clusters = meshes.clusters.data(),
          .cluster_bounds = meshes.cluster_bounds.data(),
          .vertices = meshes.vertices.data(),
          .colors = meshes.colors.empty() ? nullptr : meshes.colors.data(),
          .triangles = meshes.triangles.data()};
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

/// Of each cluster of a pack; none where it has no colors.
std::vector<std::uint32_t> colorKinds(const RenderMeshes& meshes) {
  std::vector<std::uint32_t> kinds;
  if (meshes.colors.empty()) return kinds;
  kinds.reserve(meshes.clusters.size());
  for (const RenderCluster& cluster : meshes.clusters) {
    kinds.push_back(colorKind(meshes.colors.subspan(cluster.first_vertex, cluster.vertex_count)));
  }
  return kinds;
}

}  // namespace

SoftScene::SoftScene(const RenderLibrary& library) {
  const std::vector<RenderMeshes>& packs = library.packs();
  surfaces_.resize(packs.size());
  packs_.reserve(packs.size());
  color_kinds_.reserve(packs.size());
  bases_.push_back(nullptr);  // of what is unpacked
  for (std::size_t p = 0; p < packs.size(); ++p) {
    std::vector<SurfaceTexels> textures;
    addTextures(packs[p], textures);
    surfaces_[p].reserve(packs[p].materials.size());
    for (const RenderMaterial& material : packs[p].materials) {
      SurfaceTexels surface{.texels = material.color, .kind = kFlatSurface};
      if (material.texture >= 0) surface = textures[static_cast<std::size_t>(material.texture)];
      surface.least_alpha = leastAlpha(material.alpha_cutoff);
      surfaces_[p].push_back(surface);
    }
    PackTables tables = tablesOf(packs[p]);
    tables.surfaces = surfaces_[p].data();
    color_kinds_.push_back(colorKinds(packs[p]));
    if (!color_kinds_.back().empty()) tables.color_kinds = color_kinds_.back().data();
    tables.first_semantic = library.firstSemantic(p);
    packs_.push_back(tables);
  }
  bases_[0] = unpacked_.data();
  models_.reserve(library.modelCount());
  for (std::uint32_t n = 0; n < library.modelCount(); ++n) addModel(library, n);
}

void SoftScene::addTextures(const RenderMeshes& meshes, std::vector<SurfaceTexels>& textures) {
  textures.reserve(meshes.textures.size());
  for (const RenderTexture& texture : meshes.textures) {
    if (texture.format == TexelFormat::kRgba8) {
      textures.push_back(inPlace(texture));
      continue;
    }
    textures.push_back(
        {.texels = static_cast<std::uint32_t>(unpacked_.size()), .kind = kindOf(texture.size, 0)});
    decodeBc1(texture.texels, texture.size, unpacked_);
  }
}

/// Textures of one pack lie close to each other, so they share a base: pixels whose textures do are
/// read together.
SurfaceTexels SoftScene::inPlace(const RenderTexture& texture) {
  const auto address = [](const void* pointer) {
    return reinterpret_cast<std::uintptr_t>(pointer);
  };
  const std::uintptr_t first = address(texture.texels.data());
  const std::uintptr_t end = first + texture.texels.size();
  for (std::size_t b = bases_.size(); b-- > 1;) {
    const std::uintptr_t base = address(bases_[b]);
    if (base > first || end - base > kFarthest || (first - base) % 4 != 0) continue;
    return {.texels = static_cast<std::uint32_t>((first - base) / 4),
            .kind = kindOf(texture.size, b)};
  }
  bases_.push_back(reinterpret_cast<const std::uint32_t*>(texture.texels.data()));
  return {.texels = 0, .kind = kindOf(texture.size, bases_.size() - 1)};
}

void SoftScene::addModel(const RenderLibrary& library, std::uint32_t number) {
  const RenderModel& model = library.model(number);
  const Vec3 center = (model.bounds_min + model.bounds_max) * 0.5F;
  const Vec3 half = (model.bounds_max - model.bounds_min) * 0.5F;
  // A part in a million more: the center is rounded.
  const auto wider = [](float half_extent, float at) {
    return half_extent + 1e-6F * (half_extent + std::abs(at));
  };
  models_.push_back({.pack = &packs_[library.entry(number).pack],
                     .step = model.step,
                     .first_cluster = model.first_cluster,
                     .cluster_count = model.cluster_count,
                     .first_block = model.first_block,
                     .center = {center.x, center.y, center.z},
                     .half_extents = {wider(half.x, center.x), wider(half.y, center.y),
                                      wider(half.z, center.z)}});
}

}  // namespace galactic::render
