#pragma once
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "galactic/bake/render_textures.h"
#include "support/image_files.h"

namespace galactic::test {

/// An RGBA image of `texel(x, y)`, four bytes each.
template <class Texel>
ImageContent rgbaImage(unsigned width, unsigned height, const Texel& texel) {
  ImageContent image{.width = width, .height = height, .bytes = {}};
  for (unsigned y = 0; y < height; ++y) {
    for (unsigned x = 0; x < width; ++x) {
      const std::array<std::uint8_t, 4> rgba = texel(x, y);
      image.bytes.insert(image.bytes.end(), rgba.begin(), rgba.end());
    }
  }
  return image;
}

/// The same without alpha.
inline ImageContent withoutAlpha(const ImageContent& rgba) {
  ImageContent image{.width = rgba.width, .height = rgba.height, .bytes = {}};
  for (std::size_t i = 0; i < rgba.bytes.size(); ++i) {
    if (i % 4 != 3) image.bytes.push_back(rgba.bytes[i]);
  }
  return image;
}

/// Something with structure at every scale, no two texels alike by chance.
inline ImageContent busyImage(unsigned width, unsigned height) {
  return rgbaImage(width, height, [](unsigned x, unsigned y) -> std::array<std::uint8_t, 4> {
    return {static_cast<std::uint8_t>(x * 7 + y * 3), static_cast<std::uint8_t>(x * y),
            static_cast<std::uint8_t>(200 - 2 * y), 255};
  });
}

inline bake::EmbeddedTexture embedded(const std::string& file, std::string format = "png") {
  return {.format = std::move(format), .bytes = {file.begin(), file.end()}};
}

inline bake::SourceMaterial textured(std::string texture,
                                     std::array<float, 4> factor = {1, 1, 1, 1}) {
  bake::SourceMaterial material;
  material.name = "paint";
  material.base_color = factor;
  material.base_color_texture = std::move(texture);
  return material;
}

/// bakeMaterials of embedded images; fails the test on an error.
inline bake::BakedMaterials bakeEmbedded(const std::vector<bake::SourceMaterial>& materials,
                                         const std::vector<bake::EmbeddedTexture>& images,
                                         const bake::TextureBakeOptions& options = {},
                                         unsigned threads = 1,
                                         bake::TextureLibrary* library = nullptr) {
  auto baked = bake::bakeMaterials(materials, {images, "no folder"}, options, threads, library);
  EXPECT_TRUE(baked.has_value()) << baked.error().message;
  return baked ? *std::move(baked) : bake::BakedMaterials{};
}

/// One image with a white, opaque material.
inline bake::BakedMaterials bakeImage(const std::string& file,
                                      const bake::TextureBakeOptions& options = {},
                                      bake::TextureLibrary* library = nullptr) {
  return bakeEmbedded({textured("*0")}, {embedded(file)}, options, 1, library);
}

/// R, G, B, A of texel (x, y) of a level of an Rgba8 texture.
inline std::array<int, 4> texelAt(const bake::BakedMaterials& baked, std::size_t texture,
                                  unsigned level, std::pair<unsigned, unsigned> at) {
  const bake::BakedTexture& from = baked.textures[texture];
  std::size_t offset = from.first_byte;
  unsigned edge = from.size;
  for (unsigned n = 0; n < level; ++n, edge /= 2) offset += std::size_t{edge} * edge * 4;
  offset += (std::size_t{at.second} * edge + at.first) * 4;
  const std::uint8_t* texel = &baked.texels[offset];
  return {texel[0], texel[1], texel[2], texel[3]};
}

/// The sRGB transfer function, straight from its definition.
inline double srgbToLinear(double byte) {
  const double c = byte / 255;
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}
inline double linearToSrgb(double linear) {
  return 255 * (linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055);
}

}  // namespace galactic::test
