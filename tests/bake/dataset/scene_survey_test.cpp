// What a scene names, found out without its meshes, is what is found when it is put together.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bake/dataset/small_dataset.h"
#include "galactic/bake/job_lists.h"
#include "robot_description/named_files.h"

namespace galactic::test::scene_survey_test {
namespace {

namespace fs = std::filesystem;
using bake::ComposedScene;
using bake::MeshLibrary;
using bake::SceneDataset;
using bake::SceneSurvey;
using testing::ElementsAre;

SceneDataset readDataset(const SmallDataset& small) {
  auto dataset = SceneDataset::read(small.config());
  EXPECT_TRUE(dataset) << dataset.error().text();
  return std::move(*dataset);
}

/// Both ways to look at a scene.
struct BothWays {
  SceneSurvey survey;
  ComposedScene composed;
};

BothWays lookAt(const SceneDataset& dataset, const std::string& name) {
  MeshLibrary meshes(bake::datasetMeshOptions());
  auto survey = dataset.survey(name);
  auto composed = dataset.compose(name, meshes);
  EXPECT_TRUE(survey) << name;
  EXPECT_TRUE(composed) << name;
  if (!survey || !composed) return {};
  return {std::move(*survey), std::move(*composed)};
}

TEST(SceneSurvey, FindsWhatCompositionFinds) {
  const SmallDataset small;
  const BothWays found = lookAt(readDataset(small), "a_home");
  EXPECT_EQ(found.survey.has_stage, found.composed.has_stage);
  // A URDF's meshes are not looked at, and how often something lacks is not counted.
  EXPECT_THAT(found.survey.missing,
              ElementsAre("object 'ghost': its mesh 'meshes/ghost.glb' is missing",
                          "object 'lamp' is in none of the dataset's paths"));
}

TEST(SceneSurvey, ListsWhatMovesAndInWhichFrame) {
  const auto survey = readDataset(SmallDataset()).survey("a_home");
  ASSERT_TRUE(survey);
  ASSERT_EQ(survey->movable.size(), 2U);
  const auto& [cup, shelf] = std::tie(survey->movable[0], survey->movable[1]);
  EXPECT_EQ(cup.name, "cup");
  EXPECT_EQ(cup.mesh.filename(), "box.obj");
  EXPECT_TRUE(cup.mesh.is_absolute());
  EXPECT_EQ(cup.object_from_mesh, (bake::Affine{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}));
  EXPECT_EQ(shelf.name, "shelf") << "Habitat takes what states no motion for dynamic";
  // Z up: (x, y, z) becomes (x, z, -y), then the scale.
  EXPECT_EQ(shelf.object_from_mesh, (bake::Affine{0.5, 0, 0, 0, 0, 0, 2, 0, 0, -1.5, 0, 0}));
}

TEST(SceneSurvey, CountsNoMeshOfWhatMoves) {
  const SmallDataset small;
  small.writeScene("one", R"({"stage_instance": {"template_name": "room"}, "object_instances": [
      {"template_name": "cup", "motion_type": "DYNAMIC"}, {"template_name": "ghost"}]})");
  const auto survey = readDataset(small).survey("one");
  ASSERT_TRUE(survey);
  const fs::path room = small.folder() / "meshes/room.obj";
  EXPECT_EQ(survey->bytes, fs::file_size(room));
  ASSERT_EQ(survey->meshes.size(), 1U);
  EXPECT_TRUE(fs::equivalent(survey->meshes[0], room));
  EXPECT_THAT(survey->missing,
              ElementsAre("object 'ghost': its mesh 'meshes/ghost.glb' is missing"));
}

TEST(SceneSurvey, CountsTheBytesOfEachMeshOnce) {
  const SmallDataset small;
  small.writeScene("twice", R"({"stage_instance": {"template_name": "room"}, "object_instances": [
      {"template_name": "table", "motion_type": "STATIC"},
      {"template_name": "made_here", "motion_type": "STATIC"},
      {"template_name": "crate", "motion_type": "STATIC"}]})");
  const auto survey = readDataset(small).survey("twice");
  ASSERT_TRUE(survey);
  EXPECT_EQ(survey->bytes, fs::file_size(small.folder() / "meshes/room.obj") +
                               fs::file_size(small.folder() / "meshes/box.obj") +
                               fs::file_size(small.folder() / "bare/crate.glb"));
}

TEST(SceneSurvey, CountsTheBytesOfWhatMeshesAndUrdfsName) {
  const SmallDataset small;
  small.write("meshes/hall.gltf", R"({"buffers": [{"uri": "hall%201.bin"}, {"uri": "data:,x"},
      {"uri": "lost.bin"}, {"byteLength": 9}, 7], "images": [{"uri": "wall.png"}]})");
  small.write("meshes/hall 1.bin", std::string(5000, 'b'));
  small.write("meshes/wall.png", std::string(300, 'p'));
  small.write("configs/stages/hall.stage_config.json",
              R"({"render_asset": "../../meshes/hall.gltf"})");
  small.writeScene("named", R"({"stage_instance": {"template_name": "hall"},
      "articulated_object_instances": [{"template_name": "cupboard"},
                                       {"template_name": "cupboard"}]})");
  const auto survey = readDataset(small).survey("named");
  ASSERT_TRUE(survey);
  EXPECT_EQ(survey->bytes, fs::file_size(small.folder() / "meshes/hall.gltf") + 5300 +
                               fs::file_size(small.folder() / "urdf/cupboard/cupboard.urdf") +
                               fs::file_size(small.folder() / "urdf/cupboard/door.obj"));
}

TEST(SceneSurvey, CountsWhatItCannotUnderstandByItsOwnSize) {
  const SmallDataset small;
  for (const char* broken : {"", "no json", "[1]", R"({"buffers": 3, "images": {"uri": "a"}})",
                             R"({"buffers": [{"uri": 3}, null, {"uri": "."}]})"}) {
    SCOPED_TRACE(broken);
    const fs::path gltf = small.write("broken.gltf", broken);
    EXPECT_EQ(bake::bytesWithNamedFiles(gltf, {}), std::string(broken).size());
  }
  for (const char* broken : {"filename", "filename=", "filename=\"m.stl", "filename='m.stl\"",
                             "filename x=\"m.stl\"", "filename=\"\" filename=\"/\""}) {
    SCOPED_TRACE(broken);
    small.write("m.stl", "mesh");
    const fs::path urdf = small.write("broken.urdf", broken);
    EXPECT_EQ(bake::bytesWithNamedFiles(urdf, {}), std::string(broken).size());
  }
  EXPECT_EQ(bake::bytesWithNamedFiles(small.folder() / "absent.gltf", {}), 0U);
}

TEST(ExpectedBytes, OfARobotAreThoseOfItsMeshesToo) {
  const SmallDataset small;
  const std::string mesh(7000, 'm');
  small.write("arm_description/m.stl", mesh);
  small.write("arm_description/n.stl", mesh);
  const std::string text = "<mesh filename=\"package://arm/m.stl\"/><mesh filename = 'n.stl'/>";
  const fs::path urdf = small.write("robots/r.urdf", text);
  small.write("robots/n.stl", mesh);
  small.write("world.toml",
              "[[scenes]]\nfiles = 'meshes/room.obj'\n[robot]\nfiles = 'robots/r.urdf'\n"
              "package = { arm = 'arm_description' }\n");
  bake::BakeLibraries libraries;
  const auto list = bake::jobsOfRecipe({.recipe = small.folder() / "world.toml"},
                                       small.folder() / "world.pack", libraries);
  ASSERT_TRUE(list) << list.error().text();
  ASSERT_EQ(list->assets.size(), 2U);
  EXPECT_EQ(list->assets[0].name, "robot.pack");
  EXPECT_EQ(list->assets[0].source_bytes, text.size() + 2 * mesh.size());
  EXPECT_EQ(list->assets[1].source_bytes, fs::file_size(small.folder() / "meshes/room.obj"));
}

TEST(SceneSurvey, AgreesOnStagesThatLackAndScenesThatWantNone) {
  const SmallDataset small;
  small.writeScene("none", R"({"stage_instance": {"template_name": "NONE"}})");
  small.writeScene("unknown", R"({"stage_instance": {"template_name": "hall"}})");
  small.write("configs/stages/lost.stage_config.json", R"({"render_asset": "lost.glb"})");
  small.writeScene("lost", R"({"stage_instance": {"template_name": "lost"}})");
  const SceneDataset dataset = readDataset(small);
  std::size_t staged = 0;
  for (const std::string& name : dataset.scenes()) {
    SCOPED_TRACE(name);
    const BothWays found = lookAt(dataset, name);
    EXPECT_EQ(found.survey.has_stage, found.composed.has_stage);
    staged += found.survey.has_stage ? 1U : 0U;
  }
  EXPECT_EQ(dataset.scenes().size(), 4U);
  EXPECT_EQ(staged, 1U);
}

TEST(SceneSurvey, FailsAsCompositionDoes) {
  const SmallDataset small;
  small.writeScene("broken", R"({"stage_instance": 3})");
  small.write("configs/objects/small/bad.object_config.json", R"({"render_asset": 3})");
  small.writeScene("bad", R"({"stage_instance": {"template_name": "room"}, "object_instances": [
      {"template_name": "bad"}]})");
  const SceneDataset dataset = readDataset(small);
  MeshLibrary meshes(bake::datasetMeshOptions());
  for (const char* name : {"broken", "bad", "nowhere"}) {
    const auto survey = dataset.survey(name);
    const auto composed = dataset.compose(name, meshes);
    ASSERT_FALSE(survey.has_value()) << name;
    ASSERT_FALSE(composed.has_value()) << name;
    EXPECT_EQ(survey.error().where, composed.error().where);
    EXPECT_EQ(survey.error().message, composed.error().message);
  }
}

}  // namespace
}  // namespace galactic::test::scene_survey_test
