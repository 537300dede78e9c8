// Free slices against the columns themselves, and ways out against a search of all of them.
#include "simulation/ways_out/way_out.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <random>
#include <span>
#include <vector>

#include "column_grid/column_grid_kernels.h"
#include "simulation/ways_out/column_ways.h"
#include "support/homes/box_room.h"
#include "support/packs/grid_builder.h"

namespace galactic::test::way_out_test {
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
    const std::uint32_t map = slices.add(room.scene(), 0, kHeights);
    for (int n = 0; n < 300; ++n) {
      const auto radius = static_cast<std::uint32_t>(n % 3);
      const ColumnGrid& grid = room.scene().grids()[radius];
      const Eight eight(random);
      EightPlaces places;
      const InSlices found = slices.findPlaces(
          map, radius, {eight.x.data(), eight.y.data(), eight.z.data(), 1, &places});
      ASSERT_EQ(found.blocked, places.blocked);
      ASSERT_EQ(found.unknown != 0, (places.free | places.blocked) != kAllLanes);
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

/// Cells of 1 m.
struct Sphere {
  Surroundings around;
  float part_x = 0;
  float part_z = 0;

  /// In double precision.
  [[nodiscard]] bool isFreeAfter(double by_x, double by_z) const {
    const double x = std::floor(static_cast<double>(part_x) + by_x);
    const double z = std::floor(static_cast<double>(part_z) + by_z);
    return std::abs(x) <= kCellsAround && std::abs(z) <= kCellsAround &&
           around.isFree(static_cast<int>(x), static_cast<int>(z));
  }
};

/// Spheres of a robot at furniture: half of the cells around each are blocked on one side, or a
/// block of them is.
std::vector<Sphere> randomSpheres(std::mt19937& random) {
  std::vector<Sphere> spheres(1 + random() % 8);
  for (Sphere& sphere : spheres) {
    sphere.part_x = uniformIn(random, 0.01F, 0.99F);
    sphere.part_z = uniformIn(random, 0.01F, 0.99F);
    const float angle = uniformIn(random, 0, 6.28F);
    const float from = uniformIn(random, -1.5F, 3);
    const bool is_pole = random() % 2 == 0;
    for (int z = -kCellsAround; z <= kCellsAround; ++z) {
      for (int x = -kCellsAround; x <= kCellsAround; ++x) {
        const float along =
            static_cast<float>(x) * std::cos(angle) + static_cast<float>(z) * std::sin(angle);
        const float across =
            static_cast<float>(z) * std::cos(angle) - static_cast<float>(x) * std::sin(angle);
        const bool is_blocked = along > from && (!is_pole || std::fabs(across) < 1.5F);
        if (!is_blocked) sphere.around.setFree(x, z);
      }
    }
  }
  return spheres;
}

std::optional<Push> pushOf(const FoundWay& way) {
  if (way.squared == kNoWay) return std::nullopt;
  EXPECT_EQ(way.squared, way.x * way.x + way.z * way.z);
  return Push{way.x, way.z};
}

std::optional<Push> wayOut(std::span<const Sphere> spheres, const Push& drive, float longest) {
  WayOut way(spheres.size());
  way.clear(1);
  for (const Sphere& sphere : spheres) way.add(sphere.around, sphere.part_x, sphere.part_z);
  return pushOf(way.shortest(drive, longest));
}

bool areFreeAfter(std::span<const Sphere> spheres, double by_x, double by_z) {
  return std::ranges::all_of(spheres,
                             [&](const Sphere& sphere) { return sphere.isFreeAfter(by_x, by_z); });
}

/// The places along one axis where some sphere enters a cell, and 0.
std::vector<double> borders(std::span<const Sphere> spheres, bool along_x) {
  constexpr auto kMargin = static_cast<double>(kIntoCell);
  std::vector<double> all{0};
  for (const Sphere& sphere : spheres) {
    const auto part = static_cast<double>(along_x ? sphere.part_x : sphere.part_z);
    for (int cell = -kCellsAround; cell <= kCellsAround; ++cell) {
      all.push_back(cell - part + (cell > 0 ? kMargin : 1 - kMargin));
    }
  }
  return all;
}

/// The length of the shortest way out; infinity for none.
double shortestOfAll(std::span<const Sphere> spheres) {
  double shortest = std::numeric_limits<double>::infinity();
  for (const double x : borders(spheres, true)) {
    for (const double z : borders(spheres, false)) {
      if (std::hypot(x, z) < shortest && areFreeAfter(spheres, x, z)) shortest = std::hypot(x, z);
    }
  }
  return shortest;
}

constexpr float kAny = 5;
constexpr float kRounding = 1e-5F;

TEST(WayOut, LeadsToWhereAllSpheresAreFreeAndIsLittleLongerThanTheShortest) {
  constexpr std::uint32_t kSeed = 1604;
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  Tally found;
  int longer = 0;
  double excess = 0;
  int compared = 0;
  for (int round = 0; round < 4000; ++round) {
    const std::vector<Sphere> spheres = randomSpheres(random);
    if (areFreeAfter(spheres, 0, 0)) continue;
    const std::optional<Push> push = wayOut(spheres, {}, kAny);
    found.add(push.has_value());
    if (!push) continue;
    const auto x = static_cast<double>(push->x);
    const auto z = static_cast<double>(push->z);
    ASSERT_TRUE(areFreeAfter(spheres, x, z)) << "round " << round;
    const double shortest = shortestOfAll(spheres);
    ASSERT_LE(shortest, std::hypot(x, z) + static_cast<double>(kRounding));
    longer += std::hypot(x, z) > shortest + 1e-3 ? 1 : 0;
    excess += std::hypot(x, z) - shortest;
    ++compared;
  }
  found.expectBothSides();
  // It shortens along one axis before it does along the other, and misses ways between whole cells.
  std::printf("%d of %d are longer than the shortest, all by %.3f cells on average\n", longer,
              compared, excess / compared);
  EXPECT_LT(longer, compared / 3);
  EXPECT_LT(excess, 0.2 * compared);
}

TEST(WayOut, IsTheSameForSpheresInAnyOrder) {
  std::mt19937 random(1605);
  int found = 0;
  for (int round = 0; round < 1000; ++round) {
    std::vector<Sphere> spheres = randomSpheres(random);
    const std::optional<Push> first = wayOut(spheres, {1, 0}, kAny);
    std::ranges::shuffle(spheres, random);
    const std::optional<Push> second = wayOut(spheres, {1, 0}, kAny);
    ASSERT_EQ(first.has_value(), second.has_value());
    if (!first) continue;
    ASSERT_EQ(first->x, second->x);
    ASSERT_EQ(first->z, second->z);
    ++found;
  }
  EXPECT_GT(found, 300);
}

Surroundings mirrored(const Surroundings& around) {
  Surroundings other;
  for (int z = -kCellsAround; z <= kCellsAround; ++z) {
    for (int x = -kCellsAround; x <= kCellsAround; ++x) {
      if (around.isFree(x, z)) other.setFree(x, -z);
    }
  }
  return other;
}

TEST(WayOut, OfAMirrorImageIsTheMirrorImage) {
  std::mt19937 random(1606);
  int found = 0;
  for (int round = 0; round < 2000; ++round) {
    const std::vector<Sphere> spheres = randomSpheres(random);
    if (areFreeAfter(spheres, 0, 0)) continue;
    std::vector<Sphere> image = spheres;
    for (Sphere& sphere : image) {
      sphere = {mirrored(sphere.around), sphere.part_x, 1 - sphere.part_z};
    }
    const Push drive{uniformIn(random, -1, 1), uniformIn(random, -1, 1)};
    const std::optional<Push> push = wayOut(spheres, drive, kAny);
    const std::optional<Push> other = wayOut(image, {drive.x, -drive.z}, kAny);
    ASSERT_EQ(push.has_value(), other.has_value()) << "round " << round;
    if (!push) continue;
    ASSERT_NEAR(push->x, other->x, kRounding) << "round " << round;
    ASSERT_NEAR(push->z, -other->z, kRounding) << "round " << round;
    ++found;
  }
  EXPECT_GT(found, 300);
}

TEST(WayOut, IsNoLongerThanAllowedAndDoesNotGoOnAlongTheDrive) {
  std::mt19937 random(1607);
  Tally found;
  for (int round = 0; round < 2000; ++round) {
    const std::vector<Sphere> spheres = randomSpheres(random);
    if (areFreeAfter(spheres, 0, 0)) continue;
    const Push drive{uniformIn(random, -1, 1), uniformIn(random, -1, 1)};
    constexpr float kLongest = 1.2F;
    const std::optional<Push> push = wayOut(spheres, drive, kLongest);
    found.add(push.has_value());
    if (!push) continue;
    const float length = std::hypot(push->x, push->z);
    ASSERT_LT(length, kLongest);
    ASSERT_LE(push->x * drive.x + push->z * drive.z,
              0.5F * length * std::hypot(drive.x, drive.z) + kRounding);
  }
  found.expectBothSides();
}

TEST(WayOut, IsNoneForMoreSpheresThanThereIsRoomFor) {
  Sphere sphere;
  sphere.around.setFree(1, 0);
  WayOut way(1);
  way.clear(1);
  for (std::size_t n = 0; n < kLanes; ++n) {
    way.add(sphere.around, 0.5F, 0.5F);
    ASSERT_NE(way.shortest({}, kAny).squared, kNoWay);
  }
  way.add(sphere.around, 0.5F, 0.5F);
  EXPECT_EQ(way.shortest({}, kAny).squared, kNoWay);
}

/// Spheres of a robot among furniture.
struct Body {
  explicit Body(std::mt19937& random) {
    const float x = uniformIn(random, 0.5F, 2.5F);
    const float z = uniformIn(random, 0.5F, 2.5F);
    for (std::size_t n = 1 + random() % 10; n-- > 0;) {
      centers.push_back({x + uniformIn(random, -0.3F, 0.3F), uniformIn(random, 0.15F, 1.3F),
                         z + uniformIn(random, -0.3F, 0.3F)});
      radii.push_back(static_cast<std::uint32_t>(random() % 3));
    }
  }

  std::vector<Vec3> centers;
  std::vector<std::uint32_t> radii;
};

TEST(ColumnWays, AreTheWaysOutThatAllColumnsAllow) {
  constexpr std::uint32_t kSeed = 1609;
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  constexpr float kLongest = 0.15F;
  Tally found;
  int lost = 0;
  for (int round = 0; round < 20; ++round) {
    const BoxRoom room = furnishedRoom(random, 6);
    FreeSlices slices;
    const std::uint32_t map = slices.add(room.scene(), 0, kHeights);
    for (int n = 0; n < 150; ++n) {
      const Body body(random);
      WayOut all(body.centers.size());
      WayOut sliced(body.centers.size());
      WayOut asked(body.centers.size());
      for (WayOut* way : {&all, &sliced, &asked}) way->clear(BoxRoom::kSpacing);
      ColumnWays columns(body.centers.size());
      columns.clear();
      bool is_free = true;
      for (std::size_t s = 0; s < body.centers.size(); ++s) {
        const ColumnGrid& grid = room.scene().grids()[body.radii[s]];
        const Vec3& center = body.centers[s];
        const auto around = slices.around(map, body.radii[s], center);
        const Surroundings exact = surroundingsOf(grid, center);
        is_free = is_free && exact.isFree(0, 0);
        const auto part = [&](float at) {
          const float cell = at * grid.layout().inverse_spacing;
          return cell - std::floor(cell);
        };
        all.add(exact, part(center.x), part(center.z));
        sliced.add(around ? around->cells() : exact, part(center.x), part(center.z));
        columns.add(grid, center, around);
      }
      if (is_free) continue;
      const Push drive{uniformIn(random, -1, 1), uniformIn(random, -1, 1)};
      const std::optional<Push> wanted = pushOf(all.shortest(drive, kLongest));
      const std::optional<Push> push =
          columns.addTo(asked) ? pushOf(asked.shortest(drive, kLongest)) : std::nullopt;
      found.add(push.has_value());
      ASSERT_EQ(push.has_value(), wanted.has_value()) << "round " << round << ", body " << n;
      if (!push) continue;
      ASSERT_EQ(push->x, wanted->x);
      ASSERT_EQ(push->z, wanted->z);
      lost += sliced.shortest(drive, kLongest).squared == kNoWay ? 1 : 0;
    }
  }
  found.expectBothSides();
  // What they are for.
  EXPECT_GT(lost, 0);
}

TEST(ColumnWays, KnowNoWayForMoreSpheresThanThereIsRoomFor) {
  std::mt19937 random(1610);
  const BoxRoom room = furnishedRoom(random, 6);
  const ColumnGrid& grid = room.scene().grids()[0];
  ColumnWays columns(1);
  WayOut way(1);
  way.clear(BoxRoom::kSpacing);
  columns.add(grid, {1.5F, 1.4F, 1.5F}, std::nullopt);
  EXPECT_TRUE(columns.addTo(way));
  columns.add(grid, {1.5F, 1.4F, 1.5F}, std::nullopt);
  EXPECT_FALSE(columns.addTo(way));
}

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
  CommonCells common;
  std::size_t count = 0;

  SomeWays() { std::ranges::fill(common.rows, std::uint16_t{0xffff}); }

  [[nodiscard]] WaysQuery query() {
    return {.ways = ways.data(), .count = count, .deciding = deciding.data(), .common = &common};
  }
};

TEST(WayOut, IsTheSameBitForBitWithBothKernels) {
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

TEST(WayOut, AddsGroupsAsItAddsEachOfThem) {
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

}  // namespace
}  // namespace galactic::test::way_out_test
