#pragma once
#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "galactic/pose.h"

namespace galactic {

/// A number that is the same in all episodes, or a range from which each episode of each env draws
/// its own number, uniformly, so that a policy meets many different robots (domain randomization).
struct DrawnNumber {
  float least = 0;
  float most = 0;

  constexpr DrawnNumber() = default;
  // NOLINTNEXTLINE(google-explicit-constructor): a number is the range that has nothing else in it.
  constexpr DrawnNumber(float only) : least(only), most(only) {}
  constexpr DrawnNumber(float lowest, float highest) : least(lowest), most(highest) {}

  /// Whether the number may differ between episodes.
  [[nodiscard]] constexpr bool isRange() const { return least != most; }
  /// The number that an episode draws; `luck` is from 0 to 1.
  [[nodiscard]] constexpr float at(float luck) const {
    return std::min(least + (most - least) * luck, most);
  }

  friend constexpr bool operator==(const DrawnNumber&, const DrawnNumber&) = default;
};

/// The same for a whole number.
struct DrawnCount {
  std::uint32_t least = 0;
  std::uint32_t most = 0;

  constexpr DrawnCount() = default;
  // NOLINTNEXTLINE(google-explicit-constructor): a number is the range that has nothing else in it.
  constexpr DrawnCount(std::uint32_t only) : least(only), most(only) {}
  constexpr DrawnCount(std::uint32_t lowest, std::uint32_t highest)
      : least(lowest), most(highest) {}

  /// Whether the number may differ between episodes.
  [[nodiscard]] constexpr bool isRange() const { return least != most; }
  /// The number that an episode draws; `luck` is from 0 to 1.
  [[nodiscard]] constexpr std::uint32_t at(float luck) const {
    const std::uint32_t above = most - least;
    return least +
           std::min(static_cast<std::uint32_t>(luck * static_cast<float>(above + 1)), above);
  }

  friend constexpr bool operator==(const DrawnCount&, const DrawnCount&) = default;
};

/// The number as options have it: "0.1", or "0.1-0.5" for a range. Numbers read back exactly.
[[nodiscard]] std::string drawnText(const DrawnNumber& number);

/// Reads such a text. None if it is malformed or not allowed (isDrawnWithin).
[[nodiscard]] std::optional<DrawnNumber> drawnFrom(std::string_view text, const Span& within);

/// Whether the number, or both ends of the range, are `within`. Numbers below 0 have special
/// meanings, so no range may contain any.
[[nodiscard]] bool isDrawnWithin(const DrawnNumber& number, const Span& within);

/// What a text should look like, for messages that refuse one.
[[nodiscard]] std::string wantedDrawn(const Span& within);

// The same for whole numbers from 0 to `most`.
[[nodiscard]] std::string drawnText(const DrawnCount& count);
[[nodiscard]] std::optional<DrawnCount> drawnFrom(std::string_view text, std::uint32_t most);
[[nodiscard]] bool isDrawnWithin(const DrawnCount& count, std::uint32_t most);
[[nodiscard]] std::string wantedDrawn(std::uint32_t most);

}  // namespace galactic
