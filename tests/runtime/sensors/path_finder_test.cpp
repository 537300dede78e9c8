// What the public path finder says of a floor with a wall in its middle.
#include "galactic/path_finder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "galactic/batch_simulator.h"
#include "galactic/error.h"
#include "support/homes/box_world.h"

namespace galactic::test::path_finder_test {
namespace {

using testing::HasSubstr;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr Vec3 kStart{0.75F, 0, 0.75F};
/// Behind the wall.
constexpr Vec3 kBehind{2.25F, 0, 0.75F};

/// A wall in the middle, from which the robot keeps 12 cm, with a gap at large z.
std::vector<Block> walls(float until = 2.25F) {
  return {plainFloor(), {{1.4375F, 0, 0}, {1.5625F, 2, until}}};
}

BoxWorld worldWith(const std::vector<Block>& blocks) {
  return {blocks, {{kStart, 0, {{0.75F, 0.05F, 2.25F}}}}};
}

PathFinder finderIn(const BoxWorld& world) {
  return PathFinder::create(world.world(), 0, kStart).value();
}

GeodesicFields fieldsOf(const PathFinder& finder, std::vector<Vec3> goals,
                        GoalOf of = GoalOf::kBase) {
  return finder.fieldsTo(goals, of).value();
}

float lengthOf(const std::vector<Vec3>& path) {
  float length = 0;
  for (std::size_t n = 1; n < path.size(); ++n) {
    const Vec3 step = path[n] - path[n - 1];
    length += std::sqrt(dot(step, step));
  }
  return length;
}

TEST(PathFinder, KnowsWhereTheRobotCanGo) {
  const BoxWorld world = worldWith(walls());
  const PathFinder finder = finderIn(world);
  EXPECT_TRUE(finder.isNavigable(kStart));
  EXPECT_TRUE(finder.isNavigable(kBehind));
  EXPECT_FALSE(finder.isNavigable({1.5F, 0, 1})) << "in the wall";
  EXPECT_FALSE(finder.isNavigable({1.35F, 0, 1})) << "too near to it";
  EXPECT_FALSE(finder.isNavigable({0.75F, 2.5F, 0.75F})) << "on another storey";
  EXPECT_FALSE(finder.isNavigable({-5, 0, 0})) << "outside";
  for (const float wrong : {std::nanf(""), kInfinity, -kInfinity, 1e30F, -3e9F}) {
    EXPECT_FALSE(finder.isNavigable({wrong, 0, 0.75F}));
    EXPECT_FALSE(finder.isNavigable({0.75F, 0, wrong}));
    EXPECT_EQ(fieldsOf(finder, {kStart}).way(0, {wrong, 0, 0.75F}).distance, kInfinity);
    EXPECT_TRUE(fieldsOf(finder, {kStart}).path(0, {0.75F, 0, wrong}).empty());
    EXPECT_FALSE(finder.fieldsTo(std::vector{Vec3{0.75F, wrong, 0}}, GoalOf::kHand).has_value());
    EXPECT_FALSE(PathFinder::create(world.world(), 0, {wrong, 0, wrong}).has_value());
  }
  const std::vector<Vec3> places = finder.places();
  std::size_t cells = 0;
  for (const float height : finder.heights()) cells += std::isnan(height) ? 0U : 1U;
  EXPECT_EQ(places.size(), cells);
  EXPECT_EQ(finder.heights().size(), static_cast<std::size_t>(finder.columnsX()) *
                                         static_cast<std::size_t>(finder.columnsZ()));
  for (const Vec3& place : places) {
    EXPECT_TRUE(finder.isNavigable(place));
    EXPECT_EQ(finder.snap(place).x, place.x);
    EXPECT_EQ(finder.snap(place).z, place.z);
  }
  // To the side of the wall that is nearer.
  const Vec3 snapped = finder.snap({1.48F, 0.3F, 1});
  EXPECT_TRUE(finder.isNavigable(snapped));
  EXPECT_NEAR(snapped.x, 1.3F, 0.06F);
  EXPECT_NEAR(snapped.z, 1, 0.06F);
}

TEST(PathFinder, MeasuresWaysAroundAWall) {
  const BoxWorld world = worldWith(walls());
  const PathFinder finder = finderIn(world);
  const GeodesicFields fields = fieldsOf(finder, {kBehind, {0.75F, 0, 2.25F}});
  ASSERT_EQ(fields.size(), 2U);
  EXPECT_EQ(fields.goals()[1].z, 2.25F);
  const GeodesicWay around = fields.way(0, kStart);
  const float shortest = 2 * std::hypot(0.55F, 1.65F) + 0.4F;
  EXPECT_NEAR(around.distance, shortest, 0.12F);
  EXPECT_GT(around.z, 0.8F);
  const GeodesicWay straight = fields.way(1, kStart);
  EXPECT_NEAR(straight.distance, 1.5F, 0.03F);
  EXPECT_NEAR(straight.x, 0, 0.05F);
  EXPECT_NEAR(straight.z, 1, 0.01F);
  // At the goal and around it, whose cell the base need not be in.
  EXPECT_NEAR(fields.way(0, kBehind).distance, 0, 0.06F);
  EXPECT_NEAR(fields.way(0, kBehind + Vec3{0.3F, 0, 0}).distance, 0.3F, 0.06F);
  // On another storey, and far from the floor.
  EXPECT_EQ(fields.way(0, kStart + Vec3{0, 2.5F, 0}).distance, kInfinity);
  EXPECT_EQ(fields.way(0, {-5, 0, 0}).distance, kInfinity);
  EXPECT_LT(fields.way(0, {1.4F, 0, 1}).distance, kInfinity) << "a little beside the floor";
}

TEST(PathFinder, GivesPathsThatTheRobotCanDrive) {
  const BoxWorld world = worldWith(walls());
  const PathFinder finder = finderIn(world);
  std::mt19937 random(11);
  const std::vector<Vec3> places = finder.places();
  const auto any = [&] { return places[random() % places.size()]; };
  int cornered = 0;
  for (int round = 0; round < 60; ++round) {
    const Vec3 from = any();
    const Vec3 goal = any();
    const GeodesicFields fields = fieldsOf(finder, {goal});
    const std::vector<Vec3> path = fields.path(0, from);
    ASSERT_GE(path.size(), 2U);
    EXPECT_EQ(path.front().x, from.x);
    EXPECT_EQ(path.back().x, goal.x);
    EXPECT_EQ(path.back().z, goal.z);
    if (path.size() > 2) ++cornered;
    const float distance = fields.way(0, from).distance;
    EXPECT_LT(lengthOf(path), 1.12F * distance + 0.15F);
    EXPECT_GT(lengthOf(path), 0.94F * distance - 0.15F);
    for (std::size_t n = 1; n < path.size(); ++n) {
      for (int part = 0; part <= 50; ++part) {
        const Vec3 at = path[n - 1] + (path[n] - path[n - 1]) * (static_cast<float>(part) / 50);
        ASSERT_TRUE(finder.isNavigable(at)) << at.x << ", " << at.z << " in round " << round;
      }
    }
  }
  EXPECT_GT(cornered, 10);
  // From beside the floor, the way begins with a step onto it.
  const std::vector<Vec3> beside = fieldsOf(finder, {kBehind}).path(0, {1.4F, 0, 1});
  ASSERT_GT(beside.size(), 2U);
  EXPECT_FALSE(finder.isNavigable(beside[0]));
  EXPECT_TRUE(finder.isNavigable(beside[1]));
}

TEST(PathFinder, TakesTheStairsAndNotTheLedge) {
  // A platform of 12 cm, and steps of 3 cm that lead up to it.
  const std::vector<Block> blocks{plainFloor(),
                                  {{1.5F, 0, 0}, {3, 0.12F, 1.5F}},
                                  {{1.5F, 0, 1.5F}, {3, 0.09F, 1.8F}},
                                  {{1.5F, 0, 1.8F}, {3, 0.06F, 2.1F}},
                                  {{1.5F, 0, 2.1F}, {3, 0.03F, 2.4F}}};
  const BoxWorld world = worldWith(blocks);
  const PathFinder finder = finderIn(world);
  const Vec3 up = finder.snap({2, 0.12F, 0.75F});
  ASSERT_NEAR(up.y, 0.12F, 1e-3F);
  const GeodesicFields fields = fieldsOf(finder, {up});
  // From right below the ledge, wherever in a cell: along it, and not against it.
  const Vec3 below = finder.snap({1.35F, 0, 0.75F});
  ASSERT_NEAR(below.y, 0, 1e-3F);
  for (const float x : {1.35F, 1.375F, 1.4F, 1.425F, 1.45F, 1.475F, 1.49F}) {
    if (finder.snap({x, 0, 0.75F}).y > 0.01F || !finder.isNavigable({x, 0, 0.75F})) continue;
    const GeodesicWay way = fields.way(0, {x, 0, 0.75F});
    EXPECT_GT(way.distance, 2.5F) << x;
    EXPECT_GT(way.z, 0.9F) << x;
  }
  // And from above, down.
  const GeodesicFields down = fieldsOf(finder, {below});
  for (const float x : {1.55F, 1.575F, 1.6F, 1.625F}) {
    const GeodesicWay way = down.way(0, {x, 0.12F, 0.75F});
    EXPECT_GT(way.distance, 2.5F) << x;
    EXPECT_GT(way.z, 0.9F) << x;
  }
  const std::vector<Vec3> path = fields.path(0, below);
  ASSERT_GT(path.size(), 2U);
  EXPECT_GT(lengthOf(path), 2.5F);
  float highest_z = 0;
  for (const Vec3& corner : path) highest_z = std::max(highest_z, corner.z);
  EXPECT_GT(highest_z, 1.9F) << "up the stairs";
}

TEST(PathFinder, SaysThatThereIsNoWay) {
  // The wall is closed: what is behind it belongs to another floor.
  const BoxWorld world = worldWith(walls(3));
  const PathFinder finder = finderIn(world);
  EXPECT_FALSE(finder.isNavigable(kBehind));
  const auto refused = finder.fieldsTo(std::vector<Vec3>{kStart, kBehind}, GoalOf::kBase);
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().code, ErrorCode::kInvalidInput);
  EXPECT_THAT(
      refused.error().message,
      HasSubstr("goal 1, (2.25, 0.00, 0.75), is not navigable; take what snap() makes of it"));
  const GeodesicFields hand = fieldsOf(finder, {{2.25F, 0.05F, 0.75F}}, GoalOf::kHand);
  EXPECT_EQ(hand.way(0, kStart).distance, kInfinity);
  EXPECT_TRUE(hand.path(0, kStart).empty());
  const auto other = PathFinder::create(world.world(), 0, kBehind);
  ASSERT_TRUE(other.has_value());
  EXPECT_FALSE(other->isNavigable(kStart));
}

TEST(PathFinder, MeasuresToWhatTheHandReachesAsTheSensorDoes) {
  const BoxWorld world = worldWith(walls());
  SimulationOptions options;
  options.envs = 1;
  options.threads = 1;
  options.sensors.geodesic = true;
  const BatchSimulator batch = BatchSimulator::create(world.world(), options).value();
  const ObservationPart& part = batch.observationParts().back();
  const float sensed = batch.observations()[part.first];
  const Vec3 target = batch.envState(0).objects[0].translation;
  const GeodesicFields fields = fieldsOf(finderIn(world), {target}, GoalOf::kHand);
  EXPECT_EQ(fields.way(0, kStart).distance, sensed);
  EXPECT_NEAR(sensed, 1.5F, 0.12F);
}

TEST(PathFinder, IsTheSameForAnyNumberOfThreads) {
  const BoxWorld world = worldWith(walls());
  const PathFinder finder = finderIn(world);
  const std::vector<Vec3> goals = finder.places();
  const GeodesicFields one = finder.fieldsTo(goals, GoalOf::kBase, 1).value();
  const GeodesicFields many = finder.fieldsTo(goals, GoalOf::kBase, 3).value();
  for (std::size_t n = 0; n < goals.size(); ++n) {
    ASSERT_EQ(one.way(n, kStart).distance, many.way(n, kStart).distance);
    // There and back, ways are as long.
    ASSERT_NEAR(one.way(n, kStart).distance,
                fieldsOf(finder, {finder.snap(kStart)}).way(0, goals[n]).distance, 0.15F);
  }
}

TEST(PathFinder, SaysThatAWayEndsAtItsGoal) {
  const BoxWorld world = worldWith(walls());
  const PathFinder finder = finderIn(world);
  constexpr float kHere = 2e-5F;
  constexpr float kAside = 5e-3F;
  // In the middle of a cell, near its corner and at the wall; for a hand, on the floor.
  for (const Vec3& goal :
       {Vec3{0.75F, 0, 0.75F}, Vec3{0.798F, 0, 0.703F}, Vec3{1.299F, 0, 1}, Vec3{1.2F, 0, 0.8F}}) {
    const std::vector<GeodesicFields> fields{fieldsOf(finder, {goal}),
                                             fieldsOf(finder, {goal}, GoalOf::kHand)};
    for (const GeodesicFields& to : fields) {
      for (const Vec3& off : {Vec3{}, Vec3{kHere, 0, -kHere}, Vec3{0, 0.3F, 0}}) {
        const GeodesicWay way = to.way(0, goal + off);
        EXPECT_EQ(way.distance, 0);
        EXPECT_EQ(way.x, 0);
        EXPECT_EQ(way.z, 0);
      }
      EXPECT_GT(to.way(0, goal - Vec3{kAside, 0, 0}).distance, 0);
      EXPECT_EQ(to.way(0, goal + Vec3{0, 2.5F, 0}).distance, kInfinity) << "another storey";
    }
  }
}

TEST(PathFinder, HasAWayToAHandsGoalThatIsTooHighAboveTheBase) {
  // A hand gets there from the doorstep alone.
  const BoxWorld world = worldWith({plainFloor(), {{1.5F, 0, 0}, {3, 0.15F, 3}}});
  const PathFinder finder =
      PathFinder::create(world.world(), 0, kStart, {.most_rise = 0.2F, .most_drop = 0.2F}).value();
  const Vec3 under{1, 0, 1.5F};
  ASSERT_TRUE(finder.isNavigable(under));
  const GeodesicWay way = fieldsOf(finder, {under + Vec3{0, 2.3F, 0}}, GoalOf::kHand).way(0, under);
  EXPECT_GT(way.distance, 0.8F);
  EXPECT_LT(way.distance, 1.3F);
  EXPECT_GT(way.x, 0.9F);
}

TEST(PathFinder, RefusesGoalsThatThereAreNot) {
  const GeodesicFields none;
  const BoxWorld world = worldWith(walls());
  const GeodesicFields one = fieldsOf(finderIn(world), {kStart});
  const auto expect = [](const GeodesicFields& fields, std::size_t n, const std::string& message) {
    EXPECT_THAT([&] { static_cast<void>(fields.way(n, kStart)); },
                testing::ThrowsMessage<ErrorException>("GeodesicFields::way: " + message));
    EXPECT_THAT([&] { static_cast<void>(fields.path(n, kStart)); },
                testing::ThrowsMessage<ErrorException>("GeodesicFields::path: " + message));
  };
  EXPECT_EQ(none.size(), 0U);
  expect(none, 0, "found goal 0, expected one below 0");
  expect(one, 1, "found goal 1, expected one below 1");
  expect(one, ~std::size_t{0}, "found goal 18446744073709551615, expected one below 1");
}

TEST(PathFinder, RefusesToSnapWhatIsNoPoint) {
  const BoxWorld world = worldWith(walls());
  const PathFinder finder = finderIn(world);
  for (const float wrong : {std::nanf(""), kInfinity, -kInfinity, 1e30F}) {
    for (const Vec3& point : {Vec3{wrong, 0, 0}, Vec3{0, wrong, 0}, Vec3{0, 0, wrong}}) {
      EXPECT_THAT([&] { static_cast<void>(finder.snap(point)); },
                  testing::ThrowsMessage<ErrorException>(HasSubstr("PathFinder::snap: found (")));
    }
  }
  EXPECT_TRUE(finder.isNavigable(finder.snap({-9e5F, 0, 9e5F})));
}

TEST(PathFinder, RefusesGroundOutOfItsRanges) {
  const BoxWorld world = worldWith(walls());
  for (const float wrong : {std::nanf(""), kInfinity, -1.0F}) {
    for (const GroundOptions& ground : {GroundOptions{.most_rise = wrong}, {.most_drop = wrong}}) {
      const auto refused = PathFinder::create(world.world(), 0, kStart, ground);
      ASSERT_FALSE(refused.has_value());
      EXPECT_EQ(refused.error().code, ErrorCode::kInvalidInput);
      EXPECT_THAT(refused.error().message, HasSubstr("expected 0.001 to 1000"));
    }
  }
}

TEST(PathFinder, RefusesWhatIsNoStart) {
  const BoxWorld world = worldWith(walls());
  // The root of a robot may be above its base.
  const auto above = PathFinder::create(world.world(), 0, {0.75F, 0.4F, 0.75F});
  ASSERT_TRUE(above.has_value());
  EXPECT_NEAR(above->snap(kStart).y, 0, 1e-3F);
  const auto no_scene = PathFinder::create(world.world(), 1, kStart);
  ASSERT_FALSE(no_scene.has_value());
  EXPECT_THAT(no_scene.error().message, HasSubstr("there is no scene 1, the last is 0"));
  const auto in_air = PathFinder::create(world.world(), 0, {0.75F, 7, 0.75F});
  ASSERT_FALSE(in_air.has_value());
  EXPECT_EQ(in_air.error().code, ErrorCode::kInvalidInput);
  EXPECT_THAT(in_air.error().message, HasSubstr("cannot stand at or near (0.75, 7.00, 0.75)"));
}

}  // namespace
}  // namespace galactic::test::path_finder_test
