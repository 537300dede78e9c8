#include "option_values.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

namespace galactic::bake {
namespace {

/// Beyond every length, factor and count that is meant.
constexpr double kMostNumber = 1e12;

}  // namespace

Result<std::vector<double>> parseNumbers(const std::string& text, const char* option) {
  std::vector<double> numbers;
  std::string_view rest = text;
  while (true) {
    const std::size_t comma = rest.find(',');
    const std::string_view part = rest.substr(0, comma);
    double number = 0;
    const auto [end, problem] = std::from_chars(part.data(), part.data() + part.size(), number);
    if (problem != std::errc() || end != part.data() + part.size() || !std::isfinite(number)) {
      return fail(
          ErrorCode::kInvalidInput, option,
          fmt::format("has \"{}\" in \"{}\", numbers separated by commas are wanted", part, text));
    }
    if (std::fabs(number) > kMostNumber) {
      return fail(ErrorCode::kInvalidInput, option,
                  fmt::format("has \"{}\" in \"{}\", numbers up to {:g} are wanted", part, text,
                              kMostNumber));
    }
    numbers.push_back(number);
    if (comma == std::string_view::npos) return numbers;
    rest.remove_prefix(comma + 1);
  }
}

Result<std::vector<double>> parseExactly(const std::string& text, const char* option,
                                         std::size_t count) {
  auto numbers = parseNumbers(text, option);
  if (numbers && numbers->size() != count) {
    return fail(
        ErrorCode::kInvalidInput, option,
        fmt::format("has {} numbers in \"{}\", {} are wanted", numbers->size(), text, count));
  }
  return numbers;
}

Result<double> parsePositive(const std::string& text, const char* option) {
  const auto number = parseExactly(text, option, 1);
  if (!number) return tl::unexpected(number.error());
  if ((*number)[0] > 0) return (*number)[0];
  return fail(ErrorCode::kInvalidInput, option,
              fmt::format("is {}, a number above 0 is wanted", text));
}

Result<UpAxis> parseUp(const std::string& text, const char* option) {
  const std::map<std::string, UpAxis> axes{{"x", UpAxis::kX},       {"y", UpAxis::kY},
                                           {"z", UpAxis::kZ},       {"-x", UpAxis::kMinusX},
                                           {"-y", UpAxis::kMinusY}, {"-z", UpAxis::kMinusZ}};
  const auto axis = axes.find(text);
  if (axis != axes.end()) return axis->second;
  return fail(ErrorCode::kInvalidInput, option,
              fmt::format("is \"{}\", one of x, y, z, -x, -y, -z is wanted", text));
}

Result<std::pair<std::string, std::string>> parsePair(const std::string& text, const char* option,
                                                      const char* wanted) {
  const std::size_t equals = text.find('=');
  if (equals != std::string::npos && equals > 0 && equals + 1 < text.size()) {
    return std::pair(text.substr(0, equals), text.substr(equals + 1));
  }
  return fail(ErrorCode::kInvalidInput, option,
              fmt::format("is \"{}\", {} is wanted", text, wanted));
}

std::string joined(const std::vector<std::string>& parts) {
  return fmt::format("{}", fmt::join(parts, ","));
}

Result<std::vector<std::string>> parseNames(const std::vector<std::string>& texts,
                                            const char* option) {
  std::vector<std::string> names;
  const std::string text = joined(texts);
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    if (end == begin) {
      return fail(
          ErrorCode::kInvalidInput, option,
          fmt::format("has an empty name in \"{}\", names separated by commas are wanted", text));
    }
    names.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return names;
}

std::vector<std::string> longNamesOf(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    const std::string& name = option->get_name();
    if (name.starts_with("--")) names.push_back(name);
  }
  return names;
}

}  // namespace galactic::bake
