// Free slices against the columns themselves.
#include "simulation/ways_out/free_slices.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>
#include <vector>

#include "support/homes/box_room.h"
#include "support/processor.h"

namespace galactic::test::free_slices_test {
namespace {

using namespace galactic::simulation;

constexpr unsigned kAllLanes = 0xff;
constexpr HeightsOverFloor kHeights{.lowest = 0.2F, .highest = 1.25F};

struct Eight {
  explicit Eight(std::mt19937& random) {
    for (std::size_t n = 0; n < kLanes; ++n) {
      x[n] = uniformIn(random, -0.2F, 3.2F);
      y[n] = uniformIn(random, 0.1F, 1.4F);
      z[n] = uniformIn(random, -0.2F, 3.2F);
    }
  }

  alignas(32) std::array<float, kLanes> x{}, y{}, z{};
};

struct TwoEights {
  explicit TwoEights(std::mt19937& random) {
    for (std::size_t first = 0; first < x.size(); first += kLanes) {
      const Eight eight(random);
      std::ranges::copy(eight.x, x.begin() + static_cast<std::ptrdiff_t>(first));
      std::ranges::copy(eight.y, y.begin() + static_cast<std::ptrdiff_t>(first));
      std::ranges::copy(eight.z, z.begin() + static_cast<std::ptrdiff_t>(first));
    }
  }

  alignas(32) std::array<float, 2 * kLanes> x{}, y{}, z{};
};

/// Whether both say the same of the centers that are inside.
bool areSame(const EightPlaces& one, const EightPlaces& other) {
  if (one.inside != other.inside || one.free != other.free || one.blocked != other.blocked) {
    return false;
  }
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    if ((one.inside >> lane & 1U) == 0) continue;
    if (one.row[lane] != other.row[lane] || one.column[lane] != other.column[lane] ||
        one.part_x[lane] != other.part_x[lane] || one.part_z[lane] != other.part_z[lane]) {
      return false;
    }
  }
  return true;
}

TEST(FreeSlices, CallFreeOrBlockedOnlyWhatTheColumnsDo) {
  constexpr std::uint32_t kSeed = 1601;
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  Tally said;
  Tally said_blocked;
  std::size_t free_cells = 0;
  std::size_t missed = 0;
  std::size_t unknown = 0;
  for (int round = 0; round < 10; ++round) {
    const BoxRoom room = furnishedRoom(random, 6);
    FreeSlices slices({{0, BoxRoom::kRadii[0], kAllLanes},
                       {1, BoxRoom::kRadii[1], kAllLanes},
                       {2, BoxRoom::kRadii[2], kAllLanes}});
    const std::uint32_t map = slices.add(makeFloorSlices(room.scene(), 0, kHeights));
    for (int n = 0; n < 300; ++n) {
      const auto radius = static_cast<std::uint32_t>(n % 3);
      const ColumnGrid& grid = room.scene().grids()[radius];
      const Eight eight(random);
      EightPlaces places;
      const InSlices found = slices.findPlaces(
          map, radius, {eight.x.data(), eight.y.data(), eight.z.data(), 1, &places});
      ASSERT_EQ(found.blocked, places.blocked);
      ASSERT_EQ(found.unknown, kAllLanes & ~(places.free | places.blocked));
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const Vec3 center{eight.x[lane], eight.y[lane], eight.z[lane]};
        const bool is_free = (places.free >> lane & 1U) != 0;
        ASSERT_TRUE(!is_free || grid.clearance(center) == Clearance::kFree);
        const auto around = slices.around(map, radius, center);
        ASSERT_EQ(around.has_value(), (places.inside >> lane & 1U) != 0);
        if (!around) continue;
        ASSERT_EQ(around->isFree(0, 0), is_free);
        const Surroundings exact = surroundingsOf(grid, center);
        const Surroundings cells = around->cells();
        const Surroundings blocked = around->blockedCells();
        for (int z = -kCellsAround; z <= kCellsAround; ++z) {
          for (int x = -kCellsAround; x <= kCellsAround; ++x) {
            ASSERT_EQ(cells.isFree(x, z), around->isFree(x, z));
            ASSERT_TRUE(!cells.isFree(x, z) || exact.isFree(x, z));
            // A set of cells: what is in it is blocked.
            const bool is_blocked = blocked.isFree(x, z);
            ASSERT_FALSE(is_blocked && exact.isFree(x, z));
            unknown += is_blocked || cells.isFree(x, z) ? 0U : 1U;
            said.add(cells.isFree(x, z));
            if (!cells.isFree(x, z)) said_blocked.add(is_blocked);
            free_cells += exact.isFree(x, z) ? 1U : 0U;
            missed += exact.isFree(x, z) && !cells.isFree(x, z) ? 1U : 0U;
          }
        }
      }
    }
  }
  said.expectBothSides();
  said_blocked.expectBothSides();
  EXPECT_LT(unknown, free_cells / 10);
  // Slices are as thick as they are: what lies closely above a table is lost.
  EXPECT_LT(missed, free_cells / 10);
}

TEST(FreeSlices, AreTheSameBitForBitWithBothKernels) {
  if (!detail::hasAvx2()) GTEST_SKIP() << "this processor has no AVX2";
  std::mt19937 random(1602);
  std::vector<SliceTile> tiles(100);
  for (SliceTile& tile : tiles) {
    for (std::uint16_t& row : tile.free) row = static_cast<std::uint16_t>(random());
    for (std::uint16_t& row : tile.blocked) row = static_cast<std::uint16_t>(random());
  }
  // 80 x 60 columns are 10 x 3 tiles.
  std::vector<std::uint32_t> numbers(std::size_t{10} * 3 * 20);
  for (std::uint32_t& number : numbers) {
    number = static_cast<std::uint32_t>(random() % tiles.size());
  }
  const TileSet set{numbers.data(), tiles.data()};
  // Of two groups, the second has spheres in half of its lanes.
  std::array<SliceGroup, 2> groups;
  groups[0] = {{.min_x = 0.1F,
                .min_z = 0.2F,
                .inverse_spacing = 32,
                .columns_x = 80,
                .columns_z = 60,
                .lowest = 0.15F,
                .inverse_slice = 24,
                .slices = 20,
                .slice_count = 20,
                .tiles_z = 3,
                .first = 0},
               kAllLanes};
  groups[1] = {groups[0].layout, 0x0fU};
  groups[1].layout.slices = 10;
  Tally inside;
  for (unsigned n = 0; n < 2000; ++n) {
    TwoEights centers(random);
    if (n == 0) centers.x[3] = std::numeric_limits<float>::quiet_NaN();
    std::array<EightPlaces, 2> portable;
    std::array<EightPlaces, 2> fast;
    const auto find = [&](const auto& kernel, std::array<EightPlaces, 2>& places) {
      const unsigned asked = n % 3 + 1;
      const SomeGroups some{centers.x.data(), centers.y.data(), centers.z.data(), asked,
                            places.data()};
      return kernel({groups.data(), set, &some});
    };
    const InSlices found = find(findPlacesPortable, portable);
    const InSlices found_fast = find(findPlacesAvx2, fast);
    ASSERT_EQ(found.blocked, found_fast.blocked);
    ASSERT_EQ(found.unknown, found_fast.unknown);
    ASSERT_EQ(found.blocked & ~std::uint64_t{0x0fff}, 0U);
    for (std::size_t group = 0; group < groups.size(); ++group) {
      ASSERT_TRUE(areSame(portable[group], fast[group]));
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        inside.add((fast[group].inside >> lane & 1U) != 0);
      }
    }
  }
  inside.expectBothSides();
}

TEST(FreeSlices, AnswerSeveralEnvsAsTheyAnswerEach) {
  constexpr std::uint32_t kSeed = 1609;
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  const BoxRoom room = furnishedRoom(random, 6);
  constexpr std::size_t kGroups = 3;
  constexpr std::array<unsigned, kGroups> kSpheres{kAllLanes, kAllLanes, 0x1fU};
  FreeSlices slices({{0, BoxRoom::kRadii[0], kSpheres[0]},
                     {1, BoxRoom::kRadii[1], kSpheres[1]},
                     {2, BoxRoom::kRadii[2], kSpheres[2]}});
  const std::uint32_t map = slices.add(makeFloorSlices(room.scene(), 0, kHeights));
  // Of each env, its groups, then something else.
  constexpr std::size_t kStride = kGroups * kLanes + 5;
  constexpr std::size_t kPlacesStride = kGroups + 1;
  Tally blocked;
  Tally unknown;
  for (int round = 0; round < 300; ++round) {
    std::array<float, kEnvsAsked * kStride> x;
    std::array<float, kEnvsAsked * kStride> y;
    std::array<float, kEnvsAsked * kStride> z;
    std::ranges::generate(x, [&] { return uniformIn(random, -0.2F, 3.2F); });
    std::ranges::generate(y, [&] { return uniformIn(random, 0.1F, 1.4F); });
    std::ranges::generate(z, [&] { return uniformIn(random, -0.2F, 3.2F); });
    std::array<std::uint32_t, kEnvsAsked> maps;
    std::ranges::generate(maps, [&] { return random() % 4 == 0 ? kNoClearanceMap : map; });
    std::uint64_t asked = 0;
    for (std::size_t e = 0; e < kEnvsAsked; ++e) {
      asked |= std::uint64_t{random() & random() & ((1U << kGroups) - 1)} << (kLanes * e);
    }
    std::array<EightPlaces, kEnvsAsked * kPlacesStride> places;
    std::array<InSlices, kEnvsAsked> found;
    slices.findPlaces(maps, 0,
                      {.x = x.data(),
                       .y = y.data(),
                       .z = z.data(),
                       .stride = kStride,
                       .asked = asked,
                       .places = places.data(),
                       .places_stride = kPlacesStride,
                       .found = found.data()});
    for (std::size_t e = 0; e < kEnvsAsked; ++e) {
      const auto groups = static_cast<unsigned>(asked >> (kLanes * e)) & 0xffU;
      std::array<EightPlaces, kGroups> each;
      const InSlices alone = slices.findPlaces(maps[e], 0,
                                               {.x = x.data() + e * kStride,
                                                .y = y.data() + e * kStride,
                                                .z = z.data() + e * kStride,
                                                .asked = groups,
                                                .places = each.data()});
      ASSERT_EQ(found[e].blocked, alone.blocked);
      ASSERT_EQ(found[e].unknown, alone.unknown);
      std::uint64_t spheres = 0;
      for (std::size_t n = 0; n < kGroups; ++n) {
        const bool is_asked = (groups >> n & 1U) != 0;
        spheres |= std::uint64_t{is_asked ? kSpheres[n] : 0} << (kLanes * n);
      }
      ASSERT_TRUE(maps[e] != kNoClearanceMap || alone.unknown == spheres);
      blocked.add(alone.blocked != 0);
      unknown.add(alone.unknown != 0);
      for (std::size_t n = 0; n < kGroups; ++n) {
        const bool is_asked = (groups >> n & 1U) != 0;
        ASSERT_TRUE(!is_asked || areSame(places[e * kPlacesStride + n], each[n]));
      }
    }
  }
  blocked.expectBothSides();
  unknown.expectBothSides();
}

TEST(FreeSlices, OfSeveralEnvsAreTheSameBitForBitWithBothKernels) {
  if (!detail::hasAvx2()) GTEST_SKIP() << "this processor has no AVX2";
  std::mt19937 random(1610);
  std::vector<SliceTile> tiles(50);
  for (SliceTile& tile : tiles) {
    for (std::uint16_t& row : tile.free) row = static_cast<std::uint16_t>(random());
    for (std::uint16_t& row : tile.blocked) row = static_cast<std::uint16_t>(random());
  }
  const SliceGroup somewhere{{.inverse_spacing = 32,
                              .columns_x = 16,
                              .columns_z = 24,
                              .inverse_slice = 4,
                              .slices = 2,
                              .slice_count = 2,
                              .tiles_z = 1},
                             kAllLanes};
  const std::array<std::uint32_t, 4> numbers{7, 49, 0, 21};
  // Of one env in two, nothing is known.
  std::array<SliceGroup, kLanes> here;
  std::array<SliceGroup, kLanes> nowhere;
  here.fill(somewhere);
  nowhere.fill({{}, kAllLanes});
  std::array<const SliceGroup*, kEnvsAsked> groups;
  for (std::size_t e = 0; e < kEnvsAsked; ++e)
    groups[e] = e % 2 == 0 ? here.data() : nowhere.data();
  Tally blocked;
  for (int round = 0; round < 500; ++round) {
    constexpr std::size_t kStride = kLanes * kLanes;
    std::vector<float> x(kEnvsAsked * kStride);
    std::vector<float> y(x.size());
    std::vector<float> z(x.size());
    std::ranges::generate(x, [&] { return uniformIn(random, -0.1F, 0.6F); });
    std::ranges::generate(y, [&] { return uniformIn(random, -0.1F, 0.6F); });
    std::ranges::generate(z, [&] { return uniformIn(random, -0.1F, 0.9F); });
    const std::uint64_t asked = std::uint64_t{random()} << 32U | random();
    std::vector<EightPlaces> portable(kEnvsAsked * kLanes);
    std::vector<EightPlaces> fast(portable.size());
    const auto find = [&](const auto& kernel, std::vector<EightPlaces>& places) {
      std::array<InSlices, kEnvsAsked> found;
      const GroupsOfEnvs some{.x = x.data(),
                              .y = y.data(),
                              .z = z.data(),
                              .stride = kStride,
                              .asked = asked,
                              .places = places.data(),
                              .places_stride = kLanes,
                              .found = found.data()};
      kernel({.groups = groups.data(), .tiles = {numbers.data(), tiles.data()}, .some = &some});
      return found;
    };
    const auto found = find(findPlacesOfEnvsPortable, portable);
    const auto found_fast = find(findPlacesOfEnvsAvx2, fast);
    for (std::size_t e = 0; e < kEnvsAsked; ++e) {
      ASSERT_EQ(found[e].blocked, found_fast[e].blocked);
      ASSERT_EQ(found[e].unknown, found_fast[e].unknown);
      blocked.add(found[e].blocked != 0);
    }
    for (std::size_t n = 0; n < portable.size(); ++n) ASSERT_TRUE(areSame(portable[n], fast[n]));
  }
  blocked.expectBothSides();
}

TEST(FreeSlices, SayOfEachFloorWhatTheySayOfItAlone) {
  std::mt19937 random(1608);
  FreeSlices all;
  FloorSlices slices;
  Tally free;
  for (std::uint32_t n = 1; n <= 5; ++n) {
    const BoxRoom room = furnishedRoom(random, 12);
    const float floor = 0.1F * static_cast<float>(n);
    slices = makeFloorSlices(room.scene(), floor, kHeights);
    FreeSlices alone;
    const std::uint32_t only = alone.add(slices);
    const std::uint32_t map = all.add(slices);
    ASSERT_EQ(map, n);
    for (int asked = 0; asked < 2000; ++asked) {
      const auto radius = static_cast<std::uint32_t>(asked % 3);
      const Vec3 center{uniformIn(random, -0.2F, 3.2F), uniformIn(random, 0.1F, 1.2F),
                        uniformIn(random, -0.2F, 3.2F)};
      const auto found = all.around(map, radius, center);
      const auto wanted = alone.around(only, radius, center);
      ASSERT_EQ(found.has_value(), wanted.has_value());
      if (!found) continue;
      ASSERT_EQ(found->cells().rows, wanted->cells().rows);
      ASSERT_EQ(found->blockedCells().rows, wanted->blockedCells().rows);
      free.add(found->isFree(0, 0));
    }
  }
  // What floors have in common is kept once.
  const std::size_t before = all.bytes();
  all.add(slices);
  EXPECT_EQ(all.bytes() - before, slices.numbers.size() * sizeof(slices.numbers.front()));
  free.expectBothSides();
}

TEST(SurroundingsOf, AreThoseOfTheColumns) {
  std::mt19937 random(1603);
  const BoxRoom room = furnishedRoom(random, 6);
  const ColumnGrid& grid = room.scene().grids()[1];
  Tally free;
  for (int n = 0; n < 500; ++n) {
    const Vec3 center{uniformIn(random, 0, 3), uniformIn(random, 0, 1.5F), uniformIn(random, 0, 3)};
    const Surroundings around = surroundingsOf(grid, center);
    for (int z = -kCellsAround; z <= kCellsAround; ++z) {
      for (int x = -kCellsAround; x <= kCellsAround; ++x) {
        const auto at = [&](float from, int cells) {
          return (std::floor(from / BoxRoom::kSpacing) + static_cast<float>(cells) + 0.5F) *
                 BoxRoom::kSpacing;
        };
        const Clearance clearance = grid.clearance({at(center.x, x), center.y, at(center.z, z)});
        ASSERT_EQ(around.isFree(x, z), clearance == Clearance::kFree);
        free.add(around.isFree(x, z));
      }
    }
  }
  free.expectBothSides();
}

}  // namespace
}  // namespace galactic::test::free_slices_test
