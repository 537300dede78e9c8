#pragma once
#include <string>
#include <string_view>

namespace galactic {

/// `text` with control characters replaced by '?': names in files come from strangers and must not
/// steer the terminal.
[[nodiscard]] std::string printable(std::string_view text);

}  // namespace galactic
