#include "layout/bc1.h"

#include <array>
#include <cassert>

#include "galactic/render_meshes.h"

namespace galactic::render {
namespace {

constexpr std::uint32_t kBlockEdge = 4;
constexpr std::size_t kBlockBytes = 8;
constexpr std::uint32_t kOpaque = 0xFF000000U;

struct Color {
  std::uint32_t red, green, blue;
};

Color unpack565(std::uint32_t bits) {
  const std::uint32_t red = bits >> 11U;
  const std::uint32_t green = (bits >> 5U) & 63U;
  const std::uint32_t blue = bits & 31U;
  return {red << 3U | red >> 2U, green << 2U | green >> 4U, blue << 3U | blue >> 2U};
}

std::uint32_t packed(const Color& color) {
  return color.red | color.green << 8U | color.blue << 16U | kOpaque;
}

/// (a * weight + b * (parts - weight)) / parts, rounded.
Color mixed(const Color& a, const Color& b, std::uint32_t weight, std::uint32_t parts) {
  const auto mix = [&](std::uint32_t p, std::uint32_t q) {
    return (p * weight + q * (parts - weight) + parts / 2) / parts;
  };
  return {mix(a.red, b.red), mix(a.green, b.green), mix(a.blue, b.blue)};
}

std::array<std::uint32_t, 4> paletteOf(const std::uint8_t* block) {
  const std::uint32_t first = block[0] | static_cast<std::uint32_t>(block[1]) << 8U;
  const std::uint32_t second = block[2] | static_cast<std::uint32_t>(block[3]) << 8U;
  const Color a = unpack565(first);
  const Color b = unpack565(second);
  if (first > second) {
    return {packed(a), packed(b), packed(mixed(a, b, 2, 3)), packed(mixed(a, b, 1, 3))};
  }
  return {packed(a), packed(b), packed(mixed(a, b, 1, 2)), kOpaque};
}

void decodeLevel(const std::uint8_t* blocks, std::uint32_t edge, std::uint32_t* texels) {
  const std::uint32_t across = (edge + kBlockEdge - 1) / kBlockEdge;
  for (std::uint32_t y = 0; y < edge; ++y) {
    for (std::uint32_t x = 0; x < edge; ++x) {
      const std::size_t number = std::size_t{y / kBlockEdge} * across + x / kBlockEdge;
      const std::uint8_t* block = blocks + number * kBlockBytes;
      const std::uint32_t choices = block[4 + y % kBlockEdge];
      *texels++ = paletteOf(block)[(choices >> (2U * (x % kBlockEdge))) & 3U];
    }
  }
}

}  // namespace

void decodeBc1(std::span<const std::uint8_t> blocks, std::uint32_t size,
               std::vector<std::uint32_t>& texels) {
  assert(blocks.size() == textureBytes(size, TexelFormat::kBc1));
  const std::uint8_t* from = blocks.data();
  for (std::uint32_t edge = size; edge > 0; edge /= 2) {
    const std::size_t first = texels.size();
    texels.resize(first + std::size_t{edge} * edge);
    decodeLevel(from, edge, texels.data() + first);
    const std::size_t across = (edge + kBlockEdge - 1) / kBlockEdge;
    from += across * across * kBlockBytes;
  }
}

}  // namespace galactic::render
