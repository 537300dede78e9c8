#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "galactic/drawn_number.h"
#include "galactic/pose.h"

namespace galactic {

// Ranges as options have them: LOW-HIGH, such as "0.4-0.75", or a single number.

/// Numbers read back exactly.
[[nodiscard]] std::string rangeText(const Span& range);

/// Takes a range from the beginning of `text`; none where there is no number.
[[nodiscard]] std::optional<Span> takeRange(std::string_view& text);

/// The same of a number that episodes may draw.
[[nodiscard]] std::string drawnText(const DrawnNumber& number);

/// None for what is no such text, or not allowed (isDrawnWithin).
[[nodiscard]] std::optional<DrawnNumber> drawnFrom(std::string_view text, const Span& within);

/// Whether it is a number, or the ends of a range, `within`. Numbers below 0 stand for something
/// else: no range has any.
[[nodiscard]] bool isDrawnWithin(const DrawnNumber& number, const Span& within);

/// What a text should be, for messages that refuse one.
[[nodiscard]] std::string wantedDrawn(const Span& within);

}  // namespace galactic
