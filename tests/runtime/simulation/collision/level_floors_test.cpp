// Where floors are said to be level, against the floor itself.
#include "simulation/collision/level_floors.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <limits>
#include <optional>
#include <random>

#include "galactic/simulation_options.h"
#include "simulation/collision/floor_query.h"
#include "support/homes/box_room.h"
#include "support/packs/grid_builder.h"
#include "support/sanitized.h"

namespace galactic::test::level_floors_test {
namespace {

using namespace galactic::simulation;

/// The number of the first floor.
constexpr std::uint32_t kFloor = 1;

/// The floor of a room as a simulator asks for it.
LevelFloor levelFloor(const Scene& scene, const GroundOptions& options) {
  const Vec3 start{1.5F, 0, 1.5F};
  const auto height_found = [&](const Vec3& at, float height) {
    const FloorUnder under = floorUnder(scene, {at.x, height, at.z}, options);
    return under.floor == Floor::kCarries ? under.height : std::numeric_limits<float>::quiet_NaN();
  };
  return makeLevelFloor(scene.grids().front(), start, height_found);
}

LevelFloors levelFloors(const Scene& scene, const GroundOptions& options) {
  LevelFloors floors;
  floors.add(levelFloor(scene, options));
  return floors;
}

/// The height at which a base stays.
float heightOf(const Scene& scene, const GroundOptions& options) {
  float height = 0;
  for (int step = 0; step < 8; ++step) {
    height = floorUnder(scene, {1.5F, height, 1.5F}, options).height;
  }
  return height;
}

TEST(LevelFloors, AreWhereABaseFindsTheFloorAtItsHeight) {
  constexpr std::uint32_t kSeed = 1701;
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  const GroundOptions options;
  Tally level;
  for (int round = 0; round < 20; ++round) {
    const BoxRoom room = furnishedRoom(random, 6);
    const LevelFloors floors = levelFloors(room.scene(), options);
    const float height = heightOf(room.scene(), options);
    for (int n = 0; n < 1000; ++n) {
      const Vec3 base{uniformIn(random, -0.3F, 3.3F), height, uniformIn(random, -0.3F, 3.3F)};
      const FloorUnder under = floorUnder(room.scene(), base, options);
      const std::optional<float> known = floors.heightUnder(kFloor, base);
      level.add(known.has_value());
      if (!known) continue;
      ASSERT_EQ(under.floor, Floor::kCarries) << base.x << " " << base.z;
      ASSERT_EQ(under.height, *known) << base.x << " " << base.z;
    }
  }
  level.expectBothSides();
}

TEST(LevelFloors, SayOfEachFloorWhatTheySayOfItAlone) {
  std::mt19937 random(1704);
  LevelFloors all;
  Tally level;
  for (std::uint32_t n = 1; n <= 5; ++n) {
    const BoxRoom room = furnishedRoom(random, 3);
    all.add(levelFloor(room.scene(), {}));
    const LevelFloors alone = levelFloors(room.scene(), {});
    const float height = heightOf(room.scene(), {});
    for (int asked = 0; asked < 1000; ++asked) {
      const Vec3 base{uniformIn(random, -0.3F, 3.3F), height, uniformIn(random, -0.3F, 3.3F)};
      const std::optional<float> found = all.heightUnder(n, base);
      ASSERT_EQ(found, alone.heightUnder(kFloor, base));
      level.add(found.has_value());
    }
  }
  level.expectBothSides();
}

TEST(LevelFloors, SayOfSixteenBasesWhatTheySayOfEach) {
  std::mt19937 random(1703);
  constexpr std::size_t kCount = 16;
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  const GroundOptions options;
  Tally all_known;
  for (int round = 0; round < (kIsSanitized ? 30 : 200); ++round) {
    const BoxRoom room = furnishedRoom(random, 1);
    const LevelFloors floors = levelFloors(room.scene(), options);
    const float height = heightOf(room.scene(), options);
    std::array<float, kCount> x;
    std::array<float, kCount> y;
    std::array<float, kCount> z;
    for (std::size_t n = 0; n < kCount; ++n) {
      x[n] = uniformIn(random, 0.5F, 2.5F);
      y[n] = height;
      z[n] = uniformIn(random, 0.5F, 2.5F);
    }
    // One of them in some rounds.
    const std::size_t odd = random() % kCount;
    constexpr std::array kOdd{kNan, 1e30F, -1e30F, -0.1F, 3.2F};
    std::array<float*, 3> rows{x.data(), y.data(), z.data()};
    if (round % 3 == 0) rows[random() % 3][odd] = kOdd[random() % kOdd.size()];
    bool expected = true;
    std::array<float, kCount> heights{};
    const LevelFloors::Bases bases{x.data(), y.data(), z.data(), kCount};
    const bool found = floors.heightsUnder(kFloor, bases, heights.data());
    for (std::size_t n = 0; n < kCount; ++n) {
      const std::optional<float> known = floors.heightUnder(kFloor, {x[n], y[n], z[n]});
      expected = expected && known.has_value();
      if (known.has_value()) {
        ASSERT_EQ(heights[n], *known);
      }
    }
    ASSERT_EQ(found, expected);
    all_known.add(found);
    ASSERT_FALSE(floors.heightsUnder(kNoClearanceMap, bases, heights.data()));
  }
  all_known.expectBothSides();
}

TEST(LevelFloors, KnowNothingOfOtherHeightsNorWithoutAMap) {
  std::mt19937 random(1702);
  const BoxRoom room = furnishedRoom(random, 0);
  const LevelFloors floors = levelFloors(room.scene(), {});
  const float height = heightOf(room.scene(), {});
  ASSERT_TRUE(floors.heightUnder(kFloor, {1.5F, height, 1.5F}));
  EXPECT_FALSE(floors.heightUnder(kFloor, {1.5F, height + 1e-5F, 1.5F}));
  EXPECT_FALSE(floors.heightUnder(kNoClearanceMap, {1.5F, height, 1.5F}));
  for (const float odd : {std::numeric_limits<float>::quiet_NaN(), 1e30F, -1e30F}) {
    EXPECT_FALSE(floors.heightUnder(kFloor, {odd, height, 1.5F})) << odd;
    EXPECT_FALSE(floors.heightUnder(kFloor, {1.5F, odd, 1.5F})) << odd;
    EXPECT_FALSE(floors.heightUnder(kFloor, {1.5F, height, odd})) << odd;
  }
}

}  // namespace
}  // namespace galactic::test::level_floors_test
