#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "textures/images/image.h"
#include "textures/images/transfer_function.h"

namespace galactic::bake {

/// R, G, B in linear light, multiplied with alpha; alpha.
using LinearTexel = std::array<float, 4>;

/// A square image; rows from top to bottom.
struct LinearImage {
  std::uint32_t size = 0;
  std::vector<LinearTexel> texels;
};

/// What happens to an image's alpha.
enum class AlphaUse { kIgnored, kKept };

/// `image` stretched to a square of `size` texels, in linear light, colors weighted with alpha:
/// by area where it shrinks, linearly between texels' centers where it grows, unchanged where
/// it does neither. Ignored alpha is 1.
[[nodiscard]] LinearImage resampled(const Image& image, std::uint32_t size, AlphaUse alpha,
                                    const TransferFunction& transfer);

/// The mean of each 2 x 2 texels. `image.size`: even.
[[nodiscard]] LinearImage halved(const LinearImage& image);

}  // namespace galactic::bake
