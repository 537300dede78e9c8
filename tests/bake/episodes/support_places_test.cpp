#include "episodes/home/support_places.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "made_world.h"
#include "support/oracles/box_oracle.h"

namespace galactic::test::support_places_test {
namespace {

using bake::ArmReach;
using bake::EpisodeGeneratorOptions;
using bake::FloorMap;
using bake::Footprint;
using bake::SupportPlace;
using bake::SupportPlaces;

constexpr float kTable = 0.74F;

/// A room with a table from (1, 1) to (1.8, 1.6), a lamp over its end x > 1.6, and a high shelf.
bake::TriangleMesh tableRoom() {
  MeshBuilder room = madeRoom(3, 3);
  room.box({1, 0.7F, 1}, {1.8F, kTable, 1.6F});
  room.box({1.6F, 1, 1}, {1.8F, 1.2F, 1.6F});
  room.box({0, 1.6F, 0}, {3, 1.62F, 0.3F});
  return room.build();
}

struct Supports {
  explicit Supports(const EpisodeGeneratorOptions& options = {})
      : world(tableRoom(), stickRobot()),
        floor(world.scene(), world.robot()),
        reach(world.robot()),
        places(world.scene(), {floor, reach}, {}, options) {}

  MadeWorld world;
  FloorMap floor;
  ArmReach reach;
  SupportPlaces places;
};

TEST(SupportPlaces, AreTheTopOfTheTableAndNeitherFloorNorHighShelf) {
  const Supports supports;
  ASSERT_GT(supports.places.places().size(), 200U);
  // Spheres fit under the lamp: its end of the table is a surface, too, and so is the lamp's top.
  for (const SupportPlace& place : supports.places.places()) {
    EXPECT_TRUE(std::abs(place.surface - kTable) < 0.001F ||
                std::abs(place.surface - 1.2F) < 0.001F)
        << place.surface;
    EXPECT_GT(place.x, 1);
    EXPECT_LT(place.x, 1.8F);
    EXPECT_GT(place.z, 1);
    EXPECT_LT(place.z, 1.6F);
    EXPECT_NEAR(place.floor, 0, 0.001F);
  }
}

TEST(SupportPlaces, KeepToTheHeightsAskedFor) {
  EpisodeGeneratorOptions options;
  options.heights.least = 1;
  const Supports supports(options);
  ASSERT_FALSE(supports.places.places().empty());
  for (const SupportPlace& place : supports.places.places()) {
    EXPECT_NEAR(place.surface, 1.2F, 0.001F);
  }
}

TEST(SupportPlaces, StandBetweenTheHeightsOverTheirOwnFloor) {
  // Half of the room is a platform of 40 cm, with stairs of 4 cm, over a table of 74 cm and one of
  // 34 cm: over the platform, the latter would be under it.
  MeshBuilder room = madeRoom(5, 3);
  constexpr int kSteps = 10;
  constexpr float kStep = 0.04F;
  for (int n = 1; n <= kSteps; ++n) {
    const float x = 1.6F + 0.15F * static_cast<float>(n);
    room.box({x, 0, 0}, {5, kStep * static_cast<float>(n), 3});
  }
  room.box({0.3F, 0.7F, 1}, {0.9F, kTable, 2});
  room.box({0.3F, 0.3F, 0.2F}, {0.9F, 0.34F, 0.6F});
  room.box({4.2F, 0.7F, 1}, {4.8F, kTable, 2});
  const MadeWorld world(room.build(), stickRobot());
  const FloorMap floor(world.scene(), world.robot());
  const ArmReach reach(world.robot());
  EpisodeGeneratorOptions options;
  options.heights = {0.32F, 0.8F};
  const SupportPlaces supports(world.scene(), {floor, reach}, {}, options);
  std::size_t low = 0;
  std::size_t high = 0;
  for (const SupportPlace& place : supports.places()) {
    EXPECT_GE(place.surface - place.floor, options.heights.least);
    EXPECT_LE(place.surface - place.floor, options.heights.most);
    if (place.x > 2) {
      EXPECT_NEAR(place.surface, kTable, 0.001F);
      EXPECT_LT(place.floor, kTable - options.heights.least);
      ++high;
    } else {
      EXPECT_NEAR(place.floor, 0, 0.161F);
      ++low;
    }
  }
  EXPECT_GT(low, 200U);
  EXPECT_GT(high, 200U);
}

/// A table top of cobbles: squares of 6 cm, some of them 6 mm higher.
bake::TriangleMesh bumpyRoom() {
  MeshBuilder room = madeRoom(3, 3);
  room.box({1, 0.6F, 1}, {1.84F, 0.7F, 1.6F});
  constexpr float kEdge = 0.06F;
  for (int i = 0; i < 14; ++i) {
    for (int k = 0; k < 10; ++k) {
      const float x = 1 + kEdge * static_cast<float>(i);
      const float z = 1 + kEdge * static_cast<float>(k);
      const float top = (i + k) % 2 == 0 ? kTable : kTable + 0.006F;
      room.box({x, 0.7F, z}, {x + kEdge, top, z + kEdge});
    }
  }
  return room.build();
}

TEST(SupportPlaces, OnBumpySurfacesAreAsFlatAsIsAskedFor) {
  const MadeWorld world(bumpyRoom(), stickRobot());
  const FloorMap floor(world.scene(), world.robot());
  const ArmReach reach(world.robot());
  const Footprint print{.x = 1.4F,
                        .z = 1.3F,
                        .half_length = 0.08F,
                        .half_width = 0.06F,
                        .heights = {kTable, kTable + 0.1F}};
  EpisodeGeneratorOptions options;
  const SupportPlaces strict(world.scene(), {floor, reach}, {}, options);
  EXPECT_FALSE(strict.surfaceUnder(print, kTable).has_value());
  options.flatness = 0.01F;
  const SupportPlaces lenient(world.scene(), {floor, reach}, {}, options);
  EXPECT_GT(lenient.places().size(), 4 * std::max<std::size_t>(1, strict.places().size()));
  EXPECT_EQ(lenient.surfaceCount(), 1U);
  const auto surface = lenient.surfaceUnder(print, kTable);
  ASSERT_TRUE(surface.has_value());
  // The object stands on the highest cobbles.
  EXPECT_NEAR(*surface, kTable + 0.006F, 0.0005F);
}

TEST(SupportPlaces, FootprintsFitWhereTheTableIsFlatFreeAndOpenFromAbove) {
  const Supports supports;
  std::mt19937 random(3);
  int fits = 0;
  constexpr int kCases = 3000;
  for (int n = 0; n < kCases; ++n) {
    const auto number = [&](double low, double high) {
      return static_cast<float>(low + (high - low) * uniform(random));
    };
    const float yaw = number(0, 2 * std::numbers::pi);
    const float height = number(0.02, 0.3);
    const Footprint print{.x = number(0.95, 1.85),
                          .z = number(0.95, 1.65),
                          .half_length = number(0.02, 0.15),
                          .half_width = number(0.02, 0.1),
                          .along_x = std::cos(yaw),
                          .along_z = -std::sin(yaw),
                          .heights = {kTable, kTable + height}};
    const auto surface = supports.places.surfaceUnder(print, kTable);
    // Half the extents along x and z of the turned rectangle.
    const float half_x =
        print.half_length * std::abs(print.along_x) + print.half_width * std::abs(print.along_z);
    const float half_z =
        print.half_length * std::abs(print.along_z) + print.half_width * std::abs(print.along_x);
    const auto inside = [&](float margin) {
      return print.x - half_x > 1 + margin && print.x + half_x < 1.8F - margin &&
             print.z - half_z > 1 + margin && print.z + half_z < 1.6F - margin;
    };
    // The lamp over the table's end: neither the object nor the gripper over its middle under it.
    const auto clear = [&](float margin) {
      return print.x + half_x < 1.6F - margin && print.x < 1.6F - 0.12F - margin;
    };
    constexpr float kCells = 0.08F;
    if (inside(kCells) && clear(kCells)) {
      EXPECT_TRUE(surface.has_value()) << print.x << print.z;
    }
    if (!inside(0)) {
      EXPECT_FALSE(surface.has_value()) << print.x << ", " << print.z;
    }
    if (print.x > 1.6F - 0.12F + kCells) {
      EXPECT_FALSE(surface.has_value()) << print.x;
    }
    if (surface) {
      EXPECT_NEAR(*surface, kTable, 0.001F);
      ++fits;
    }
  }
  EXPECT_GT(fits, kCases / 10);
  EXPECT_LT(fits, kCases * 9 / 10);
}

TEST(SupportPlaces, FootprintsOutsideTheGridFitNowhere) {
  const Supports supports;
  const Footprint print{
      .x = 90, .z = 1, .half_length = 0.1F, .half_width = 0.1F, .heights = {0, 1}};
  EXPECT_FALSE(supports.places.surfaceUnder(print, 0).has_value());
}

}  // namespace
}  // namespace galactic::test::support_places_test
