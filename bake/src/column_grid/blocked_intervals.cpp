#include "column_grid/blocked_intervals.h"

#include <algorithm>

#include "galactic/bake/columns.h"

namespace galactic::bake {
namespace {

/// The only comparison that decides whether a gap is free. It uses float arithmetic, like the
/// vectorized engine, so that all engines cut at the same heights.
bool isGap(float below, float above) { return below + kMergeTolerance < above; }

}  // namespace

std::uint64_t appendFreeSpans(std::span<BlockedInterval> blocked, Span heights,
                              std::vector<Span>& out) {
  std::sort(blocked.begin(), blocked.end(),
            [](const BlockedInterval& a, const BlockedInterval& b) { return a.lo < b.lo; });
  std::uint64_t merged_gaps = 0;
  // Everything up to this height is done: first the lower end of `heights`, then the highest end of
  // the intervals so far.
  float reached = heights.lo;
  for (const BlockedInterval& interval : blocked) {
    const float top = std::min(interval.lo, heights.hi);
    if (isGap(reached, top)) {
      out.push_back({reached, top});
    } else if (reached < top && reached > heights.lo && top < heights.hi) {
      ++merged_gaps;
    }
    reached = std::max(reached, interval.hi);
    if (reached >= heights.hi) return merged_gaps;
  }
  if (isGap(reached, heights.hi)) out.push_back({reached, heights.hi});
  return merged_gaps;
}

}  // namespace galactic::bake
