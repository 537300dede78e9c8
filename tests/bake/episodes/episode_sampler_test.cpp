#include "galactic/bake/episode_sampler.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "episode_oracle.h"
#include "made_world.h"

namespace galactic::test {
namespace {

using bake::EpisodeSamplerOptions;
using bake::SourceEpisodes;
using testing::HasSubstr;

/// A room with two tables.
bake::TriangleMesh tablesRoom() {
  MeshBuilder room = madeRoom(3, 3);
  room.box({0.2F, 0.6F, 0.2F}, {0.9F, 0.65F, 1});
  room.box({2, 0.6F, 2}, {2.8F, 0.65F, 2.7F});
  return room.build();
}

Result<SourceEpisodes> sampled(const MadeWorld& world, const EpisodeSamplerOptions& options) {
  return bake::sampleEpisodes(world.scenes(), world.objects(), world.robot(), options);
}

/// The message of the error that sampling ends with.
std::string refusal(const MadeWorld& world, const EpisodeSamplerOptions& options) {
  const auto result = sampled(world, options);
  if (result) return "no error";
  EXPECT_EQ(result.error().code, ErrorCode::kInvalidInput);
  return result.error().where + ": " + result.error().message;
}

TEST(EpisodeSampler, EpisodesOfASmallRoomKeepEveryPromise) {
  const MadeWorld world(tablesRoom(), stickRobot());
  const EpisodeSamplerOptions options{.episodes = 40, .objects = 4};
  const auto set = sampled(world, options);
  ASSERT_TRUE(set.has_value()) << set.error().message;
  EXPECT_EQ(set->scenes, std::vector<std::string>{"room"});
  EXPECT_EQ(set->objects, std::vector<std::string>{"cube"});
  EXPECT_EQ(set->robot, "stick");
  EXPECT_EQ(set->name, "room");
  ASSERT_EQ(set->episodes.size(), 40U);
  ASSERT_EQ(set->placements.size(), 160U);
  EpisodeOracle oracle(world.scene(), world.objects(), world.robot(), options);
  std::vector<int> targets(4, 0);
  for (std::size_t n = 0; n < set->episodes.size(); ++n) {
    const Episode& episode = set->episodes[n];
    EXPECT_EQ(episode.first_placement, 4 * n);
    EXPECT_EQ(episode.placement_count, 4U);
    ASSERT_LT(episode.target, 4U);
    ++targets[episode.target];
    EXPECT_TRUE(oracle.isApart(*set, episode)) << n;
    EXPECT_TRUE(oracle.allStand(*set, episode)) << n;
    EXPECT_TRUE(oracle.startsFree(*set, episode)) << n;
    EXPECT_TRUE(oracle.isReached(*set, episode, false)) << n;
    EXPECT_TRUE(oracle.isReached(*set, episode, true)) << n;
    EXPECT_GE(oracle.travel(*set, episode), 1.0);
  }
  // Any of the objects may be the target.
  EXPECT_THAT(targets, testing::Each(testing::Gt(0)));
}

TEST(EpisodeSampler, TakesScenesInTurnByTheirNames) {
  const MadeWorld world(tablesRoom(), stickRobot());
  const MemoryPack attic = scenePackOf(tablesRoom(), "attic");
  std::vector<Scene> scenes{world.scene(), MemoryPack::opened(Scene::from(attic.pack()))};
  const EpisodeSamplerOptions options{.episodes = 5, .objects = 2};
  const auto set = bake::sampleEpisodes(scenes, world.objects(), world.robot(), options);
  ASSERT_TRUE(set.has_value()) << set.error().message;
  EXPECT_EQ(set->scenes, (std::vector<std::string>{"attic", "room"}));
  for (std::size_t n = 0; n < set->episodes.size(); ++n) {
    EXPECT_EQ(set->episodes[n].scene, n % 2);
  }
  scenes.push_back(world.scene());
  const auto twice = bake::sampleEpisodes(scenes, world.objects(), world.robot(), options);
  ASSERT_FALSE(twice.has_value());
  EXPECT_EQ(twice.error().where, "room");
  EXPECT_THAT(twice.error().message, HasSubstr("two scenes have this name"));
}

TEST(EpisodeSampler, RefusesOptionsThatMakeNoSense) {
  const MadeWorld world(tablesRoom(), stickRobot());
  EXPECT_THAT(refusal(world, {.episodes = 0}), HasSubstr("0 episodes are asked for"));
  EXPECT_THAT(refusal(world, {.objects = 0}), HasSubstr("0 objects are asked for"));
  EXPECT_THAT(refusal(world, {.lowest = 1, .highest = 0.5F}), HasSubstr("from 1 to 0.5 m"));
  constexpr float kNoNumber = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(refusal(world, {.lowest = kNoNumber}), HasSubstr("no range"));
  EXPECT_THAT(refusal(world, {.least_distance = -1}), HasSubstr("is -1 m; give 0 or more"));
  EXPECT_THAT(refusal(world, {.least_distance = kNoNumber}), HasSubstr("give 0 or more"));
}

TEST(EpisodeSampler, SaysWhatIsMissingWhereNothingFits) {
  const MadeWorld bare(madeRoom(3, 3).build(), stickRobot());
  EXPECT_THAT(refusal(bare, {}), HasSubstr("room: no flat surface between 0.3 and 1.2 m"));
  const MadeWorld world(tablesRoom(), stickRobot());
  EXPECT_THAT(refusal(world, {.least_distance = 20}),
              HasSubstr("0 ended at the target, 20 at a goal 20 m"));
  EXPECT_THAT(refusal(world, {.objects = 200}), HasSubstr("at the other 199 objects"));
}

TEST(EpisodeSampler, SaysWhenTheRobotStandsNowhere) {
  RobotPackFields tall = stickRobot();
  tall.spheres[0].centre.y = 2.45F;
  const MadeWorld world(tablesRoom(), tall);
  EXPECT_THAT(refusal(world, {}), HasSubstr("the robot stick stands nowhere"));
}

TEST(EpisodeSampler, RefusesRobotsThatCannotDoTheTask) {
  RobotPackFields robot = stickRobot();
  robot.base = std::nullopt;
  EXPECT_THAT(refusal(MadeWorld(tablesRoom(), robot), {}),
              HasSubstr("stick: the robot has no base"));
  robot = stickRobot();
  robot.end_effector = std::nullopt;
  EXPECT_THAT(refusal(MadeWorld(tablesRoom(), robot), {}), HasSubstr("no end effector"));
}

TEST(EpisodeSampler, RefusesPacksOfOtherRadii) {
  const MadeWorld world(tablesRoom(), stickRobot());
  const MemoryPack other = scenePackOf(tablesRoom(), "room", {0.02F, 0.05F});
  const std::vector<Scene> scenes{MemoryPack::opened(Scene::from(other.pack()))};
  const auto result = bake::sampleEpisodes(scenes, world.objects(), world.robot(), {});
  ASSERT_FALSE(result.has_value());
  EXPECT_THAT(result.error().message, HasSubstr("spheres of 0.02, 0.05 m, the robot for 0.015"));
  const auto none = bake::sampleEpisodes({}, world.objects(), world.robot(), {});
  ASSERT_FALSE(none.has_value());
  EXPECT_THAT(none.error().message, HasSubstr("no scene is given"));
}

}  // namespace
}  // namespace galactic::test
