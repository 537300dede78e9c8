#pragma once
#include <cstdint>

namespace galactic {

/// The finalizer of SplitMix64 (Steele, Lea, Flood 2014): every bit of the input decides every bit
/// of the output.
[[nodiscard]] constexpr std::uint64_t mix(std::uint64_t z) {
  z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27U)) * 0x94D049BB133111EBULL;
  return z ^ (z >> 31U);
}

/// A stream of random numbers that its purpose fully determines, so that an env's numbers depend
/// neither on other envs nor on the order in which envs are stepped.
class RandomStream {
 public:
  /// `episode` counts the episodes that the env has begun; `step` counts the steps in the episode.
  RandomStream(std::uint64_t seed, std::uint32_t env, std::uint64_t episode, std::uint32_t step)
      : state_(mix(mix(mix(mix(seed + kGamma) ^ env) ^ episode) ^ step)) {}

  [[nodiscard]] std::uint64_t next() {
    state_ += kGamma;
    return mix(state_);
  }

  /// Uniform in [0, 1), a multiple of 2^-24.
  [[nodiscard]] float unit() { return static_cast<float>(next() >> 40U) * 0x1p-24F; }

  /// The sum of four uniform numbers, with mean 0 and deviation 1: within 1 % of the normal
  /// distribution, and never farther out than 3.5 deviations.
  [[nodiscard]] float nearlyNormal() {
    constexpr std::uint64_t kPart = 0xffff;
    // 65536 / sqrt(3).
    constexpr float kInverseDeviation = 1.0F / 37837.228F;
    const std::uint64_t bits = next();
    std::int64_t sum = -2 * static_cast<std::int64_t>(kPart);
    for (unsigned n = 0; n < 4; ++n) sum += static_cast<std::int64_t>((bits >> (16 * n)) & kPart);
    return static_cast<float>(sum) * kInverseDeviation;
  }

 private:
  static constexpr std::uint64_t kGamma = 0x9E3779B97F4A7C15ULL;

  std::uint64_t state_;
};

}  // namespace galactic
