#pragma once
#include <cstdint>
#include <vector>

#include "galactic/render_meshes.h"

namespace galactic {

/// All texels of a texture, level after level, as RGBA with R lowest, whatever its format: alpha is
/// 255 where the format has none. `texture`: as checked packs have them. Thread-safe.
[[nodiscard]] std::vector<std::uint32_t> decodedTexels(const RenderTexture& texture);

}  // namespace galactic
