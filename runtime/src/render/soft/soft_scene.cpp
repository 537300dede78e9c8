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

std::uintptr_t addressOf(const void* pointer) { return reinterpret_cast<std::uintptr_t>(pointer); }

bool reaches(const std::uint32_t* base, std::span<const std::uint8_t> texels) {
  const std::uintptr_t from = addressOf(base);
  const std::uintptr_t first = addressOf(texels.data());
  return from <= first && first + texels.size() - from <= kFarthest && (first - from) % 4 == 0;
}

}  // namespace

SoftScene::SoftScene(const RenderLibrary& library) {
  const std::vector<RenderMeshes>& packs = library.packs();
  surfaces_.resize(packs.size());
  packs_.reserve(packs.size());
  color_kinds_.reserve(packs.size());
  bases_.push_back(nullptr);  // of what is unpacked
  findBases(packs);
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

/// Pixels whose textures share a base are read together: as few bases as possible, from the lowest
/// address on.
void SoftScene::findBases(const std::vector<RenderMeshes>& packs) {
  std::vector<std::span<const std::uint8_t>> all;
  for (const RenderMeshes& pack : packs) {
    for (const RenderTexture& texture : pack.textures) {
      if (texture.format == TexelFormat::kRgba8) all.push_back(texture.texels);
    }
  }
  std::sort(all.begin(), all.end(),
            [](const auto& a, const auto& b) { return addressOf(a.data()) < addressOf(b.data()); });
  for (const std::span<const std::uint8_t> texels : all) {
    if (bases_.size() > 1 && reaches(bases_.back(), texels)) continue;
    bases_.push_back(reinterpret_cast<const std::uint32_t*>(texels.data()));
  }
}

SurfaceTexels SoftScene::inPlace(const RenderTexture& texture) const {
  std::size_t b = bases_.size() - 1;
  while (!reaches(bases_[b], texture.texels)) --b;
  return {.texels = static_cast<std::uint32_t>(
              (addressOf(texture.texels.data()) - addressOf(bases_[b])) / 4),
          .kind = textureKind(texture.size, b)};
}

void SoftScene::addModel(const RenderLibrary& library, std::uint32_t number) {
  models_.push_back(modelTables(library, number));
  models_.back().pack = &packs_[library.entry(number).pack];
}

}  // namespace galactic::render
