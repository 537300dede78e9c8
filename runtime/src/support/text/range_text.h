#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "galactic/drawn_number.h"
#include "galactic/pose.h"

namespace galactic {

// Ranges as the text of an option: LOW-HIGH, such as "0.4-0.75", or a single number. Ranges that
// episodes draw from are DrawnNumbers.

/// Numbers read back exactly.
[[nodiscard]] std::string rangeText(const Span& range);

/// Takes a range from the beginning of `text`; none if no number is there.
[[nodiscard]] std::optional<Span> takeRange(std::string_view& text);

}  // namespace galactic
