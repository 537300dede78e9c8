#pragma once
#define XXH_INLINE_ALL
#include <xxhash.h>

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "support/render_pack_builder.h"
#include "support/scene_pack_builder.h"

namespace galactic::test {

/// XXH3-128, low half first, as packs name shared textures.
using TexelHash = std::pair<std::uint64_t, std::uint64_t>;

inline TexelHash hashOf(const std::vector<std::uint8_t>& texels) {
  const XXH128_hash_t hash = XXH3_128bits(texels.data(), texels.size());
  return {hash.low64, hash.high64};
}

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
inline AlignedBytes buildPack(const TexturePackFields& fields) {
  flatbuffers::FlatBufferBuilder builder;
  const auto name = builder.CreateString(fields.name);
  const auto texels = renderPool(builder, fields.texels);
  const auto [low, high] = fields.hash.value_or(hashOf(fields.texels));
  const schema::Hash128 hash(low, high);
  const auto root = schema::CreateSharedTexture(
      builder, name, fields.size, static_cast<schema::TexelFormat>(fields.format), &hash, texels);
  return finishFile(builder, fields.kind, schema::Asset::SharedTexture, root.Union());
}

}  // namespace galactic::test
