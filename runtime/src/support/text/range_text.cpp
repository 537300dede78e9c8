#include "support/text/range_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <system_error>

namespace galactic {
namespace {

/// Takes a number from the beginning of `text`.
template <class T = float>
std::optional<T> takeNumber(std::string_view& text) {
  T value{};
  const char* end = text.data() + text.size();
  const auto [stop, problem] = std::from_chars(text.data(), end, value);
  if (problem != std::errc()) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(stop - text.data()));
  return value;
}

}  // namespace

std::string rangeText(const Span& range) {
  return range.lo == range.hi ? fmt::format("{}", range.lo)
                              : fmt::format("{}-{}", range.lo, range.hi);
}

std::optional<Span> takeRange(std::string_view& text) {
  const std::optional<float> lo = takeNumber(text);
  if (!lo || !text.starts_with('-')) return lo ? std::optional(Span{*lo, *lo}) : std::nullopt;
  text.remove_prefix(1);
  const std::optional<float> hi = takeNumber(text);
  if (!hi) return std::nullopt;
  return Span{*lo, *hi};
}

std::string drawnText(const DrawnNumber& number) { return rangeText({number.least, number.most}); }

std::optional<DrawnNumber> drawnFrom(std::string_view text, const Span& within) {
  const std::optional<Span> range = takeRange(text);
  if (!range || !text.empty()) return std::nullopt;
  const DrawnNumber number{range->lo, range->hi};
  return isDrawnWithin(number, within) ? std::optional(number) : std::nullopt;
}

bool isDrawnWithin(const DrawnNumber& number, const Span& within) {
  const float least = number.isRange() ? std::max(within.lo, 0.0F) : within.lo;
  // Written so that NaN is not within.
  return number.least >= least && number.least <= number.most && number.most <= within.hi;
}

std::string wantedDrawn(const Span& within) {
  return fmt::format("{} to {}, or a range from {} to {} such as 0.1-0.3", within.lo, within.hi,
                     std::max(within.lo, 0.0F), within.hi);
}

std::string drawnText(const DrawnCount& count) {
  return count.isRange() ? fmt::format("{}-{}", count.least, count.most)
                         : fmt::format("{}", count.least);
}

std::optional<DrawnCount> drawnFrom(std::string_view text, std::uint32_t most) {
  const std::optional<std::uint32_t> lowest = takeNumber<std::uint32_t>(text);
  std::optional<std::uint32_t> highest = lowest;
  if (lowest && text.starts_with('-')) {
    text.remove_prefix(1);
    highest = takeNumber<std::uint32_t>(text);
  }
  if (!lowest || !highest || !text.empty()) return std::nullopt;
  const DrawnCount count{*lowest, *highest};
  return isDrawnWithin(count, most) ? std::optional(count) : std::nullopt;
}

bool isDrawnWithin(const DrawnCount& count, std::uint32_t most) {
  return count.least <= count.most && count.most <= most;
}

std::string wantedDrawn(std::uint32_t most) {
  return fmt::format("a whole number from 0 to {}, or a range of them such as 0-2", most);
}

}  // namespace galactic
