#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "support/packs/render_pack_builder.h"
#include "support/packs/scene_pack_builder.h"

namespace galactic::test {

/// XXH3-128, low half first, as packs name shared textures.
using TexelHash = std::pair<std::uint64_t, std::uint64_t>;

TexelHash hashOf(const std::vector<std::uint8_t>& texels);

/// All that a texture pack holds: two by two texels and their mean.
struct TexturePackFields {
  PackKind kind = PackKind::kTexture;
  std::string name = "oak";
  std::uint32_t size = 2;
  std::uint8_t format = 0;
  std::vector<std::uint8_t> texels = std::vector<std::uint8_t>(20, 0x60);
  /// That of the texels where it is not given.
  std::optional<TexelHash> hash;
};

/// The whole file: header and payload.
AlignedBytes buildPack(const TexturePackFields& fields);

}  // namespace galactic::test
