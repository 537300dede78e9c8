#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "galactic/pose.h"

namespace galactic {

// Heights as the text of an option: separated by commas, each a height or a range of heights, such
// as "0.25,0.4-0.75". "robot" stands for the heights of the robot's recipe.

/// Numbers read back exactly. No heights become "robot".
[[nodiscard]] std::string heightText(std::span<const Span> heights);

/// None if the text is malformed, has more than kMostLaserHeights heights, or one outside of
/// `within`.
[[nodiscard]] std::optional<std::vector<Span>> heightsFrom(std::string_view text,
                                                           const Span& within);

/// Whether heightsFrom() could return these heights.
[[nodiscard]] bool areHeights(std::span<const Span> heights, const Span& within);

/// What the text should be, for messages that refuse one.
[[nodiscard]] std::string wantedHeights(const Span& within);

}  // namespace galactic
