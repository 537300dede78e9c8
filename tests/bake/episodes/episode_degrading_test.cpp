// What becomes of episodes for which there is hardly a place, or none.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "episode_oracle.h"
#include "episodes/episode_draft.h"
#include "episodes/generation_world.h"
#include "episodes/home/prepared_scene.h"
#include "galactic/bake/packs.h"
#include "made_world.h"

namespace galactic::test::episode_degrading_test {
namespace {

using bake::DraftEase;
using bake::EpisodeGeneratorOptions;
using bake::GeneratedEpisodes;
using bake::SourceEpisodes;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Tables in two corners of a room.
bake::TriangleMesh tablesRoom() {
  MeshBuilder room = madeRoom(3, 3);
  room.box({0.2F, 0.6F, 0.2F}, {0.9F, 0.65F, 1});
  room.box({2, 0.6F, 2}, {2.8F, 0.65F, 2.7F});
  return room.build();
}

/// A table of slats as wide as three columns, every second one 4 mm higher.
bake::TriangleMesh slattedRoom() {
  MeshBuilder room = madeRoom(3, 3);
  for (int n = 0; n < 12; ++n) {
    const float z = 1 + 0.09F * static_cast<float>(n);
    room.box({1, 0.6F, z}, {2, n % 2 == 0 ? 0.65F : 0.654F, z + 0.09F});
  }
  return room.build();
}

/// One table in a room, at most 0.9 m across.
bake::TriangleMesh closet() {
  MeshBuilder room = madeRoom(1.8F, 1.8F);
  room.box({0.1F, 0.6F, 0.1F}, {0.8F, 0.65F, 0.7F});
  return room.build();
}

/// A long counter under a cupboard, where a box fits and a gripper does not, and two small tables.
bake::TriangleMesh cupboardRoom() {
  MeshBuilder room = madeRoom(4, 4);
  room.box({0.1F, 0.6F, 0.1F}, {3.9F, 0.65F, 0.8F});
  room.box({0.1F, 0.8F, 0.1F}, {3.9F, 2.5F, 0.8F});
  room.box({0.2F, 0.6F, 2.5F}, {0.46F, 0.65F, 2.76F});
  room.box({3.2F, 0.6F, 2.5F}, {3.46F, 0.65F, 2.76F});
  return room.build();
}

EpisodeGeneratorOptions optionsFor(std::uint32_t episodes, std::uint32_t objects) {
  EpisodeGeneratorOptions options;
  options.episodes = episodes;
  options.objects = {objects, objects};
  return options;
}

Result<GeneratedEpisodes> generated(const MadeWorld& world, const EpisodeGeneratorOptions& options,
                                    unsigned threads = 1) {
  return bake::generateEpisodes({.packs = world.packs(), .threads = threads}, options);
}

std::string refusal(const Result<GeneratedEpisodes>& result) {
  return result ? "no error" : result.error().text();
}

TEST(EpisodesThatAreCrowded, HaveFewerObjects) {
  const MadeWorld world(tablesRoom(), stickRobot());
  const EpisodeGeneratorOptions options = optionsFor(2, 200);
  const auto made = generated(world, options);
  ASSERT_TRUE(made.has_value()) << made.error().message;
  EXPECT_EQ(made->skipped, 0U);
  EXPECT_EQ(made->with_fewer_objects, 2U);
  EXPECT_THAT(made->episodes.warnings,
              ElementsAre("2 episodes have fewer than 200 objects: no more found a place"));
  EpisodeOracle oracle(world.scene(), world.objects(), world.robot(), options);
  for (const Episode& episode : made->episodes.episodes) {
    EXPECT_GT(episode.placement_count, 4U);
    EXPECT_LT(episode.placement_count, 200U);
    EXPECT_LT(episode.target, episode.placement_count);
    EXPECT_TRUE(oracle.isApart(made->episodes, episode));
    EXPECT_TRUE(oracle.allStand(made->episodes, episode));
    EXPECT_TRUE(oracle.startsFree(made->episodes, episode));
  }
}

/// The robot starts at a distance that a draw hits once in some million tries.
EpisodeGeneratorOptions rarelyPossible(std::uint32_t episodes) {
  EpisodeGeneratorOptions options = optionsFor(episodes, 2);
  options.start_to_target = {1.2F, 1.200001F};
  options.most_skipped = 1;
  return options;
}

TEST(EpisodesWithoutAPlace, AreSkippedAndTheOthersStayWhatTheyAre) {
  const MadeWorld world(tablesRoom(), stickRobot());
  EpisodeGeneratorOptions options = rarelyPossible(40);
  const auto many = generated(world, options);
  ASSERT_TRUE(many.has_value()) << many.error().message;
  const std::size_t count = many->episodes.episodes.size();
  EXPECT_EQ(count + many->skipped, 40U);
  EXPECT_GE(count, 4U) << "the test wants episodes of both kinds";
  EXPECT_GE(many->skipped, 4U);
  EXPECT_EQ(many->scenes[0].episodes, count);
  EXPECT_EQ(many->scenes[0].skipped, many->skipped);
  EXPECT_THAT(many->episodes.warnings,
              ElementsAre("scene room: " + std::to_string(many->skipped) +
                          " of 40 episodes found no place and are skipped"));
  // Those of a shorter run are the first of a longer one.
  options.episodes = 25;
  const auto few = generated(world, options);
  ASSERT_TRUE(few.has_value()) << few.error().message;
  ASSERT_LE(few->episodes.episodes.size(), count);
  for (std::size_t n = 0; n < few->episodes.episodes.size(); ++n) {
    const Episode& one = few->episodes.episodes[n];
    const Episode& same = many->episodes.episodes[n];
    EXPECT_EQ(one.base_position, same.base_position) << n;
    EXPECT_EQ(one.goal.translation, same.goal.translation) << n;
  }
  const auto parallel = generated(world, options, 3);
  ASSERT_TRUE(parallel.has_value());
  const auto bytesOf = [](const SourceEpisodes& set) {
    return MemoryPack::opened(bake::encodeEpisodePack(set, testProvenance("e")));
  };
  EXPECT_TRUE(bytesOf(few->episodes) == bytesOf(parallel->episodes));
}

TEST(EpisodesWithoutAPlace, AreAnErrorBeyondTheShareThatMayBeSkipped) {
  const MadeWorld world(tablesRoom(), stickRobot());
  EpisodeGeneratorOptions options = rarelyPossible(20);
  options.most_skipped = 0.1F;
  EXPECT_THAT(refusal(generated(world, options)),
              AllOf(HasSubstr("room: "),
                    HasSubstr("of 20 episodes found no place, a share of 0.1 may be skipped"),
                    HasSubstr("in any of 150 drafts: 0 ended at the target, 0 at a goal"),
                    HasSubstr("150 at the robot's start")));
  // All of them are an error, whatever the share.
  options.most_skipped = 1;
  options.start_to_target = {20, 30};
  options.episodes = 1;
  EXPECT_THAT(refusal(generated(world, options)), HasSubstr("1 of 1 episodes found no place"));
}

TEST(ScenesWithoutPlacesForGoals, AreLeftOutBeforeAnythingIsDrawn) {
  const MadeWorld world(tablesRoom(), stickRobot());
  EpisodeGeneratorOptions options = optionsFor(1000, 2);
  // Between the farthest places of one table and the nearest ones of two.
  options.target_to_goal = {0.95F, 1.05F};
  EXPECT_THAT(refusal(generated(world, options)),
              HasSubstr("room: no places were found for a target and its goal 0.95 to 1.05 m away "
                        "in 20000 tries on its"));
}

TEST(ScenesWithoutPlacesForGoals, SayWhatWasDrawnAndNotTaken) {
  EpisodeGeneratorOptions options = optionsFor(10, 2);
  options.target_to_goal = {0.95F, 1.05F};
  EXPECT_THAT(refusal(generated(MadeWorld(tablesRoom(), stickRobot()), options)),
              AllOf(HasSubstr("(drawn and not taken: distance "),
                    HasSubstr("); ask for other distances, other heights or smaller objects")));
  // No cube stands flat on the slats of a tray.
  EXPECT_THAT(refusal(generated(MadeWorld(slattedRoom(), stickRobot()), optionsFor(10, 2))),
              AllOf(HasSubstr("(drawn and not taken: no_room "),
                    HasSubstr("); hardly any place is flat to 0.002 m under an object and free "
                              "over it: give scans `flatness` 0.01")));
  // Nothing comes near a grasp point that is in the middle of a sphere.
  RobotPackFields robot = stickRobot();
  robot.end_effector->grasp_point = robot.spheres.back().center;
  robot.end_effector->grasp_radius = 0.01F;
  options.target_to_goal = {.least = 0.3F};
  EXPECT_THAT(refusal(generated(MadeWorld(tablesRoom(), robot), options)),
              AllOf(HasSubstr("a target and its goal 0.3 m or more away in 20000 tries"),
                    HasSubstr("not_reached "),
                    HasSubstr("; the hand reached none of the targets that stood: see that the "
                              "grasp point of the robot's recipe is outside of its spheres")));
}

TEST(SmallScenes, HaveTheirGoalsNearerWhereThatIsAllowed) {
  const MadeWorld world(closet(), stickRobot());
  EpisodeGeneratorOptions options = optionsFor(8, 2);
  EXPECT_THAT(refusal(generated(world, options)),
              AllOf(HasSubstr("room: its surfaces within reach are 0."),
                    HasSubstr("m apart at most, but goals must be 1 m away")));
  options.shorten_way = true;
  const auto made = generated(world, options);
  ASSERT_TRUE(made.has_value()) << made.error().message;
  ASSERT_TRUE(made->scenes[0].shortened_way.has_value());
  const float least = *made->scenes[0].shortened_way;
  EXPECT_GT(least, 0.3F);
  EXPECT_LT(least, 0.6F);
  ASSERT_EQ(made->episodes.warnings.size(), 1U);
  EXPECT_THAT(made->episodes.warnings[0],
              HasSubstr("scene room is too small for goals 1 m away: they are 0."));
  EpisodeOracle oracle(world.scene(), world.objects(), world.robot(), options);
  for (const Episode& episode : made->episodes.episodes) {
    EXPECT_GE(oracle.travel(made->episodes, episode), static_cast<double>(least) - 1e-5);
  }
}

TEST(EpisodesOnFewPlaces, SayWhichOptionsWouldHelp) {
  // Two small tables 3 m apart that are flat, and one between them of slats as wide as two columns.
  MeshBuilder room = madeRoom(4, 3);
  for (const float x : {0.2F, 3.2F}) room.box({x, 0.6F, 1.2F}, {x + 0.4F, 0.65F, 1.6F});
  for (int n = 0; n < 20; ++n) {
    const float x = 1.2F + 0.06F * static_cast<float>(n);
    room.box({x, 0.6F, 0.2F}, {x + 0.06F, n % 2 == 0 ? 0.65F : 0.654F, 0.9F});
  }
  const MadeWorld world(room.build(), stickRobot());
  EpisodeGeneratorOptions options = optionsFor(4, 1);
  options.flatness = 0.002F;
  options.target_to_goal = {2.95F, 2.954F};
  const auto made = generated(world, options);
  ASSERT_TRUE(made.has_value()) << made.error().message;
  EXPECT_THAT(made->episodes.warnings,
              ElementsAre(testing::MatchesRegex(
                              "scene room: objects stand at [0-9]+ places on [0-9]+ surfaces, "
                              "which are flat to 0.002 m; with `flatness` 0.01, as scans need it, "
                              "there are [0-9]+"),
                          testing::MatchesRegex(
                              "[0-9]+ of [0-9]+ places drawn and not taken were goals that are not "
                              "2.95 to 2.954 m away from their targets: with a wider "
                              "`goal-distance` episodes are drawn sooner and use more places")));
  options.flatness = 0.01F;
  options.target_to_goal = {0.3F, 5};
  const auto easy = generated(world, options);
  ASSERT_TRUE(easy.has_value()) << easy.error().message;
  EXPECT_THAT(easy->episodes.warnings, IsEmpty());
}

TEST(SmallScenes, AreLeftOutBesideOthers) {
  const MadeWorld world(tablesRoom(), stickRobot());
  const MemoryPack small = scenePackOf(closet(), "closet");
  bake::EpisodeInputs inputs{world.packs(), {}};
  inputs.packs.push_back(&small.pack());
  EpisodeGeneratorOptions options = optionsFor(6, 2);
  const auto made = bake::generateEpisodes(inputs, options);
  ASSERT_TRUE(made.has_value()) << made.error().message;
  ASSERT_EQ(made->left_out.size(), 1U);
  EXPECT_EQ(made->left_out[0].name, "closet");
  EXPECT_EQ(made->scenes[0].episodes, 6U);
  options.shorten_way = true;
  const auto both = bake::generateEpisodes(inputs, options);
  ASSERT_TRUE(both.has_value()) << both.error().message;
  EXPECT_THAT(both->left_out, IsEmpty());
  EXPECT_TRUE(both->scenes[0].shortened_way.has_value());
  EXPECT_FALSE(both->scenes[1].shortened_way.has_value()) << "large enough";
}

TEST(ProvenPlaces, LetMoreDraftsSucceed) {
  const MadeWorld world(cupboardRoom(), stickRobot());
  const EpisodeGeneratorOptions options = optionsFor(1, 1);
  const auto packs = world.packs();
  const auto generation = bake::GenerationWorld::open(packs);
  ASSERT_TRUE(generation.has_value()) << generation.error().message;
  const bake::ArmReach reach(generation->robot());
  const bake::GenerationContext context{*generation, reach, {}, options};
  const auto prepared =
      bake::PreparedScene::prepare(context, generation->scenes().front().scene, {});
  ASSERT_TRUE(prepared.has_value()) << prepared.error().message;
  const bake::DraftHome home = (*prepared)->draftHome();
  const auto pairs = bake::findProvenPairs(home).pairs;
  EXPECT_FALSE(pairs.empty());
  const auto& places = home.supports.places();
  for (const bake::ProvenPair& pair : pairs) {
    EXPECT_GT(places[pair.target].z, 2);
    EXPECT_GT(places[pair.goal].z, 2) << "a gripper does not fit under the cupboard";
  }
  constexpr int kDrafts = 60;
  const auto successes = [&](const DraftEase& ease) {
    int count = 0;
    for (std::uint64_t seed = 0; seed < kDrafts; ++seed) {
      bake::Random random(seed);
      bake::DraftedEpisode episode;
      bake::RejectionCounts rejections;
      count += bake::draftEpisode(home, ease, random, episode, rejections) == bake::DraftEnd::kDone
                   ? 1
                   : 0;
    }
    return count;
  };
  const int anywhere = successes({});
  const int near_proven = successes({.proven = pairs});
  RecordProperty("anywhere", anywhere);
  EXPECT_LT(anywhere, kDrafts * 8 / 10);
  EXPECT_GT(near_proven, kDrafts * 9 / 10);
}

TEST(ProvenPlaces, CountOneReasonForEachTry) {
  const MadeWorld world(tablesRoom(), stickRobot());
  const EpisodeGeneratorOptions options = optionsFor(1, 1);
  const auto packs = world.packs();
  const auto generation = bake::GenerationWorld::open(packs);
  ASSERT_TRUE(generation.has_value()) << generation.error().message;
  const bake::ArmReach reach(generation->robot());
  const bake::GenerationContext context{*generation, reach, {}, options};
  const auto prepared =
      bake::PreparedScene::prepare(context, generation->scenes().front().scene, {});
  ASSERT_TRUE(prepared.has_value()) << prepared.error().message;
  bake::DraftHome home = (*prepared)->draftHome();
  // No place is that far from any other.
  home.target_to_goal = {50, 60};
  const bake::PairSearch search = bake::findProvenPairs(home);
  EXPECT_THAT(search.pairs, IsEmpty());
  EXPECT_GT(search.reached_targets, 0U);
  EXPECT_EQ(search.rejections[bake::EpisodeRejection::kDistance], search.reached_targets);
  std::uint64_t drawn = 0;
  for (std::size_t reason = 0; reason < bake::kRejectionCount; ++reason) {
    drawn += search.rejections[static_cast<bake::EpisodeRejection>(reason)];
  }
  EXPECT_EQ(drawn, bake::kSurveyTries);
}

}  // namespace
}  // namespace galactic::test::episode_degrading_test
