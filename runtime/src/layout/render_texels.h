#pragma once
#include <cstdint>
#include <vector>

#include "galactic/render_meshes.h"

namespace galactic {

/// All texels of a texture of any format, level by level, as RGBA with R lowest; alpha is 255 if
/// the format has none. `texture` must come from a checked pack. Thread-safe.
[[nodiscard]] std::vector<std::uint32_t> decodedTexels(const RenderTexture& texture);

}  // namespace galactic
