// The kernels of ways out against each other.
#include "simulation/ways_out/way_out_kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <random>
#include <vector>

#include "support/oracles/resting_oracle.h"
#include "support/processor.h"

namespace galactic::test::way_out_kernels_test {
namespace {

using namespace galactic::simulation;

/// Rows of which most cells are free, and places among them.
struct RandomRows {
  explicit RandomRows(std::mt19937& random) {
    for (std::uint16_t& row : rows) {
      row = static_cast<std::uint16_t>(random() | random() | random() | random());
    }
    // As slices begin.
    std::fill_n(rows.begin(), SliceTile::kRows, std::uint16_t{0xffff});
  }

  [[nodiscard]] static EightPlaces places(std::mt19937& random) {
    EightPlaces places;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      places.row[lane] = static_cast<std::int32_t>(random() % 1000);
      places.column[lane] = static_cast<std::int32_t>(random() % kTileColumns);
      places.part_x[lane] = uniformIn(random, 0, 1);
      places.part_z[lane] = uniformIn(random, 0, 1);
    }
    return places;
  }

  std::vector<std::uint16_t> rows = std::vector<std::uint16_t>(1100);
};

/// Whether both say the same of eight spheres; what rows count from may differ.
bool areSame(const EightWays& one, const EightWays& other) {
  return std::ranges::equal(one.row, other.row) && std::ranges::equal(one.column, other.column) &&
         std::ranges::equal(one.part_x, other.part_x) &&
         std::ranges::equal(one.part_z, other.part_z) &&
         std::ranges::equal(one.cells.rows, other.cells.rows) && one.spheres == other.spheres;
}

/// Ways of some spheres, and the cells that all leave free.
struct SomeWays {
  /// Room for kWaysAtATime, of which the last do not count, and for what groups add.
  std::array<EightWays, kWaysAtATime + kLanes> ways{};
  std::array<DecidingEight, kWaysAtATime + kLanes + 1> deciding;
  CommonCells common = CommonCells::everywhere();
  std::size_t count = 0;

  [[nodiscard]] WaysQuery query() {
    return {.ways = ways.data(), .count = count, .deciding = deciding.data(), .common = &common};
  }
};

TEST(WayKernels, AgreeBitForBit) {
  if (!detail::hasAvx2()) GTEST_SKIP() << "this processor has no AVX2";
  constexpr std::uint32_t kSeed = 1608;
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  const WayKernels portable = portableWays();
  const WayKernels fast = avx2Ways();
  Tally counted;
  Tally found;
  Tally aslant;
  const RandomRows slices(random);
  for (int round = 0; round < 8000; ++round) {
    SomeWays ways;
    SomeWays fast_ways;
    for (std::size_t n = 0; n < 2; ++n) {
      const EightPlaces places = RandomRows::places(random);
      // Few spheres: of many, some one is always blocked.
      const auto lanes = static_cast<unsigned>(random() & random() & 0xffU);
      const bool counts =
          portable.add(slices.rows.data(), places, lanes, ways.ways[n], ways.common);
      ASSERT_EQ(counts,
                fast.add(slices.rows.data(), places, lanes, fast_ways.ways[n], fast_ways.common));
      ASSERT_TRUE(areSame(ways.ways[n], fast_ways.ways[n]));
      counted.add(counts);
    }
    ways.count = fast_ways.count = 2;
    ASSERT_TRUE(std::ranges::equal(ways.common.rows, fast_ways.common.rows));
    // Such cells that a sphere goes a tenth of one into them: many are behind, or near a border.
    constexpr float kWideMargin = 0.1F;
    WaysQuery query = ways.query();
    query.spacing = kIntoCell / kWideMargin;
    query.drive_x = uniformIn(random, -1, 1);
    query.drive_z = round % 4 == 0 ? 0 : uniformIn(random, -1, 1);
    query.longest = uniformIn(random, 0, 6 * query.spacing);
    const FoundWay way = portable.shortest(query);
    query.ways = fast_ways.ways.data();
    const FoundWay fast_way = fast.shortest(query);
    ASSERT_EQ(way.x, fast_way.x);
    ASSERT_EQ(way.z, fast_way.z);
    ASSERT_EQ(way.squared, fast_way.squared);
    found.add(way.squared != kNoWay);
    aslant.add(way.x != 0 && way.z != 0);
  }
  counted.expectBothSides();
  found.expectBothSides();
  aslant.expectBothSides();
}

TEST(WayKernels, AddGroupsAsTheyAddEachOfThem) {
  constexpr std::uint32_t kSeed = 1611;
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  std::vector<WayKernels> all{portableWays()};
  if (detail::hasAvx2()) all.push_back(avx2Ways());
  const RandomRows slices(random);
  Tally whole;
  Tally outside;
  for (int round = 0; round < 2000; ++round) {
    std::array<EightPlaces, kLanes> places;
    std::array<EightSpheres, kLanes> eights;
    for (std::size_t n = 0; n < kLanes; ++n) {
      places[n] = RandomRows::places(random);
      places[n].free = static_cast<unsigned>(random() & 0xffU);
      places[n].inside = static_cast<unsigned>((random() | random() | random()) & 0xffU);
      eights[n].spheres = static_cast<unsigned>(random() & random() & 0xffU);
    }
    const GroupsToAdd groups{.rows = slices.rows.data(),
                             .groups = eights.data(),
                             .places = places.data(),
                             .asked = static_cast<unsigned>(random() & 0xffU),
                             .blocked = std::uint64_t{random()} << 32U | random()};
    for (const WayKernels& kernels : all) {
      SomeWays together;
      const AddedGroups added = kernels.add_groups(groups, together.ways.data(), together.common);
      SomeWays one_by_one;
      for (std::size_t n = 0; n < kLanes; ++n) {
        const bool is_asked = (groups.asked >> n & 1U) != 0;
        const auto blocked = static_cast<unsigned>(groups.blocked >> (n * kLanes));
        const unsigned wanted = eights[n].spheres & (places[n].free | blocked);
        ASSERT_EQ((added.whole >> n & 1U) != 0, is_asked && wanted == eights[n].spheres);
        ASSERT_EQ((added.outside >> n & 1U) != 0, is_asked && (wanted & ~places[n].inside) != 0);
        if (!is_asked) continue;
        whole.add(wanted == eights[n].spheres);
        outside.add((wanted & ~places[n].inside) != 0);
        EightWays& ways = one_by_one.ways[one_by_one.count];
        one_by_one.count +=
            kernels.add(groups.rows, places[n], wanted & places[n].inside, ways, one_by_one.common)
                ? 1U
                : 0U;
      }
      ASSERT_EQ(added.count, one_by_one.count);
      ASSERT_TRUE(std::ranges::equal(together.common.rows, one_by_one.common.rows));
      for (std::size_t n = 0; n < added.count; ++n) {
        ASSERT_TRUE(areSame(together.ways[n], one_by_one.ways[n]));
      }
    }
  }
  whole.expectBothSides();
  outside.expectBothSides();
}

TEST(WayKernels, LeaveCellsThatNoSphereOfGroupsHasBlocked) {
  constexpr std::uint32_t kSeed = 1612;
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  std::vector<WayKernels> all{portableWays()};
  if (detail::hasAvx2()) all.push_back(avx2Ways());
  // In the first tile, nothing is blocked; in one of two of the others much, in the rest little.
  std::vector<SliceTile> tiles(41);
  for (std::size_t n = 1; n < tiles.size(); ++n) {
    for (std::uint16_t& row : tiles[n].blocked) {
      row = static_cast<std::uint16_t>(n % 2 == 0 ? random() & random() & random() & random()
                                                  : random() | random());
    }
  }
  Tally left;
  for (int round = 0; round < 2000; ++round) {
    std::array<EightPlaces, kLanes> places;
    std::array<EightSpheres, kLanes> eights;
    for (std::size_t n = 0; n < kLanes; ++n) {
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const auto tile = static_cast<std::int32_t>(1 + 2 * (random() % 20)) + round % 2;
        places[n].row[lane] = tile * kTileStride + static_cast<std::int32_t>(random() % kTileRows);
        places[n].column[lane] = static_cast<std::int32_t>(random() % kTileColumns);
      }
      places[n].inside = static_cast<unsigned>((random() | random()) & 0xffU);
      eights[n].spheres = static_cast<unsigned>(random() & random() & 0xffU);
    }
    const GroupsToAdd groups{.rows = tiles.front().free,
                             .groups = eights.data(),
                             .places = places.data(),
                             .asked = static_cast<unsigned>(random() & 0xffU)};
    const auto is_blocked = [&](int x, int z) {
      for (std::size_t n = 0; n < kLanes; ++n) {
        if ((groups.asked >> n & 1U) == 0) continue;
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
          if ((eights[n].spheres & places[n].inside & 1U << lane) == 0) continue;
          const std::int32_t row = places[n].row[lane] + z;
          const SliceTile& tile = tiles[static_cast<std::size_t>(row / kTileStride)];
          const std::uint16_t bits = tile.blocked[row % kTileStride];
          if ((bits >> (places[n].column[lane] + x) & 1) != 0) return true;
        }
      }
      return false;
    };
    for (const WayKernels& kernels : all) {
      CommonCells cells = CommonCells::everywhere();
      const bool is_any_left = kernels.leave_unblocked(groups, cells);
      bool is_any = false;
      for (int z = 0; z <= 2 * kCellsAround; ++z) {
        for (int x = 0; x <= 2 * kCellsAround; ++x) {
          const bool is_left = (cells.rows[z] >> x & 1) != 0;
          ASSERT_EQ(is_left, !is_blocked(x, z)) << x << ' ' << z;
          is_any = is_any || is_left;
        }
      }
      ASSERT_EQ(is_any_left, is_any);
      left.add(is_any_left);
    }
  }
  left.expectBothSides();
}

}  // namespace
}  // namespace galactic::test::way_out_kernels_test
