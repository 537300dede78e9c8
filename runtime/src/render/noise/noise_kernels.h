#pragma once
#include <cstddef>
#include <cstdint>

namespace galactic::render {

/// What the random numbers of an image's pixels are derived from, besides the pixel's number.
struct PixelKey {
  std::uint32_t words[4];
};

/// Noise of one depth image.
struct DepthNoise {
  PixelKey key;
  /// Standard deviation at 1 m, meters.
  float deviation;
  /// How many of 2^24 pixels lose their depth.
  std::int32_t dropped;
  /// Noise reduces no depth below this, meters.
  float near;
};

/// Noise of one color image.
struct ColorNoise {
  PixelKey key;
  /// Standard deviation of a channel, levels.
  float deviation;
  float gain;
};

// Each kernel exists for any processor and for those with AVX2; both write the same bits.

/// `depth`: `count` pixels.
void addDepthNoisePortable(const DepthNoise& noise, float* depth, std::size_t count) noexcept;
void addDepthNoiseAvx2(const DepthNoise& noise, float* depth, std::size_t count) noexcept;

/// `color`: `count` pixels of `channels` bytes each, 3 or 4; the fourth byte stays as it is.
void addColorNoisePortable(const ColorNoise& noise, std::uint8_t* color, std::uint32_t channels,
                           std::size_t count) noexcept;
void addColorNoiseAvx2(const ColorNoise& noise, std::uint8_t* color, std::uint32_t channels,
                       std::size_t count) noexcept;

}  // namespace galactic::render
