#include "support/packs/texture_pack_builder.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "support/packs/schema_parts.h"

namespace galactic::test {

TexelHash hashOf(const std::vector<std::uint8_t>& texels) {
  const XXH128_hash_t hash = XXH3_128bits(texels.data(), texels.size());
  return {hash.low64, hash.high64};
}

AlignedBytes buildPack(const TexturePackFields& fields) {
  flatbuffers::FlatBufferBuilder builder;
  const auto name = builder.CreateString(fields.name);
  const auto texels = alignedNumbers(builder, fields.texels);
  const auto [low, high] = fields.hash.value_or(hashOf(fields.texels));
  const schema::Hash128 hash(low, high);
  const auto root = schema::CreateSharedTexture(
      builder, name, fields.size, static_cast<schema::TexelFormat>(fields.format), &hash, texels);
  return finishFile(builder, fields.kind, schema::Asset::SharedTexture, root.Union());
}

}  // namespace galactic::test
