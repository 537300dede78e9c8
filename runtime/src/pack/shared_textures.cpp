#include "galactic/render_library.h"
#include "pack/schema_values.h"
#include "support/content_hash.h"

namespace galactic {

Result<void> SharedTextures::add(const PackFile& pack) {
  const schema::SharedTexture* stored =
      pack.kind() == PackKind::kTexture ? pack.root().asset_as_SharedTexture() : nullptr;
  if (stored == nullptr) {
    return fail(ErrorCode::kInvalidInput, pack.where(),
                "is a pack of kind " + packKindName(pack.kind()) + ", expected a texture (TXTR)");
  }
  by_hash_.try_emplace({stored->hash()->low(), stored->hash()->high()},
                       RenderTexture{.name = detail::fromSchema(stored->name()),
                                     .size = stored->size(),
                                     .format = static_cast<TexelFormat>(stored->format()),
                                     .texels = detail::inPlace<std::uint8_t>(stored->texels())});
  return {};
}

const RenderTexture* SharedTextures::find(std::uint64_t hash_low, std::uint64_t hash_high) const {
  const auto found = by_hash_.find({hash_low, hash_high});
  return found == by_hash_.end() ? nullptr : &found->second;
}

std::filesystem::path texturePackBeside(const PackFile& pack, const MissingTexture& texture) {
  const std::filesystem::path folder = std::filesystem::path(pack.where()).parent_path();
  return folder / ".." / "textures" /
         (detail::hexOf({texture.hash_low, texture.hash_high}) + ".pack");
}

}  // namespace galactic
