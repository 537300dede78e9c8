#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "galactic/pose.h"

namespace galactic::bake {

/// Heights of one column in which a ball touches something; meters.
struct BlockedInterval {
  float lo = 0;
  float hi = 0;
};

/// Appends to `out` the free spans of one column, ascending: what `blocked` leaves of `heights`.
/// `blocked` may overlap and stand in any order; it is sorted in place by `lo`. Intervals whose gap
/// is at most kMergeTolerance count as one, and so does a gap to either end of `heights`: every
/// span emitted is longer than that. Returns the number of gaps closed between intervals (touching
/// and overlapping ones have no gap). The same set of intervals gives the same spans in any order.
/// Bounds are finite; `lo` <= `hi`. Safe to call from many threads on different data.
std::uint64_t appendFreeSpans(std::span<BlockedInterval> blocked, Span heights,
                              std::vector<Span>& out);

}  // namespace galactic::bake
