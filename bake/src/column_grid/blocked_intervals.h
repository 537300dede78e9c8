#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "galactic/pose.h"

namespace galactic::bake {

/// Heights in one column at which a ball touches something; meters.
struct BlockedInterval {
  float lo = 0;
  float hi = 0;
};

/// Appends the free spans of one column to `out`, ascending: `heights` without `blocked`, whose
/// intervals may overlap and come in any order; they are sorted in place by `lo`. Gaps of at most
/// kMergeTolerance between intervals, or between an interval and an end of `heights`, are closed,
/// so every span is longer than that. Returns the number of gaps closed between intervals (touching
/// and overlapping ones have no gap). The order of the intervals does not affect the spans. Bounds
/// are finite; `lo` <= `hi`. Safe to call from many threads on different data.
std::uint64_t appendFreeSpans(std::span<BlockedInterval> blocked, Span heights,
                              std::vector<Span>& out);

}  // namespace galactic::bake
