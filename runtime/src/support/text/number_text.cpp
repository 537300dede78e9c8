#include "support/text/number_text.h"

#include <fmt/format.h>

#include <charconv>
#include <system_error>

namespace galactic {
namespace {

std::string_view shown(std::string_view text) { return text.empty() ? "nothing" : text; }

template <class Number>
bool isWithin(std::string_view text, Number least, Number most) {
  Number value{};
  const char* end = text.data() + text.size();
  const auto [stop, problem] = std::from_chars(text.data(), end, value);
  // Every comparison is false for NaN.
  return problem == std::errc() && stop == end && value >= least && value <= most;
}

/// A limit that is stored in single precision reads as it was written in the source.
std::string limitText(double limit) {
  const auto single = static_cast<float>(limit);
  return static_cast<double>(single) == limit ? fmt::format("{}", single)
                                              : fmt::format("{}", limit);
}

}  // namespace

std::string numberFault(std::string_view text, double least, double most) {
  if (isWithin(text, least, most)) return {};
  return fmt::format("found {}, expected a number from {} to {}", shown(text), limitText(least),
                     limitText(most));
}

std::string wholeFault(std::string_view text, std::uint64_t least, std::uint64_t most) {
  const bool has_leading_zero = text.size() > 1 && text.front() == '0';
  if (!has_leading_zero && isWithin(text, least, most)) return {};
  return fmt::format("found {}, expected a whole number from {} to {}", shown(text), least, most);
}

TextCheck numberCheck(double least, double most) {
  return [=](const std::string& text) { return numberFault(text, least, most); };
}

TextCheck wholeCheck(std::uint64_t least, std::uint64_t most) {
  return [=](const std::string& text) { return wholeFault(text, least, most); };
}

TextCheck switchCheck() {
  return [](const std::string& text) {
    if (text == "true" || text == "false") return std::string();
    return fmt::format("found \"{}\", expected nothing, =true or =false", text);
  };
}

}  // namespace galactic
