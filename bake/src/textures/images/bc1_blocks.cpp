// The only file that names stb_dxt.
#include <array>
#include <cstring>
// The header needs <cstring> before it.
#define STB_DXT_IMPLEMENTATION
#define STB_DXT_STATIC
#include <stb/stb_dxt.h>

#include "textures/images/mip_chain.h"

namespace galactic::bake {

std::vector<std::uint8_t> encodeBc1(const std::vector<std::uint8_t>& rgba, std::uint32_t size) {
  std::vector<std::uint8_t> blocks(textureBytes(size, TexelFormat::kBc1));
  std::uint8_t* to = blocks.data();
  const std::uint8_t* level = rgba.data();
  for (std::size_t edge = size; edge > 0; level += edge * edge * 4, edge /= 2) {
    for (std::size_t y = 0; y < edge; y += 4) {
      for (std::size_t x = 0; x < edge; x += 4) {
        // Levels smaller than 4 texels are repeated to fill their block.
        std::array<std::uint8_t, 64> block{};
        for (std::size_t i = 0; i < 16; ++i) {
          const std::size_t from = ((y + i / 4) % edge) * edge + (x + i % 4) % edge;
          std::memcpy(&block[4 * i], level + 4 * from, 4);
        }
        stb_compress_dxt_block(to, block.data(), 0, STB_DXT_HIGHQUAL);
        to += 8;
      }
    }
  }
  return blocks;
}

}  // namespace galactic::bake
