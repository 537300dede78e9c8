#pragma once
#include <cstdint>
#include <functional>

#include "column_grid/column_strip.h"
#include "galactic/bake/column_engines.h"

namespace galactic::bake {

/// Rows per strip: few enough that a strip's working state stays in the second-level cache.
inline constexpr std::uint32_t kRowsPerStrip = 32;

/// Calls `fill` for each strip of kRowsPerStrip rows on `threads` threads and joins the strips'
/// free spans in row order. `fill` adds the blocked heights of strip `index` to an empty strip.
[[nodiscard]] ExactColumns assembleColumns(
    const GridFrame& frame, unsigned threads, std::uint32_t strip_count,
    const std::function<void(std::uint32_t index, ColumnStrip& strip)>& fill);

/// The columns of Coverage::kCell: a height is free only if it is free over the whole square of the
/// cell. Each triangle's interval is computed in closed form over the square, in double precision.
/// The square and the interval are padded by kMergeTolerance and two parts in 2^23 of the grid's
/// size, which exceeds all later float rounding together, including that of queries.
[[nodiscard]] ExactColumns cellColumns(const TriangleMesh& mesh, const GridFrame& frame,
                                       unsigned threads);

}  // namespace galactic::bake
