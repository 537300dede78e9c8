#include "render/soft/soft_scene.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>

#include "layout/bc1.h"
#include "render/raster/tables.h"

namespace galactic::render {
namespace {

std::uintptr_t addressOf(const void* pointer) { return reinterpret_cast<std::uintptr_t>(pointer); }

}  // namespace

SoftScene::SoftScene(const RenderLibrary& library, std::size_t most_bytes)
    : most_bytes_(most_bytes) {
  const std::vector<RenderMeshes>& packs = library.packs();
  surfaces_.resize(packs.size());
  packs_.reserve(packs.size());
  color_kinds_.reserve(packs.size());
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
  for (const std::vector<std::uint32_t>& texels : unpacked_) bases_.push_back(texels.data());
  models_.reserve(library.modelCount());
  for (std::uint32_t n = 0; n < library.modelCount(); ++n) addModel(library, n);
}

void SoftScene::addTextures(const RenderMeshes& meshes, std::vector<SurfaceTexels>& textures) {
  textures.reserve(meshes.textures.size());
  for (const RenderTexture& texture : meshes.textures) {
    const bool is_in_place = texture.format == TexelFormat::kRgba8;
    textures.push_back(is_in_place ? inPlace(texture) : unpacked(texture));
  }
}

/// Finds as few bases as possible, from the lowest address on, because pixels whose textures share
/// a base are read together.
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
    if (!bases_.empty() && reaches(bases_.back(), texels)) continue;
    bases_.push_back(reinterpret_cast<const std::uint32_t*>(texels.data()));
  }
  bases_in_packs_ = bases_.size();
}

bool SoftScene::reaches(const std::uint32_t* base, std::span<const std::uint8_t> texels) const {
  const std::uintptr_t from = addressOf(base);
  const std::uintptr_t first = addressOf(texels.data());
  return from <= first && first + texels.size() - from <= most_bytes_ && (first - from) % 4 == 0;
}

SurfaceTexels SoftScene::inPlace(const RenderTexture& texture) const {
  std::size_t b = bases_.size() - 1;
  while (!reaches(bases_[b], texture.texels)) --b;
  return {.texels = static_cast<std::uint32_t>(
              (addressOf(texture.texels.data()) - addressOf(bases_[b])) / 4),
          .kind = textureKind(texture.size, b)};
}

/// Unpacks a texture once, however many packs have it.
SurfaceTexels SoftScene::unpacked(const RenderTexture& texture) {
  const auto [known, is_new] = known_.try_emplace(keyOf(texture));
  if (!is_new) return known->second;
  const std::size_t bytes = textureBytes(texture.size, TexelFormat::kRgba8);
  const bool has_room =
      !unpacked_.empty() && unpacked_.back().size() * sizeof(std::uint32_t) + bytes <= most_bytes_;
  if (!has_room) unpacked_.emplace_back();
  std::vector<std::uint32_t>& texels = unpacked_.back();
  known->second = {.texels = static_cast<std::uint32_t>(texels.size()),
                   .kind = textureKind(texture.size, bases_in_packs_ + unpacked_.size() - 1)};
  decodeBc1(texture.texels, texture.size, texels);
  return known->second;
}

void SoftScene::addModel(const RenderLibrary& library, std::uint32_t number) {
  models_.push_back(modelTables(library, number));
  models_.back().pack = &packs_[library.entry(number).pack];
}

}  // namespace galactic::render
