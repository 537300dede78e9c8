// Straight ways through column grids, against the spans that these were made of.
#include "column_grid/free_way.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "column_grid/column_grid_kernels.h"
#include "support/oracles/resting_oracle.h"
#include "support/packs/grid_builder.h"

namespace galactic::test::free_way_test {
namespace {

using detail::FreeWay;
using detail::freeWay;
using detail::StraightLine;

constexpr std::uint32_t kSeed = 31;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Heights keep clear of contacts by so much, in a grid of 8 m.
constexpr double kMargin = 3e-5;

Point3 pointAt(const StraightLine& line, double way) {
  Point3 point = toPoint3(line.from);
  for (std::size_t n = 0; n < 3; ++n) point[n] += line.along[n] * way;
  return point;
}

/// What a query would say if it knew no rounding.
Clearance judge(const TestGrid& grid, const Point3& point) {
  const GridSpec& spec = grid.spec;
  const double i =
      std::floor((point[0] - static_cast<double>(spec.min_x)) / static_cast<double>(spec.spacing));
  const double k =
      std::floor((point[2] - static_cast<double>(spec.min_z)) / static_cast<double>(spec.spacing));
  if (!(i >= 0 && i < spec.columns_x && k >= 0 && k < spec.columns_z)) return Clearance::kOutside;
  if (point[1] < static_cast<double>(spec.heights.lo)) return Clearance::kOutside;
  if (point[1] > static_cast<double>(spec.heights.hi)) return Clearance::kOutside;
  const auto& spans =
      grid.columns[static_cast<std::size_t>(k) * spec.columns_x + static_cast<std::size_t>(i)];
  const bool is_free = std::any_of(spans.begin(), spans.end(), [&](const Span& span) {
    return point[1] >= static_cast<double>(span.lo) && point[1] <= static_cast<double>(span.hi);
  });
  return is_free ? Clearance::kFree : Clearance::kBlocked;
}

StraightLine randomLine(const GridSpec& spec, std::mt19937& random) {
  const float width = spec.spacing * static_cast<float>(spec.columns_x);
  const float depth = spec.spacing * static_cast<float>(spec.columns_z);
  StraightLine line;
  line.from = {uniformIn(random, spec.min_x, spec.min_x + width),
               uniformIn(random, spec.heights.lo, spec.heights.hi),
               uniformIn(random, spec.min_z, spec.min_z + depth)};
  const double azimuth = 2 * std::numbers::pi * uniform(random);
  const double up = random() % 4 == 0 ? 0.0 : 2 * uniform(random) - 1;
  const double level = std::sqrt(1 - up * up);
  line.along = {level * std::cos(azimuth), up, level * std::sin(azimuth)};
  if (random() % 8 == 0) line.along = {0, uniform(random) < 0.5 ? -1.0 : 1.0, 0};
  line.length = 3 * uniform(random);
  return line;
}

TEST(FreeWay, IsFreeAllAlongAndEndsWhereTheSpansDo) {
  RecordProperty("seed", static_cast<int>(kSeed));
  constexpr double kStep = 2e-3;
  std::mt19937 random(kSeed);
  std::array<int, 3> ends{};
  int begun = 0;
  // One whose codes fit into one range, and one of several.
  for (const float quantum : {0x1p-12F, 0x1p-14F}) {
    const GridSpec spec{.spacing = 0.25F,
                        .min_x = -1,
                        .min_z = 2,
                        .heights = {-4, 4},
                        .quantum = quantum,
                        .columns_x = 13,
                        .columns_z = 9};
    TestGrid grid;
    for (int n = 0; n < 3000; ++n) {
      if (n % 100 == 0) grid = roomyGrid(spec, random);
      const StraightLine line = randomLine(spec, random);
      const FreeWay way = freeWay(grid.view(), line);
      if (judge(grid, toPoint3(line.from)) != Clearance::kFree) {
        ASSERT_EQ(way.length, 0);
        ASSERT_EQ(way.end, Clearance::kBlocked);
        continue;
      }
      ++begun;
      ++ends[static_cast<std::size_t>(way.end)];
      // What is cut off of a corner is between two points here; so it may end sooner.
      for (double at = 0; at < way.length - 1e-6; at += kStep) {
        ASSERT_EQ(judge(grid, pointAt(line, at)), Clearance::kFree) << n << " at " << at;
      }
      ASSERT_LE(way.length, line.length);
      if (way.end == Clearance::kFree) {
        ASSERT_EQ(way.length, line.length);
        continue;
      }
      const double slack = line.along[1] == 0 ? 1e-6 : kMargin / std::abs(line.along[1]) + 1e-6;
      bool ends_there = false;
      for (int part = 1; part <= 1000 && !ends_there; ++part) {
        const double beyond = way.length + slack * part / 1000;
        ends_there = judge(grid, pointAt(line, beyond)) == way.end;
      }
      ASSERT_TRUE(ends_there) << n << " after " << way.length;
    }
  }
  std::printf("of %d ways, %d go all along, %d come to something, %d leave the grid\n", begun,
              ends[0], ends[1], ends[2]);
  for (const int count : ends) {
    EXPECT_GT(count, begun / 10);
    EXPECT_LT(count, 9 * begun / 10);
  }
}

/// 5 x 3 columns of 1 m, free from 1 to 7 m of 8, but for column (3, 1).
TestGrid openGrid() {
  GridBuilder builder(GridSpec{});
  for (std::uint32_t k = 0; k < 3; ++k) {
    for (std::uint32_t i = 0; i < 5; ++i) builder.column(i, k, {{1, 7}});
  }
  builder.column(3, 1, {});
  return builder.build();
}

StraightLine level(const Vec3& from, double x, double z, double length = kInfinity) {
  const double whole = std::hypot(x, z);
  return {from, {x / whole, 0, z / whole}, length};
}

TEST(FreeWay, IsExactInRoundNumbers) {
  const TestGrid grid = openGrid();
  const auto expect = [&](const StraightLine& line, double length, Clearance end) {
    const FreeWay way = freeWay(grid.view(), line);
    EXPECT_NEAR(way.length, length, 1e-12);
    EXPECT_EQ(way.end, end);
  };
  expect(level({0.5F, 2, 1.5F}, 1, 0), 2.5, Clearance::kBlocked);
  expect(level({0.5F, 2, 1.5F}, 1, 0, 2.5), 2.5, Clearance::kFree);
  expect(level({0.5F, 2, 1.5F}, 1, 0, 2.4), 2.4, Clearance::kFree);
  expect(level({0.5F, 2, 1.5F}, 1, 0, 0), 0, Clearance::kFree);
  expect(level({4.5F, 2, 1.5F}, -1, 0), 0.5, Clearance::kBlocked);
  expect(level({0.5F, 2, 0.5F}, 1, 0), 4.5, Clearance::kOutside);
  expect(level({0.5F, 2, 0.5F}, -1, 0), 0.5, Clearance::kOutside);
  // From corner to corner, past the blocked column and into it.
  expect(level({2.5F, 2, 0.5F}, 1, 1), std::sqrt(0.5), Clearance::kBlocked);
  expect(level({2.5F, 2, 1.5F}, 1, 1), std::sqrt(0.5) * 3, Clearance::kOutside);
  // At the height of a contact, which is no obstacle to what moves along it.
  expect(level({0.5F, 1, 0.5F}, 1, 0), 4.5, Clearance::kOutside);
  expect(level({0.5F, 7, 0.5F}, 1, 0), 4.5, Clearance::kOutside);
  const FreeWay down = freeWay(grid.view(), {{0.5F, 2, 0.5F}, {0, -1, 0}, kInfinity});
  EXPECT_LE(down.length, 1);
  EXPECT_NEAR(down.length, 1, kMargin);
  EXPECT_EQ(down.end, Clearance::kBlocked);
  EXPECT_EQ(grid.view().clearance({0.5F, 2 - static_cast<float>(down.length), 0.5F}),
            Clearance::kFree);
}

TEST(FreeWay, BeginsWhereAQueryIsFree) {
  const TestGrid grid = openGrid();
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  for (const auto& [from, end] :
       std::initializer_list<std::pair<Vec3, Clearance>>{{{3.5F, 2, 1.5F}, Clearance::kBlocked},
                                                         {{0.5F, 0.5F, 0.5F}, Clearance::kBlocked},
                                                         {{0.5F, 8.5F, 0.5F}, Clearance::kOutside},
                                                         {{-0.5F, 2, 0.5F}, Clearance::kOutside},
                                                         {{1e30F, 2, 0.5F}, Clearance::kOutside},
                                                         {{kNan, 2, 0.5F}, Clearance::kBlocked}}) {
    const FreeWay way = freeWay(grid.view(), level(from, 1, 0));
    EXPECT_EQ(way.length, 0);
    EXPECT_EQ(way.end, end);
  }
}

TEST(ColumnContact, IsThatOfTheColumnsPoints) {
  std::mt19937 random(kSeed);
  const GridSpec spec{.columns_x = 9, .columns_z = 7};
  const TestGrid made = randomGrid(spec, random);
  const ColumnGrid grid = made.view();
  for (int n = 0; n < 5000; ++n) {
    const Vec3 at{uniformIn(random, 0, 9), uniformIn(random, -1, 9), uniformIn(random, 0, 7)};
    const Contact one = grid.contact(at);
    const Contact other = grid.contact(*grid.columnAt(at.x, at.z), at.y);
    ASSERT_EQ(one.clearance, other.clearance);
    ASSERT_EQ(one.down, other.down);
    ASSERT_EQ(one.up, other.up);
  }
  EXPECT_EQ(grid.contact(ColumnIndex{9, 0}, 1).clearance, Clearance::kOutside);
  EXPECT_EQ(grid.contact(ColumnIndex{0, 7}, 1).clearance, Clearance::kOutside);
  EXPECT_EQ(grid.contact(ColumnIndex{0, 0}, std::nanf("")).clearance, Clearance::kBlocked);
}

}  // namespace
}  // namespace galactic::test::free_way_test
