#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

namespace galactic::simulation {

// One bit for each sphere of a batch, in words of 64.

inline constexpr std::size_t kBitsPerWord = 64;

[[nodiscard]] constexpr std::size_t wordsFor(std::size_t spheres) {
  return (spheres + kBitsPerWord - 1) / kBitsPerWord;
}

[[nodiscard]] inline bool hasBit(std::span<const std::uint64_t> bits, std::size_t sphere) {
  return (bits[sphere / kBitsPerWord] >> (sphere % kBitsPerWord) & 1U) != 0;
}

inline void setBit(std::span<std::uint64_t> bits, std::size_t sphere) {
  bits[sphere / kBitsPerWord] |= std::uint64_t{1} << (sphere % kBitsPerWord);
}

[[nodiscard]] inline bool isEmpty(std::span<const std::uint64_t> bits) {
  return std::ranges::all_of(bits, [](std::uint64_t word) { return word == 0; });
}

/// Spheres that do not count: those of a held object that penetrated something already when it was
/// grasped (its spheres reach further than the box that represented it at rest), until they are
/// free. If empty, all spheres count.
using IgnoredSpheres = std::span<const std::uint64_t>;

[[nodiscard]] inline bool isIgnored(IgnoredSpheres ignored, std::size_t sphere) {
  return !ignored.empty() && hasBit(ignored, sphere);
}

/// Whether any bit is set that is not ignored.
[[nodiscard]] inline bool anyCounts(std::span<const std::uint64_t> bits, IgnoredSpheres ignored) {
  std::uint64_t any = 0;
  for (std::size_t w = 0; w < bits.size(); ++w) any |= bits[w] & ~ignored[w];
  return any != 0;
}

/// Stops ignoring the spheres that are free now, whose bit is not set. Returns whether any sphere
/// is still ignored.
inline bool keepPenetrating(std::span<std::uint64_t> ignored, std::span<const std::uint64_t> bits) {
  std::uint64_t any = 0;
  for (std::size_t w = 0; w < ignored.size(); ++w) {
    ignored[w] &= bits[w];
    any |= ignored[w];
  }
  return any != 0;
}

}  // namespace galactic::simulation
