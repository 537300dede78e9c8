#include "column_grid/cell_check.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstring>

#include "check/offence.h"
#include "column_grid/column_grid_kernels.h"
#include "layout/column_cell.h"

namespace galactic::detail {
namespace {

/// The counts of one pass over some cells.
struct CellScan {
  std::uint32_t offences = 0;
  std::uint32_t first_spans = 0;
  std::uint32_t second_spans = 0;
  std::uint32_t overflow = 0;
};

/// Tiles scanned together if all have the same base.
constexpr std::size_t kTilesPerScan = 8;

/// Counts the spans and the ill-formed cells of up to kTilesPerScan tiles; codes up to `highest`
/// lie inside the heights. Without branches and in 32-bit steps, which compilers can vectorize for
/// any x86-64.
CellScan scanCells(std::span<const std::uint64_t> cells, std::int32_t highest) {
  std::array<std::uint32_t, kTilesPerScan * kCellsPerTile * 2> halves;
  std::memcpy(halves.data(), cells.data(), cells.size_bytes());
  CellScan scan;
  for (std::size_t n = 0; n < cells.size(); ++n) {
    const std::uint32_t half0 = halves[2 * n];
    const std::uint32_t half1 = halves[2 * n + 1];
    const auto lo0 = static_cast<std::int32_t>(half0 & 0xffffU);
    const auto hi0 = static_cast<std::int32_t>(half0 >> 16U);
    const auto lo1 = static_cast<std::int32_t>(half1 & 0xffffU);
    const auto hi1 = static_cast<std::int32_t>(half1 >> 16U);
    const std::uint32_t overflow = half0 == kOverflowMark ? 1 : 0;
    const std::uint32_t empty0 = half0 == kEmptySpanCode ? 1 : 0;
    const std::uint32_t empty1 = half1 == kEmptySpanCode ? 1 : 0;
    const std::uint32_t first = (lo0 <= hi0 ? 1U : 0U) & (hi0 <= highest ? 1U : 0U);
    const std::uint32_t second =
        first & (lo1 <= hi1 ? 1U : 0U) & (hi1 <= highest ? 1U : 0U) & (hi0 < lo1 ? 1U : 0U);
    const std::uint32_t good = overflow | (empty0 & empty1) | (first & empty1) | second;
    scan.offences += 1U - good;
    scan.first_spans += first;
    scan.second_spans += second;
    scan.overflow += overflow;
  }
  return scan;
}

/// Checks the cells of one grid.
class CellChecker {
 public:
  CellChecker(const CellBlock& block, const std::string& where)
      : block_(block), layout_(block.layout), offence_(where) {
    const double height =
        static_cast<double>(layout_.heights.hi) - static_cast<double>(layout_.heights.lo);
    // One quantum of tolerance: a span's end may be rounded to the next code.
    constexpr double kBeyondAnyCode = 1e9;
    highest_code_ = static_cast<std::int64_t>(
        std::min(kBeyondAnyCode, std::floor(height / static_cast<double>(layout_.quantum)) + 1));
  }

  Result<CellTotals> run() {
    checkPadding();
    checkTiles();
    checkBorder();
    if (offence_.found()) return tl::unexpected<Error>(offence_.result().error());
    return totals_;
  }

 private:
  [[nodiscard]] std::size_t tiles() const {
    return (block_.stored_cells.size() - kTilePaddingCells) / kCellsPerTile;
  }

  /// Position of a cell in the stored vector.
  [[nodiscard]] std::size_t element(std::size_t cell) const {
    return cell + static_cast<std::size_t>(layout_.cells - block_.stored_cells.data());
  }

  /// The highest code of this tile inside the heights; negative if no span fits.
  [[nodiscard]] std::int32_t highestCode(std::size_t tile) const {
    const std::int64_t base =
        layout_.tile_base == nullptr ? 0 : std::int64_t{layout_.tile_base[tile]};
    const std::int64_t highest = highest_code_ - base * std::int64_t{kCodesPerTileBase};
    return static_cast<std::int32_t>(std::clamp(highest, std::int64_t{-1}, std::int64_t{kMaxCode}));
  }

  void checkPadding() {
    const std::size_t before = element(0);
    for (std::size_t n = 0; n < block_.stored_cells.size(); ++n) {
      if (n == before) n += tiles() * kCellsPerTile;
      if (n == block_.stored_cells.size()) break;
      offence_.require(block_.stored_cells[n] == 0, fmt::format("cells[{}]", n),
                       "is an unused element of value {:#x}, expected 0", block_.stored_cells[n]);
    }
  }

  void checkTiles() {
    const std::size_t step = layout_.tile_base == nullptr ? kTilesPerScan : 1;
    std::uint64_t first_spans = 0;
    std::uint64_t second_spans = 0;
    for (std::size_t tile = 0; tile < tiles(); tile += step) {
      const std::size_t end = std::min(tile + step, tiles());
      const std::span cells(layout_.cells + tile * kCellsPerTile, (end - tile) * kCellsPerTile);
      const CellScan scan = scanCells(cells, highestCode(tile));
      if (scan.offences != 0) return explain(tile, end);
      if (scan.overflow != 0) checkOverflowCells(tile, end);
      if (offence_.found()) return;
      first_spans += scan.first_spans;
      second_spans += scan.second_spans;
    }
    offence_.require(next_overflow_ == block_.overflow_elements, overflowField(next_overflow_),
                     "belongs to no overflow cell, expected {} elements as the cells name them",
                     next_overflow_);
    totals_.spans += first_spans + second_spans;
    const std::uint32_t inline_spans = second_spans != 0 ? 2 : (first_spans != 0 ? 1 : 0);
    totals_.max_spans_per_column = std::max(totals_.max_spans_per_column, inline_spans);
  }

  /// Checks the overflow cells of the tiles from `begin` to `end` with their spans.
  void checkOverflowCells(std::size_t begin, std::size_t end) {
    for (std::size_t n = begin * kCellsPerTile; n < end * kCellsPerTile && !offence_.found(); ++n) {
      const std::uint64_t cell = layout_.cells[n];
      if (!isOverflow(cell)) continue;
      if (overflowStart(cell) != next_overflow_) {
        return offence_.require(false, fmt::format("cells[{}]", element(n)),
                                "is an overflow cell whose spans begin at element {}, expected {}",
                                overflowStart(cell), next_overflow_);
      }
      checkOverflowSpans();
    }
  }

  /// Reports the first invalid cell in the tiles from `begin` to `end`, and what is wrong with it.
  void explain(std::size_t begin, std::size_t end) {
    for (std::size_t n = begin * kCellsPerTile; n < end * kCellsPerTile && !offence_.found(); ++n) {
      const std::uint64_t cell = layout_.cells[n];
      if (isOverflow(cell)) continue;
      explainCell(cell, highestCode(n / kCellsPerTile), fmt::format("cells[{}]", element(n)));
    }
    assert(offence_.found());
  }

  void explainCell(std::uint64_t cell, std::int32_t highest, const std::string& field) {
    const auto half0 = static_cast<std::uint32_t>(cell);
    const auto half1 = static_cast<std::uint32_t>(cell >> 32U);
    if (half0 != kEmptySpanCode) explainSpan(half0, highest, field, "first");
    if (half1 == kEmptySpanCode) return;
    offence_.require(half0 != kEmptySpanCode, field, "has a second span but no first one");
    explainSpan(half1, highest, field, "second");
    offence_.require(
        (half0 >> 16U) < (half1 & 0xffffU), field,
        "has a second span from code {} and a first one to code {}, expected ascending "
        "disjoint spans",
        half1 & 0xffffU, half0 >> 16U);
  }

  void explainSpan(std::uint32_t half, std::int32_t highest, const std::string& field,
                   const char* which) {
    const std::uint32_t lo = half & 0xffffU;
    const std::uint32_t hi = half >> 16U;
    offence_.require(
        lo <= hi, field,
        "has a {} span of codes {} to {}, expected ascending codes or ({}, 0) for none", which, lo,
        hi, kEmptySpanCode);
    offence_.require(static_cast<std::int64_t>(hi) <= highest, field,
                     "has a {} span up to code {}, expected at most {}, the top of the grid", which,
                     hi, highest);
  }

  /// Cells of border tiles beyond the last column must be blocked.
  void checkBorder() {
    const std::uint32_t end_x = layout_.tiles_x * kTileColumnsX;
    const std::uint32_t end_z = tileCount(layout_.columns_z, kTileColumnsZ) * kTileColumnsZ;
    for (std::uint32_t k = 0; k < end_z; ++k) {
      const std::uint32_t begin_x = k < layout_.columns_z ? layout_.columns_x : 0;
      for (std::uint32_t i = begin_x; i < end_x; ++i) {
        const std::size_t index = cellIndex(i, k, layout_.tiles_x);
        if (layout_.cells[index] == kBlockedCell) continue;
        return offence_.require(false, fmt::format("cells[{}]", element(index)),
                                "lies beyond the last column and is {:#x}, expected blocked {:#x}",
                                layout_.cells[index], kBlockedCell);
      }
    }
  }

  /// Checks the spans of one overflow cell, from element next_overflow_ to the end mark, and moves
  /// next_overflow_ past it.
  void checkOverflowSpans() {
    const Span heights{layout_.heights.lo - layout_.quantum, layout_.heights.hi + layout_.quantum};
    const std::size_t first = next_overflow_;
    std::size_t n = first;
    for (; n < block_.overflow_elements; ++n) {
      const Span span = overflowSpan(layout_, static_cast<std::uint32_t>(n));
      if (span == kEndOfSpans) break;
      // False for NaN and infinity.
      const bool inside = span.lo >= heights.lo && span.lo <= span.hi && span.hi <= heights.hi;
      const bool above =
          n == first || span.lo > overflowSpan(layout_, static_cast<std::uint32_t>(n - 1)).hi;
      if (!inside || !above) return explainOverflowSpan(n, inside);
    }
    if (n == block_.overflow_elements) {
      return offence_.require(
          false, overflowField(first),
          "begins the spans of an overflow cell, expected an end mark behind them");
    }
    if (n == first) {
      return offence_.require(false, overflowField(first),
                              "is an end mark, expected the first span of an overflow cell");
    }
    totals_.spans += n - first;
    totals_.max_spans_per_column =
        std::max(totals_.max_spans_per_column, static_cast<std::uint32_t>(n - first));
    next_overflow_ = n + 1;
  }

  [[nodiscard]] std::string overflowField(std::size_t n) const {
    return fmt::format("{}[{}]",
                       layout_.overflow_codes == nullptr ? "overflow_spans" : "overflow_codes", n);
  }

  void explainOverflowSpan(std::size_t n, bool inside) {
    const Span span = overflowSpan(layout_, static_cast<std::uint32_t>(n));
    offence_.require(
        inside, overflowField(n),
        "is {} to {} m, expected ascending finite heights inside the grid's {} to {} m", span.lo,
        span.hi, layout_.heights.lo, layout_.heights.hi);
    offence_.require(false, overflowField(n),
                     "begins at {} m, expected above the end of the span before it in its column",
                     span.lo);
  }

  const CellBlock& block_;
  const ColumnGridLayout& layout_;
  Offence offence_;
  std::int64_t highest_code_ = 0;
  /// Where the spans of the next overflow cell begin.
  std::size_t next_overflow_ = 0;
  CellTotals totals_;
};

}  // namespace

Result<CellTotals> checkCells(const CellBlock& block, const std::string& where) {
  return CellChecker(block, where).run();
}

}  // namespace galactic::detail
