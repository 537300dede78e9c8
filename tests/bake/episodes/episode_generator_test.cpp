#include "galactic/bake/episode_generator.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "episode_oracle.h"
#include "made_world.h"

namespace galactic::test::episode_generator_test {
namespace {

using bake::EpisodeGeneratorOptions;
using bake::GeneratedEpisodes;
using bake::SourceEpisodes;
using testing::AllOf;
using testing::HasSubstr;

/// A room with two tables.
bake::TriangleMesh tablesRoom() {
  MeshBuilder room = madeRoom(3, 3);
  room.box({0.2F, 0.6F, 0.2F}, {0.9F, 0.65F, 1});
  room.box({2, 0.6F, 2}, {2.8F, 0.65F, 2.7F});
  return room.build();
}

Result<GeneratedEpisodes> generated(const MadeWorld& world,
                                    const EpisodeGeneratorOptions& options) {
  return bake::generateEpisodes({world.packs(), {}}, options);
}

EpisodeGeneratorOptions optionsFor(std::uint32_t episodes, std::uint32_t objects) {
  EpisodeGeneratorOptions options;
  options.episodes = episodes;
  options.objects = {objects, objects};
  return options;
}

/// The message of the error that a generation ends with.
std::string refusal(const MadeWorld& world, const EpisodeGeneratorOptions& options) {
  const auto result = generated(world, options);
  if (result) return "no error";
  EXPECT_EQ(result.error().code, ErrorCode::kInvalidInput);
  return result.error().text();
}

TEST(EpisodeGenerator, EpisodesOfASmallRoomKeepEveryPromise) {
  const MadeWorld world(tablesRoom(), stickRobot());
  const EpisodeGeneratorOptions options = optionsFor(40, 4);
  const auto made = generated(world, options);
  ASSERT_TRUE(made.has_value()) << made.error().message;
  const SourceEpisodes* set = &made->episodes;
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

TEST(EpisodeGenerator, TakesScenesInTurnByTheirNames) {
  const MadeWorld world(tablesRoom(), stickRobot());
  const MemoryPack attic = scenePackOf(tablesRoom(), "attic");
  bake::EpisodeInputs inputs{world.packs(), {}};
  inputs.packs.push_back(&attic.pack());
  const auto made = bake::generateEpisodes(inputs, optionsFor(5, 2));
  ASSERT_TRUE(made.has_value()) << made.error().message;
  const SourceEpisodes& set = made->episodes;
  EXPECT_EQ(set.scenes, (std::vector<std::string>{"attic", "room"}));
  for (std::size_t n = 0; n < set.episodes.size(); ++n) EXPECT_EQ(set.episodes[n].scene, n % 2);
  ASSERT_EQ(made->scenes.size(), 2U);
  EXPECT_EQ(made->scenes[0].name, "attic");
  EXPECT_EQ(made->scenes[0].episodes, 3U);
  EXPECT_EQ(made->scenes[1].episodes, 2U);
  EXPECT_EQ(made->scenes[1].surfaces, 2U);
  inputs.packs.push_back(inputs.packs.front());
  const auto twice = bake::generateEpisodes(inputs, optionsFor(5, 2));
  ASSERT_FALSE(twice.has_value());
  EXPECT_EQ(twice.error().where, "room");
  EXPECT_THAT(twice.error().message, HasSubstr("two scenes have this name"));
}

TEST(EpisodeGenerator, RefusesOptionsThatMakeNoSense) {
  const MadeWorld world(tablesRoom(), stickRobot());
  constexpr float kNoNumber = std::numeric_limits<float>::quiet_NaN();
  const auto refused = [&world](const auto& spoil) {
    EpisodeGeneratorOptions options;
    spoil(options);
    return refusal(world, options);
  };
  using Options = EpisodeGeneratorOptions;
  EXPECT_THAT(refused([](Options& o) { o.episodes = 0; }), HasSubstr("0 episodes are asked for"));
  EXPECT_THAT(refused([](Options& o) { o.objects = {0, 3}; }), HasSubstr("0 objects are asked"));
  EXPECT_THAT(refused([](Options& o) { o.objects = {4, 3}; }), HasSubstr("4 to 3 objects"));
  EXPECT_THAT(refused([](Options& o) { o.heights = {1, 0.5F}; }), HasSubstr("from 1 to 0.5 m"));
  EXPECT_THAT(refused([](Options& o) { o.heights.least = kNoNumber; }), HasSubstr("no range"));
  EXPECT_THAT(refused([](Options& o) { o.target_to_goal.least = -1; }),
              HasSubstr("from target to goal from -1 to inf m is not a range"));
  EXPECT_THAT(refused([](Options& o) { o.target_to_goal.least = kNoNumber; }),
              HasSubstr("is not a range"));
  EXPECT_THAT(refused([](Options& o) {
                o.start_to_target = {2, 1};
              }),
              HasSubstr("from start to target from 2 to 1 m is not a range"));
  EXPECT_THAT(refused([](Options& o) { o.flatness = 0.5F; }), HasSubstr("0.5 m is asked for"));
  EXPECT_THAT(refused([](Options& o) { o.flatness = 0; }), HasSubstr("more than 0"));
  EXPECT_THAT(refused([](Options& o) { o.split.held_out = 1.5F; }), HasSubstr("held out is 1.5"));
  EXPECT_THAT(refused([](Options& o) { o.most_skipped = -0.1F; }), HasSubstr("skipped is -0.1"));
  EXPECT_THAT(refused([](Options& o) { o.most_skipped = kNoNumber; }), HasSubstr("skipped is nan"));
}

TEST(EpisodeGenerator, SaysWhatIsMissingWhereNothingFits) {
  const MadeWorld bare(madeRoom(3, 3).build(), stickRobot());
  EXPECT_THAT(refusal(bare, {}), HasSubstr("room: no flat surface between 0.3 and 1.2 m"));
  const MadeWorld world(tablesRoom(), stickRobot());
  EpisodeGeneratorOptions options;
  options.target_to_goal.least = 20;
  EXPECT_THAT(refusal(world, options),
              AllOf(HasSubstr("surfaces within reach are"), HasSubstr("goals must be 20 m away")));
  options = optionsFor(1, 1);
  options.supports = bake::SupportChoice::kReceptacles;
  EXPECT_THAT(refusal(world, options), HasSubstr("no receptacles of the scene are known"));
}

TEST(EpisodeGenerator, SaysWhenTheRobotStandsNowhere) {
  RobotPackFields tall = stickRobot();
  tall.spheres[0].center.y = 2.45F;
  const MadeWorld world(tablesRoom(), tall);
  EXPECT_THAT(refusal(world, {}), HasSubstr("the robot stick stands nowhere"));
}

TEST(EpisodeGenerator, RefusesRobotsThatCannotDoTheTask) {
  RobotPackFields robot = stickRobot();
  robot.base = std::nullopt;
  EXPECT_THAT(refusal(MadeWorld(tablesRoom(), robot), {}),
              HasSubstr("stick: the robot has no base"));
  robot = stickRobot();
  robot.end_effector = std::nullopt;
  EXPECT_THAT(refusal(MadeWorld(tablesRoom(), robot), {}), HasSubstr("no end effector"));
}

TEST(EpisodeGenerator, RefusesPacksThatDoNotGoTogether) {
  const MadeWorld world(tablesRoom(), stickRobot());
  const auto refused = [](std::vector<const PackFile*> packs) {
    const auto result = bake::generateEpisodes({std::move(packs), {}}, {});
    return result ? "no error" : result.error().message;
  };
  const MemoryPack other = scenePackOf(tablesRoom(), "attic", {0.02F, 0.05F});
  std::vector<const PackFile*> packs = world.packs();
  packs.push_back(&other.pack());
  EXPECT_THAT(refused(packs), HasSubstr("spheres of 0.02, 0.05 m, the robot for 0.015"));
  packs = world.packs();
  packs.push_back(packs[1]);
  EXPECT_THAT(refused(packs), HasSubstr("two objects have this name"));
  packs = world.packs();
  packs.push_back(packs[2]);
  EXPECT_THAT(refused(packs), HasSubstr("is a second robot, the first is stick"));
  EXPECT_THAT(refused({packs[1], packs[2]}), HasSubstr("found 0 scenes, 1 object and 1 robot;"));
}

}  // namespace
}  // namespace galactic::test::episode_generator_test
