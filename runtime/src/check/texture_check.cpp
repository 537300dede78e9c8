#include "check/texture_check.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "galactic/render_meshes.h"

namespace galactic::detail {

Result<void> checkSharedTexture(const schema::SharedTexture& texture, const std::string& where) {
  Offence offence(where + ": shared_texture");
  requireTextureForm(texture, "", offence);
  if (offence.found()) return offence.result();
  const std::size_t wanted =
      textureBytes(texture.size(), static_cast<TexelFormat>(texture.format()));
  offence.require(texture.texels()->size() == wanted, "texels", "has {} bytes, expected {}",
                  texture.texels()->size(), wanted);
  const XXH128_hash_t hash = XXH3_128bits(texture.texels()->data(), texture.texels()->size());
  offence.require(hash.low64 == texture.hash()->low() && hash.high64 == texture.hash()->high(),
                  "hash", "is not that of the texels, expected {:016x}{:016x}", hash.high64,
                  hash.low64);
  return offence.result();
}

}  // namespace galactic::detail
