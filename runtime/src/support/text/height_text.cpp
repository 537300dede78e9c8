#include "support/text/height_text.h"

#include <fmt/format.h>

#include <algorithm>

#include "galactic/simulation_options.h"
#include "support/text/range_text.h"

namespace galactic {
namespace {

constexpr std::string_view kOfRobotText = "robot";

bool takeComma(std::string_view& text) {
  if (!text.starts_with(',')) return false;
  text.remove_prefix(1);
  return true;
}

}  // namespace

std::string heightText(std::span<const Span> heights) {
  if (heights.empty()) return std::string(kOfRobotText);
  std::string text;
  for (const Span& one : heights) {
    if (!text.empty()) text += ',';
    text += rangeText(one);
  }
  return text;
}

std::optional<std::vector<Span>> heightsFrom(std::string_view text, const Span& within) {
  std::vector<Span> heights;
  if (text == kOfRobotText) return heights;
  do {
    const std::optional<Span> one = takeRange(text);
    if (!one) return std::nullopt;
    heights.push_back(*one);
  } while (takeComma(text));
  if (!text.empty() || !areHeights(heights, within)) return std::nullopt;
  return heights;
}

bool areHeights(std::span<const Span> heights, const Span& within) {
  // Written so that NaN is not within.
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
