#include "galactic/column_grid.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <optional>
#include <random>
#include <utility>

#include "support/kept_word.h"
#include "support/packs/grid_builder.h"

namespace galactic::test::column_grid_test {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
/// Small against the quantum of the hand-made grids is not enough: an end is only known to one
/// code.
constexpr float kEpsilon = 1.0F / 1024;

/// Distances to contact are short of it by two millionths of the grid's height, 48 m at most.
constexpr float kMargin = 2e-4F;

/// 100 x 100 columns of 1 m, as in the unit test of the published implementation.
GridSpec publishedSpec() {
  GridSpec spec;
  spec.columns_x = 100;
  spec.columns_z = 100;
  return spec;
}

Clearance clearanceAt(const TestGrid& grid, Vec3 center) { return grid.view().clearance(center); }

TEST(ColumnAt, IsTheCellAroundThePoint) {
  const TestGrid grid = GridBuilder(GridSpec{.spacing = 0.5F, .min_x = -1, .min_z = 2}).build();
  EXPECT_EQ(grid.view().columnAt(-1, 2), (ColumnIndex{0, 0}));
  EXPECT_EQ(grid.view().columnAt(-0.51F, 2.49F), (ColumnIndex{0, 0}));
  EXPECT_EQ(grid.view().columnAt(-0.5F, 2.5F), (ColumnIndex{1, 1}));
  EXPECT_EQ(grid.view().columnAt(1.49F, 3.49F), (ColumnIndex{4, 2}));
}

TEST(ColumnAt, IsNoneOutsideTheRectangleAndForNan) {
  const TestGrid grid = GridBuilder(GridSpec{}).build();
  for (const auto& [x, z] : std::initializer_list<std::pair<float, float>>{{-0.001F, 1},
                                                                           {5, 1},
                                                                           {1, -0.001F},
                                                                           {1, 3},
                                                                           {kNan, 1},
                                                                           {1, kNan},
                                                                           {kInfinity, 1},
                                                                           {1, -3e38F}}) {
    EXPECT_EQ(grid.view().columnAt(x, z), std::nullopt) << x << ", " << z;
  }
}

/// A point in the middle of the only column that is free is free, and one elsewhere is not.
TEST(ColumnAt, IsTheColumnByWhichQueriesAreJudged) {
  const GridSpec spec{.spacing = 0.25F, .min_x = -0.5F, .min_z = 1};
  const TestGrid grid = GridBuilder(spec).column(3, 1, {{1, 2}}).build();
  constexpr unsigned kSeed = 20230607;
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<float> x(-1.2F, 1.4F);
  std::uniform_real_distribution<float> z(0.7F, 2.1F);
  int free = 0;
  int outside = 0;
  for (int n = 0; n < 4000; ++n) {
    const Vec3 center{x(random), 1.5F, z(random)};
    const auto column = grid.view().columnAt(center.x, center.z);
    const Clearance expected = !column                        ? Clearance::kOutside
                               : *column == ColumnIndex{3, 1} ? Clearance::kFree
                                                              : Clearance::kBlocked;
    ASSERT_EQ(clearanceAt(grid, center), expected) << "seed " << kSeed << " case " << n;
    free += expected == Clearance::kFree ? 1 : 0;
    outside += expected == Clearance::kOutside ? 1 : 0;
  }
  EXPECT_GT(free, 20);
  EXPECT_GT(outside, 400);
}

TEST(Spans, OfColumnsOutsideTheGridAreNone) {
  const TestGrid grid = GridBuilder(publishedSpec()).column(99, 99, {{1, 2}}).build();
  std::array<Span, 2> spans{};
  EXPECT_EQ(grid.view().spans(99, 99, spans), 1U);
  EXPECT_EQ(grid.view().spans(100, 99, spans), 0U);
  EXPECT_EQ(grid.view().spans(99, 100, spans), 0U);
  EXPECT_EQ(grid.view().spanCount(1000000, 1000000), 0U);
}

TEST(ColumnGrid, AnswersBlockedInEveryColumnOfAnEmptyGrid) {
  const TestGrid grid = GridBuilder(publishedSpec()).build();
  for (int cell = 0; cell < 100; cell += 7) {
    const float at = static_cast<float>(cell) + 0.5F;
    EXPECT_EQ(clearanceAt(grid, {at, 1.5F, at / 2}), Clearance::kBlocked);
  }
}

TEST(ColumnGrid, AnswersThePublishedParityVectorsOfOneSpan) {
  const TestGrid grid = GridBuilder(publishedSpec()).column(0, 0, {{1, 2}}).build();
  EXPECT_EQ(clearanceAt(grid, {0.5F, 1.5F, 0.5F}), Clearance::kFree);
  EXPECT_EQ(clearanceAt(grid, {0, 1.5F, 0}), Clearance::kFree);
  EXPECT_EQ(clearanceAt(grid, {0, 1 - kEpsilon, 0}), Clearance::kBlocked);
  EXPECT_EQ(clearanceAt(grid, {0, 2 + kEpsilon, 0}), Clearance::kBlocked);
  // Far below and above, and beside the grid, is contact there and kOutside here.
  EXPECT_EQ(clearanceAt(grid, {0, -1000, 0}), Clearance::kOutside);
  EXPECT_EQ(clearanceAt(grid, {0, 1000, 0}), Clearance::kOutside);
  for (const float beside : {-kEpsilon, 100.0F, 1000.0F, -1000.0F}) {
    EXPECT_EQ(clearanceAt(grid, {beside, 1.5F, 0}), Clearance::kOutside) << beside;
    EXPECT_EQ(clearanceAt(grid, {0, 1.5F, beside}), Clearance::kOutside) << beside;
  }
}

TEST(ColumnGrid, AnswersThePublishedParityVectorsOfThreeSpans) {
  const TestGrid grid = GridBuilder(publishedSpec()).column(0, 0, {{1, 2}, {3, 4}, {5, 6}}).build();
  EXPECT_EQ(clearanceAt(grid, {0, 2.5F, 0}), Clearance::kBlocked);
  for (const float free : {1.5F, 3.5F, 5.5F}) {
    EXPECT_EQ(clearanceAt(grid, {0, free, 0}), Clearance::kFree) << free;
  }
}

TEST(ColumnGrid, CountsBothEndsOfASpanAsFree) {
  const TestGrid grid = GridBuilder(GridSpec{})
                            .column(0, 0, {{1, 2}, {3, 4}})
                            .column(1, 0, {{1, 2}, {3, 4}, {5, 6}})
                            .build();
  for (const float x : {0.5F, 1.5F}) {
    for (const float end : {1.0F, 2.0F, 3.0F, 4.0F}) {
      EXPECT_EQ(clearanceAt(grid, {x, end, 0.5F}), Clearance::kFree) << x << " " << end;
    }
    EXPECT_EQ(clearanceAt(grid, {x, std::nextafter(1.0F, 0.0F), 0.5F}), Clearance::kBlocked);
    EXPECT_EQ(clearanceAt(grid, {x, std::nextafter(2.0F, 3.0F), 0.5F}), Clearance::kBlocked);
  }
}

TEST(ColumnGrid, MeasuresTheDistancesToContactInInlineAndOverflowCells) {
  const TestGrid grid = GridBuilder(GridSpec{})
                            .column(0, 0, {{1, 2}, {3, 5}})
                            .column(1, 0, {{1, 2}, {3, 5}, {6, 7}})
                            .build();
  for (const float x : {0.5F, 1.5F}) {
    const Contact free = grid.view().contact({x, 3.5F, 0.5F});
    EXPECT_EQ(free.clearance, Clearance::kFree);
    EXPECT_NEAR(free.down, 0.5F, kMargin);
    EXPECT_NEAR(free.up, 1.5F, kMargin);
    const Contact blocked = grid.view().contact({x, 2.5F, 0.5F});
    EXPECT_EQ(blocked.clearance, Clearance::kBlocked);
    EXPECT_EQ(blocked.down, 0);
    EXPECT_EQ(blocked.up, 0);
  }
}

TEST(ColumnGrid, AnswersBlockedWhenACoordinateIsNan) {
  const TestGrid grid = GridBuilder(GridSpec{}).column(0, 0, {{0, 8}}).build();
  EXPECT_EQ(clearanceAt(grid, {kNan, 1, 0.5F}), Clearance::kBlocked);
  EXPECT_EQ(clearanceAt(grid, {0.5F, kNan, 0.5F}), Clearance::kBlocked);
  EXPECT_EQ(clearanceAt(grid, {0.5F, 1, kNan}), Clearance::kBlocked);
  EXPECT_EQ(clearanceAt(grid, {kInfinity, 1, kNan}), Clearance::kBlocked);
  EXPECT_EQ(clearanceAt(grid, {-1000, kNan, 1000}), Clearance::kBlocked);
}

TEST(ColumnGrid, AnswersOutsideForInfiniteAndHugeCoordinates) {
  const TestGrid grid = GridBuilder(GridSpec{}).column(0, 0, {{0, 8}}).build();
  for (const float far : {kInfinity, -kInfinity, std::numeric_limits<float>::max(),
                          -std::numeric_limits<float>::max()}) {
    EXPECT_EQ(clearanceAt(grid, {far, 1, 0.5F}), Clearance::kOutside) << far;
    EXPECT_EQ(clearanceAt(grid, {0.5F, far, 0.5F}), Clearance::kOutside) << far;
    EXPECT_EQ(clearanceAt(grid, {0.5F, 1, far}), Clearance::kOutside) << far;
  }
}

TEST(ColumnGrid, IncludesItsLowerSidesAndItsHeightsButNotItsUpperSides) {
  const TestGrid grid =
      GridBuilder(GridSpec{}).column(0, 0, {{0, 8}}).column(4, 2, {{0, 8}}).build();
  EXPECT_EQ(clearanceAt(grid, {0, 1, 0}), Clearance::kFree);
  EXPECT_EQ(clearanceAt(grid, {-0.0F, 1, -0.0F}), Clearance::kFree);
  EXPECT_EQ(clearanceAt(grid, {std::nextafter(5.0F, 0.0F), 1, std::nextafter(3.0F, 0.0F)}),
            Clearance::kFree);
  EXPECT_EQ(clearanceAt(grid, {5, 1, 2.5F}), Clearance::kOutside);
  EXPECT_EQ(clearanceAt(grid, {4.5F, 1, 3}), Clearance::kOutside);
  EXPECT_EQ(clearanceAt(grid, {0, 0, 0}), Clearance::kFree);
  EXPECT_EQ(clearanceAt(grid, {0, 8, 0}), Clearance::kFree);
  EXPECT_EQ(clearanceAt(grid, {0, std::nextafter(8.0F, 9.0F), 0}), Clearance::kOutside);
  EXPECT_EQ(clearanceAt(grid, {0, std::nextafter(0.0F, -1.0F), 0}), Clearance::kOutside);
}

TEST(ColumnGrid, AnswersInTallGridsByTheBaseOfEachTile) {
  GridSpec spec;
  spec.heights = {-8, 40};
  const TestGrid grid = GridBuilder(spec)
                            .column(0, 0, {{-7, 3}})
                            .column(4, 0, {{30, 38}, {39, 40}})
                            .column(4, 2, {{-1, 38}})
                            .build();
  ASSERT_FALSE(grid.tile_base.empty());
  ASSERT_GT(grid.tile_base[1], 0);
  EXPECT_EQ(clearanceAt(grid, {0.5F, -7, 0.5F}), Clearance::kFree);
  EXPECT_EQ(clearanceAt(grid, {0.5F, 30, 0.5F}), Clearance::kBlocked);
  const Contact upstairs = grid.view().contact({4.5F, 30.25F, 0.5F});
  EXPECT_EQ(upstairs.clearance, Clearance::kFree);
  EXPECT_NEAR(upstairs.down, 0.25F, kMargin);
  EXPECT_NEAR(upstairs.up, 7.75F, kMargin);
  EXPECT_EQ(clearanceAt(grid, {4.5F, 29.5F, 0.5F}), Clearance::kBlocked);
  EXPECT_EQ(clearanceAt(grid, {4.5F, 38.5F, 0.5F}), Clearance::kBlocked);
  // 39 m do not fit into one tile's codes: an overflow cell with a single span.
  EXPECT_NEAR(grid.view().contact({4.5F, 0, 2.5F}).up, 38, kMargin);
}

TEST(ColumnGrid, ReturnsTheSpansOfAColumnAsTheyWereStored) {
  GridSpec spec;
  spec.heights = {-8, 40};
  const std::vector<Span> two{{30, 38}, {39, 40}};
  const std::vector<Span> three{{1, 2}, {3, 4}, {5, 6}};
  const TestGrid grid =
      GridBuilder(spec).column(4, 0, two).column(1, 2, three).column(2, 0, {{1, 2}}).build();
  const ColumnGrid view = grid.view();
  EXPECT_EQ(view.spanCount(0, 0), 0U);
  EXPECT_EQ(view.spanCount(2, 0), 1U);
  std::array<Span, 4> spans;
  ASSERT_EQ(view.spans(4, 0, spans), 2U);
  EXPECT_TRUE(std::equal(two.begin(), two.end(), spans.begin()));
  ASSERT_EQ(view.spans(1, 2, spans), 3U);
  EXPECT_TRUE(std::equal(three.begin(), three.end(), spans.begin()));
  // Too small a buffer takes what fits, and learns the number.
  std::array<Span, 1> one;
  EXPECT_EQ(view.spans(4, 0, one), 2U);
  EXPECT_EQ(one[0], two[0]);
  EXPECT_EQ(view.spans(1, 2, one), 3U);
  EXPECT_EQ(one[0], three[0]);
}

/// Grids whose numbers are not exact in floats: heights far off and near 0, flat and tall.
TEST(ColumnGrid, KeepsItsWordInEveryColumn) {
  constexpr unsigned kSeed = 29;
  constexpr int kGrids = 60;
  SCOPED_TRACE(fmt::format("seed {}", kSeed));
  std::mt19937 random(kSeed);
  const auto between = [&](float lo, float hi) {
    return std::uniform_real_distribution<float>(lo, hi)(random);
  };
  std::size_t free = 0;
  std::size_t blocked = 0;
  std::size_t spans = 0;
  for (int n = 0; n < kGrids; ++n) {
    GridSpec spec;
    spec.radius = 0.05F;
    spec.spacing = 0.03F;
    spec.min_x = between(-700, 700);
    spec.min_z = between(-5, 5);
    const float low = n % 3 == 0 ? between(-790, 700) : between(-4, 0.5F);
    spec.heights = {low, low + (n % 4 == 0 ? between(7, 90) : between(0.5F, 6))};
    const float height = spec.heights.hi - spec.heights.lo;
    spec.quantum = height > 6.2F ? 95e-6F : std::nextafter(height / 65534, 1.0F);
    spec.columns_x = 21;
    spec.columns_z = 12;
    const TestGrid grid = randomGrid(spec, random);
    const ColumnGrid view = grid.view();
    KeptWord word(view);
    word.askEveryColumn();
    ASSERT_EQ(word.broken(), "") << "grid " << n << ": heights " << low << " to "
                                 << spec.heights.hi;
    free += word.free();
    blocked += word.blocked();
    spans += word.spans();
  }
  EXPECT_GT(spans, 10'000U);
  // Nearly all ends have a blocked side; the few others reach the next span within the tolerance.
  EXPECT_GT(blocked, 2 * spans * 9 / 10);
  EXPECT_GT(blocked, free / 100);
}

/// What the spans that the grid was made from say, in double precision; nothing when the answer
/// depends on rounding.
struct Expected {
  bool certain = false;
  bool free = false;
  double down = 0;
  double up = 0;
};

Expected bruteForce(const TestGrid& grid, Vec3 center) {
  // An end is rounded by up to one code, and a code is computed in float.
  const double tolerance = 1.5 * static_cast<double>(grid.spec.quantum);
  constexpr double kBorderTolerance = 1e-4;
  const double fx = (static_cast<double>(center.x) - static_cast<double>(grid.spec.min_x)) /
                    static_cast<double>(grid.spec.spacing);
  const double fz = (static_cast<double>(center.z) - static_cast<double>(grid.spec.min_z)) /
                    static_cast<double>(grid.spec.spacing);
  Expected expected;
  expected.certain = std::fabs(fx - std::round(fx)) > kBorderTolerance &&
                     std::fabs(fz - std::round(fz)) > kBorderTolerance;
  const auto i = static_cast<std::size_t>(fx);
  const auto k = static_cast<std::size_t>(fz);
  const auto y = static_cast<double>(center.y);
  for (const Span& span : grid.columns[k * grid.spec.columns_x + i]) {
    const double down = y - static_cast<double>(span.lo);
    const double up = static_cast<double>(span.hi) - y;
    if (std::fabs(down) < tolerance || std::fabs(up) < tolerance) expected.certain = false;
    if (down >= 0 && up >= 0) {
      expected.free = true;
      expected.down = down;
      expected.up = up;
    }
  }
  return expected;
}

void compareWithBruteForce(const GridSpec& spec, std::uint32_t seed) {
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  const TestGrid grid = randomGrid(spec, random);
  const ColumnGrid view = grid.view();
  const auto extent = [&](std::uint32_t columns) {
    return std::uniform_real_distribution<float>(
        0, static_cast<float>(columns) * spec.spacing * 0.99999F);
  };
  auto x = extent(spec.columns_x);
  auto z = extent(spec.columns_z);
  std::uniform_real_distribution<float> y(spec.heights.lo, spec.heights.hi);
  const double tolerance = 2 * static_cast<double>(spec.quantum);
  constexpr int kQueries = 200'000;
  int certain = 0;
  int free = 0;
  for (int n = 0; n < kQueries; ++n) {
    const Vec3 center{spec.min_x + x(random), y(random), spec.min_z + z(random)};
    const Expected expected = bruteForce(grid, center);
    if (!expected.certain) continue;
    ++certain;
    free += expected.free ? 1 : 0;
    const Contact contact = view.contact(center);
    ASSERT_EQ(contact.clearance == Clearance::kFree, expected.free)
        << center.x << " " << center.y << " " << center.z;
    ASSERT_EQ(contact.clearance == Clearance::kBlocked, !expected.free);
    ASSERT_NEAR(static_cast<double>(contact.down), expected.down, tolerance);
    ASSERT_NEAR(static_cast<double>(contact.up), expected.up, tolerance);
  }
  EXPECT_GT(certain, kQueries * 9 / 10);
  EXPECT_GT(free, certain / 10);
  EXPECT_LT(free, certain * 9 / 10);
}

TEST(ColumnGrid, AgreesWithBruteForceOverTheSpansItWasMadeFrom) {
  GridSpec spec{.radius = 0.05F,
                .spacing = 0.03F,
                .min_x = -2.66F,
                .min_z = -4.76F,
                .heights = {-0.1F, 3.1F},
                .quantum = 9.5e-5F,
                .columns_x = 61,
                .columns_z = 47};
  compareWithBruteForce(spec, 101);
  spec.heights = {-3, 22.5F};
  compareWithBruteForce(spec, 102);
}

}  // namespace
}  // namespace galactic::test::column_grid_test
