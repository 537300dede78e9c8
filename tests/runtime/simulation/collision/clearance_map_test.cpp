// What the maps call surely free, against the columns themselves, and the two kernels.
#include "simulation/collision/clearance_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <limits>
#include <random>
#include <vector>

#include "column_grid/column_grid_kernels.h"
#include "simulation/collision/collision.h"
#include "support/homes/box_room.h"
#include "support/packs/grid_builder.h"

namespace galactic::test::clearance_map_test {
namespace {

using namespace galactic::simulation;

constexpr HeightsOverFloor kHeights{.lowest = 0.2F, .highest = 1.25F};
constexpr float kUnevenness = 0.03F;

/// Eight centers near each other, as one of eight groups whose bounds are alike.
struct Eight {
  explicit Eight(std::mt19937& random) : Eight(random, uniformIn(random, 0.15F, 1.3F)) {}
  /// `from_y`: the height of the lowest, about.
  Eight(std::mt19937& random, float from_y) {
    const float size = uniformIn(random, 0, 0.3F);
    const float from_x = uniformIn(random, -0.2F, 3);
    const float from_z = uniformIn(random, -0.2F, 3);
    for (std::size_t n = 0; n < kLanes; ++n) {
      x[n] = from_x + uniformIn(random, 0, size);
      y[n] = from_y + uniformIn(random, 0, size);
      z[n] = from_z + uniformIn(random, 0, size);
    }
    const auto fill = [&](std::size_t bound, const std::array<float, kLanes>& values) {
      const auto [least, most] = std::ranges::minmax(values);
      std::fill_n(bounds.begin() + static_cast<std::ptrdiff_t>(bound * kLanes), kLanes, least);
      std::fill_n(bounds.begin() + static_cast<std::ptrdiff_t>((bound + 1) * kLanes), kLanes, most);
    };
    fill(0, x);
    fill(2, y);
    fill(4, z);
  }

  std::array<float, kLanes> x{}, y{}, z{};
  alignas(32) std::array<float, kBounds * kLanes> bounds{};
};

SureGroups sureOf(const ClearanceMaps& maps, std::uint32_t map, std::size_t eight,
                  const float* bounds) {
  SureGroups sure;
  maps.surelyFree(map, eight, {bounds, kLanes}, sure);
  return sure;
}

TEST(ClearanceMaps, CallNothingSurelyFreeThatAColumnBlocks) {
  constexpr std::uint32_t kSeed = 1501;
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  std::size_t sure = 0;
  std::size_t all_free = 0;
  std::size_t asked = 0;
  for (int round = 0; round < 20; ++round) {
    const BoxRoom room = furnishedRoom(random, 5);
    const auto radii = static_cast<std::uint32_t>(room.scene().grids().size());
    // As a simulator has them: what is asked about is not in the first eight.
    ClearanceMaps maps({2, 2, 2, 2, 2, 2, 2, 2, 0, 1, 2});
    const std::uint32_t map = maps.add(room.scene(), 0, kUnevenness, kHeights);
    for (int n = 0; n < 2000; ++n) {
      const Eight eight(random);
      const unsigned free = sureOf(maps, map, 1, eight.bounds.data()).free;
      for (std::uint32_t radius = 0; radius < radii; ++radius) {
        const bool is_free =
            room.scene().grids()[radius].firstNotFree({eight.x, eight.y, eight.z}) == kLanes;
        const bool is_sure = (free >> radius & 1U) != 0;
        ASSERT_TRUE(is_free || !is_sure) << "radius " << radius << " at " << eight.x[0] << " "
                                         << eight.y[0] << " " << eight.z[0];
        ++asked;
        all_free += is_free ? 1U : 0U;
        sure += is_sure ? 1U : 0U;
      }
    }
  }
  // Both answers, and a use: the maps know of a good part of what is free.
  EXPECT_GT(sure, asked / 10);
  EXPECT_LT(sure, asked * 9 / 10);
  EXPECT_GT(sure, all_free / 3);
}

TEST(ClearanceMaps, CallLowWhatIsFreeAndWouldStandInAThickerFloor) {
  constexpr std::uint32_t kSeed = 1505;
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  std::size_t low = 0;
  std::size_t all_free = 0;
  for (int round = 0; round < 20; ++round) {
    const BoxRoom room = furnishedRoom(random, 5);
    const auto radii = static_cast<std::uint32_t>(room.scene().grids().size());
    ClearanceMaps maps({0, 1, 2});
    const std::uint32_t map = maps.add(room.scene(), 0, kUnevenness, {0, kHeights.highest});
    for (std::uint32_t radius = 0; radius < radii; ++radius) {
      const ColumnGrid& grid = room.scene().grids()[radius];
      for (int n = 0; n < 1000; ++n) {
        const Eight eight(random, grid.radius() + uniformIn(random, 0, 2 * kUnevenness));
        const SureGroups sure = sureOf(maps, map, 0, eight.bounds.data());
        const bool is_free = grid.firstNotFree({eight.x, eight.y, eight.z}) == kLanes;
        const bool is_low = (sure.free & sure.low) >> radius & 1U;
        ASSERT_TRUE(is_free || !is_low) << "radius " << radius << " at " << eight.x[0] << " "
                                        << eight.y[0] << " " << eight.z[0];
        const float lowest = *std::ranges::min_element(eight.y);
        ASSERT_TRUE(!is_low || lowest < grid.radius() + 2 * kUnevenness);
        all_free += is_free ? 1U : 0U;
        low += is_low ? 1U : 0U;
      }
    }
  }
  EXPECT_GT(low, all_free / 10);
  EXPECT_LT(low, all_free * 9 / 10);
}

TEST(ClearanceMaps, KnowThatSpheresThatAreNeverLowAreFreeOverARug) {
  constexpr std::uint32_t kSeed = 1507;
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  constexpr float kRug = 0.01F;
  constexpr float kOverFloor = 0.02F;
  const BoxRoom room({{{-1, -0.2F, -1}, {4, 0, 4}},
                      {{0.2F, 0, 0.2F}, {2.4F, kRug, 2.8F}},
                      {{2.5F, 0, 0.5F}, {2.8F, 0.5F, 0.8F}}});
  const ColumnGrid& grid = room.scene().grids()[2];
  const std::array<float, 3> lowest{0, 0, grid.radius() + kOverFloor};
  const HeightsOverFloor heights{0.07F, kHeights.highest};
  ClearanceMaps any({2});
  any.add(room.scene(), 0, kUnevenness, heights);
  ClearanceMaps never_low({2});
  never_low.add(room.scene(), 0, kUnevenness, heights, lowest);
  std::size_t known = 0;
  std::size_t known_more = 0;
  for (int n = 0; n < 5000; ++n) {
    const Eight eight(random, grid.radius() + uniformIn(random, 0, 2 * kOverFloor));
    const bool is_free = grid.firstNotFree({eight.x, eight.y, eight.z}) == kLanes;
    const SureGroups before = sureOf(any, 0, 0, eight.bounds.data());
    const SureGroups now = sureOf(never_low, 0, 0, eight.bounds.data());
    ASSERT_TRUE(is_free || (now.free & 1U) == 0);
    // What is low decides which way robots slide: it stays what it was.
    ASSERT_EQ(before.low, now.low);
    const bool may_be_asked = *std::ranges::min_element(eight.y) >= lowest[2];
    if (!may_be_asked) continue;
    known += before.free & before.low & 1U;
    known_more += now.free & now.low & 1U;
  }
  EXPECT_GT(known_more, 2 * known);
}

TEST(ClearanceMaps, SayHowFarWhatIsSurelyFreeMayGo) {
  constexpr std::uint32_t kSeed = 1506;
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  std::size_t moved = 0;
  std::size_t far = 0;
  for (int round = 0; round < 20; ++round) {
    const BoxRoom room = furnishedRoom(random, 5);
    ClearanceMaps maps({0, 1, 2});
    const std::uint32_t map = maps.add(room.scene(), 0, kUnevenness, kHeights);
    for (int n = 0; n < 2000; ++n) {
      const Eight eight(random);
      const SureGroups sure = sureOf(maps, map, 0, eight.bounds.data());
      for (std::uint32_t radius = 0; radius < room.scene().grids().size(); ++radius) {
        const float slack = sure.slack[radius];
        ASSERT_EQ(slack >= 0, (sure.free >> radius & 1U) != 0);
        if (slack < 0) continue;
        // To a corner of the square: what is farthest.
        Eight other = eight;
        const float by_x = random() % 2 == 0 ? slack : -slack;
        const float by_z = random() % 2 == 0 ? slack : -slack;
        for (float& x : other.x) x += by_x;
        for (float& z : other.z) z += by_z;
        ASSERT_EQ(room.scene().grids()[radius].firstNotFree({other.x, other.y, other.z}), kLanes)
            << "radius " << radius << ", by " << by_x << " " << by_z;
        ++moved;
        far += slack > 0.06F ? 1U : 0U;
      }
    }
  }
  EXPECT_GT(far, moved / 10);
  EXPECT_LT(far, moved * 9 / 10);
}

/// How many columns around a cell of a map are free on all sides, among blocks that are higher than
/// all that is asked; less than none where one of its own is not.
int freeColumnsAround(const ColumnGrid& grid, const Vec3& center) {
  const auto cell_of = [](float at) {
    return static_cast<int>(at / BoxRoom::kSpacing) / static_cast<int>(kColumnsPerCell);
  };
  const auto is_free = [&](int i, int k) {
    const auto middle = [](int n) { return (static_cast<float>(n) + 0.5F) * BoxRoom::kSpacing; };
    return grid.clearance({middle(i), center.y, middle(k)}) == Clearance::kFree;
  };
  const int columns = static_cast<int>(kColumnsPerCell);
  const int first_i = columns * cell_of(center.x);
  const int first_k = columns * cell_of(center.z);
  int around = -1;
  for (bool all = true; all; around += all ? 1 : 0) {
    const int n = around + 1;
    for (int i = first_i - n; all && i < first_i + columns + n; ++i) {
      for (int k = first_k - n; all && k < first_k + columns + n; ++k) all = is_free(i, k);
    }
  }
  return around;
}

TEST(ClearanceMaps, KnowOfEachColumn) {
  constexpr std::uint32_t kSeed = 1508;
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  // From the floor to far above the robot.
  const BoxRoom room(
      {{{1.2F, -1, 0.7F}, {1.6F, 2.9F, 1.1F}}, {{2.1F, -1, 2.2F}, {2.2F, 2.9F, 2.9F}}});
  ClearanceMaps maps({0, 1, 2});
  const std::uint32_t map = maps.add(room.scene(), 0, kUnevenness, kHeights);
  Tally free;
  int narrow = 0;
  for (int n = 0; n < 4000; ++n) {
    const Eight eight(random, 0.5F);
    const SureGroups sure = sureOf(maps, map, 0, eight.bounds.data());
    const float wide = eight.bounds[kLanes] - eight.bounds[0];
    const float deep = eight.bounds[5 * kLanes] - eight.bounds[4 * kLanes];
    const Vec3 middle{eight.bounds[0] + 0.5F * wide, 0.6F, eight.bounds[4 * kLanes] + 0.5F * deep};
    if (middle.x < 0 || middle.z < 0) continue;
    for (std::uint32_t radius = 0; radius < room.scene().grids().size(); ++radius) {
      const auto around =
          static_cast<float>(freeColumnsAround(room.scene().grids()[radius], middle));
      const float half = 0.5F * std::max(wide, deep) / BoxRoom::kSpacing;
      const bool is_sure = (sure.free >> radius & 1U) != 0;
      free.add(is_sure);
      // With nothing lost to rounding to cells, but for the middle's place in its own.
      ASSERT_TRUE(is_sure || around < half + 0.02F) << "radius " << radius;
      ASSERT_TRUE(!is_sure || around > half - 1.02F) << "radius " << radius;
      narrow += is_sure && around < half ? 1 : 0;
    }
  }
  free.expectBothSides();
  // Where the middle is in its cell counts, too.
  EXPECT_GT(narrow, 20);
}

TEST(ClearanceMaps, AnswerSeveralEnvsAsTheyAnswerEach) {
  std::mt19937 random(1507);
  const BoxRoom room = furnishedRoom(random, 5);
  ClearanceMaps maps({0, 1, 2});
  const std::uint32_t map = maps.add(room.scene(), 0, kUnevenness, kHeights);
  constexpr std::size_t kEnvs = 11;
  constexpr std::size_t kStride = kBounds * kLanes;
  alignas(32) std::array<float, kEnvs * kStride> bounds;
  std::array<std::uint32_t, kEnvs> map_of;
  for (std::size_t env = 0; env < kEnvs; ++env) {
    const Eight eight(random);
    std::ranges::copy(eight.bounds, bounds.data() + env * kStride);
    map_of[env] = env % 4 == 0 ? kNoClearanceMap : map;
  }
  std::array<SureGroups, kEnvs> sure;
  maps.surelyFree(map_of, 0, {bounds.data(), kLanes}, kStride, sure);
  for (std::size_t env = 0; env < kEnvs; ++env) {
    EXPECT_EQ(sure[env], sureOf(maps, map_of[env], 0, bounds.data() + env * kStride));
  }
}

TEST(ClearanceMaps, AnswerAlikeWithBothKernels) {
  if (!detail::hasAvx2()) GTEST_SKIP() << "this processor has no AVX2";
  constexpr std::uint32_t kSeed = 1502;
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  // A map by hand: distances at random.
  ClearanceLanes lanes{};
  std::vector<std::uint8_t> cells(64 * 8 * 8 * kClearancePlanes + 3);
  for (std::uint8_t& cell : cells) cell = static_cast<std::uint8_t>(random() % 8);
  for (std::size_t n = 0; n < kLanes; ++n) {
    lanes.inverse_cell[n] = 16;
    lanes.column[n] = 1.0F / 32;
    lanes.cells_x[n] = 50;
    lanes.cells_z[n] = 60;
    lanes.lowest[n] = 0.2F;
    lanes.low[n] = 0.3F;
    lanes.highest[n] = 1.4F;
    lanes.band_from[n] = 0.1F;
    lanes.inverse_band[n] = kClearanceBands / 1.3F;
    lanes.band_bytes[n] = 64 * 8 * 8;
    lanes.tiles_x[n] = 7;
  }
  std::size_t sure = 0;
  std::size_t low = 0;
  std::size_t still = 0;
  constexpr int kRounds = 20000;
  for (int n = 0; n < kRounds; ++n) {
    const Eight eight(random);
    const ClearanceQuestion question{&lanes, eight.bounds.data()};
    SureGroups found;
    SureGroups fast;
    surelyFreePortable(&question, 1, cells.data(), kLanes, &found);
    surelyFreeAvx2(&question, 1, cells.data(), kLanes, &fast);
    ASSERT_EQ(fast, found);
    const float reach = uniformIn(random, 0, 0.5F);
    const unsigned within = freeWithinPortable(found, reach);
    ASSERT_EQ(freeWithinAvx2(found, reach), within);
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      ASSERT_EQ((within >> lane & 1U) != 0, found.slack[lane] >= reach);
    }
    still += within == 0 ? 0U : 1U;
    sure += found.free == 0 ? 0U : 1U;
    low += (found.free & found.low) == 0 ? 0U : 1U;
  }
  EXPECT_GT(low, kRounds / 50);
  EXPECT_GT(still, kRounds / 50);
  EXPECT_GT(sure, kRounds / 10);
  EXPECT_LT(sure, kRounds * 9 / 10);
}

TEST(ClearanceMaps, KnowNothingWithoutAMap) {
  std::mt19937 random(1503);
  const Eight eight(random);
  EXPECT_EQ(sureOf(ClearanceMaps({0}), kNoClearanceMap, 0, eight.bounds.data()), SureGroups{});
}

TEST(ClearanceMaps, TakeNoMoreThanThereIsRoomFor) {
  std::mt19937 random(1505);
  const BoxRoom room = furnishedRoom(random, 5);
  std::uint32_t added = 0;
  ClearanceMaps maps({0}, 100'000);
  while (maps.add(room.scene(), 0, kUnevenness, kHeights) == added) ++added;
  // The same that fits into more room.
  EXPECT_GT(added, 0U);
  EXPECT_EQ(maps.add(room.scene(), 0, kUnevenness, kHeights), kNoClearanceMap);
  ClearanceMaps more({0}, 200'000);
  for (std::uint32_t n = 0; n <= added; ++n) {
    EXPECT_EQ(more.add(room.scene(), 0, kUnevenness, kHeights), n);
  }
  const Eight eight(random);
  EXPECT_EQ(sureOf(maps, added - 1, 0, eight.bounds.data()),
            sureOf(more, 0, 0, eight.bounds.data()));
}

TEST(ClearanceMaps, AreNotFooledByWhatIsNoNumber) {
  std::mt19937 random(1504);
  const BoxRoom room = furnishedRoom(random, 5);
  ClearanceMaps maps({0});
  const std::uint32_t map = maps.add(room.scene(), 0, kUnevenness, kHeights);
  for (const float odd : {std::numeric_limits<float>::quiet_NaN(), 1e30F, -1e30F}) {
    alignas(32) std::array<float, kBounds * kLanes> bounds;
    bounds.fill(odd);
    EXPECT_EQ(sureOf(maps, map, 0, bounds.data()).free, 0U) << odd;
  }
}

}  // namespace
}  // namespace galactic::test::clearance_map_test
