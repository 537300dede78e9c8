#pragma once
#include <cstdint>
#include <vector>

namespace galactic::bake {

/// Limits of a source image: edge in texels, and texels in all. Scans of rooms come with 8192 x
/// 8192.
inline constexpr std::uint32_t kLargestImageEdge = 16384;
inline constexpr std::uint64_t kMostImageTexels = std::uint64_t{1} << 26U;

/// A decoded image: rows from top to bottom, four bytes a texel: R, G, B (sRGB), straight alpha.
struct Image {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<std::uint8_t> rgba;
};

}  // namespace galactic::bake
