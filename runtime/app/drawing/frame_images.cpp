#include "drawing/frame_images.h"

#include <algorithm>
#include <cmath>

namespace galactic {
namespace {

using pictures::DeepImage;
using pictures::Image;
using pictures::Rgb;

constexpr std::uint32_t kMostDeep = 65535;

/// A picture whose pixel n is `color_of(n)`.
template <class ColorOf>
Image pictureOf(const DrawnImage& image, const ColorOf& color_of) {
  Image picture(static_cast<int>(image.width), static_cast<int>(image.height), {});
  for (std::uint32_t y = 0; y < image.height; ++y) {
    for (std::uint32_t x = 0; x < image.width; ++x) {
      const std::size_t pixel = std::size_t{y} * image.width + x;
      picture.set(static_cast<int>(x), static_cast<int>(y), color_of(pixel));
    }
  }
  return picture;
}

DeepImage deepImage(const DrawnImage& image) {
  return {static_cast<int>(image.width), static_cast<int>(image.height), {}};
}

}  // namespace

Rgb semanticColor(std::uint32_t id) {
  if (id == 0) return {};
  // Maps consecutive ids to colors that are far apart and never dark.
  constexpr std::uint32_t kScatter = 2654435769U;
  constexpr std::uint32_t kDarkest = 64;
  const std::uint32_t bits = id * kScatter;
  const auto channel = [bits](unsigned shift) {
    return static_cast<std::uint8_t>(kDarkest + (bits >> shift & 0xFFU) * (255 - kDarkest) / 255);
  };
  return {channel(24), channel(16), channel(8)};
}

Image colorPicture(const DrawnImage& image) {
  const auto bytes = static_cast<std::size_t>(image.format);
  return pictureOf(image, [&](std::size_t pixel) {
    const std::span<const std::uint8_t> at = image.color.subspan(pixel * bytes, 3);
    return Rgb{at[0], at[1], at[2]};
  });
}

Rgb depthColor(float depth) {
  const auto gray = static_cast<std::uint8_t>(std::lround(255 / (1 + depth / kHalfBright)));
  return {gray, gray, gray};
}

Image depthPicture(const DrawnImage& image) {
  return pictureOf(image, [&](std::size_t pixel) {
    const float depth = image.depth[pixel];
    return depth > 0 ? depthColor(depth) : Rgb{};
  });
}

Image semanticPicture(const DrawnImage& image) {
  return pictureOf(image, [&](std::size_t pixel) { return semanticColor(image.semantics[pixel]); });
}

DeepImage depthNumbers(const DrawnImage& image) {
  constexpr float kMillimeters = 1000;
  DeepImage numbers = deepImage(image);
  numbers.pixels.reserve(image.depth.size());
  for (const float depth : image.depth) {
    const float clamped = std::clamp<float>(depth * kMillimeters, 0, kMostDeep);
    numbers.pixels.push_back(static_cast<std::uint16_t>(std::lround(clamped)));
  }
  return numbers;
}

DeepImage semanticNumbers(const DrawnImage& image) {
  DeepImage numbers = deepImage(image);
  numbers.pixels.reserve(image.semantics.size());
  for (const std::uint32_t id : image.semantics) {
    numbers.pixels.push_back(static_cast<std::uint16_t>(std::min(id, kMostDeep)));
  }
  return numbers;
}

}  // namespace galactic
