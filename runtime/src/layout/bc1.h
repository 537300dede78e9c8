#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace galactic::render {

/// Decodes a texture of BC1 blocks with all its levels to RGBA (R lowest, alpha 255), and appends
/// the texels level by level. `size` is the edge of the largest level, a power of two; `blocks` has
/// textureBytes(size, TexelFormat::kBc1) bytes. Colors between a block's two are rounded within the
/// tolerance of Direct3D 10.
void decodeBc1(std::span<const std::uint8_t> blocks, std::uint32_t size,
               std::vector<std::uint32_t>& texels);

}  // namespace galactic::render
