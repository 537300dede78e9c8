#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace galactic {

// What programs take for a number on their command lines, in recipes and in files of options: the
// whole text, no blank, no NaN, no infinity; of a whole number digits alone, so that "-1" does not
// become a huge number, nor "010" an octal one.

/// Why `text` is no number from `least` to `most`; empty: it is.
[[nodiscard]] std::string numberFault(std::string_view text, double least, double most);

/// The same of whole numbers.
[[nodiscard]] std::string wholeFault(std::string_view text, std::uint64_t least,
                                     std::uint64_t most);

/// The same as checks of options, for parsers of command lines.
using TextCheck = std::function<std::string(const std::string& text)>;
[[nodiscard]] TextCheck numberCheck(double least, double most);
[[nodiscard]] TextCheck wholeCheck(std::uint64_t least, std::uint64_t most);
/// The same of switches, which may be given as --NAME=true and --NAME=false: parsers would take
/// numbers, too.
[[nodiscard]] TextCheck switchCheck();

}  // namespace galactic
