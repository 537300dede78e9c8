// What can be wrong with a rearrangement dataset of Habitat, one by one.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ostream>
#include <string>

#include "galactic/bake/episode_set_import.h"
#include "support/habitat_text.h"
#include "support/scratch_folder.h"

namespace galactic::test::habitat_faults_test {
namespace {

struct Fault {
  const char* name;
  /// What of the good text is replaced, and by what.
  const char* from;
  const char* to;
  /// After "tidy.json: ".
  const char* where;
  const char* message;
};

std::ostream& operator<<(std::ostream& out, const Fault& fault) { return out << fault.name; }

constexpr const char* kNotRigid =
    "it is not a rigid transform: its columns must be perpendicular, right-handed and of length "
    "1, with the translation in the last one, and its last row 0, 0, 0, 1";
constexpr const char* kFirstMatrix =
    "[[1, 0, 0, 0.5], [0, 1, 0, 1], [0, 0, 1, -0.25], [0, 0, 0, 1]]";
constexpr const char* kFirst = "episodes[0].rigid_objs[0][1]";

const std::vector<Fault>& faults() {
  static const std::vector<Fault> all{
      {"EpisodesNoList", "\"episodes\": [", "\"episodes\": 3, \"old\": [", "episodes",
       "expected a list"},
      {"NoEpisode", "\"episodes\": [", "\"episodes\": [], \"old\": [", "episodes",
       "is empty, expected at least one episode"},
      {"EpisodeNoObject", "\"episodes\": [", "\"episodes\": [3, ", "episodes[0].scene_id",
       "it is missing"},
      {"NoScene", "\"scene_id\"", "\"scene\"", "episodes[0].scene_id", "it is missing"},
      {"SceneNotText", "\"scene_id\": \"v3_sc0_staging_00\"", "\"scene_id\": 3",
       "episodes[1].scene_id", "expected a string"},
      {"SceneEmpty", "\"scene_id\": \"v3_sc0_staging_00\"", "\"scene_id\": \"data/\"",
       "episodes[1].scene_id", "is empty, expected a scene's name or file"},
      {"NoStart", "\"start_position\"", "\"start\"", "episodes[0].start_position", "it is missing"},
      {"StartOfTwo", "[1.5, 0.125, -2.5]", "[1.5, 0.125]", "episodes[0].start_position",
       "it has 2 numbers, expected 3"},
      {"StartFar", "[1.5, 0.125, -2.5]", "[1.5, 1e5, -2.5]", "episodes[0].start_position[1]",
       "found 100000, expected -10000 to 10000"},
      {"NoHeading", "\"start_rotation\"", "\"start_turn\"", "episodes[0].start_rotation",
       "it is missing"},
      {"HeadingOfNothing", "[0, 0.7071068, 0, 0.7071068]", "[0, 0, 0, 0]",
       "episodes[0].start_rotation",
       "has the length 0, expected a rotation x, y, z, w of length 1"},
      {"HeadingUp", "[0, 0.7071068, 0, 0.7071068]", "[0, 0, 0.7071068, 0.7071068]",
       "episodes[0].start_rotation", "points the robot up or down, expected a heading"},
      {"FurnitureNoObject", "\"ao_states\": {}", "\"ao_states\": []", "episodes[1].ao_states",
       "expected an object"},
      {"FurnitureLinksNoObject", "{\"7\": 0.45, \"6\": 0}", "[0.45]",
       "episodes[0].ao_states.kitchen_counter_:0000", "expected an object"},
      {"FurnitureStateNoNumber", "{\"7\": 0.45, \"6\": 0}", "{\"7\": \"open\"}",
       "episodes[0].ao_states.kitchen_counter_:0000.7", "expected a number"},
      {"NoObjects", "\"rigid_objs\"", "\"objects\"", "episodes[0].rigid_objs", "it is missing"},
      {"ObjectsEmpty", "\"rigid_objs\": [", "\"rigid_objs\": [], \"old\": [",
       "episodes[0].rigid_objs", "is empty, expected at least one object"},
      {"ObjectNoPair", "\"rigid_objs\": [", "\"rigid_objs\": [[\"mug\"], ",
       "episodes[0].rigid_objs[0]",
       "it has 1 elements, expected an object's template and its transform"},
      {"ObjectNotText", "\"003_cracker_box.object_config.json\"", "3",
       "episodes[0].rigid_objs[0][0]", "expected a string"},
      {"ObjectWithoutName", "\"003_cracker_box.object_config.json\"", "\"\"",
       "episodes[0].rigid_objs[0][0]", "is empty, expected an object's template"},
      {"MatrixNoList", kFirstMatrix, "7", kFirst, "expected a list"},
      {"MatrixOfThreeRows", kFirstMatrix, "[[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]", kFirst,
       "it has 3 rows, expected 4 rows of 4 numbers"},
      {"MatrixOfShortRows", kFirstMatrix, "[[1, 0, 0], [0, 1, 0], [0, 0, 1], [0, 0, 0]]",
       "episodes[0].rigid_objs[0][1][0]", "it has 3 numbers, expected 4"},
      {"MatrixNoNumber", "[0, 1, 0, 1], [0, 0, 1, -0.25]", "[0, 1, 0, 1], [0, 0, null, 0]",
       "episodes[0].rigid_objs[0][1][2][2]", "expected a number"},
      {"MatrixScaled", kFirstMatrix,
       "[[2, 0, 0, 0.5], [0, 2, 0, 1], [0, 0, 2, -0.25], [0, 0, 0, 1]]", kFirst, kNotRigid},
      {"MatrixMirrored", kFirstMatrix,
       "[[-1, 0, 0, 0.5], [0, 1, 0, 1], [0, 0, 1, -0.25], [0, 0, 0, 1]]", kFirst, kNotRigid},
      {"MatrixSheared", kFirstMatrix,
       "[[1, 0.6, 0, 0.5], [0, 0.8, 0, 1], [0, 0, 1, -0.25], [0, 0, 0, 1]]", kFirst, kNotRigid},
      {"MatrixByColumns", kFirstMatrix,
       "[[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0.5, 1, -0.25, 1]]", kFirst, kNotRigid},
      {"NoTargets", "\"targets\"", "\"goals\"", "episodes[0].targets", "it is missing"},
      {"TargetsNoObject", "\"targets\": {\"mug_:0000\"", "\"targets\": 1, \"o\": {\"mug_:0000\"",
       "episodes[1].targets", "expected an object"},
      {"TargetsEmpty", "\"targets\": {\"mug_:0000\"", "\"targets\": {}, \"o\": {\"mug_:0000\"",
       "episodes[1].targets", "is empty, expected at least one target"},
      {"TargetNoHandle", "\"003_cracker_box_:0000\"", "\"003_cracker_box\"",
       "episodes[0].targets.003_cracker_box",
       "is not an instance's handle, expected a template's name and its number, for example "
       "mug_:0000"},
      {"TargetNumberNoNumber", "\"003_cracker_box_:0000\"", "\"003_cracker_box_:first\"",
       "episodes[0].targets.003_cracker_box_:first",
       "is not an instance's handle, expected a template's name and its number, for example "
       "mug_:0000"},
      {"TargetNotThere", "\"003_cracker_box_:0000\"", "\"003_cracker_box_:0001\"",
       "episodes[0].targets.003_cracker_box_:0001",
       "is number 1 of the objects '003_cracker_box' from 0 on, rigid_objs has 1 of them"},
      {"TargetOfOtherName", "\"003_cracker_box_:0000\"", "\"bowl_:0000\"",
       "episodes[0].targets.bowl_:0000",
       "is number 0 of the objects 'bowl' from 0 on, rigid_objs has 0 of them"},
      {"TwoGoals", "\"003_cracker_box_:0000\"", "\"mug_:1\"", "episodes[0].targets.mug_:1",
       "is the second goal of one object, expected one for each"},
      {"GoalNoMatrix", "\"mug_:0000\": [[1, 0, 0, 2]", "\"mug_:0000\": [[1, 1, 0, 2]",
       "episodes[1].targets.mug_:0000", kNotRigid},
  };
  return all;
}

class HabitatFaults : public testing::TestWithParam<Fault> {};

TEST_P(HabitatFaults, AreRefusedWithTheirPlace) {
  const Fault& fault = GetParam();
  std::string text = kSmallHabitatSet;
  const std::size_t at = text.find(fault.from);
  ASSERT_NE(at, std::string::npos);
  text.replace(at, std::string_view(fault.from).size(), fault.to);
  const ScratchFolder folder;
  const auto file = folder.write("tidy.json", text);
  const auto set = bake::readEpisodeFile(file);
  ASSERT_FALSE(set.has_value());
  EXPECT_EQ(set.error().code, ErrorCode::kInvalidInput);
  EXPECT_EQ(set.error().where, file.string() + ": " + fault.where);
  EXPECT_EQ(set.error().message, fault.message);
}

INSTANTIATE_TEST_SUITE_P(All, HabitatFaults, testing::ValuesIn(faults()),
                         [](const auto& fault) { return std::string(fault.param.name); });

TEST(HabitatFaults, SayWhatADatasetOfNavigationIs) {
  const ScratchFolder folder;
  const auto set = bake::readEpisodeFile(folder.write("nav.json", R"({"episodes": [
    {"episode_id": "0", "scene_id": "mp3d/a/a.glb", "start_position": [0, 0.1, 0],
     "start_rotation": [0, 0, 0, 1], "info": {"geodesic_distance": 3},
     "goals": [{"position": [1, 0.1, 1], "radius": null}], "shortest_paths": null}]})"));
  ASSERT_FALSE(set.has_value());
  EXPECT_THAT(set.error().where, testing::EndsWith("nav.json: episodes[0]"));
  EXPECT_EQ(set.error().message,
            "has goals and no rigid_objs, as Habitat's navigation (PointNav) has; only "
            "rearrangement datasets are imported: to navigate, run the task of "
            "examples/python/point_nav.py in a world of generated episodes");
}

TEST(HabitatFaults, KeepNothingOfAFileThatIsNeither) {
  const ScratchFolder folder;
  for (const char* text : {"[]", "{}", "3", "{\"episodeSet\": {}, \"episodes\": []}"}) {
    SCOPED_TRACE(text);
    EXPECT_FALSE(bake::readEpisodeFile(folder.write("x.json", text)).has_value());
  }
}

}  // namespace
}  // namespace galactic::test::habitat_faults_test
