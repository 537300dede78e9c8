#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "galactic/bake/columns.h"

namespace galactic::bake {

/// The free spans of one row of columns, in the order of the columns.
struct RowSpans {
  /// Number of spans of each column. Shape: columns_x.
  std::vector<std::uint32_t> counts;
  std::vector<Span> spans;
};

/// Finds each row with `find_row` on `threads` threads and joins them in row order, so that the
/// result does not depend on the number of threads. `find_row` must not throw.
[[nodiscard]] Columns columnsByRows(const GridFrame& frame, unsigned threads,
                                    const std::function<RowSpans(std::uint32_t row)>& find_row);

}  // namespace galactic::bake
