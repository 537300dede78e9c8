#pragma once
#include <cstddef>
#include <cstdint>

namespace galactic::render {

/// What the random numbers of an image's pixels follow from, beside the pixel's number.
struct PixelKey {
  std::uint32_t words[4];
};

/// Noise of the depth of one image.
struct DepthNoise {
  PixelKey key;
  /// At 1 m, meters.
  float deviation;
  /// Of 2^24 pixels, those that lose their depth.
  std::int32_t dropped;
  /// Noise makes no depth less than this, meters.
  float near;
};

/// The same of colors.
struct ColorNoise {
  PixelKey key;
  /// Of a channel, levels.
  float deviation;
  float gain;
};

// Each on any processor, and for those with AVX2: the same bits.

/// `depth`: `count` pixels.
void addDepthNoisePortable(const DepthNoise& noise, float* depth, std::size_t count) noexcept;
void addDepthNoiseAvx2(const DepthNoise& noise, float* depth, std::size_t count) noexcept;

/// `color`: `count` pixels of `channels` bytes each, 3 or 4; the fourth stays as it is.
void addColorNoisePortable(const ColorNoise& noise, std::uint8_t* color, std::uint32_t channels,
                           std::size_t count) noexcept;
void addColorNoiseAvx2(const ColorNoise& noise, std::uint8_t* color, std::uint32_t channels,
                       std::size_t count) noexcept;

}  // namespace galactic::render
