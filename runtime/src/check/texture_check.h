#pragma once
#include <bit>
#include <cstdint>
#include <string>

#include "check/offence.h"
#include "galactic/error.h"
#include "galactic/schema/pack_generated.h"

namespace galactic::detail {

inline constexpr std::uint32_t kLargestTexture = 4096;

/// Checks size and format of a RenderTexture or SharedTexture; `prefix` precedes the names of
/// fields.
template <class Texture>
void requireTextureForm(const Texture& texture, const std::string& prefix, Offence& offence) {
  offence.require(texture.size() <= kLargestTexture && std::has_single_bit(texture.size()),
                  prefix + "size", "is {}, expected a power of two up to {}", texture.size(),
                  kLargestTexture);
  offence.require(texture.format() <= schema::TexelFormat::MAX, prefix + "format",
                  "is {}, expected a value up to {}", static_cast<unsigned>(texture.format()),
                  static_cast<unsigned>(schema::TexelFormat::MAX));
}

/// Checks every value of a texture pack, including the hash of its texels.
[[nodiscard]] Result<void> checkSharedTexture(const schema::SharedTexture& texture,
                                              const std::string& where);

}  // namespace galactic::detail
