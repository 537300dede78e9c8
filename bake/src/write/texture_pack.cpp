#include <span>

#include "galactic/bake/packs.h"
#include "support/content_hash.h"
#include "write/pack_payload.h"

namespace galactic::bake {

std::string textureHash(const BakedTexture& texture) {
  return detail::hexOf({texture.hash_low, texture.hash_high});
}

std::vector<std::byte> encodeTexturePack(const BakedMaterials& materials,
                                         const BakedTexture& texture,
                                         const Provenance& provenance) {
  FlatBufferBuilder builder;
  const auto provenance_table = provenanceTable(builder, provenance);
  const std::span<const std::uint8_t> bytes =
      std::span(materials.texels)
          .subspan(texture.first_byte, textureBytes(texture.size, texture.format));
  const auto texels = alignedVector<std::uint8_t>(builder, bytes);
  const auto name = builder.CreateString(texture.name);
  const schema::Hash128 hash(texture.hash_low, texture.hash_high);
  const auto root = schema::CreateSharedTexture(
      builder, name, texture.size, static_cast<schema::TexelFormat>(texture.format), &hash, texels);
  return finishPack(builder, provenance_table, schema::Asset::SharedTexture, root.Union());
}

Result<std::uint64_t> writeTexturePack(const std::filesystem::path& path,
                                       const BakedMaterials& materials, const BakedTexture& texture,
                                       const Provenance& provenance) {
  return writePackFile(path, PackKind::kTexture, encodeTexturePack(materials, texture, provenance));
}

}  // namespace galactic::bake
