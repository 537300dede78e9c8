// Encoding a grid: what is stored is never freer than what was found, and hardly less free.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "galactic/bake/columns.h"
#include "layout/column_cell.h"
#include "support/oracles/encoded_grid_view.h"

namespace galactic::bake::grid_encoder_test {
namespace {

constexpr std::uint32_t kSeed = 20250311;
/// What storing may take from either end of a span, meters.
constexpr double kStorageTolerance = 1e-4;

using ColumnList = std::vector<std::vector<Span>>;

Columns columnsOf(std::uint32_t columns_x, std::uint32_t columns_z, Span heights,
                  const ColumnList& lists) {
  Columns columns;
  columns.frame.radius = 0.05F;
  columns.frame.spacing = 0.03F;
  columns.frame.min_x = -1.23F;
  columns.frame.min_z = 4.56F;
  columns.frame.heights = heights;
  columns.frame.columns_x = columns_x;
  columns.frame.columns_z = columns_z;
  columns.first.push_back(0);
  for (std::uint32_t at = 0; at < columns_x * columns_z; ++at) {
    if (at < lists.size()) {
      columns.spans.insert(columns.spans.end(), lists[at].begin(), lists[at].end());
    }
    columns.first.push_back(static_cast<std::uint32_t>(columns.spans.size()));
  }
  return columns;
}

using HeightList = std::vector<std::array<double, 2>>;

/// Appends the span between two codes; nothing where lo > hi.
void appendCodes(const EncodedGrid& grid, std::uint64_t lo, std::uint64_t hi, HeightList& spans) {
  if (lo > hi) return;
  const auto bottom = static_cast<double>(grid.frame.heights.lo);
  const auto quantum = static_cast<double>(grid.quantum);
  spans.push_back(
      {bottom + quantum * static_cast<double>(lo), bottom + quantum * static_cast<double>(hi)});
}

/// Reads a cell by the words of schema/column_grid.fbs, with plain arithmetic in double: the
/// runtime's reader has no part in it.
HeightList decode(const EncodedGrid& grid, std::uint32_t i, std::uint32_t k) {
  const std::uint32_t tiles_x = (grid.frame.columns_x + 3) / 4;
  const std::size_t tile = std::size_t{k / 2} * tiles_x + i / 4;
  const std::uint64_t cell = grid.cells[tile * 8 + std::size_t{k % 2} * 4 + i % 4];
  HeightList spans;
  if ((cell & 0xffffffffU) == 0xffffffffU) {
    for (std::uint64_t s = cell >> 32U;; ++s) {
      if (grid.tile_base.empty()) {
        const std::uint32_t pair = grid.overflow_codes.at(s);
        if (pair == 0xffffffffU) return spans;
        appendCodes(grid, pair & 0xffffU, pair >> 16U, spans);
      } else {
        const Span& heights = grid.overflow_spans.at(s);
        if (heights.lo == std::numeric_limits<float>::max()) return spans;
        spans.push_back({static_cast<double>(heights.lo), static_cast<double>(heights.hi)});
      }
    }
  }
  const std::uint64_t base =
      grid.tile_base.empty() ? 0U : 1024U * std::uint64_t{grid.tile_base[tile]};
  for (const unsigned shift : {0U, 32U}) {
    const std::uint64_t lo = (cell >> shift) & 0xffffU;
    const std::uint64_t hi = (cell >> (shift + 16U)) & 0xffffU;
    if (lo <= hi) appendCodes(grid, lo + base, hi + base, spans);
  }
  return spans;
}

/// What the columns of one grid had in them.
struct Seen {
  std::uint64_t stored = 0;
  std::uint64_t slivers = 0;
  std::uint64_t inline_columns = 0;
  std::uint64_t overflow_columns = 0;
};

/// Every stored span lies in the span it comes from and lacks no more than the tolerance; those
/// that are missing hold no code.
void expectFaithful(const Columns& columns, const EncodedGrid& grid, Seen& seen) {
  const GridFrame& frame = columns.frame;
  for (std::uint32_t k = 0; k < frame.columns_z; ++k) {
    for (std::uint32_t i = 0; i < frame.columns_x; ++i) {
      const auto exact = columns.column(columns.index(i, k));
      const auto stored = decode(grid, i, k);
      std::size_t next = 0;
      for (const Span& span : exact) {
        const auto lo = static_cast<double>(span.lo);
        const auto hi = static_cast<double>(span.hi);
        const bool is_stored =
            next < stored.size() && stored[next][0] >= lo && stored[next][1] <= hi;
        if (!is_stored) {
          ASSERT_LT(hi - lo, static_cast<double>(grid.quantum)) << "column " << i << ", " << k;
          ++seen.slivers;
          continue;
        }
        ASSERT_LE(stored[next][0] - lo, kStorageTolerance);
        ASSERT_LE(hi - stored[next][1], kStorageTolerance);
        ++next;
        ++seen.stored;
      }
      ASSERT_EQ(next, stored.size()) << "freer than found in column " << i << ", " << k;
      const std::uint32_t tiles_x = tileCount(frame.columns_x, kTileColumnsX);
      ++(isOverflow(grid.cells[cellIndex(i, k, tiles_x)]) ? seen.overflow_columns
                                                          : seen.inline_columns);
    }
  }
  EXPECT_EQ(grid.cells.size(), cellCount(frame.columns_x, frame.columns_z));
  EXPECT_LE(grid.quantum, kMaxQuantum);
  const bool tall = !grid.tile_base.empty();
  EXPECT_TRUE(tall ? grid.overflow_codes.empty() : grid.overflow_spans.empty());
}

/// The runtime reads what the words of the schema say, to the rounding of a float.
void expectReadTheSame(const EncodedGrid& grid) {
  const ColumnGrid view = test::viewOf(grid);
  std::vector<Span> spans(64);
  // A few units in the last place of the range's ends: the runtime computes in floats.
  const float greatest = std::max(std::abs(view.heights().lo), std::abs(view.heights().hi));
  const double rounding = 4e-7 * static_cast<double>(greatest);
  for (std::uint32_t k = 0; k < grid.frame.columns_z; ++k) {
    for (std::uint32_t i = 0; i < grid.frame.columns_x; ++i) {
      const std::size_t count = view.spans(i, k, spans);
      ASSERT_EQ(view.spanCount(i, k), count);
      std::size_t s = 0;
      for (const auto& wanted : decode(grid, i, k)) {
        const bool is_there =
            s < count && std::abs(static_cast<double>(spans[s].lo) - wanted[0]) <= rounding;
        if (!is_there) {
          // Of hardly more than one height, rounding to free ones may leave nothing.
          ASSERT_LE(wanted[1] - wanted[0], 2 * rounding);
          continue;
        }
        ASSERT_NEAR(static_cast<double>(spans[s].hi), wanted[1], rounding);
        ++s;
      }
      ASSERT_EQ(s, count);
    }
  }
}

/// Random columns: blocked ones, ones with many spans, slivers, spans that touch the ends of the
/// heights, and spans that are apart by hardly anything.
ColumnList randomColumns(std::mt19937& random, std::size_t count, Span heights) {
  const auto number = [&](float lo, float hi) {
    return std::uniform_real_distribution<float>(lo, hi)(random);
  };
  ColumnList lists(count);
  for (auto& list : lists) {
    const auto spans = static_cast<std::size_t>(random() % 6);
    std::vector<float> ends;
    for (std::size_t n = 0; n < 2 * spans; ++n) ends.push_back(number(heights.lo, heights.hi));
    std::sort(ends.begin(), ends.end());
    if (spans > 0 && random() % 4 == 0) ends.front() = heights.lo;
    if (spans > 0 && random() % 4 == 0) ends.back() = heights.hi;
    for (std::size_t n = 0; n < ends.size(); n += 2) {
      if (random() % 8 == 0) ends[n + 1] = std::min(ends[n + 1], ends[n] + number(0, 2e-4F));
      if (ends[n + 1] - ends[n] <= kMergeTolerance) continue;
      list.push_back({ends[n], ends[n + 1]});
    }
  }
  return lists;
}

TEST(GridEncoder, StoresSpansToTheBlockedSideWithinATenthOfAMillimeter) {
  RecordProperty("seed", static_cast<int>(kSeed));
  std::mt19937 random(kSeed);
  const Span ranges[] = {{-0.06F, 2.61F}, {0, 6.2F}, {-3.3F, 2.92F}, {-1, 7.5F},
                         {-700.3F, -690}, {-10, 40}, {611, 618},     {-0.011F, 0.0111F}};
  for (const Span heights : ranges) {
    SCOPED_TRACE(testing::Message() << "heights " << heights.lo << " to " << heights.hi);
    Seen seen;
    for (int round = 0; round < 10; ++round) {
      const auto columns_x = static_cast<std::uint32_t>(1 + random() % 23);
      const auto columns_z = static_cast<std::uint32_t>(1 + random() % 17);
      const ColumnList lists = randomColumns(random, std::size_t{columns_x} * columns_z, heights);
      const Columns columns = columnsOf(columns_x, columns_z, heights, lists);
      const EncodedGrid grid = encodeGrid(columns);
      Seen once;
      expectFaithful(columns, grid, once);
      expectReadTheSame(grid);
      ASSERT_FALSE(HasFatalFailure()) << "seed " << kSeed << ", round " << round;
      EXPECT_EQ(grid.spans, once.stored);
      EXPECT_EQ(grid.slivers, once.slivers);
      seen.slivers += once.slivers;
      seen.inline_columns += once.inline_columns;
      seen.overflow_columns += once.overflow_columns;
    }
    // No span is thinner than the merge tolerance, which is wider than the codes of a low grid.
    EXPECT_EQ(seen.slivers > 0, heights.hi - heights.lo > 1);
    const std::uint64_t all = seen.inline_columns + seen.overflow_columns;
    EXPECT_GT(seen.overflow_columns, all / 10);
    EXPECT_LT(seen.overflow_columns, all * 9 / 10);
  }
}

TEST(GridEncoder, AnswersFreeOnlyWhereTheColumnIsFree) {
  std::mt19937 random(kSeed + 1);
  for (const Span heights : {Span{-0.06F, 2.61F}, Span{-10, 40}}) {
    const Columns columns = columnsOf(12, 9, heights, randomColumns(random, 108, heights));
    const EncodedGrid grid = encodeGrid(columns);
    const ColumnGrid view = test::viewOf(grid);
    // A query's own float arithmetic on heights, at most a few units in the last place of 50 m.
    constexpr double kQueryRounding = 1e-5;
    int free = 0;
    constexpr int kQueries = 200000;
    for (int n = 0; n < kQueries; ++n) {
      const auto i = static_cast<std::uint32_t>(random() % 12);
      const auto k = static_cast<std::uint32_t>(random() % 9);
      const float y = std::uniform_real_distribution<float>(heights.lo, heights.hi)(random);
      const Vec3 center{static_cast<float>(columns.frame.centerX(i)), y,
                        static_cast<float>(columns.frame.centerZ(k))};
      const bool is_free = view.clearance(center) == Clearance::kFree;
      free += is_free ? 1 : 0;
      const auto spans = columns.column(columns.index(i, k));
      const bool expected = std::any_of(spans.begin(), spans.end(), [&](const Span& span) {
        return static_cast<double>(y) >= static_cast<double>(span.lo) - kQueryRounding &&
               static_cast<double>(y) <= static_cast<double>(span.hi) + kQueryRounding;
      });
      ASSERT_TRUE(expected || !is_free) << "height " << y;
    }
    EXPECT_GT(free, kQueries / 10);
    EXPECT_LT(free, kQueries * 9 / 10);
  }
}

TEST(GridEncoder, LaysOutAGridWithoutSpansAsBlocked) {
  const EncodedGrid grid = encodeGrid(columnsOf(5, 3, {0, 3}, {}));
  EXPECT_EQ(grid.cells.size(), 32U);
  for (const std::uint64_t cell : grid.cells) EXPECT_EQ(cell, kBlockedCell);
  EXPECT_TRUE(grid.tile_base.empty());
  EXPECT_EQ(grid.overflow_columns, 0U);
  EXPECT_TRUE(grid.overflow_codes.empty());
  EXPECT_TRUE(grid.overflow_spans.empty());
  EXPECT_EQ(grid.spans, 0U);
  EXPECT_EQ(grid.slivers, 0U);
  EXPECT_EQ(grid.max_spans_per_column, 0U);
}

TEST(GridEncoder, BlocksTheCellsOfBorderTilesThatNoColumnHas) {
  const ColumnList lists(15, {{0.5F, 2}});
  const EncodedGrid grid = encodeGrid(columnsOf(5, 3, {0, 3}, lists));
  int used = 0;
  for (std::uint32_t cell = 0; cell < grid.cells.size(); ++cell) {
    const std::uint32_t tile = cell / 8;
    const std::uint32_t i = tile % 2 * 4 + cell % 4;
    const std::uint32_t k = tile / 2 * 2 + cell % 8 / 4;
    if (i < 5 && k < 3) {
      ++used;
      EXPECT_NE(grid.cells[cell], kBlockedCell);
    } else {
      EXPECT_EQ(grid.cells[cell], kBlockedCell);
    }
  }
  EXPECT_EQ(used, 15);
}

TEST(GridEncoder, KeepsTwoSpansInTheCellAndThreeBeside) {
  const EncodedGrid grid = encodeGrid(columnsOf(
      3, 1, {0, 3}, {{{0.1F, 0.2F}, {1, 2}}, {{0.1F, 0.2F}, {0.5F, 0.6F}, {1, 2}}, {{1, 2}}}));
  EXPECT_FALSE(isOverflow(grid.cells[0]));
  EXPECT_TRUE(isOverflow(grid.cells[1]));
  EXPECT_FALSE(isOverflow(grid.cells[2]));
  EXPECT_EQ(grid.max_spans_per_column, 3U);
  EXPECT_EQ(grid.spans, 6U);
  EXPECT_EQ(grid.overflow_columns, 1U);
  ASSERT_EQ(grid.overflow_codes.size(), 4U);
  EXPECT_EQ(overflowStart(grid.cells[1]), 0U);
  for (std::size_t n = 0; n < 3; ++n) {
    EXPECT_LT(lowCode(grid.overflow_codes[n]), highCode(grid.overflow_codes[n]));
  }
  EXPECT_EQ(grid.overflow_codes[3], kEndOfCodes);
}

/// A sliver is dropped before it is decided whether a column fits in its cell.
TEST(GridEncoder, CountsSliversAndGivesThemNoPlace) {
  const Span sliver{1.00000F, 1.00002F};
  const EncodedGrid grid = encodeGrid(columnsOf(1, 1, {0, 6}, {{{0.1F, 0.5F}, sliver, {2, 3}}}));
  EXPECT_EQ(grid.spans + grid.slivers, 3U);
  EXPECT_EQ(grid.slivers, 1U);
  EXPECT_FALSE(isOverflow(grid.cells[0]));
}

TEST(GridEncoder, GivesTilesABaseOnlyWhenTheHeightsNeedIt) {
  const ColumnList low(8, {{0.5F, 2}});
  EXPECT_TRUE(encodeGrid(columnsOf(4, 2, {0, 6.2F}, low)).tile_base.empty());
  ColumnList lists(16, {{0.5F, 2}});
  for (std::size_t at = 4; at < 8; ++at) lists[at] = {{30.5F, 33}};
  for (std::size_t at = 12; at < 16; ++at) lists[at] = {{31, 33}};
  const EncodedGrid grid = encodeGrid(columnsOf(8, 2, {0, 50}, lists));
  EXPECT_EQ(grid.quantum, kMaxQuantum);
  ASSERT_EQ(grid.tile_base.size(), 2U);
  EXPECT_EQ(grid.tile_base[0], static_cast<std::uint16_t>(0.5 / (1024 * 9.5e-5)));
  EXPECT_EQ(grid.tile_base[1], static_cast<std::uint16_t>(30.5 / (1024 * 9.5e-5)));
  EXPECT_TRUE(grid.overflow_spans.empty());
}

TEST(GridEncoder, KeepsAColumnOfFiftyMetersBesideItsCell) {
  const ColumnList lists{{{0, 50}}, {{0, 0.4F}}, {{1, 3}, {4, 49.5F}}};
  const Columns columns = columnsOf(3, 1, {0, 50}, lists);
  const EncodedGrid grid = encodeGrid(columns);
  EXPECT_TRUE(isOverflow(grid.cells[0]));
  EXPECT_FALSE(isOverflow(grid.cells[1]));
  EXPECT_TRUE(isOverflow(grid.cells[2]));
  // Heights as they are: floats need no rounding.
  EXPECT_EQ(grid.overflow_spans,
            (std::vector<Span>{{0, 50}, kEndOfSpans, {1, 3}, {4, 49.5F}, kEndOfSpans}));
  Seen seen;
  expectFaithful(columns, grid, seen);
  EXPECT_EQ(seen.stored, 4U);
  const ColumnGrid view = test::viewOf(grid);
  const auto x = static_cast<float>(columns.frame.centerX(0));
  const auto z = static_cast<float>(columns.frame.centerZ(0));
  const Contact contact = view.contact({x, 20, z});
  EXPECT_EQ(contact.clearance, Clearance::kFree);
  // Distances stay clear of the contact by some millionths of the grid's height.
  EXPECT_NEAR(static_cast<double>(contact.down), 20, 2e-4);
  EXPECT_NEAR(static_cast<double>(contact.up), 30, 2e-4);
}

/// The tallest scene that the importer lets through.
TEST(GridEncoder, ReachesTheTopOfTheTallestScene) {
  const Span heights{-800, 800};
  const ColumnList lists{{{-800, -799}}, {{799, 800}}, {{-800, 800}}, {{0, 1}}};
  const Columns columns = columnsOf(20, 1, heights, lists);
  const EncodedGrid grid = encodeGrid(columns);
  Seen seen;
  expectFaithful(columns, grid, seen);
  EXPECT_EQ(seen.stored, 4U);
  expectReadTheSame(grid);
}

}  // namespace
}  // namespace galactic::bake::grid_encoder_test
