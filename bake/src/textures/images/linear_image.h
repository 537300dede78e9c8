#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "textures/images/image.h"
#include "textures/images/transfer_function.h"

namespace galactic::bake {

/// R, G, B in linear light, premultiplied with alpha, and alpha.
using LinearTexel = std::array<float, 4>;

/// A square image; rows from top to bottom.
struct LinearImage {
  std::uint32_t size = 0;
  std::vector<LinearTexel> texels;
};

/// How to treat an image's alpha.
enum class AlphaUse { kIgnored, kKept };

/// `image` resampled to a square of `size` texels per edge, in linear light, with colors weighted
/// by alpha. Each axis is averaged by area if it shrinks, interpolated between texel centers if it
/// grows, and otherwise unchanged. Ignored alpha becomes 1.
[[nodiscard]] LinearImage resampled(const Image& image, std::uint32_t size, AlphaUse alpha,
                                    const TransferFunction& transfer);

/// The image at half the size: the mean of each block of 2 x 2 texels. `image.size` must be even.
[[nodiscard]] LinearImage halved(const LinearImage& image);

}  // namespace galactic::bake
