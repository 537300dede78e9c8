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
#include "support/processor.h"

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

bool isSure(const SureGroups& sure, std::uint32_t group) { return (sure.free >> group & 1U) != 0; }

/// With the same slack of those that are free.
void expectSame(const SureGroups& some, const SureGroups& others) {
  ASSERT_EQ(some.free, others.free);
  for (std::size_t n = 0; n < kLanes; ++n) {
    if ((some.free >> n & 1U) == 0) continue;
    EXPECT_EQ(some.down_x.values[n], others.down_x.values[n]);
    EXPECT_EQ(some.up_x.values[n], others.up_x.values[n]);
    EXPECT_EQ(some.down_z.values[n], others.down_z.values[n]);
    EXPECT_EQ(some.up_z.values[n], others.up_z.values[n]);
  }
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
    const std::uint32_t map = maps.add(makeFloorClearance(room.scene(), 0, kUnevenness, kHeights));
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

TEST(ClearanceMaps, KnowOfWhatIsFreeCloseOverABareFloor) {
  constexpr std::uint32_t kSeed = 1505;
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  Tally sure;
  std::size_t free = 0;
  for (int round = 0; round < 20; ++round) {
    const BoxRoom room = furnishedRoom(random, 5);
    const auto radii = static_cast<std::uint32_t>(room.scene().grids().size());
    ClearanceMaps maps({0, 1, 2});
    const std::uint32_t map =
        maps.add(makeFloorClearance(room.scene(), 0, kUnevenness, {0, kHeights.highest}));
    for (std::uint32_t radius = 0; radius < radii; ++radius) {
      const ColumnGrid& grid = room.scene().grids()[radius];
      for (int n = 0; n < 1000; ++n) {
        // So low that a floor of this unevenness would block them.
        const Eight eight(random, grid.radius() + uniformIn(random, 0, kUnevenness));
        const bool is_free = grid.firstNotFree({eight.x, eight.y, eight.z}) == kLanes;
        const bool is_sure = isSure(sureOf(maps, map, 0, eight.bounds.data()), radius);
        ASSERT_TRUE(is_free || !is_sure) << "radius " << radius << " at " << eight.x[0] << " "
                                         << eight.y[0] << " " << eight.z[0];
        sure.add(is_sure);
        free += is_free ? 1U : 0U;
      }
    }
  }
  sure.expectBothSides();
  EXPECT_GT(sure.yes, free * 9 / 10);
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
  const std::uint32_t map = any.add(makeFloorClearance(room.scene(), 0, kUnevenness, heights));
  ClearanceMaps never_low({2});
  ASSERT_EQ(never_low.add(makeFloorClearance(room.scene(), 0, kUnevenness, heights, lowest)), map);
  std::size_t known = 0;
  std::size_t known_more = 0;
  for (int n = 0; n < 5000; ++n) {
    const Eight eight(random, grid.radius() + uniformIn(random, 0, 2 * kOverFloor));
    const bool is_free = grid.firstNotFree({eight.x, eight.y, eight.z}) == kLanes;
    const SureGroups before = sureOf(any, map, 0, eight.bounds.data());
    const SureGroups now = sureOf(never_low, map, 0, eight.bounds.data());
    ASSERT_TRUE(is_free || (now.free & 1U) == 0);
    // Others are higher than the rug, as far as any map knows, or lower than what is ever asked.
    const float over_floor = *std::ranges::min_element(eight.y);
    if (over_floor < lowest[2] || over_floor >= grid.radius() + kUnevenness) continue;
    known += before.free & 1U;
    known_more += now.free & 1U;
  }
  EXPECT_GT(known_more, 2 * known);
}

TEST(ClearanceMaps, SayHowFarWhatIsSurelyFreeMayGo) {
  constexpr std::uint32_t kSeed = 1506;
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  std::size_t moved = 0;
  std::size_t far = 0;
  std::size_t one_way = 0;
  for (int round = 0; round < 20; ++round) {
    const BoxRoom room = furnishedRoom(random, 5);
    ClearanceMaps maps({0, 1, 2});
    const std::uint32_t map = maps.add(makeFloorClearance(room.scene(), 0, kUnevenness, kHeights));
    for (int n = 0; n < 2000; ++n) {
      const Eight eight(random);
      const SureGroups sure = sureOf(maps, map, 0, eight.bounds.data());
      ASSERT_EQ(maps.freeAfter(map, 0, sure, 0, 0) & ~sure.free, 0U);
      const float by_x = uniformIn(random, -0.2F, 0.2F);
      const float by_z = uniformIn(random, -0.2F, 0.2F);
      const unsigned free = maps.freeAfter(map, 0, sure, by_x, by_z);
      ASSERT_EQ(free & ~sure.free, 0U);
      for (std::uint32_t radius = 0; radius < room.scene().grids().size(); ++radius) {
        if (!isSure(sure, radius)) continue;
        ++moved;
        const bool back = (maps.freeAfter(map, 0, sure, -by_x, -by_z) >> radius & 1U) != 0;
        if ((free >> radius & 1U) == 0) continue;
        Eight other = eight;
        for (float& x : other.x) x += by_x;
        for (float& z : other.z) z += by_z;
        ASSERT_EQ(room.scene().grids()[radius].firstNotFree({other.x, other.y, other.z}), kLanes)
            << "radius " << radius << ", by " << by_x << " " << by_z;
        ++far;
        one_way += back ? 0U : 1U;
      }
    }
  }
  EXPECT_GT(far, moved / 10);
  EXPECT_LT(far, moved * 9 / 10);
  // Away from what is near there is more room than towards it.
  EXPECT_GT(one_way, far / 10);
}

/// Whether all columns are free that some eight's bounds reach. `margin`: so much wider on all
/// sides, meters.
bool areColumnsFree(const ColumnGrid& grid, const Eight& eight, float margin) {
  const auto column_of = [&](float at) {
    return static_cast<int>(std::floor(at / grid.spacing()));
  };
  const auto first = [&](std::size_t bound) {
    return column_of(eight.bounds[bound * kLanes] - margin);
  };
  const auto last = [&](std::size_t bound) {
    return column_of(eight.bounds[bound * kLanes] + margin);
  };
  const auto middle = [&](int n) { return (static_cast<float>(n) + 0.5F) * grid.spacing(); };
  for (int i = first(0); i <= last(1); ++i) {
    for (int k = first(4); k <= last(5); ++k) {
      if (grid.clearance({middle(i), 0.6F, middle(k)}) != Clearance::kFree) return false;
    }
  }
  return true;
}

/// In a room with blocks from the floor to far above the robot, so that a column is free at all
/// heights that are asked about or at none. `columns`: along an edge of it. `step`: what room is
/// counted in, meters.
void expectToKnowOfEachColumn(std::uint32_t columns, float step) {
  constexpr std::uint32_t kSeed = 1508;
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  const BoxRoom room(
      {{{1.2F, -1, 0.7F}, {1.6F, 2.9F, 1.1F}}, {{2.1F, -1, 2.2F}, {2.2F, 2.9F, 2.9F}}}, columns);
  ClearanceMaps maps({0, 1, 2});
  const std::uint32_t map = maps.add(makeFloorClearance(room.scene(), 0, kUnevenness, kHeights));
  Tally sure_in_all;
  std::size_t free = 0;
  std::size_t unknown = 0;
  for (int n = 0; n < 4000; ++n) {
    const Eight eight(random, 0.5F);
    const SureGroups sure = sureOf(maps, map, 0, eight.bounds.data());
    for (std::uint32_t radius = 0; radius < room.scene().grids().size(); ++radius) {
      const ColumnGrid& grid = room.scene().grids()[radius];
      const bool is_sure = isSure(sure, radius);
      sure_in_all.add(is_sure);
      ASSERT_TRUE(!is_sure || areColumnsFree(grid, eight, 0)) << "radius " << radius;
      // A rectangle begins with a whole cell, and ends with a whole step.
      const float lost = (kStepsPerCell + 1) * step;
      if (!areColumnsFree(grid, eight, lost)) continue;
      ++free;
      unknown += is_sure ? 0U : 1U;
    }
  }
  sure_in_all.expectBothSides();
  // Not all that is free around a corner is in one rectangle.
  EXPECT_LT(unknown, free / 50);
}

TEST(ClearanceMaps, KnowOfEachColumn) {
  expectToKnowOfEachColumn(BoxRoom::kColumns, BoxRoom::kSpacing);
}

TEST(ClearanceMaps, CountSeveralColumnsOfAFineGridAsOne) {
  constexpr float kFiner = 4;
  static_assert(kMostRoom * BoxRoom::kSpacing / kFiner < 0.125F,
                "room would be counted in columns");
  expectToKnowOfEachColumn(BoxRoom::kColumns * static_cast<std::uint32_t>(kFiner),
                           BoxRoom::kSpacing);
}

TEST(ClearanceMaps, AnswerSeveralEnvsAsTheyAnswerEach) {
  std::mt19937 random(1507);
  const BoxRoom room = furnishedRoom(random, 5);
  ClearanceMaps maps({0, 1, 2});
  const std::uint32_t map = maps.add(makeFloorClearance(room.scene(), 0, kUnevenness, kHeights));
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
    expectSame(sure[env], sureOf(maps, map_of[env], 0, bounds.data() + env * kStride));
  }
}

TEST(ClearanceMaps, AnswerAlikeWithBothKernels) {
  if (!detail::hasAvx2()) GTEST_SKIP() << "this processor has no AVX2";
  constexpr std::uint32_t kSeed = 1502;
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  // A map by hand: rooms at random, and few that end at once.
  ClearanceLanes lanes{};
  std::vector<RoomAround> cells(64 * 8 * 8 * kClearancePlanes + 1);
  for (RoomAround& cell : cells) cell = static_cast<RoomAround>(random() | 0x1111U);
  for (std::size_t n = 0; n < kLanes; ++n) {
    lanes.inverse_step[n] = 32;
    lanes.steps_x[n] = 100;
    lanes.steps_z[n] = 120;
    lanes.lowest[n] = 0.2F;
    lanes.low[n] = 0.3F;
    lanes.highest[n] = 1.4F;
    lanes.band_from[n] = 0.1F;
    lanes.inverse_band[n] = kClearanceBands / 1.3F;
    lanes.band_cells[n] = 64 * 8 * 8;
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
    expectSame(fast, found);
    CenterBounds box;
    for (std::size_t b = 0; b < kBounds; ++b) box.values[b] = eight.bounds[b * kLanes];
    const BoxQuestion of_box{&lanes, &box};
    unsigned free = 0;
    boxesSurelyFreePortable(&of_box, 1, cells.data(), &free);
    ASSERT_EQ(free, found.free);
    free = 0;
    boxesSurelyFreeAvx2(&of_box, 1, cells.data(), &free);
    ASSERT_EQ(free, found.free);
    const float x = uniformIn(random, -0.2F, 0.2F);
    const float z = uniformIn(random, -0.2F, 0.2F);
    const unsigned after = freeAfterPortable(lanes, found, x, z);
    ASSERT_EQ(freeAfterAvx2(lanes, fast, x, z), after);
    still += after == 0 ? 0U : 1U;
    sure += found.free == 0 ? 0U : 1U;
    low += found.free != 0 && *std::ranges::min_element(eight.y) < lanes.low[0] ? 1U : 0U;
  }
  EXPECT_GT(low, kRounds / 50);
  EXPECT_GT(still, kRounds / 50);
  EXPECT_GT(sure, kRounds / 10);
  EXPECT_LT(sure, kRounds * 9 / 10);
}

TEST(ClearanceMaps, KnowNothingWithoutAMap) {
  std::mt19937 random(1503);
  const Eight eight(random);
  // Two eights of lanes.
  const ClearanceMaps maps(std::vector<std::uint32_t>(kLanes + 1));
  const SureGroups sure = sureOf(maps, kNoClearanceMap, 1, eight.bounds.data());
  EXPECT_EQ(sure.free, 0U);
  EXPECT_EQ(maps.freeAfter(kNoClearanceMap, 1, sure, 0, 0), 0U);
  constexpr std::array<std::uint32_t, 2> kNone{kNoClearanceMap, kNoClearanceMap};
  std::array<SureGroups, 2> of_each;
  for (SureGroups& groups : of_each) groups.free = 1;
  maps.surelyFree(kNone, 1, {eight.bounds.data(), kLanes}, 0, of_each);
  EXPECT_EQ(of_each[0].free | of_each[1].free, 0U);
  const std::array<CenterBounds, 2> bounds{};
  std::array<unsigned, 2> free{1, 1};
  maps.surelyFree(kNone, 1, bounds, free);
  EXPECT_EQ(free[0] | free[1], 0U);
}

TEST(ClearanceMaps, TakeNoMoreThanThereIsRoomFor) {
  std::mt19937 random(1505);
  const BoxRoom room = furnishedRoom(random, 5);
  std::uint32_t added = 0;
  ClearanceMaps maps({0}, 100'000);
  while (maps.add(makeFloorClearance(room.scene(), 0, kUnevenness, kHeights)) == added + 1) ++added;
  // The same that fits into more room.
  EXPECT_GT(added, 0U);
  EXPECT_EQ(maps.add(makeFloorClearance(room.scene(), 0, kUnevenness, kHeights)), kNoClearanceMap);
  ClearanceMaps more({0}, 200'000);
  for (std::uint32_t n = 1; n <= added + 1; ++n) {
    EXPECT_EQ(more.add(makeFloorClearance(room.scene(), 0, kUnevenness, kHeights)), n);
  }
  const Eight eight(random);
  expectSame(sureOf(maps, added, 0, eight.bounds.data()), sureOf(more, 1, 0, eight.bounds.data()));
}

TEST(ClearanceMaps, AreNotFooledByWhatIsNoNumber) {
  std::mt19937 random(1504);
  const BoxRoom room = furnishedRoom(random, 5);
  ClearanceMaps maps({0});
  const std::uint32_t map = maps.add(makeFloorClearance(room.scene(), 0, kUnevenness, kHeights));
  for (const float odd : {std::numeric_limits<float>::quiet_NaN(), 1e30F, -1e30F}) {
    alignas(32) std::array<float, kBounds * kLanes> bounds;
    bounds.fill(odd);
    EXPECT_EQ(sureOf(maps, map, 0, bounds.data()).free, 0U) << odd;
  }
}

}  // namespace
}  // namespace galactic::test::clearance_map_test
