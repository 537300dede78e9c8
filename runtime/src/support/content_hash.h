#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

namespace galactic::detail {

/// An XXH3-128 hash, as packs store it.
struct ContentHash {
  std::uint64_t low = 0;
  std::uint64_t high = 0;

  friend bool operator==(const ContentHash&, const ContentHash&) = default;
};

[[nodiscard]] ContentHash contentHash(std::span<const std::byte> bytes);

}  // namespace galactic::detail
