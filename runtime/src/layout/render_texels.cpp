#include "layout/render_texels.h"

#include <bit>
#include <cstring>

#include "layout/bc1.h"

namespace galactic {

static_assert(std::endian::native == std::endian::little, "texels are read as they lie");

std::vector<std::uint32_t> decodedTexels(const RenderTexture& texture) {
  std::vector<std::uint32_t> texels;
  if (texture.format == TexelFormat::kBc1) {
    render::decodeBc1(texture.texels, texture.size, texels);
    return texels;
  }
  texels.resize(texture.texels.size() / sizeof(std::uint32_t));
  std::memcpy(texels.data(), texture.texels.data(), texels.size() * sizeof(std::uint32_t));
  return texels;
}

}  // namespace galactic
