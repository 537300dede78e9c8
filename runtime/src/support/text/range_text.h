#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "galactic/drawn_number.h"
#include "galactic/pose.h"

namespace galactic {

// Ranges as options have them: LOW-HIGH, such as "0.4-0.75", or a single number. Those that
// episodes draw from are DrawnNumbers.

/// Numbers read back exactly.
[[nodiscard]] std::string rangeText(const Span& range);

/// Takes a range from the beginning of `text`; none where there is no number.
[[nodiscard]] std::optional<Span> takeRange(std::string_view& text);

}  // namespace galactic
