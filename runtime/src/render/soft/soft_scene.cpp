#include "render/soft/soft_scene.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>

#include "render/raster/tables.h"
#include "render/soft/bc1.h"

namespace galactic::render {
namespace {

/// From a base to the last texel of a texture: what a 32-bit number of bytes can tell.
constexpr std::uintptr_t kFarthest = 0x7FFFFFFF;

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
    surfaces_[p] = surfacesOf(packs[p], textures);
    PackTables tables = packTables(packs[p]);
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
    textures.push_back({.texels = static_cast<std::uint32_t>(unpacked_.size()),
                        .kind = textureKind(texture.size, 0)});
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
            .kind = textureKind(texture.size, b)};
  }
  bases_.push_back(reinterpret_cast<const std::uint32_t*>(texture.texels.data()));
  return {.texels = 0, .kind = textureKind(texture.size, bases_.size() - 1)};
}

void SoftScene::addModel(const RenderLibrary& library, std::uint32_t number) {
  models_.push_back(modelTables(library, number));
  models_.back().pack = &packs_[library.entry(number).pack];
}

}  // namespace galactic::render
