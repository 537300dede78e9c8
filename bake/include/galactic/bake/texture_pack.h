#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "galactic/bake/provenance.h"
#include "galactic/bake/render_textures.h"
#include "galactic/error.h"

namespace galactic::bake {

/// 32 hexadecimal digits of the texture's hash: the name of its pack.
[[nodiscard]] std::string textureHash(const BakedTexture& texture);

/// The bytes of a texture pack's FlatBuffer, without the file header: `texture` of `materials`.
[[nodiscard]] std::vector<std::byte> encodeTexturePack(const BakedMaterials& materials,
                                                       const BakedTexture& texture,
                                                       const Provenance& provenance);

/// Writes header and payload atomically; returns the file's size in bytes.
[[nodiscard]] Result<std::uint64_t> writeTexturePack(const std::filesystem::path& path,
                                                     const BakedMaterials& materials,
                                                     const BakedTexture& texture,
                                                     const Provenance& provenance);

}  // namespace galactic::bake
