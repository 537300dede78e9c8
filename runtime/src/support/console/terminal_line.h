#pragma once
#include <string>

namespace galactic {

/// As much of a line of text as fits on one of the terminal that the descriptor `file` leads to: a
/// longer one could not be written over, and would leave its beginning behind. All of it where the
/// width is not known. Letters beyond ASCII are kept or left out whole.
[[nodiscard]] std::string fittingLine(std::string text, int file);

}  // namespace galactic
