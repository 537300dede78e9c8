// Noise of images, eight pixels at a time.
#include "render/noise/noise_kernels.h"
#include "render/raster/lanes_eight.inl"

namespace galactic::render {
namespace {

/// Every bit of the input decides every bit of the output (Wellons 2018, "lowbias32").
inline WordLanes mixed(WordLanes x) {
  x ^= x >> 16;
  x *= 0x7FEB352DU;
  x ^= x >> 15;
  x *= 0x846CA68BU;
  return x ^ x >> 16;
}

/// The first random words of the pixel with this number and of the seven after it.
inline WordLanes firstWords(const PixelKey& key, std::size_t pixel) {
  const WordLanes numbers{0, 1, 2, 3, 4, 5, 6, 7};
  return mixed(numbers + (key.words[0] + static_cast<std::uint32_t>(pixel)));
}

/// The sum of four uniform numbers, scaled to mean 0 and deviation 1: within 1 % of the normal
/// distribution, and never further out than 3.5 deviations. The numbers have 16 bits each and come
/// from two words.
inline Lanes nearlyNormal(WordLanes a, WordLanes b) {
  // 65536 / sqrt(3).
  constexpr float kInverseDeviation = 1.0F / 37837.228F;
  const WordLanes sum = (a & 0xFFFFU) + (a >> 16) + (b & 0xFFFFU) + (b >> 16);
  return toFloat(as<IntLanes>(sum) - 2 * 0xFFFF) * spread(kInverseDeviation);
}

/// The same from numbers of 8 bits, in one word: fine enough for results that are rounded to
/// levels.
inline Lanes nearlyNormal(WordLanes a) {
  // sqrt((256^2 - 1) / 3).
  constexpr float kInverseDeviation = 1.0F / 147.80054F;
  const WordLanes pairs = (a & 0x00FF00FFU) + (a >> 8 & 0x00FF00FFU);
  const WordLanes sum = (pairs & 0xFFFFU) + (pairs >> 16);
  return toFloat(as<IntLanes>(sum) - 2 * 0xFF) * spread(kInverseDeviation);
}

inline Lanes noisyDepth(const DepthNoise& noise, Lanes depth, std::size_t pixel) {
  const WordLanes first = firstWords(noise.key, pixel);
  const Lanes normal =
      nearlyNormal(mixed(first ^ noise.key.words[1]), mixed(first ^ noise.key.words[2]));
  const Lanes moved = depth + depth * depth * spread(noise.deviation) * normal;
  const auto lot = as<IntLanes>(mixed(first ^ noise.key.words[3]) >> 8);
  const IntLanes is_seen = (depth > spread(0.0F)) & (lot >= spread(noise.dropped));
  return pick(is_seen, greater(moved, lesser(depth, spread(noise.near))), spread(0.0F));
}

inline void addDepthNoise(const DepthNoise& noise, float* depth, std::size_t count) {
  std::size_t n = 0;
  for (; n + kLanes <= count; n += kLanes) {
    store(depth + n, noisyDepth(noise, load<Lanes>(depth + n), n));
  }
  if (n == count) return;
  float rest[kLanes] = {};
  __builtin_memcpy(rest, depth + n, (count - n) * sizeof(float));
  store(rest, noisyDepth(noise, load<Lanes>(rest), n));
  __builtin_memcpy(depth + n, rest, (count - n) * sizeof(float));
}

/// Adds noise to the colors in the three lower bytes of each word; the highest byte stays as it is.
inline WordLanes noisyColor(const ColorNoise& noise, WordLanes color, std::size_t pixel) {
  const WordLanes first = firstWords(noise.key, pixel);
  WordLanes result = color & 0xFF000000U;
  for (std::uint32_t channel = 0; channel < 3; ++channel) {
    Lanes level = toFloat(as<IntLanes>(color >> (8 * channel) & 0xFFU)) * spread(noise.gain);
    const Lanes normal = nearlyNormal(mixed(first ^ noise.key.words[1 + channel]));
    level += spread(noise.deviation) * normal;
    const IntLanes rounded = toInt(clampTo(level + spread(0.5F), 0, 255));
    result |= as<WordLanes>(rounded) << (8 * channel);
  }
  return result;
}

/// Adds noise to eight pixels. It also writes the byte after the last one, which stays as it is.
inline void addToBlock(const ColorNoise& noise, std::uint8_t* color, std::uint32_t channels,
                       std::size_t pixel) {
  const auto word = [&](std::uint32_t n) {
    return load<std::uint32_t>(color + std::size_t{channels} * n);
  };
  const WordLanes before{word(0), word(1), word(2), word(3), word(4), word(5), word(6), word(7)};
  const WordLanes words = noisyColor(noise, before, pixel);
  // The order matters: with three channels, the highest byte of a word is the first of the next
  // pixel.
  for (std::uint32_t n = 0; n < kLanes; ++n) {
    store(color + std::size_t{channels} * n, words[n]);
  }
}

inline void addColorNoise(const ColorNoise& noise, std::uint8_t* color, std::uint32_t channels,
                          std::size_t count) {
  std::size_t n = 0;
  // Only the last block may have no byte after it.
  for (; n + kLanes < count; n += kLanes) addToBlock(noise, color + channels * n, channels, n);
  std::uint8_t rest[4 * kLanes + 1] = {};
  __builtin_memcpy(rest, color + channels * n, (count - n) * channels);
  addToBlock(noise, rest, channels, n);
  __builtin_memcpy(color + channels * n, rest, (count - n) * channels);
}

}  // namespace
}  // namespace galactic::render
