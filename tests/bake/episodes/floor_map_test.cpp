#include "episodes/home/floor_map.h"

#include <gtest/gtest.h>

#include <numbers>
#include <set>

#include "episodes/home/robot_body.h"
#include "floor_oracle.h"
#include "made_world.h"

namespace galactic::test::floor_map_test {
namespace {

using bake::FloorMap;
using bake::FloorPlace;

/// A large and a small room: the wall between them leaves a gap of `gap` meters.
bake::TriangleMesh twoRooms(float gap) {
  MeshBuilder rooms = madeRoom(4, 2);
  rooms.box({2.6F, 0, gap}, {2.7F, 2.5F, 2});
  return rooms.build();
}

/// Whether the map has a place in the large room, and in the small one.
std::array<bool, 2> roomsOn(const FloorMap& map) {
  std::array<bool, 2> rooms{false, false};
  for (const FloorPlace& place : map.places()) {
    rooms[map.position(place).x > 2.7F ? 1 : 0] = true;
  }
  return rooms;
}

TEST(FloorMap, AgreesWithBruteForceOnWhereTheRobotStands) {
  MeshBuilder room = madeRoom(3, 2.5F);
  room.box({1, 0.7F, 0.8F}, {2, 0.74F, 1.6F});
  room.box({0, 0, 2}, {0.6F, 0.04F, 2.5F});
  room.box({2.5F, 0, 0}, {3, 0.4F, 0.5F});
  const MadeWorld world(room.build(), stickRobot());
  const FloorMap map(world.scene(), world.robot());
  const FloorOracle oracle(world.scene(), world.robot());
  std::size_t stands = 0;
  std::size_t asked = 0;
  const ColumnGrid& grid = world.scene().grids().back();
  for (std::uint32_t k = 0; k < grid.columnsZ(); ++k) {
    for (std::uint32_t i = 0; i < grid.columnsX(); ++i) {
      // Off the center, where the columns of the other radii do not tie.
      const float x = grid.layout().min_x + (static_cast<float>(i) + 0.4F) * grid.spacing();
      const float z = grid.layout().min_z + (static_cast<float>(k) + 0.4F) * grid.spacing();
      const auto expected = oracle.largestPartAt(static_cast<double>(x), static_cast<double>(z));
      const std::span<const FloorPlace> found = map.placesAt(x, z);
      EXPECT_EQ(!found.empty(), expected.has_value()) << x << ", " << z;
      ++asked;
      if (found.empty() || !expected) continue;
      ++stands;
      // The step of the platform in the corner is the only unevenness.
      EXPECT_NEAR(static_cast<double>(found.front().height), *expected, 0.0401);
      EXPECT_TRUE(map.heightAt(x, z, found.front().height).has_value());
    }
  }
  EXPECT_GT(stands, asked / 10);
  EXPECT_LT(stands, asked * 9 / 10);
}

/// A heading in a column.
struct Standing {
  int i = 0;
  int k = 0;
  int heading = 0;
  friend auto operator<=>(const Standing&, const Standing&) = default;
};

/// Where the robot is free on a floor at height 0.
std::set<Standing> freeStandings(const Scene& scene, const Robot& robot) {
  std::set<Standing> free;
  const ColumnGrid& grid = scene.grids().back();
  for (std::uint32_t heading = 0; heading < bake::kHeadings; ++heading) {
    const bake::RobotBody body =
        bake::robotBody(robot, bake::groundPose({}, bake::yawOf(heading)), robot.startPositions());
    for (std::uint32_t k = 0; k < grid.columnsZ(); ++k) {
      for (std::uint32_t i = 0; i < grid.columnsX(); ++i) {
        const Vec3 ground{grid.layout().min_x + (static_cast<float>(i) + 0.5F) * grid.spacing(), 0,
                          grid.layout().min_z + (static_cast<float>(k) + 0.5F) * grid.spacing()};
        if (!bake::isFree(scene, body.spheres, ground)) continue;
        free.insert({static_cast<int>(i), static_cast<int>(k), static_cast<int>(heading)});
      }
    }
  }
  return free;
}

/// The largest part of them that single steps and turns connect.
std::set<Standing> largestPart(std::set<Standing> free) {
  std::set<Standing> largest;
  constexpr int kCount = bake::kHeadings;
  while (!free.empty()) {
    std::set<Standing> part;
    std::vector<Standing> open{*free.begin()};
    free.erase(free.begin());
    while (!open.empty()) {
      const Standing at = open.back();
      open.pop_back();
      part.insert(at);
      for (const Standing& next :
           {Standing{at.i - 1, at.k, at.heading}, Standing{at.i + 1, at.k, at.heading},
            Standing{at.i, at.k - 1, at.heading}, Standing{at.i, at.k + 1, at.heading},
            Standing{at.i, at.k, (at.heading + 1) % kCount},
            Standing{at.i, at.k, (at.heading + kCount - 1) % kCount}}) {
        if (free.erase(next) > 0) open.push_back(next);
      }
    }
    if (part.size() > largest.size()) largest = part;
  }
  return largest;
}

TEST(FloorMap, HasTheHeadingsToWhichALongRobotCanTurnAndDrive) {
  RobotPackFields robot = stickRobot();
  // Its arm is stretched out: it cannot turn around in the corridor between the rooms.
  robot.start_positions = {0, 0, 0};
  MeshBuilder rooms = madeRoom(4, 2);
  rooms.box({2.2F, 0, 0}, {3.2F, 2.5F, 0.75F});
  rooms.box({2.2F, 0, 1.25F}, {3.2F, 2.5F, 2});
  // A pot at the height of the hand: there is room for the hand in it, but no way there.
  rooms.box({1, 0.5F, 0.9F}, {1.3F, 0.55F, 1.2F});
  rooms.box({1, 0.5F, 0.9F}, {1.04F, 0.9F, 1.2F});
  rooms.box({1.26F, 0.5F, 0.9F}, {1.3F, 0.9F, 1.2F});
  rooms.box({1, 0.5F, 0.9F}, {1.3F, 0.9F, 0.94F});
  rooms.box({1, 0.5F, 1.16F}, {1.3F, 0.9F, 1.2F});
  const MadeWorld world(rooms.build(), robot);
  const FloorMap map(world.scene(), world.robot());
  std::set<Standing> found;
  for (const FloorPlace& place : map.places()) {
    for (std::uint32_t heading = 0; heading < bake::kHeadings; ++heading) {
      if (((place.headings >> heading) & 1U) == 0) continue;
      found.insert(
          {static_cast<int>(place.i), static_cast<int>(place.k), static_cast<int>(heading)});
    }
  }
  const std::set<Standing> free = freeStandings(world.scene(), world.robot());
  const std::set<Standing> expected = largestPart(free);
  EXPECT_LT(expected.size(), free.size());
  EXPECT_GT(expected.size(), free.size() / 2);
  EXPECT_TRUE(found == expected) << found.size() << " of " << expected.size();
}

TEST(FloorMap, HasAPartForEachLargeRoomThatTheRobotCannotLeave) {
  for (const float middle : {1.9F, 2.6F}) {
    MeshBuilder rooms = madeRoom(4, 2);
    // It is no ceiling: what is free over it connects the rooms for spheres.
    rooms.box({middle, 0, 0}, {middle + 0.1F, 1.5F, 2});
    const MadeWorld world(rooms.build(), stickRobot());
    const FloorMap map(world.scene(), world.robot());
    ASSERT_EQ(map.parts(), 2U);
    std::array<std::size_t, 2> counts{};
    for (const FloorPlace& place : map.places()) {
      ASSERT_LT(place.part, 2U);
      const bool is_beyond = map.position(place).x > middle;
      EXPECT_EQ(place.part == 0, is_beyond == (middle < 2)) << middle;
      ++counts[place.part];
    }
    EXPECT_GT(counts[0], counts[1]);
    EXPECT_GT(counts[1], 0U);
  }
}

TEST(FloorMap, LeavesOutSmallRoomsThatTheRobotCannotLeave) {
  // The base's sphere is 0.24 m wide.
  const MadeWorld narrow(twoRooms(0.2F), stickRobot());
  EXPECT_EQ(roomsOn(FloorMap(narrow.scene(), narrow.robot())), (std::array{true, false}));
  const MadeWorld wide(twoRooms(0.8F), stickRobot());
  EXPECT_EQ(roomsOn(FloorMap(wide.scene(), wide.robot())), (std::array{true, true}));
}

TEST(FloorMap, TakesStepsThatTheBaseTakesAndNoHigherOnes) {
  for (const auto& [step, climbs] : {std::pair{0.04F, true}, std::pair{0.08F, false}}) {
    MeshBuilder room = madeRoom(3, 2);
    room.box({1.8F, 0, 0}, {3, step, 2});
    const MadeWorld world(room.build(), stickRobot());
    const FloorMap map(world.scene(), world.robot());
    const bool has_step = std::any_of(
        map.places().begin(), map.places().end(),
        [step = step](const FloorPlace& place) { return std::abs(place.height - step) < 0.001F; });
    EXPECT_TRUE(has_step) << step;
    EXPECT_EQ(map.parts(), climbs ? 1U : 2U) << step;
  }
}

TEST(FloorMap, IsEmptyWhereTheRobotStandsNowhere) {
  RobotPackFields tall = stickRobot();
  // A sphere above the ceiling.
  tall.spheres[0].center.y = 2.45F;
  const MadeWorld world(madeRoom(2, 2).build(), tall);
  const FloorMap map(world.scene(), world.robot());
  EXPECT_TRUE(map.places().empty());
  EXPECT_GT(map.tried(), 100U);
}

TEST(FloorMap, HeadingsAreEvenlySpreadYaws) {
  for (std::uint32_t heading = 0; heading < bake::kHeadings; ++heading) {
    const float yaw = bake::yawOf(heading);
    constexpr float kTurn = 2 * std::numbers::pi_v<float>;
    EXPECT_EQ(bake::nearestHeading(yaw), heading);
    EXPECT_EQ(bake::nearestHeading(yaw - kTurn + 0.1F), heading);
    EXPECT_EQ(bake::nearestHeading(yaw + kTurn - 0.1F), heading);
  }
}

}  // namespace
}  // namespace galactic::test::floor_map_test
