#pragma once
#include <cstdint>

namespace galactic {

/// The lowest 21 bits of `value`, each followed by two zeros (Morton 1966).
constexpr std::uint64_t spreadBits(std::uint64_t value) {
  value &= 0x1FFFFFU;
  value = (value | value << 32U) & 0x1F00000000FFFFU;
  value = (value | value << 16U) & 0x1F0000FF0000FFU;
  value = (value | value << 8U) & 0x100F00F00F00F00FU;
  value = (value | value << 4U) & 0x10C30C30C30C30C3U;
  value = (value | value << 2U) & 0x1249249249249249U;
  return value;
}

/// The position of a cube, whose coordinates are below 2^21, along a curve that keeps neighbors
/// close.
constexpr std::uint64_t mortonPlace(std::uint64_t x, std::uint64_t y, std::uint64_t z) {
  return spreadBits(x) | spreadBits(y) << 1U | spreadBits(z) << 2U;
}

}  // namespace galactic
