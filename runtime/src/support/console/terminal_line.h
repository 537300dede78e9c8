#pragma once
#include <string>

namespace galactic {

/// As much of `text` as fits on one line of the terminal that the descriptor `file` leads to: a
/// longer line could not be overwritten and would leave its beginning behind. The whole text if the
/// width is unknown. Characters beyond ASCII are kept or dropped whole.
[[nodiscard]] std::string fittingLine(std::string text, int file);

}  // namespace galactic
