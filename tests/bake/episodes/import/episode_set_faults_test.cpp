// What can be wrong with an episode set, one by one.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ostream>

#include "episode_texts.h"

namespace galactic::test::episode_set_faults_test {
namespace {

using testing::HasSubstr;

struct Fault {
  const char* name;
  /// What of the good text is replaced, and by what.
  const char* from;
  const char* to;
  /// After "small.episode_set.json: ".
  const char* where;
  const char* message;
};

std::ostream& operator<<(std::ostream& out, const Fault& fault) { return out << fault.name; }

constexpr const char* kScenes = "\"staticScenes\": [";
constexpr const char* kFirstJoints = "[0.125, -0.5]";

const std::vector<Fault>& faults() {
  static const std::vector<Fault> all{
      {"NoSet", "\"episodeSet\"", "\"episodes\"", "episodeSet", "it is missing"},
      {"NoAssets", "\"renderAssets\"", "\"assets\"", "episodeSet.renderAssets", "it is missing"},
      {"AssetNameNotText", "{\"name\": \"mug\"}", "{\"name\": 3}",
       "episodeSet.renderAssets[1].name", "expected a string"},
      {"ObjectWithoutName", "{\"name\": \"mug\"}", "{\"name\": \"\"}",
       "episodeSet.freeObjects[0].renderAssetIndex", "leads to an asset without a name"},
      {"NoScenes", kScenes, "\"rooms\": [", "episodeSet.staticScenes", "it is missing"},
      {"ScenesNoList", kScenes, "\"staticScenes\": 1, \"old\": [", "episodeSet.staticScenes",
       "expected a list"},
      {"SceneWithoutName", "\"name\": \"b_room\"", "\"name\": \"\"",
       "episodeSet.staticScenes[0].name", "is empty, expected a scene's name"},
      {"TwoScenesOfOneName", "\"name\": \"a_room\"", "\"name\": \"b_room\"",
       "episodeSet.staticScenes[2].name",
       "'b_room' is the name of two scenes; give them names of their own"},
      {"AssetOutOfRange", "\"renderAssetIndex\": 3", "\"renderAssetIndex\": 4",
       "episodeSet.freeObjects[1].renderAssetIndex", "is 4, expected one of 4 render assets"},
      {"AssetNegative", "\"renderAssetIndex\": 3", "\"renderAssetIndex\": -1",
       "episodeSet.freeObjects[1].renderAssetIndex", "is -1, expected one of 4 render assets"},
      {"AssetNotWhole", "\"renderAssetIndex\": 3", "\"renderAssetIndex\": 2.5",
       "episodeSet.freeObjects[1].renderAssetIndex", "expected a whole number"},
      {"AssetHuge", "\"renderAssetIndex\": 3", "\"renderAssetIndex\": 18446744073709551615",
       "episodeSet.freeObjects[1].renderAssetIndex",
       "found 18446744073709551615, expected -2147483648 to 2147483647"},
      {"ObjectOutOfRange", "\"freeObjIndex\": 2", "\"freeObjIndex\": 3",
       "episodeSet.freeObjectSpawns[1].freeObjIndex", "is 3, expected one of 3 free objects"},
      {"NoRotation", "\"startRotation\"", "\"rotation\"",
       "episodeSet.freeObjectSpawns[0].startRotation", "it is missing"},
      {"RotationOfThree", "\"startRotation\": [1, 0, 0, 0]", "\"startRotation\": [1, 0, 0]",
       "episodeSet.freeObjectSpawns[0].startRotation", "it has 3 numbers, expected 4"},
      {"RotationTooLong", "\"startRotation\": [1, 0, 0, 0]", "\"startRotation\": [1.002, 0, 0, 0]",
       "episodeSet.freeObjectSpawns[0].startRotation",
       "has the length 1.002, expected a rotation w, x, y, z of length 1"},
      {"RotationOfNothing", "\"startRotation\": [1, 0, 0, 0]", "\"startRotation\": [0, 0, 0, 0]",
       "episodeSet.freeObjectSpawns[0].startRotation",
       "has the length 0, expected a rotation w, x, y, z of length 1"},
      {"PlaceOfTwo", "\"startPos\": [1, 2, 3]", "\"startPos\": [1, 2]",
       "episodeSet.freeObjectSpawns[0].startPos", "it has 2 numbers, expected 3"},
      {"PlaceNotANumber", "\"startPos\": [1, 2, 3]", "\"startPos\": [1, null, 3]",
       "episodeSet.freeObjectSpawns[0].startPos[1]", "expected a number"},
      {"PlaceTooFar", "\"startPos\": [1, 2, 3]", "\"startPos\": [1, 2, 3e5]",
       "episodeSet.freeObjectSpawns[0].startPos[2]", "found 300000, expected -10000 to 10000"},
      {"SceneOutOfRange", "\"staticSceneIndex\": 2", "\"staticSceneIndex\": 3",
       "episodeSet.episodes[1].staticSceneIndex", "is 3, expected one of 3 scenes"},
      {"FirstSpawnOutOfRange", "\"firstFreeObjectSpawnIndex\": 1",
       "\"firstFreeObjectSpawnIndex\": 4", "episodeSet.episodes[1].firstFreeObjectSpawnIndex",
       "is 4, expected one of 4 spawns"},
      {"NoSpawns", "\"numFreeObjectSpawns\": 2", "\"numFreeObjectSpawns\": 0",
       "episodeSet.episodes[0].numFreeObjectSpawns", "found 0, expected 1 to 2147483647"},
      {"TooManySpawns", "\"firstFreeObjectSpawnIndex\": 1, \"numFreeObjectSpawns\": 2",
       "\"firstFreeObjectSpawnIndex\": 1, \"numFreeObjectSpawns\": 4",
       "episodeSet.episodes[1].numFreeObjectSpawns",
       "is 4, but there are only 3 of the 4 spawns from the first one, 1, on"},
      {"TargetOutOfRange", "\"targetObjIndex\": 1", "\"targetObjIndex\": 2",
       "episodeSet.episodes[0].targetObjIndex", "is 2, expected one of 2 spawns of its episode"},
      {"TargetNegative", "\"targetObjIndex\": 1", "\"targetObjIndex\": -1",
       "episodeSet.episodes[0].targetObjIndex", "is -1, expected one of 2 spawns of its episode"},
      {"StartOfThree", "[0.5, -0.25]", "[0.5, 0, -0.25]", "episodeSet.episodes[0].agentStartPos",
       "it has 3 numbers, expected 2"},
      {"NoYaw", "\"agentStartYaw\"", "\"yaw\"", "episodeSet.episodes[0].agentStartYaw",
       "it is missing"},
      {"YawAsText", "\"agentStartYaw\": 1.5", "\"agentStartYaw\": \"1.5\"",
       "episodeSet.episodes[0].agentStartYaw", "expected a number"},
      {"TooManyJoints", kFirstJoints, "[0.125, -0.5, 0]",
       "episodeSet.episodes[0].robotStartJointPositions",
       "has 3 positions for 2 start joints; name the joint of each"},
      {"JointsNoList", kFirstJoints, "7", "episodeSet.episodes[0].robotStartJointPositions",
       "expected a list"},
      {"NoGoal", "\"targetObjGoalPos\"", "\"goal\"", "episodeSet.episodes[0].targetObjGoalPos",
       "it is missing"},
      {"GoalTooFar", "[-1, 1, -2]", "[-1, 1, -2e9]", "episodeSet.episodes[0].targetObjGoalPos[2]",
       "found -2000000000, expected -10000 to 10000"},
      {"GoalRotationTooShort", "\"targetObjGoalRotation\": [1, 0, 0, 0]",
       "\"targetObjGoalRotation\": [0.5, 0, 0, 0]", "episodeSet.episodes[1].targetObjGoalRotation",
       "has the length 0.5, expected a rotation w, x, y, z of length 1"},
  };
  return all;
}

class EpisodeSetFaults : public testing::TestWithParam<Fault> {};

TEST_P(EpisodeSetFaults, NameTheirElement) {
  const Fault& fault = GetParam();
  const auto set = importText(replaced(kSmallEpisodeSet, fault.from, fault.to));
  ASSERT_FALSE(set.has_value());
  EXPECT_EQ(set.error().code, ErrorCode::kInvalidInput);
  EXPECT_EQ(std::filesystem::path(set.error().where).filename(),
            fmt::format("small.episode_set.json: {}", fault.where));
  EXPECT_EQ(set.error().message, fault.message);
}

INSTANTIATE_TEST_SUITE_P(Texts, EpisodeSetFaults, testing::ValuesIn(faults()),
                         [](const auto& fault) { return fault.param.name; });

TEST(EpisodeSetFiles, ThatAreNoJsonSayWhere) {
  const std::string good = kSmallEpisodeSet;
  for (std::size_t length = 0; length < good.size() - 1; length += 7) {
    const auto set = importText(good.substr(0, length));
    ASSERT_FALSE(set.has_value()) << length;
    EXPECT_EQ(set.error().code, ErrorCode::kInvalidInput);
    EXPECT_THAT(set.error().message, HasSubstr("it is not JSON: "));
  }
  const auto huge = importText(replaced(good, "[1, 2, 3]", "[1, 2, 1e999]"));
  ASSERT_FALSE(huge.has_value());
  EXPECT_THAT(huge.error().message, HasSubstr("it is not JSON: "));
}

TEST(EpisodeSetFiles, ThatAreMissingOrFoldersAreIoErrors) {
  const ScratchFolder folder;
  const auto missing = bake::readEpisodeSet(folder.path() / "none.episode_set.json");
  ASSERT_FALSE(missing.has_value());
  EXPECT_EQ(missing.error().code, ErrorCode::kIo);
  const auto a_folder = bake::readEpisodeSet(folder.path());
  ASSERT_FALSE(a_folder.has_value());
  EXPECT_EQ(a_folder.error().code, ErrorCode::kIo);
  EXPECT_EQ(a_folder.error().message, "it is a folder; give the path of a .episode_set.json file");
}

TEST(EpisodeSetOptions, ThatDoNotFitTheFileAreErrors) {
  auto unknown = twoJoints();
  unknown.scene_names = {{"attic", "loft"}};
  auto set = importText(kSmallEpisodeSet, unknown);
  ASSERT_FALSE(set.has_value());
  EXPECT_EQ(set.error().message,
            "has no scene 'attic' to be named 'loft'; the first of 3 is 'b_room'");
  auto same = twoJoints();
  same.scene_names = {{"a_room", "b_room"}};
  set = importText(kSmallEpisodeSet, same);
  ASSERT_FALSE(set.has_value());
  EXPECT_THAT(set.error().message, HasSubstr("'b_room' is the name of two scenes"));
  set = importText(kSmallEpisodeSet, {});
  ASSERT_FALSE(set.has_value());
  EXPECT_EQ(set.error().message, "has 2 positions for 7 start joints; name the joint of each");
  const std::vector<std::pair<std::vector<std::uint32_t>, const char*>> lists{
      {{}, "none is to be kept; name at least one"},
      {{0, 2}, "has 2 episodes, number 2 is to be kept; they count from 0"},
      {{1, 0, 1}, "number 1 is to be kept twice; name each once"}};
  for (const auto& [indices, message] : lists) {
    auto only = twoJoints();
    only.only = indices;
    set = importText(kSmallEpisodeSet, only);
    ASSERT_FALSE(set.has_value());
    EXPECT_EQ(set.error().code, ErrorCode::kInvalidInput);
    EXPECT_EQ(set.error().message, message);
  }
}

}  // namespace
}  // namespace galactic::test::episode_set_faults_test
