// Ways out against a search of all of them.
#include "simulation/ways_out/way_out.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <random>
#include <span>
#include <vector>

#include "simulation/ways_out/column_ways.h"
#include "support/homes/box_room.h"

namespace galactic::test::way_out_test {
namespace {

using namespace galactic::simulation;

constexpr HeightsOverFloor kHeights{.lowest = 0.2F, .highest = 1.25F};

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

TEST(WayOut, IsOpenAsLongAsOneCellIsFreeForAllSpheres) {
  WayOut way(2);
  way.clear(1);
  EXPECT_TRUE(way.isOpen());
  Surroundings corner;
  corner.setFree(kCellsAround, -kCellsAround);
  way.add(corner, 0.5F, 0.5F);
  EXPECT_TRUE(way.isOpen());
  way.add(Surroundings{}, 0.5F, 0.5F);
  EXPECT_FALSE(way.isOpen());
  way.clear(1);
  way.close();
  EXPECT_FALSE(way.isOpen());
  EXPECT_EQ(way.shortest({}, kAny).squared, kNoWay);
  way.clear(1);
  EXPECT_TRUE(way.isOpen());
}

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
    const std::uint32_t map = slices.add(makeFloorSlices(room.scene(), 0, kHeights));
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

}  // namespace
}  // namespace galactic::test::way_out_test
