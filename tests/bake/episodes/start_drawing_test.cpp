// Starts for published episodes that have none.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "episodes/home/robot_body.h"
#include "episodes/trial/episode_replay.h"
#include "galactic/bake/episode_generator.h"
#include "made_world.h"

namespace galactic::test::start_drawing_test {
namespace {

using bake::SourceEpisodes;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Where the cubes are: in the way of the base's sphere, which is over the floor. Meters.
constexpr float kBottom = 0.1F;

/// Cubes at x and z = 0.6 and 1.5 in each episode.
SourceEpisodes setOf(std::uint32_t episodes) {
  SourceEpisodes set;
  set.name = "tidy";
  set.scenes = {"room"};
  set.objects = {"cube"};
  for (std::uint32_t n = 0; n < episodes; ++n) {
    set.placements.push_back({.object = 0, .pose = {{0.6F, kBottom, 0.6F}, {}}});
    set.placements.push_back({.object = 0, .pose = {{1.5F, kBottom, 1.5F}, {}}});
    set.episodes.push_back({.scene = 0,
                            .first_placement = 2 * n,
                            .placement_count = 2,
                            .target = 1,
                            .base_position = {},
                            .base_yaw = 0,
                            .goal = {{2.4F, kBottom, 2.4F}, {}}});
    set.without_start.push_back(n);
  }
  return set;
}

Result<void> draw(const MadeWorld& world, SourceEpisodes& set, std::uint64_t seed = 1,
                  unsigned threads = 1) {
  return bake::drawStarts({.packs = world.packs(), .threads = threads}, seed, set);
}

std::vector<Vec3> startsOf(const SourceEpisodes& set) {
  std::vector<Vec3> starts;
  for (const Episode& episode : set.episodes) starts.push_back(episode.base_position);
  return starts;
}

TEST(DrawnStarts, StandOnTheFloorAndTouchNothing) {
  const MadeWorld world(madeRoom(3, 3).build(), stickRobot());
  constexpr std::uint32_t kEpisodes = 100;
  SourceEpisodes set = setOf(kEpisodes);
  const auto drawn = draw(world, set);
  ASSERT_TRUE(drawn.has_value()) << drawn.error().text();
  EXPECT_EQ(set.robot, "stick");
  EXPECT_THAT(set.without_start, IsEmpty());
  EXPECT_THAT(set.warnings, IsEmpty());
  ASSERT_EQ(set.episodes.size(), kEpisodes);
  for (const Episode& episode : set.episodes) {
    const Vec3& base = episode.base_position;
    EXPECT_NEAR(base.y, 0, 1e-3);
    // As far from the walls as the base's sphere is wide, but for what columns see: half a cell.
    constexpr float kClear = 0.12F - 0.015F;
    for (const float at : {base.x, base.z}) {
      EXPECT_GE(at, kClear);
      EXPECT_LE(at, 3 - kClear);
    }
    const bake::RobotBody body = bake::robotBody(
        world.robot(), bake::groundPose(base, episode.base_yaw), world.robot().startPositions());
    EXPECT_TRUE(bake::isFree(world.scene(), body.spheres));
    for (const bake::BodySphere& sphere : body.spheres) {
      for (const float cube : {0.6F, 1.5F}) {
        const float x = std::max(std::abs(sphere.center.x - cube) - 0.04F, 0.0F);
        const float y = std::max(std::abs(sphere.center.y - kBottom - 0.04F) - 0.04F, 0.0F);
        const float z = std::max(std::abs(sphere.center.z - cube) - 0.04F, 0.0F);
        EXPECT_GE(std::hypot(x, y, z), sphere.radius);
      }
    }
  }
  const auto ends = bake::replayEpisodes(world.packs(), set);
  ASSERT_TRUE(ends.has_value()) << ends.error().text();
  EXPECT_THAT(*ends, testing::Each(bake::ReplayEnd::kStands));
}

TEST(DrawnStarts, DependOnTheSeedAndTheNumberOfTheirEpisodeAlone) {
  const MadeWorld world(madeRoom(3, 3).build(), stickRobot());
  SourceEpisodes set = setOf(80);
  ASSERT_TRUE(draw(world, set).has_value());
  SourceEpisodes again = setOf(80);
  ASSERT_TRUE(draw(world, again, 1, 3).has_value());
  EXPECT_EQ(startsOf(again), startsOf(set));
  SourceEpisodes few = setOf(10);
  ASSERT_TRUE(draw(world, few).has_value());
  std::vector<Vec3> first = startsOf(set);
  first.resize(few.episodes.size());
  EXPECT_EQ(startsOf(few), first);
  SourceEpisodes other = setOf(10);
  ASSERT_TRUE(draw(world, other, 2).has_value());
  EXPECT_NE(startsOf(other), startsOf(few));
  EXPECT_NE(few.episodes[0].base_position, few.episodes[1].base_position);
}

TEST(DrawnStarts, LeaveThoseAloneThatAreGiven) {
  const MadeWorld world(madeRoom(3, 3).build(), stickRobot());
  SourceEpisodes set = setOf(3);
  set.without_start = {0, 2};
  set.episodes[1].base_position = {2, 0, 1};
  set.episodes[1].base_yaw = 0.5F;
  ASSERT_TRUE(draw(world, set).has_value());
  EXPECT_EQ(set.episodes[1].base_position, (Vec3{2, 0, 1}));
  EXPECT_EQ(set.episodes[1].base_yaw, 0.5F);
  EXPECT_NE(set.episodes[0].base_position, (Vec3{}));
  SourceEpisodes all = setOf(3);
  ASSERT_TRUE(draw(world, all).has_value());
  EXPECT_EQ(set.episodes[2].base_position, all.episodes[2].base_position);
  // Nothing is to be done, so no packs are needed.
  const SourceEpisodes before = set;
  EXPECT_TRUE(bake::drawStarts({}, 1, set).has_value());
  EXPECT_EQ(startsOf(set), startsOf(before));
}

/// A closet in which the robot fits at hardly any place but where the cube is.
bake::TriangleMesh closet() { return madeRoom(0.3F, 0.3F).build(); }

TEST(DrawnStarts, LeaveEpisodesOutThatHaveNone) {
  const MadeWorld world(closet(), stickRobot());
  const Pose in_the_way{{0.15F, kBottom, 0.15F}, {}};
  SourceEpisodes set = setOf(3);
  set.placements[2].pose = in_the_way;
  const auto drawn = draw(world, set);
  ASSERT_TRUE(drawn.has_value()) << drawn.error().text();
  ASSERT_EQ(set.episodes.size(), 2U);
  EXPECT_EQ(set.placements.size(), 4U);
  EXPECT_EQ(set.episodes[1].first_placement, 2U);
  ASSERT_EQ(set.warnings.size(), 1U);
  EXPECT_THAT(set.warnings.front(),
              testing::StartsWith("1 of 3 episodes are left out: no start of the robot stick was "
                                  "found (drawn and not taken: start_blocked "));

  SourceEpisodes blocked = setOf(1);
  blocked.placements[0].pose = in_the_way;
  const auto none = draw(world, blocked);
  ASSERT_FALSE(none.has_value());
  EXPECT_EQ(none.error().code, ErrorCode::kInvalidInput);
  EXPECT_THAT(none.error().message, HasSubstr("can be played in none of 1 episode: no start of"));
}

TEST(DrawnStarts, SayWhereTheRobotStandsNowhere) {
  const MadeWorld world(madeRoom(0.2F, 3).build(), stickRobot());
  SourceEpisodes set = setOf(2);
  const auto none = draw(world, set);
  ASSERT_FALSE(none.has_value());
  EXPECT_THAT(none.error().message,
              HasSubstr("; in the scene room the robot stick stands nowhere: "));
}

TEST(DrawnStarts, NeedThePacksOfScenesAndObjects) {
  const MadeWorld world(madeRoom(3, 3).build(), stickRobot());
  SourceEpisodes set = setOf(1);
  set.scenes = {"attic"};
  const auto no_scene = draw(world, set);
  ASSERT_FALSE(no_scene.has_value());
  EXPECT_EQ(no_scene.error().text(),
            "tidy: has episodes in the scene attic, which none of the packs holds; give its pack, "
            "too, or name it with `scene-name` attic=NAME");
  set = setOf(1);
  set.objects = {"bowl"};
  const auto no_object = draw(world, set);
  ASSERT_FALSE(no_object.has_value());
  EXPECT_EQ(no_object.error().text(),
            "tidy: places the object bowl, which none of the packs holds; give its pack, too");
  set = setOf(1);
  const auto no_robot = bake::drawStarts({.packs = {world.packs().front()}}, 1, set);
  ASSERT_FALSE(no_robot.has_value());
  EXPECT_THAT(no_robot.error().message, HasSubstr("found 1 scene, 0 objects and 0 robots"));
}

TEST(DrawnStarts, StopWhenTheyAreAskedTo) {
  const MadeWorld world(madeRoom(3, 3).build(), stickRobot());
  SourceEpisodes set = setOf(1);
  const auto stopped =
      bake::drawStarts({.packs = world.packs(), .stops = [] { return true; }}, 1, set);
  ASSERT_FALSE(stopped.has_value());
  EXPECT_EQ(stopped.error().code, ErrorCode::kInterrupted);
}

}  // namespace
}  // namespace galactic::test::start_drawing_test
