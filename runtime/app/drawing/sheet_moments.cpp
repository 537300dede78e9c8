#include "drawing/sheet_moments.h"

#include <algorithm>
#include <utility>

namespace galactic {
namespace {

/// The `n`th of `count` numbers, evenly spread from 0 to `last`.
std::uint64_t spread(std::uint64_t last, std::size_t n, std::size_t count) {
  const std::uint64_t gaps = std::max<std::uint64_t>(count - 1, 1);
  return (n * last + gaps / 2) / gaps;
}

std::uint64_t distance(std::uint64_t a, std::uint64_t b) { return a < b ? b - a : a - b; }

}  // namespace

SheetMoments::SheetMoments(std::uint64_t steps, std::uint64_t every) : stride_(every) {
  const std::uint64_t last = steps / every;
  const std::size_t rows = std::min<std::uint64_t>(last + 1, kMost);
  for (std::size_t row = 0; row < rows; ++row) planned_.insert(spread(last, row, rows) * every);
  const bool ends_between = steps % every != 0;
  planned_count_ = std::min(kMost, rows + (ends_between ? 1 : 0));
}

bool SheetMoments::wants(std::uint64_t step) const {
  return step % stride_ == 0 || planned_.contains(step);
}

void SheetMoments::add(Moment moment) {
  held_.push_back(std::move(moment));
  const auto at_stride =
      std::ranges::count_if(held_, [this](const Moment& one) { return one.step % stride_ == 0; });
  if (static_cast<std::size_t>(at_stride) > kMostAtStride) thinOut();
}

std::vector<SheetMoments::Moment> SheetMoments::take() {
  if (held_.size() <= kMost) return std::move(held_);
  const std::uint64_t last = held_.back().step;
  std::vector<Moment> moments;
  auto next = held_.begin();
  for (std::size_t row = 0; row < kMost; ++row) {
    const std::uint64_t wanted = spread(last, row, kMost);
    // Leaves enough moments for the rows below.
    const auto end = held_.end() - static_cast<std::ptrdiff_t>(kMost - 1 - row);
    next = std::min_element(next, end, [wanted](const Moment& a, const Moment& b) {
      return distance(a.step, wanted) < distance(b.step, wanted);
    });
    moments.push_back(std::move(*next++));
  }
  return moments;
}

void SheetMoments::thinOut() {
  stride_ *= 2;
  std::erase_if(held_, [this](const Moment& one) { return !wants(one.step); });
}

}  // namespace galactic
