#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace galactic::detail {

/// An XXH3-128 hash, as packs store it.
struct ContentHash {
  std::uint64_t low = 0;
  std::uint64_t high = 0;

  friend bool operator==(const ContentHash&, const ContentHash&) = default;
};

/// 32 hexadecimal digits, the high half first.
[[nodiscard]] std::string hexOf(const ContentHash& hash);

[[nodiscard]] ContentHash contentHash(std::span<const std::byte> bytes);

}  // namespace galactic::detail
