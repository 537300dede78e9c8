#include "support/height_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <system_error>

#include "galactic/simulation_options.h"

namespace galactic {
namespace {

constexpr std::string_view kOfRobotText = "robot";

/// Takes a number from the beginning of `text`.
std::optional<float> takeNumber(std::string_view& text) {
  float value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, problem] = std::from_chars(text.data(), end, value);
  if (problem != std::errc()) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(stop - text.data()));
  return value;
}

bool takeLetter(std::string_view& text, char letter) {
  if (!text.starts_with(letter)) return false;
  text.remove_prefix(1);
  return true;
}

std::optional<Span> takeSpan(std::string_view& text) {
  const std::optional<float> lo = takeNumber(text);
  if (!lo) return std::nullopt;
  if (!takeLetter(text, '-')) return Span{*lo, *lo};
  const std::optional<float> hi = takeNumber(text);
  if (!hi) return std::nullopt;
  return Span{*lo, *hi};
}

}  // namespace

std::string heightText(std::span<const Span> heights) {
  if (heights.empty()) return std::string(kOfRobotText);
  std::string text;
  for (const Span& one : heights) {
    if (!text.empty()) text += ',';
    text += one.lo == one.hi ? fmt::format("{}", one.lo) : fmt::format("{}-{}", one.lo, one.hi);
  }
  return text;
}

std::optional<std::vector<Span>> heightsFrom(std::string_view text, const Span& within) {
  std::vector<Span> heights;
  if (text == kOfRobotText) return heights;
  do {
    const std::optional<Span> one = takeSpan(text);
    if (!one) return std::nullopt;
    heights.push_back(*one);
  } while (takeLetter(text, ','));
  if (!text.empty() || !areHeights(heights, within)) return std::nullopt;
  return heights;
}

bool areHeights(std::span<const Span> heights, const Span& within) {
  // Whatever is not a number is not within.
  return heights.size() <= kMostLaserHeights && std::ranges::all_of(heights, [&](const Span& one) {
           return one.lo >= within.lo && one.lo <= one.hi && one.hi <= within.hi;
         });
}

std::string wantedHeights(const Span& within) {
  return fmt::format(
      "{}, or up to {} heights from {} to {} separated by commas, or ranges of them, such as "
      "0.25,0.4-0.75",
      kOfRobotText, kMostLaserHeights, within.lo, within.hi);
}

}  // namespace galactic
