// What the hand lets go of inside the robot does not hold the robot fast, however many objects it
// is.
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <random>
#include <vector>

#include "support/homes/one_robot.h"
#include "support/homes/small_home.h"
#include "support/oracles/resting_oracle.h"

namespace galactic::test::leaving_test {
namespace {

using namespace galactic::simulation;

constexpr std::uint32_t kObjects = 9;

/// One episode with many objects on the table.
WorldFields crowdedTable() {
  WorldFields world = smallHomeWorld();
  constexpr float kTop = 0.701F;
  constexpr float kApart = 0.102F;
  world.episodes.placements.clear();
  world.episodes.start_positions.clear();
  world.episodes.episodes.clear();
  for (int n = 0; n < static_cast<int>(kObjects); ++n) {
    const float x = 1.1F + kApart * static_cast<float>(n % 3);
    const float z = 1.4F + kApart * static_cast<float>(n / 3);
    world.episodes.placements.push_back({0, {{x, kTop, z}, {}}});
  }
  world.episodes.start_positions = {0, 0.25F};
  world.episodes.episodes = {{.scene = 0,
                              .first_placement = 0,
                              .placement_count = kObjects,
                              .target = 0,
                              .base_position = {0.65F, 0, 1.5F},
                              .base_yaw = 0,
                              .goal = {{1.2F, kTop, 1.2F}, {}}}};
  return world;
}

/// Releases some objects in and around the robot's base.
void releaseAround(OneRobot& robot, std::mt19937& random) {
  const std::uint32_t count = 2 + static_cast<std::uint32_t>(random() % 4);
  for (std::uint32_t object = 0; object < count; ++object) {
    const Vec3 base = robot.base();
    const Vec3 place{base.x + uniformIn(random, -0.2F, 0.2F), base.y + 0.02F,
                     base.z + uniformIn(random, -0.2F, 0.2F)};
    ASSERT_TRUE(robot.release(object, place));
  }
}

class Leaving : public testing::Test {
 protected:
  void SetUp() override {
    path_ = writeWorld(folder_, crowdedTable());
    Result<World> world = World::open(std::span(&path_, 1));
    ASSERT_TRUE(world) << world.error().message;
    world_ = std::make_unique<World>(std::move(*world));
    model_ = std::make_unique<Model>(modelOfOne(*world_));
  }

  ScratchFolder folder_;
  std::filesystem::path path_;
  std::unique_ptr<World> world_;
  std::unique_ptr<Model> model_;
};

/// Objects that not all of the robot's spheres have been free of since.
std::uint32_t leftBy(OneRobot& robot) {
  std::uint32_t left = 0;
  for (std::uint32_t object = 0; object < kObjects; ++object) {
    left += isEmpty(robot.state().leaving(0, object)) ? 0U : 1U;
  }
  return left;
}

TEST_F(Leaving, ARobotThatStandsStillIsNeverRefusedWhateverItLetGoOf) {
  constexpr std::uint32_t kSeed = 1510;
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  Tally several;
  for (int round = 0; round < 400; ++round) {
    OneRobot robot(*model_);
    releaseAround(robot, random);
    several.add(robot.env().left > 1);
    const std::uint32_t left = robot.env().left;
    robot.drive(0, 0);
    ASSERT_FALSE(robot.env().refused) << "round " << round << ", leaves " << left;
    ASSERT_EQ(robot.state().moves(0).slid, 0U) << "round " << round << ", leaves " << left;
    ASSERT_EQ(robot.env().left, left);
  }
  several.expectBothSides();
}

TEST_F(Leaving, AnObjectThatTheRobotIsFreeOfCountsAgain) {
  constexpr std::uint32_t kSeed = 1511;
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  Tally left;
  for (int round = 0; round < 200; ++round) {
    OneRobot robot(*model_);
    releaseAround(robot, random);
    std::uint32_t before = robot.env().left;
    for (int n = 0; n < 5; ++n) {
      robot.drive(uniformIn(random, -1, 1), uniformIn(random, -1, 1));
      // Never more than before: what counts again goes on counting.
      ASSERT_LE(robot.env().left, before);
      ASSERT_EQ(robot.env().left, leftBy(robot));
      before = robot.env().left;
    }
    left.add(before == 0);
  }
  left.expectBothSides();
}

TEST_F(Leaving, WhatTheHandTakesAgainIsNotLeftAnyMore) {
  OneRobot robot(*model_);
  const Vec3 base = robot.base();
  const Vec3 place{base.x + 0.05F, base.y + 0.02F, base.z};
  ASSERT_TRUE(robot.release(3, place));
  ASSERT_EQ(robot.env().left, 1U);
  robot.take(3, place);
  EXPECT_EQ(robot.env().left, 0U);
}

}  // namespace
}  // namespace galactic::test::leaving_test
