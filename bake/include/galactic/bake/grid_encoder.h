#pragma once
#include <cstdint>
#include <vector>

#include "galactic/bake/columns.h"
#include "galactic/error.h"

namespace galactic::bake {

/// A grid in the layout of schema/column_grid.fbs, ready to be written or queried in place.
struct EncodedGrid {
  GridFrame frame;
  float quantum = 0;
  std::vector<std::uint64_t> cells;
  std::vector<std::uint16_t> tile_base;
  /// One of the two is empty: heights where there are tile bases, else code pairs. The spans of
  /// each overflow cell end with an end mark.
  std::vector<std::uint32_t> overflow_codes;
  std::vector<Span> overflow_spans;
  /// Spans stored, and those dropped because they are thinner than the quantum.
  std::uint64_t spans = 0;
  std::uint64_t slivers = 0;
  std::uint32_t max_spans_per_column = 0;
  std::uint64_t overflow_columns = 0;
};

/// Bytes of the grid's cells and overflow spans.
[[nodiscard]] std::uint64_t storedBytes(const EncodedGrid& grid);

/// Largest height of a code: with rounding to the blocked side, no stored end is further than this
/// from the exact one. Meters.
inline constexpr float kMaxQuantum = 9.5e-5F;

/// Lays out the columns' spans; every end is rounded to the blocked side, so the stored grid is
/// never freer than `columns`.
[[nodiscard]] EncodedGrid encodeGrid(const Columns& columns);

}  // namespace galactic::bake
