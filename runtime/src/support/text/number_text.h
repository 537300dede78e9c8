#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace galactic {

// What programs accept as a number on their command lines, in recipes and in option files: the
// whole text, without blanks, NaN or infinity; for a whole number only digits, so that "-1" does
// not become a huge number, nor "010" an octal one.

/// Why `text` is not a number from `least` to `most`; empty if it is one.
[[nodiscard]] std::string numberFault(std::string_view text, double least, double most);

/// The same for whole numbers.
[[nodiscard]] std::string wholeFault(std::string_view text, std::uint64_t least,
                                     std::uint64_t most);

/// The same as option checks for command-line parsers.
using TextCheck = std::function<std::string(const std::string& text)>;
[[nodiscard]] TextCheck numberCheck(double least, double most);
[[nodiscard]] TextCheck wholeCheck(std::uint64_t least, std::uint64_t most);
/// The same for switches, which may be given as --NAME=true and --NAME=false: parsers would also
/// accept numbers.
[[nodiscard]] TextCheck switchCheck();

}  // namespace galactic
