// Compressed textures against a decoder of our own.
#include <gmock/gmock.h>

#include <cstring>

#include "texture_helpers.h"

namespace galactic::test::bc1_test {
namespace {

using bake::BakedMaterials;

std::array<double, 3> expanded565(unsigned color) {
  const unsigned r = color >> 11U;
  const unsigned g = (color >> 5U) & 63U;
  const unsigned b = color & 31U;
  return {r * 255. / 31, g * 255. / 63, b * 255. / 31};
}

/// R, G, B of texel (x, y) of the level that begins at `blocks`.
std::array<double, 3> bc1Texel(const std::uint8_t* blocks, unsigned edge,
                               std::pair<unsigned, unsigned> at) {
  const unsigned across = (edge + 3) / 4;
  const std::uint8_t* block = blocks + 8 * (at.second / 4 * across + at.first / 4);
  std::uint16_t first = 0;
  std::uint16_t second = 0;
  std::uint32_t codes = 0;
  std::memcpy(&first, block, 2);
  std::memcpy(&second, block + 2, 2);
  std::memcpy(&codes, block + 4, 4);
  const auto a = expanded565(first);
  const auto b = expanded565(second);
  const unsigned code = codes >> (2 * (at.second % 4 * 4 + at.first % 4)) & 3U;
  EXPECT_TRUE(first > second || code == 0) << "a block of three colors and black";
  const std::array<double, 4> share{0, 1, 1. / 3, 2. / 3};
  std::array<double, 3> color{};
  for (std::size_t c = 0; c < 3; ++c) color[c] = a[c] + (b[c] - a[c]) * share[code];
  return color;
}

TEST(Bc1, IsCloseToTheTexelsItStandsFor) {
  // Smooth, as photographs are within blocks of 4 x 4.
  const ImageContent image = rgbaImage(64, 64, [](unsigned x, unsigned y) {
    return std::array<std::uint8_t, 4>{static_cast<std::uint8_t>(x * 4),
                                       static_cast<std::uint8_t>(y * 3),
                                       static_cast<std::uint8_t>(128 + x - y), 255};
  });
  const BakedMaterials plain = bakeImage(pngFile(image));
  const BakedMaterials packed = bakeImage(pngFile(image), {.format = TexelFormat::kBc1});
  ASSERT_EQ(packed.textures.size(), 1U);
  EXPECT_EQ(packed.textures[0].format, TexelFormat::kBc1);
  EXPECT_EQ(packed.texels.size(), textureBytes(64, TexelFormat::kBc1));
  EXPECT_EQ(packed.materials[0].color, plain.materials[0].color);
  const std::uint8_t* level = packed.texels.data();
  double sum = 0;
  std::size_t values = 0;
  for (unsigned n = 0, edge = 64; edge > 0; ++n, edge /= 2) {
    for (unsigned y = 0; y < edge; ++y) {
      for (unsigned x = 0; x < edge; ++x) {
        const auto color = bc1Texel(level, edge, {x, y});
        const auto wanted = texelAt(plain, 0, n, {x, y});
        for (std::size_t c = 0; c < 3; ++c) {
          const double error = std::abs(color[c] - wanted[c]);
          // Small levels put large gradients into one block.
          if (n == 0) {
            ASSERT_LE(error, 16) << "texel " << x << ", " << y;
          }
          sum += error;
          ++values;
        }
      }
    }
    level += 8 * ((edge + 3) / 4) * ((edge + 3) / 4);
  }
  EXPECT_EQ(level, packed.texels.data() + packed.texels.size());
  EXPECT_LE(sum / static_cast<double>(values), 4);
}

TEST(Bc1, IsNotUsedWhereShapesAreCutOut) {
  const ImageContent image = rgbaImage(16, 16, [](unsigned x, unsigned y) {
    return std::array<std::uint8_t, 4>{static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y),
                                       0, static_cast<std::uint8_t>(x < 8 ? 0 : 255)};
  });
  bake::SourceMaterial mask = textured("*0");
  mask.alpha_mode = bake::AlphaMode::kMask;
  const BakedMaterials baked = bakeEmbedded({mask, textured("*0")}, {embedded(pngFile(image))},
                                            {.format = TexelFormat::kBc1});
  ASSERT_EQ(baked.textures.size(), 2U);
  EXPECT_EQ(baked.textures[0].format, TexelFormat::kRgba8);
  EXPECT_EQ(baked.textures[1].format, TexelFormat::kBc1);
}

}  // namespace
}  // namespace galactic::test::bc1_test
