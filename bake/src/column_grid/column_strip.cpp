#include "column_grid/column_strip.h"

#include <algorithm>
#include <iterator>
#include <limits>

namespace galactic::bake {
namespace {

constexpr float kEmptyLo = std::numeric_limits<float>::max();
constexpr float kEmptyHi = std::numeric_limits<float>::lowest();
/// The values of head_ for a column without a list, and for one whose intervals are in tall_.
constexpr std::int32_t kNone = -1;
constexpr std::int32_t kTall = -2;
/// Longest list that is searched linearly. Rooms have shorter lists; with 200,000 things above one
/// another, the time would grow with the square of their number.
constexpr unsigned kMostWalked = 32;

/// Removes the intervals that overlap `added` from disjoint `intervals`, and returns them and
/// `added` merged into one.
BlockedInterval takeJoined(std::map<float, float>& intervals, BlockedInterval added) {
  auto first = intervals.lower_bound(added.lo);
  while (first != intervals.begin() && std::prev(first)->second >= added.lo) --first;
  auto end = first;
  for (; end != intervals.end() && end->first <= added.hi; ++end) {
    added.lo = std::min(added.lo, end->first);
    added.hi = std::max(added.hi, end->second);
  }
  intervals.erase(first, end);
  return added;
}

void put(std::map<float, float>& intervals, BlockedInterval added) {
  const BlockedInterval joined = takeJoined(intervals, added);
  intervals.emplace(joined.lo, joined.hi);
}

}  // namespace

ColumnStrip::ColumnStrip(const GridFrame& frame, std::uint32_t first_row, std::uint32_t end_row)
    : frame_(frame),
      first_row_(first_row),
      end_row_(end_row),
      stride_(frame.columns_x + kPadding),
      lo_(stride_ * (end_row - first_row), kEmptyLo),
      hi_(stride_ * (end_row - first_row), kEmptyHi),
      head_(stride_ * (end_row - first_row), kNone) {}

void ColumnStrip::spill(std::uint32_t row, std::uint32_t column, float lo, float hi) {
  const std::size_t at = rowStart(row) + column;
  if (head_[at] == kTall) {
    spillTall(at, {lo, hi});
    return;
  }
  unsigned walked = 0;
  for (std::int32_t index = head_[at]; index >= 0; ++walked) {
    Node& node = nodes_[static_cast<std::size_t>(index)];
    if (lo <= node.hi && hi >= node.lo) {
      const float merged_lo = std::min(lo, node.lo);
      const float merged_hi = std::max(hi, node.hi);
      node.lo = lo_[at];
      node.hi = hi_[at];
      lo_[at] = merged_lo;
      hi_[at] = merged_hi;
      return;
    }
    index = node.next;
  }
  if (walked >= kMostWalked) {
    makeTall(at);
    spillTall(at, {lo, hi});
    return;
  }
  nodes_.push_back({lo_[at], hi_[at], head_[at]});
  head_[at] = static_cast<std::int32_t>(nodes_.size() - 1);
  lo_[at] = lo;
  hi_[at] = hi;
}

void ColumnStrip::makeTall(std::size_t at) {
  std::map<float, float>& intervals = tall_[at];
  for (std::int32_t index = head_[at]; index >= 0;) {
    const Node& node = nodes_[static_cast<std::size_t>(index)];
    put(intervals, {node.lo, node.hi});
    index = node.next;
  }
  head_[at] = kTall;
}

void ColumnStrip::spillTall(std::size_t at, BlockedInterval added) {
  std::map<float, float>& intervals = tall_[at];
  put(intervals, {lo_[at], hi_[at]});
  const BlockedInterval joined = takeJoined(intervals, added);
  lo_[at] = joined.lo;
  hi_[at] = joined.hi;
}

void ColumnStrip::add(std::uint32_t row, std::uint32_t column, float lo, float hi) {
  const std::size_t at = rowStart(row) + column;
  const bool empty = lo_[at] > hi_[at];
  if (!empty && (hi_[at] < lo || hi < lo_[at])) {
    spill(row, column, lo, hi);
    return;
  }
  lo_[at] = std::min(lo_[at], lo);
  hi_[at] = std::max(hi_[at], hi);
}

std::uint64_t ColumnStrip::appendFree(std::vector<std::uint32_t>& counts,
                                      std::vector<Span>& spans) const {
  std::uint64_t merged_gaps = 0;
  std::vector<BlockedInterval> blocked;
  for (std::uint32_t row = first_row_; row < end_row_; ++row) {
    for (std::uint32_t column = 0; column < frame_.columns_x; ++column) {
      const std::size_t at = rowStart(row) + column;
      blocked.clear();
      if (lo_[at] <= hi_[at]) blocked.push_back({lo_[at], hi_[at]});
      for (std::int32_t index = head_[at]; index >= 0;) {
        const Node& node = nodes_[static_cast<std::size_t>(index)];
        blocked.push_back({node.lo, node.hi});
        index = node.next;
      }
      if (head_[at] == kTall) {
        for (const auto& [lo, hi] : tall_.at(at)) blocked.push_back({lo, hi});
      }
      const std::size_t before = spans.size();
      merged_gaps += appendFreeSpans(blocked, frame_.heights, spans);
      counts.push_back(static_cast<std::uint32_t>(spans.size() - before));
    }
  }
  return merged_gaps;
}

}  // namespace galactic::bake
