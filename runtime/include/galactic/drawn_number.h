#pragma once
#include <algorithm>
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

/// As options have it: "0.1", or of a range "0.1-0.5". Numbers read back exactly.
[[nodiscard]] std::string drawnText(const DrawnNumber& number);

/// None for what is no such text, or not allowed (isDrawnWithin).
[[nodiscard]] std::optional<DrawnNumber> drawnFrom(std::string_view text, const Span& within);

/// Whether it is a number, or the ends of a range, `within`. Numbers below 0 stand for something
/// else: no range has any.
[[nodiscard]] bool isDrawnWithin(const DrawnNumber& number, const Span& within);

/// What a text should be, for messages that refuse one.
[[nodiscard]] std::string wantedDrawn(const Span& within);

}  // namespace galactic
