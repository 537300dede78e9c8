#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace galactic::render {

/// Decodes a texture of BC1 blocks with all its levels to RGBA, R lowest, alpha 255; appends the
/// texels, level after level. `size`: edge of the largest level, a power of two; `blocks` has
/// textureBytes(size, TexelFormat::kBc1) bytes. Colors between a block's two are rounded as
/// Direct3D 10 wants them, within its tolerance.
void decodeBc1(std::span<const std::uint8_t> blocks, std::uint32_t size,
               std::vector<std::uint32_t>& texels);

}  // namespace galactic::render
