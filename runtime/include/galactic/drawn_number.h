#pragma once
#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "galactic/pose.h"

namespace galactic {

/// A number that is the same in all episodes, or a range from which each episode of each env draws
/// its own, all of it as likely: so that a policy meets many robots (domain randomization).
struct DrawnNumber {
  float least = 0;
  float most = 0;

  constexpr DrawnNumber() = default;
  // NOLINTNEXTLINE(google-explicit-constructor): a number is the range that has nothing else in it.
  constexpr DrawnNumber(float only) : least(only), most(only) {}
  constexpr DrawnNumber(float lowest, float highest) : least(lowest), most(highest) {}

  /// Whether episodes differ in it.
  [[nodiscard]] constexpr bool isRange() const { return least != most; }
  /// What an episode draws; `luck` from 0 to 1.
  [[nodiscard]] constexpr float at(float luck) const {
    return std::min(least + (most - least) * luck, most);
  }

  friend constexpr bool operator==(const DrawnNumber&, const DrawnNumber&) = default;
};

/// The same of a whole number.
struct DrawnCount {
  std::uint32_t least = 0;
  std::uint32_t most = 0;

  constexpr DrawnCount() = default;
  // NOLINTNEXTLINE(google-explicit-constructor): a number is the range that has nothing else in it.
  constexpr DrawnCount(std::uint32_t only) : least(only), most(only) {}
  constexpr DrawnCount(std::uint32_t lowest, std::uint32_t highest)
      : least(lowest), most(highest) {}

  /// Whether episodes differ in it.
  [[nodiscard]] constexpr bool isRange() const { return least != most; }
  /// What an episode draws; `luck` from 0 to 1.
  [[nodiscard]] constexpr std::uint32_t at(float luck) const {
    const std::uint32_t above = most - least;
    return least +
           std::min(static_cast<std::uint32_t>(luck * static_cast<float>(above + 1)), above);
  }

  friend constexpr bool operator==(const DrawnCount&, const DrawnCount&) = default;
};

/// As options have it: "0.1", or of a range "0.1-0.5". Numbers read back exactly.
[[nodiscard]] std::string drawnText(const DrawnNumber& number);

/// None for what is no such text, or not allowed (isDrawnWithin).
[[nodiscard]] std::optional<DrawnNumber> drawnFrom(std::string_view text, const Span& within);

/// Whether it is a number, or the ends of a range, `within`. Numbers below 0 stand for something
/// else: no range has any.
[[nodiscard]] bool isDrawnWithin(const DrawnNumber& number, const Span& within);

/// What a text should be, for messages that refuse one.
[[nodiscard]] std::string wantedDrawn(const Span& within);

// The same of whole numbers from 0 to `most`.
[[nodiscard]] std::string drawnText(const DrawnCount& count);
[[nodiscard]] std::optional<DrawnCount> drawnFrom(std::string_view text, std::uint32_t most);
[[nodiscard]] bool isDrawnWithin(const DrawnCount& count, std::uint32_t most);
[[nodiscard]] std::string wantedDrawn(std::uint32_t most);

}  // namespace galactic
