#pragma once
#include <algorithm>

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

}  // namespace galactic
