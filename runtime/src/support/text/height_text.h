#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "galactic/pose.h"

namespace galactic {

// Heights as one option has them: separated by commas, each a height or a range of heights, such as
// "0.25,0.4-0.75". "robot" stands for those of the robot's recipe.

/// Numbers read back exactly. No heights are the robot's.
[[nodiscard]] std::string heightText(std::span<const Span> heights);

/// None for what is no such text, or has more than kMostLaserHeights heights, or one outside of
/// `within`.
[[nodiscard]] std::optional<std::vector<Span>> heightsFrom(std::string_view text,
                                                           const Span& within);

/// Whether heights are such as heightsFrom() returns.
[[nodiscard]] bool areHeights(std::span<const Span> heights, const Span& within);

/// What a text should be, for messages that refuse one.
[[nodiscard]] std::string wantedHeights(const Span& within);

}  // namespace galactic
