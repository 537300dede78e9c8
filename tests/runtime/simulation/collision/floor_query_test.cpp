// The floor under a base.
#include "simulation/collision/floor_query.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <random>

#include "support/homes/box_world.h"

namespace galactic::test::floor_query_test {
namespace {

using namespace galactic::simulation;

/// Grids round heights to 0.06 mm.
constexpr float kHeightTolerance = 1e-4F;

Floor floorAt(const BoxRoom& room, const Vec3& base) {
  return floorUnder(room.scene(), base, {}).floor;
}

TEST(FloorUnder, FindsTheFloorAHandAboveAndBelow) {
  const BoxRoom room({plainFloor(), {{1, -0.25F, 0}, {2, 0.04F, 3}}});
  const auto height = [&](const Vec3& base) { return floorUnder(room.scene(), base, {}).height; };
  for (const float y : {-0.04F, 0.0F, 0.04F}) {
    EXPECT_EQ(floorAt(room, {0.5F, y, 0.5F}), Floor::kCarries);
    EXPECT_NEAR(height({0.5F, y, 0.5F}), 0, kHeightTolerance);
  }
  EXPECT_EQ(floorAt(room, {1.5F, 0, 0.5F}), Floor::kCarries);
  EXPECT_NEAR(height({1.5F, 0, 0.5F}), 0.04F, kHeightTolerance);
}

TEST(FloorUnder, BlocksWhatIsTooHighAndRefusesWhatIsTooDeepOrUnknown) {
  const BoxRoom room({plainFloor(), {{1, 0, 0}, {2, 0.06F, 3}}});
  EXPECT_EQ(floorAt(room, {1.5F, 0, 0.5F}), Floor::kBlocks);
  EXPECT_EQ(floorAt(room, {0.5F, 0.06F, 0.5F}), Floor::kDrops);
  EXPECT_EQ(floorAt(room, {0.5F, 0.049F, 0.5F}), Floor::kCarries);
  EXPECT_EQ(floorAt(room, {-0.01F, 0, 0.5F}), Floor::kDrops);
  EXPECT_EQ(floorAt(room, {0.5F, 0, 3.01F}), Floor::kDrops);
  EXPECT_EQ(floorAt(room, {0.5F, 7, 0.5F}), Floor::kDrops);
  EXPECT_NE(floorAt(room, {std::numeric_limits<float>::quiet_NaN(), 0, 0.5F}), Floor::kCarries);
}

TEST(FloorUnder, ObeysItsOptions) {
  const BoxRoom room({plainFloor(), {{1, 0, 0}, {2, 0.2F, 3}}});
  const GroundOptions climber{.most_rise = 0.25F, .most_drop = 0.01F};
  const FloorUnder under = floorUnder(room.scene(), {1.5F, 0, 0.5F}, climber);
  EXPECT_EQ(under.floor, Floor::kCarries);
  EXPECT_NEAR(under.height, 0.2F, kHeightTolerance);
  EXPECT_EQ(floorUnder(room.scene(), {0.5F, 0.02F, 0.5F}, climber).floor, Floor::kDrops);
}

TEST(FloorUnder, IsFoundUnderACeilingThatIsLowerThanTheHighestRise) {
  // A hall with a step of 20 cm and a slab 1 m above the floor; a corner of it is open to the top.
  const BoxRoom room({plainFloor(), {{1, -0.25F, 0}, {2, 0.2F, 3}}, {{0, 1, 0}, {3, 1.2F, 2}}});
  for (const float rise : {0.1F, 0.25F, 0.9F, 0.98F, 1.1F, 2.95F, 100.0F}) {
    const GroundOptions climber{.most_rise = rise};
    const auto under = [&](const Vec3& base) { return floorUnder(room.scene(), base, climber); };
    EXPECT_EQ(under({0.5F, 0, 0.5F}).floor, Floor::kCarries) << rise;
    EXPECT_NEAR(under({0.5F, 0, 2.5F}).height, 0, kHeightTolerance) << rise;
    const bool is_above_slab = rise > 1.2F && rise < 3;
    EXPECT_NEAR(under({0.5F, 0, 0.5F}).height, is_above_slab ? 1.2F : 0, kHeightTolerance) << rise;
    const bool reaches_step = rise > 0.2F && rise < 3;
    EXPECT_EQ(under({1.5F, 0, 2.5F}).floor, reaches_step ? Floor::kCarries : Floor::kBlocks)
        << rise;
    EXPECT_EQ(under({0.5F, 0.3F, 2.5F}).floor, Floor::kDrops) << rise;
    EXPECT_EQ(under({-0.01F, 0, 0.5F}).floor, Floor::kDrops) << rise;
  }
}

TEST(FloorUnderStart, IsFoundHalfAMeterDown) {
  const BoxRoom room({plainFloor()});
  for (const float y : {0.0F, 0.1F, 0.49F}) {
    const FloorUnder under = floorUnderStart(room.scene(), {0.5F, y, 0.5F}, {});
    EXPECT_EQ(under.floor, Floor::kCarries) << y;
    EXPECT_NEAR(under.height, 0, kHeightTolerance) << y;
  }
  EXPECT_EQ(floorUnderStart(room.scene(), {0.5F, 0.51F, 0.5F}, {}).floor, Floor::kDrops);
  const GroundOptions jumper{.most_drop = 0.8F};
  EXPECT_EQ(floorUnderStart(room.scene(), {0.5F, 0.7F, 0.5F}, jumper).floor, Floor::kCarries);
}

TEST(FloorsUnder, AreThoseOfEachBase) {
  const BoxRoom room({plainFloor(), {{1, -0.25F, 0}, {2, 0.2F, 3}}, {{0, 1, 0}, {3, 1.2F, 2}}});
  std::mt19937 random(7);
  std::uniform_real_distribution<float> across(-0.2F, 3.2F);
  std::uniform_real_distribution<float> up(-0.1F, 0.3F);
  int carried = 0;
  constexpr int kRounds = 40;
  for (int n = 0; n < kRounds; ++n) {
    const GroundOptions options{.most_rise = n % 2 == 0 ? 0.05F : 0.95F};
    std::array<Vec3, kMostBases> bases;
    for (Vec3& base : bases) base = {across(random), up(random), across(random)};
    std::array<FloorUnder, kMostBases> under;
    floorsUnder(room.scene(), bases, options, under);
    for (std::size_t b = 0; b < bases.size(); ++b) {
      const FloorUnder alone = floorUnder(room.scene(), bases[b], options);
      EXPECT_EQ(under[b].floor, alone.floor);
      EXPECT_EQ(under[b].height, alone.height);
      carried += alone.floor == Floor::kCarries ? 1 : 0;
    }
  }
  constexpr int kCases = kRounds * static_cast<int>(kMostBases);
  EXPECT_GT(carried, kCases / 10);
  EXPECT_LT(carried, kCases - kCases / 10);
}

}  // namespace
}  // namespace galactic::test::floor_query_test
