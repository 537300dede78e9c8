#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "galactic/column_grid.h"
#include "layout/column_cell.h"

namespace galactic::test {

/// The frame of a hand-made grid. The defaults make every number exact in floats.
struct GridSpec {
  float radius = 0.5F;
  float spacing = 1;
  float min_x = 0;
  float min_z = 0;
  Span heights{0, 8};
  float quantum = 1.0F / 4096;
  std::uint32_t columns_x = 5;
  std::uint32_t columns_z = 3;
};

/// A grid in the layout of schema/column_grid.fbs, with the spans it was made from.
struct TestGrid {
  GridSpec spec;
  /// Spans of each column in meters, row by row, as they were given.
  std::vector<std::vector<Span>> columns;
  /// The tiles, without the padding that a pack adds.
  std::vector<std::uint64_t> cells;
  std::vector<std::uint16_t> tile_base;
  /// Spans and end marks of the overflow cells: codes in a flat grid, heights in a tall one.
  std::vector<std::uint32_t> overflow_codes;
  std::vector<Span> overflow_spans;

  [[nodiscard]] ColumnGrid view() const {
    ColumnGridLayout layout;
    layout.radius = spec.radius;
    layout.spacing = spec.spacing;
    layout.inverse_spacing = 1 / spec.spacing;
    layout.min_x = spec.min_x;
    layout.min_z = spec.min_z;
    layout.heights = spec.heights;
    layout.quantum = spec.quantum;
    layout.inverse_quantum = 1 / spec.quantum;
    layout.columns_x = spec.columns_x;
    layout.columns_z = spec.columns_z;
    layout.tiles_x = tileCount(spec.columns_x, kTileColumnsX);
    layout.cells = cells.data();
    layout.tile_base = tile_base.empty() ? nullptr : tile_base.data();
    layout.overflow_codes = overflow_codes.empty() ? nullptr : overflow_codes.data();
    layout.overflow_spans = overflow_spans.data();
    return ColumnGrid(layout);
  }
};

/// Lays out hand-made columns: a plain, slow twin of the bake's encoder, so that the runtime's
/// tests need nothing of the bake.
class GridBuilder {
 public:
  explicit GridBuilder(const GridSpec& spec) {
    grid_.spec = spec;
    grid_.columns.resize(std::size_t{spec.columns_x} * spec.columns_z);
  }

  /// Gives column (i, k) these spans: ascending, disjoint, meters.
  GridBuilder& column(std::uint32_t i, std::uint32_t k, std::vector<Span> spans) {
    grid_.columns[std::size_t{k} * grid_.spec.columns_x + i] = std::move(spans);
    return *this;
  }

  [[nodiscard]] TestGrid build() const {
    TestGrid grid = grid_;
    const GridSpec& spec = grid.spec;
    grid.cells.assign(cellCount(spec.columns_x, spec.columns_z), kBlockedCell);
    if (lowestCode({spec.heights.hi, spec.heights.hi}) > std::int64_t{kMaxCode}) {
      fillTileBase(grid);
    }
    // Overflow spans stand in the order of the cells, so walk over cells, not columns.
    const std::uint32_t tiles_x = tileCount(spec.columns_x, kTileColumnsX);
    const std::uint32_t tiles_z = tileCount(spec.columns_z, kTileColumnsZ);
    for (std::uint32_t tile_z = 0; tile_z < tiles_z; ++tile_z) {
      for (std::uint32_t tile_x = 0; tile_x < tiles_x; ++tile_x) encodeTile(grid, tile_x, tile_z);
    }
    return grid;
  }

 private:
  [[nodiscard]] std::int64_t lowestCode(Span span) const {
    const double height = static_cast<double>(span.lo) - static_cast<double>(grid_.spec.heights.lo);
    return std::llround(std::ceil(height / static_cast<double>(grid_.spec.quantum)));
  }

  [[nodiscard]] std::int64_t highestCode(Span span) const {
    const double height = static_cast<double>(span.hi) - static_cast<double>(grid_.spec.heights.lo);
    return std::llround(std::floor(height / static_cast<double>(grid_.spec.quantum)));
  }

  [[nodiscard]] std::uint64_t code(Span span, std::int64_t base) const {
    return spanCode(static_cast<std::uint32_t>(lowestCode(span) - base),
                    static_cast<std::uint32_t>(highestCode(span) - base));
  }

  void fillTileBase(TestGrid& grid) const {
    const GridSpec& spec = grid.spec;
    const std::uint32_t tiles_x = tileCount(spec.columns_x, kTileColumnsX);
    std::vector<std::int64_t> lowest(grid.cells.size() / kCellsPerTile, -1);
    for (std::uint32_t k = 0; k < spec.columns_z; ++k) {
      for (std::uint32_t i = 0; i < spec.columns_x; ++i) {
        const auto& spans = grid.columns[std::size_t{k} * spec.columns_x + i];
        if (spans.empty()) continue;
        std::int64_t& tile = lowest[cellIndex(i, k, tiles_x) / kCellsPerTile];
        const std::int64_t code = lowestCode(spans.front());
        tile = tile < 0 ? code : std::min(tile, code);
      }
    }
    for (const std::int64_t code : lowest) {
      grid.tile_base.push_back(
          static_cast<std::uint16_t>(std::max<std::int64_t>(code, 0) / kCodesPerTileBase));
    }
  }

  void encodeTile(TestGrid& grid, std::uint32_t tile_x, std::uint32_t tile_z) const {
    const GridSpec& spec = grid.spec;
    const std::uint32_t tiles_x = tileCount(spec.columns_x, kTileColumnsX);
    const std::size_t tile = std::size_t{tile_z} * tiles_x + tile_x;
    const std::int64_t base =
        grid.tile_base.empty() ? 0 : std::int64_t{grid.tile_base[tile]} * kCodesPerTileBase;
    for (std::uint32_t n = 0; n < kCellsPerTile; ++n) {
      const std::uint32_t i = tile_x * kTileColumnsX + n % kTileColumnsX;
      const std::uint32_t k = tile_z * kTileColumnsZ + n / kTileColumnsX;
      if (i >= spec.columns_x || k >= spec.columns_z) continue;
      grid.cells[tile * kCellsPerTile + n] =
          encode(grid, grid.columns[std::size_t{k} * spec.columns_x + i], base);
    }
  }

  [[nodiscard]] std::uint64_t encode(TestGrid& grid, const std::vector<Span>& spans,
                                     std::int64_t base) const {
    if (spans.empty()) return kBlockedCell;
    if (spans.size() > 2 || highestCode(spans.back()) - base > std::int64_t{kMaxCode}) {
      const std::size_t start = grid.overflow_codes.size() + grid.overflow_spans.size();
      for (const Span& span : spans) {
        if (grid.tile_base.empty()) {
          grid.overflow_codes.push_back(static_cast<std::uint32_t>(code(span, 0)));
        } else {
          grid.overflow_spans.push_back(span);
        }
      }
      if (grid.tile_base.empty()) {
        grid.overflow_codes.push_back(kEndOfCodes);
      } else {
        grid.overflow_spans.push_back(kEndOfSpans);
      }
      return overflowCell(static_cast<std::uint32_t>(start));
    }
    std::array<std::uint64_t, 2> codes{kEmptySpanCode, kEmptySpanCode};
    for (std::size_t n = 0; n < spans.size(); ++n) codes[n] = code(spans[n], base);
    return codes[0] | (codes[1] << 32U);
  }

  TestGrid grid_;
};

/// Spans of a random column: a tenth of the columns blocked, the others with 1 to 5 spans, mostly
/// one or two as in rooms; about half of each column free.
inline std::vector<Span> randomColumn(const GridSpec& spec, std::mt19937& random) {
  constexpr std::array<std::size_t, 20> kSpanCounts{0, 0, 1, 1, 1, 1, 1, 1, 1, 1,
                                                    1, 2, 2, 2, 2, 2, 2, 3, 4, 5};
  std::uniform_real_distribution<float> height(spec.heights.lo, spec.heights.hi);
  std::vector<float> ends(2 * kSpanCounts[random() % kSpanCounts.size()]);
  std::generate(ends.begin(), ends.end(), [&] { return height(random); });
  std::sort(ends.begin(), ends.end());
  std::vector<Span> column;
  for (std::size_t n = 0; n < ends.size(); n += 2) {
    const bool wide = ends[n + 1] - ends[n] > 4 * spec.quantum;
    const bool apart = column.empty() || ends[n] - column.back().hi > 4 * spec.quantum;
    if (wide && apart) column.push_back({ends[n], ends[n + 1]});
  }
  return column;
}

/// A grid of random columns.
inline TestGrid randomGrid(const GridSpec& spec, std::mt19937& random) {
  GridBuilder builder(spec);
  for (std::uint32_t k = 0; k < spec.columns_z; ++k) {
    for (std::uint32_t i = 0; i < spec.columns_x; ++i) {
      builder.column(i, k, randomColumn(spec, random));
    }
  }
  return builder.build();
}

/// Random columns, mostly free, whose spans end at codes: so the grid has exactly these.
inline TestGrid roomyGrid(const GridSpec& spec, std::mt19937& random) {
  constexpr float kRightAt = 2e-3F;
  GridBuilder builder(spec);
  for (std::uint32_t k = 0; k < spec.columns_z; ++k) {
    for (std::uint32_t i = 0; i < spec.columns_x; ++i) {
      std::vector<Span> spans =
          random() % 3 == 0 ? randomColumn(spec, random) : std::vector<Span>{spec.heights};
      for (Span& span : spans) {
        span.lo = std::ceil(span.lo / spec.quantum) * spec.quantum;
        span.hi = std::floor(span.hi / spec.quantum) * spec.quantum;
        // As bakes have it, nothing is right at the ends of a grid's heights.
        if (span.lo < spec.heights.lo + kRightAt) span.lo = spec.heights.lo;
        if (span.hi > spec.heights.hi - kRightAt) span.hi = spec.heights.hi;
      }
      builder.column(i, k, spans);
    }
  }
  return builder.build();
}

}  // namespace galactic::test
