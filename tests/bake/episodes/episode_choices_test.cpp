// Where episodes take place and where their objects stand: splits, receptacles, geometry, several
// packs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <set>

#include "episodes/home/support_places.h"
#include "episodes/trial/episode_replay.h"
#include "galactic/bake/packs.h"
#include "made_world.h"
#include "support/oracles/box_oracle.h"

namespace galactic::test::episode_choices_test {
namespace {

using bake::EpisodeGeneratorOptions;
using bake::EpisodeInputs;
using bake::EpisodeRejection;
using bake::GeneratedEpisodes;
using bake::SceneDetails;
using bake::SourceEpisodes;
using bake::SplitSide;
using bake::SupportChoice;
using bake::SupportRegion;

/// Tables at both ends of a room; the second is split by a gap of 1.2 cm, into which a sphere of
/// 1.5 cm sinks by 1.3 mm: less than what counts as uneven in columns.
constexpr float kGapFrom = 2.3F;
constexpr float kGapTo = 2.312F;
constexpr float kTop = 0.65F;

bake::TriangleMesh twoTables() {
  MeshBuilder room = madeRoom(3, 3);
  room.box({0.2F, 0.6F, 0.2F}, {0.9F, kTop, 1});
  room.box({2, 0.6F, 2}, {kGapFrom, kTop, 2.7F});
  room.box({kGapTo, 0.6F, 2}, {2.8F, kTop, 2.7F});
  return room.build();
}

EpisodeGeneratorOptions optionsFor(std::uint32_t episodes, std::uint32_t objects) {
  EpisodeGeneratorOptions options;
  options.episodes = episodes;
  options.objects = {objects, objects};
  return options;
}

GeneratedEpisodes generated(const EpisodeInputs& inputs, const EpisodeGeneratorOptions& options) {
  return MemoryPack::opened(bake::generateEpisodes(inputs, options));
}

/// Origins of all objects and goals.
std::vector<Vec3> originsOf(const SourceEpisodes& set) {
  std::vector<Vec3> origins;
  for (const Placement& placement : set.placements) origins.push_back(placement.pose.translation);
  for (const Episode& episode : set.episodes) origins.push_back(episode.goal.translation);
  return origins;
}

std::vector<std::byte> bytesOf(const SourceEpisodes& set) {
  return MemoryPack::opened(bake::encodeEpisodePack(set, testProvenance("episodes")));
}

std::size_t countNotIn(const SourceEpisodes& set, const SupportRegion& region) {
  const auto origins = originsOf(set);
  const Vec3 center = region.world_from_region.translation;
  const auto outside = [&](const Vec3& p) {
    const Vec3 at = rotate(conjugate(region.world_from_region.rotation), p - center);
    constexpr float kRounding = 1e-4F;
    return std::abs(at.x) > region.half_extents.x + kRounding ||
           std::abs(at.z) > region.half_extents.z + kRounding;
  };
  return static_cast<std::size_t>(std::count_if(origins.begin(), origins.end(), outside));
}

TEST(SplitsOfScenes, HoldOutTheShareThatIsAskedForWhateverElseThereIs) {
  constexpr int kScenes = 4000;
  for (const float share : {0.2F, 0.5F}) {
    int held_out = 0;
    int moved = 0;
    for (int n = 0; n < kScenes; ++n) {
      const std::string name = "scene_" + std::to_string(n);
      bake::SceneSplit split{.held_out = share};
      const bool is_held_out = bake::isHeldOut(name, split);
      if (is_held_out) ++held_out;
      split.seed = 2;
      if (bake::isHeldOut(name, split) != is_held_out) ++moved;
    }
    // Four standard deviations of a binomial.
    const double expected = kScenes * static_cast<double>(share);
    EXPECT_NEAR(held_out, expected, 4 * std::sqrt(expected));
    EXPECT_GT(moved, kScenes / 10);
  }
  EXPECT_FALSE(bake::isHeldOut("any", {.held_out = 0}));
  EXPECT_TRUE(bake::isHeldOut("any", {.held_out = 1}));
}

TEST(SplitsOfScenes, TakeEachSceneOnOneSide) {
  const MadeWorld world(twoTables(), stickRobot());
  std::vector<MemoryPack> more;
  more.reserve(4);
  for (const char* name : {"attic", "cellar", "hall", "kitchen"}) {
    more.push_back(scenePackOf(twoTables(), name));
  }
  EpisodeInputs inputs{world.packs(), {}};
  for (const MemoryPack& pack : more) inputs.packs.push_back(&pack.pack());
  EpisodeGeneratorOptions options = optionsFor(10, 1);
  options.split.held_out = 0.5F;
  std::set<std::string> all;
  for (const SplitSide side : {SplitSide::kTrain, SplitSide::kValidation}) {
    options.split.side = side;
    const auto made = generated(inputs, options);
    for (const std::string& scene : made.episodes.scenes) {
      EXPECT_TRUE(all.insert(scene).second) << scene << " is on both sides";
      EXPECT_EQ(bake::isHeldOut(scene, options.split), side == SplitSide::kValidation);
    }
  }
  EXPECT_EQ(all.size(), 5U);
  options.split.held_out = 0;
  const auto none = bake::generateEpisodes(inputs, options);
  ASSERT_FALSE(none.has_value());
  EXPECT_THAT(none.error().message,
              testing::HasSubstr("none of the 5 scenes is for validation when 0 of them"));
}

TEST(Receptacles, ContainWhatIsInOrJustUnderTheirBoxes) {
  std::mt19937 random(23);
  constexpr int kCases = 4000;
  int inside = 0;
  for (int n = 0; n < kCases; ++n) {
    const double yaw = 2 * std::numbers::pi * uniform(random);
    const SupportRegion region{.name = "top",
                               .world_from_region = {{1, 0.7F, 2},
                                                     {0, static_cast<float>(std::sin(yaw / 2)), 0,
                                                      static_cast<float>(std::cos(yaw / 2))}},
                               .half_extents = {0.4F, 0.05F, 0.2F}};
    const double along = 1.2 * uniform(random) - 0.6;
    const double across = 0.6 * uniform(random) - 0.3;
    const double up = 0.4 * uniform(random) - 0.2;
    // 5 cm under the box and 2 cm over it count as well.
    const double margin =
        std::min({0.4 - std::abs(along), 0.2 - std::abs(across), 0.07 - up, up + 0.1});
    constexpr double kRounding = 1e-4;
    if (std::abs(margin) < kRounding) continue;
    const Vec3 point{static_cast<float>(1 + along * std::cos(yaw) + across * std::sin(yaw)),
                     static_cast<float>(0.7 + up),
                     static_cast<float>(2 - along * std::sin(yaw) + across * std::cos(yaw))};
    EXPECT_EQ(bake::contains(region, point), margin > 0) << along << " " << up << " " << across;
    if (margin > 0) ++inside;
  }
  EXPECT_GT(inside, kCases / 10);
  EXPECT_LT(inside, kCases * 9 / 10);
}

TEST(Receptacles, HoldAllObjectsOrMoreOfThemAsAsked) {
  const MadeWorld world(twoTables(), stickRobot());
  // The first table's front half, and the whole of it in height.
  const SupportRegion region{.name = "front",
                             .world_from_region = {{0.55F, kTop + 0.05F, 0.4F}, {}},
                             .half_extents = {0.35F, 0.06F, 0.2F}};
  EpisodeInputs inputs{world.packs(), [&](std::string_view scene) -> Result<SceneDetails> {
                         EXPECT_EQ(scene, "room");
                         return SceneDetails{.mesh = {}, .receptacles = {region}};
                       }};
  EpisodeGeneratorOptions options = optionsFor(200, 2);
  options.target_to_goal.least = 0.1F;
  const auto outside = [&](SupportChoice choice) {
    options.supports = choice;
    const auto made = generated(inputs, options);
    EXPECT_EQ(made.scenes.front().receptacles, 1U);
    return static_cast<double>(countNotIn(made.episodes, region)) /
           static_cast<double>(3 * options.episodes);
  };
  const double any = outside(SupportChoice::kFound);
  const double both = outside(SupportChoice::kBoth);
  EXPECT_EQ(outside(SupportChoice::kReceptacles), 0);
  EXPECT_GT(any, 0.6);
  EXPECT_LT(both, any - 0.1);
  EXPECT_GT(both, 0.1);
}

TEST(Geometry, ShowsGapsThatColumnsBridge) {
  const MadeWorld world(twoTables(), stickRobot());
  const auto over_gap = [](const SourceEpisodes& set) {
    const auto origins = originsOf(set);
    // The cube's half diagonal would be more; this much is under it in every direction.
    constexpr float kHalf = 0.04F;
    return std::count_if(origins.begin(), origins.end(), [](const Vec3& p) {
      return p.x > kGapTo - kHalf && p.x < kGapFrom + kHalf;
    });
  };
  EpisodeInputs inputs{world.packs(), {}};
  const EpisodeGeneratorOptions options = optionsFor(200, 3);
  const auto blind = generated(inputs, options);
  EXPECT_GT(over_gap(blind.episodes), 20);
  EXPECT_FALSE(blind.scenes.front().has_mesh);
  inputs.details = [](std::string_view) -> Result<SceneDetails> {
    return SceneDetails{.mesh = twoTables(), .receptacles = {}};
  };
  const auto seeing = generated(inputs, options);
  EXPECT_EQ(over_gap(seeing.episodes), 0);
  EXPECT_TRUE(seeing.scenes.front().has_mesh);
  EXPECT_GT(seeing.rejections[EpisodeRejection::kUneven], 0U);
}

TEST(Geometry, OfAnotherPlaceIsRefused) {
  const MadeWorld world(twoTables(), stickRobot());
  const EpisodeInputs inputs{world.packs(), [](std::string_view) -> Result<SceneDetails> {
                               bake::TriangleMesh mesh = twoTables();
                               mesh.bounds.max = {1, 3, 1};
                               return SceneDetails{.mesh = mesh, .receptacles = {}};
                             }};
  const auto made = bake::generateEpisodes(inputs, optionsFor(1, 1));
  ASSERT_FALSE(made.has_value());
  EXPECT_EQ(made.error().where, "room");
  EXPECT_THAT(made.error().message, testing::HasSubstr("to x 1, z 1 m, its column grids from"));
}

/// A room without anything in it, and one that is too low for the robot's arm.
bake::TriangleMesh bareRoom() { return madeRoom(3, 3).build(); }
bake::TriangleMesh crawlSpace() { return madeRoom(1, 1, 0.5F).build(); }

TEST(ScenesWithoutFloorOrSurface, AreLeftOutAsIfTheyWereNotThere) {
  const MadeWorld world(twoTables(), stickRobot());
  const MemoryPack kitchen = scenePackOf(twoTables(), "kitchen");
  const MemoryPack attic = scenePackOf(bareRoom(), "attic");
  const MemoryPack den = scenePackOf(crawlSpace(), "den");
  EpisodeInputs good{world.packs(), {}};
  good.packs.push_back(&kitchen.pack());
  EpisodeInputs all = good;
  all.packs.push_back(&attic.pack());
  all.packs.push_back(&den.pack());
  for (const std::uint32_t episodes : {1U, 3U, 150U}) {
    EpisodeGeneratorOptions options = optionsFor(episodes, 2);
    const auto wanted = generated(good, options);
    for (const unsigned threads : {1U, 2U, 5U}) {
      all.threads = threads;
      std::size_t told = 0;
      const auto made = MemoryPack::opened(
          bake::generateEpisodes(all, options, [&told](std::size_t done) { told = done; }));
      EXPECT_EQ(told, episodes);
      EXPECT_TRUE(bytesOf(made.episodes) == bytesOf(wanted.episodes)) << episodes << " " << threads;
      EXPECT_EQ(made.episodes.scenes, (std::vector<std::string>{"kitchen", "room"}));
      EXPECT_EQ(made.scenes.size(), wanted.scenes.size());
      EXPECT_EQ(made.rejections[EpisodeRejection::kNoRoom],
                wanted.rejections[EpisodeRejection::kNoRoom]);
      ASSERT_EQ(made.left_out.size(), 2U);
      EXPECT_EQ(made.left_out[0].name, "attic");
      EXPECT_THAT(made.left_out[0].reason, testing::HasSubstr("no flat surface between"));
      EXPECT_EQ(made.left_out[1].name, "den");
      EXPECT_THAT(made.left_out[1].reason, testing::HasSubstr("stands nowhere"));
      EXPECT_THAT(made.episodes.warnings,
                  testing::ElementsAre(testing::StartsWith("scene attic is left out: no flat"),
                                       testing::StartsWith("scene den is left out: the robot")));
    }
  }
}

TEST(ScenesWithoutFloorOrSurface, AreAnErrorWhenNoOtherIsLeft) {
  const MadeWorld world(bareRoom(), stickRobot());
  const MemoryPack den = scenePackOf(crawlSpace(), "den");
  EpisodeInputs inputs{world.packs(), {}};
  inputs.packs.push_back(&den.pack());
  for (const std::uint32_t episodes : {1U, 10U}) {
    const auto none = bake::generateEpisodes(inputs, optionsFor(episodes, 1));
    ASSERT_FALSE(none.has_value());
    EXPECT_EQ(none.error().code, ErrorCode::kInvalidInput);
    EXPECT_EQ(none.error().where, "den");
    EXPECT_THAT(none.error().message, testing::HasSubstr("stands nowhere"));
    EXPECT_THAT(none.error().message, testing::EndsWith("; the other scene cannot be used either"));
  }
}

TEST(ScenesWithoutFloorOrSurface, ChangeNoSplit) {
  // Which scenes are held out has to be the same whether or not one of them can be used.
  const MadeWorld world(twoTables(), stickRobot());
  const std::vector<std::string> names{"attic", "cellar", "hall", "kitchen", "shed"};
  std::vector<MemoryPack> whole;
  std::vector<MemoryPack> partly;
  EpisodeInputs usable{world.packs(), {}};
  EpisodeInputs mixed = usable;
  for (std::size_t n = 0; n < names.size(); ++n) {
    whole.push_back(scenePackOf(twoTables(), names[n]));
    partly.push_back(scenePackOf(n % 2 == 0 ? twoTables() : bareRoom(), names[n]));
  }
  for (std::size_t n = 0; n < names.size(); ++n) {
    usable.packs.push_back(&whole[n].pack());
    mixed.packs.push_back(&partly[n].pack());
  }
  EpisodeGeneratorOptions options = optionsFor(12, 1);
  options.split.held_out = 0.5F;
  std::size_t left_out = 0;
  for (const SplitSide side : {SplitSide::kTrain, SplitSide::kValidation}) {
    options.split.side = side;
    auto wanted = generated(usable, options).episodes.scenes;
    const auto made = generated(mixed, options);
    left_out += made.left_out.size();
    for (const bake::UnusableScene& scene : made.left_out) {
      EXPECT_EQ(std::erase(wanted, scene.name), 1U) << scene.name << " is on the other side";
    }
    EXPECT_EQ(made.episodes.scenes, wanted);
  }
  EXPECT_EQ(left_out, 2U);
}

TEST(Receptacles, ThatAreAskedForLeaveOutScenesThatHaveNone) {
  const MadeWorld world(twoTables(), stickRobot());
  const MemoryPack attic = scenePackOf(twoTables(), "attic");
  EpisodeInputs inputs{
      world.packs(), [](std::string_view scene) -> Result<SceneDetails> {
        SceneDetails details;
        if (scene == "attic") return details;
        details.receptacles.push_back({"top", {{0.55F, kTop, 0.6F}, {}}, {0.35F, 0.06F, 0.4F}});
        return details;
      }};
  inputs.packs.push_back(&attic.pack());
  EpisodeGeneratorOptions options = optionsFor(10, 1);
  options.target_to_goal.least = 0.1F;
  EXPECT_EQ(generated(inputs, options).episodes.scenes.size(), 2U);
  options.supports = SupportChoice::kReceptacles;
  const auto made = generated(inputs, options);
  EXPECT_EQ(made.episodes.scenes, (std::vector<std::string>{"room"}));
  ASSERT_EQ(made.left_out.size(), 1U);
  EXPECT_THAT(made.left_out[0].reason, testing::HasSubstr("no receptacles of the scene are known"));
}

TEST(GeneratedEpisodes, AreTheSameWithAnyThreadsAndAnyOrderOfPacks) {
  const MadeWorld world(twoTables(), stickRobot());
  const MemoryPack attic = scenePackOf(twoTables(), "attic");
  const MemoryPack balls = cubePack("ball");
  EpisodeInputs inputs{world.packs(), [](std::string_view) -> Result<SceneDetails> {
                         return SceneDetails{.mesh = twoTables(), .receptacles = {}};
                       }};
  inputs.packs.push_back(&attic.pack());
  inputs.packs.push_back(&balls.pack());
  EpisodeGeneratorOptions options = optionsFor(130, 2);
  std::size_t told = 0;
  const auto first = MemoryPack::opened(
      bake::generateEpisodes(inputs, options, [&told](std::size_t done) { told = done; }));
  EXPECT_EQ(told, 130U);
  EXPECT_EQ(first.episodes.objects, (std::vector<std::string>{"ball", "cube"}));
  std::array<int, 2> uses{};
  for (const Placement& placement : first.episodes.placements) ++uses[placement.object];
  EXPECT_THAT(uses, testing::Each(testing::Gt(50)));
  const auto bytes = bytesOf(first.episodes);
  std::ranges::reverse(inputs.packs);
  for (const unsigned threads : {2U, 5U}) {
    inputs.threads = threads;
    const auto again = generated(inputs, options);
    EXPECT_TRUE(bytesOf(again.episodes) == bytes) << threads;
    for (std::size_t n = 0; n < bake::kRejectionCount; ++n) {
      const auto reason = static_cast<EpisodeRejection>(n);
      EXPECT_EQ(again.rejections[reason], first.rejections[reason]) << rejectionName(reason);
    }
  }
  options.seed = 2;
  EXPECT_FALSE(bytesOf(generated(inputs, options).episodes) == bytes);
}

TEST(GeneratedEpisodes, StayInThePartOfTheFloorInWhichTheyBegin) {
  MeshBuilder rooms = madeRoom(6, 3);
  rooms.box({2.95F, 0, 0}, {3.05F, 1.5F, 3});
  for (const float x : {0.2F, 5.1F}) {
    rooms.box({x, 0.6F, 0.2F}, {x + 0.7F, kTop, 1});
    rooms.box({x, 0.6F, 2}, {x + 0.7F, kTop, 2.7F});
  }
  const MadeWorld world(rooms.build(), stickRobot());
  const auto made = generated({.packs = world.packs(), .details = {}}, optionsFor(60, 2));
  ASSERT_EQ(made.scenes.size(), 1U);
  EXPECT_EQ(made.scenes.front().floor_parts, 2U);
  EXPECT_GT(made.rejections[EpisodeRejection::kOtherPart], 0U);
  const SourceEpisodes& set = made.episodes;
  std::array<int, 2> begun{};
  for (const Episode& episode : set.episodes) {
    const auto is_beyond = [](const Vec3& point) { return point.x > 3; };
    const Vec3& target = set.placements[episode.first_placement + episode.target].pose.translation;
    EXPECT_EQ(is_beyond(target), is_beyond(episode.base_position));
    EXPECT_EQ(is_beyond(episode.goal.translation), is_beyond(episode.base_position));
    ++begun[is_beyond(episode.base_position) ? 1 : 0];
  }
  EXPECT_GT(begun[0], 15);
  EXPECT_GT(begun[1], 15);
}

TEST(GeneratedEpisodes, HaveTheirGoalsOnTheOtherTableWhereAsked) {
  const MadeWorld world(twoTables(), stickRobot());
  const EpisodeInputs inputs{world.packs(), {}};
  EpisodeGeneratorOptions options = optionsFor(200, 2);
  options.target_to_goal.least = 0.1F;
  const auto crossing = [&] {
    const auto set = generated(inputs, options).episodes;
    return std::ranges::count_if(set.episodes, [&](const Episode& episode) {
      const Vec3 from = set.placements[episode.first_placement + episode.target].pose.translation;
      return (from.x < 1.5F) != (episode.goal.translation.x < 1.5F);
    });
  };
  const auto some = crossing();
  EXPECT_GT(some, 20);
  EXPECT_LT(some, 180);
  options.goal_on_other_support = true;
  EXPECT_EQ(crossing(), 200);
}

/// A cube of 8 cm that comes to rest in these poses.
MemoryPack bottlePack(const std::vector<StablePose>& poses) {
  ObjectPackFields fields;
  fields.radii = madeRadii();
  ObjectFields& bottle = fields.objects.emplace_back();
  constexpr float kHalf = 0.04F;
  bottle.name = "bottle";
  bottle.box_half_extents = Vec3{kHalf, kHalf, kHalf};
  bottle.spheres = {{{}, 1}};
  bottle.stable_poses = poses;
  return {buildPack(fields), "bottle"};
}

Quat aboutX(float angle) { return {std::sin(angle / 2), 0, 0, std::cos(angle / 2)}; }

/// How much the up axes of all objects and goals of 40 episodes lean, whole degrees.
std::set<long> leansOf(const std::vector<StablePose>& poses, bake::PoseChoice choice) {
  const MadeWorld world(twoTables(), stickRobot());
  const MemoryPack bottle = bottlePack(poses);
  auto packs = world.packs();
  packs[1] = &bottle.pack();
  EpisodeGeneratorOptions options = optionsFor(40, 2);
  options.poses = choice;
  const SourceEpisodes set = generated({packs, {}}, options).episodes;
  std::set<long> leans;
  const auto add = [&](const Quat& rotation) {
    const float up = std::clamp(rotate(rotation, {0, 1, 0}).y, -1.0F, 1.0F);
    leans.insert(std::lround(std::acos(up) * 180 / std::numbers::pi_v<float>));
  };
  for (const Placement& placement : set.placements) add(placement.pose.rotation);
  for (const Episode& episode : set.episodes) add(episode.goal.rotation);
  return leans;
}

TEST(GeneratedEpisodes, HaveUprightObjectsWhereAsked) {
  constexpr float kDegree = std::numbers::pi_v<float> / 180;
  constexpr float kHeight = 0.06F;
  const StablePose lying{aboutX(90 * kDegree), kHeight, 0.6F};
  const StablePose hanging{aboutX(180 * kDegree), kHeight, 0.2F};
  const StablePose leaning{aboutX(10 * kDegree), kHeight, 0.1F};
  const StablePose standing{{}, kHeight, 0.1F};
  const std::vector poses{lying, hanging, leaning, standing};
  EXPECT_THAT(leansOf(poses, bake::PoseChoice::kDropped), testing::ElementsAre(0, 10, 90, 180));
  EXPECT_THAT(leansOf(poses, bake::PoseChoice::kUpright), testing::ElementsAre(0, 10));
  // What cannot stand leans least.
  EXPECT_THAT(leansOf({lying, hanging}, bake::PoseChoice::kUpright), testing::ElementsAre(90));
}

TEST(Replay, TellsEpisodesThatStandFromThoseThatDoNot) {
  const MadeWorld world(twoTables(), stickRobot());
  SourceEpisodes set = generated({world.packs(), {}}, optionsFor(40, 2)).episodes;
  const auto packs = world.packs();
  EXPECT_THAT(MemoryPack::opened(bake::replayEpisodes(packs, set)),
              testing::Each(bake::ReplayEnd::kStands));
  // Every second robot in the wall, or where it is pushed out of an object.
  for (std::size_t n = 0; n < set.episodes.size(); n += 2) {
    Episode& episode = set.episodes[n];
    if (n % 4 == 0) {
      episode.base_position.x = -0.05F;
    } else {
      set.placements[episode.first_placement].pose.translation =
          episode.base_position + Vec3{0.13F, 0.1F, 0};
    }
  }
  const auto ends = MemoryPack::opened(bake::replayEpisodes(packs, set));
  for (std::size_t n = 0; n < ends.size(); ++n) {
    EXPECT_EQ(ends[n] == bake::ReplayEnd::kStands, n % 2 == 1) << n;
  }
  for (Episode& episode : set.episodes) episode.base_position.x = -0.05F;
  EXPECT_THAT(MemoryPack::opened(bake::replayEpisodes(packs, set)),
              testing::Each(bake::ReplayEnd::kBlocked));
}

}  // namespace
}  // namespace galactic::test::episode_choices_test
