// What can be wrong with the files of a dataset, one by one.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ostream>
#include <string>
#include <vector>

#include "bake/dataset/small_dataset.h"
#include "dataset/scene_dataset.h"
#include "support/try.h"

namespace galactic::test::dataset_faults_test {
namespace {

struct Fault {
  const char* name;
  /// The file that is broken, relative to the dataset's folder, and its content.
  const char* file;
  const char* content;
  /// After the file.
  const char* where;
  const char* message;
};

std::ostream& operator<<(std::ostream& out, const Fault& fault) { return out << fault.name; }

constexpr const char* kConfig = "home.scene_dataset_config.json";
constexpr const char* kScene = "scenes/a_home.scene_instance.json";
constexpr const char* kTable = "configs/objects/big/table.object_config.json";
constexpr const char* kStage = "configs/stages/room.stage_config.json";
constexpr const char* kFurniture = "urdf/cupboard/cupboard.ao_config.json";

const std::vector<Fault>& datasetFaults() {
  static const std::vector<Fault> all{
      {"List", kConfig, "[]", "the file", "expected an object"},
      {"StagesNoObject", kConfig, R"({"stages": 3})", "stages", "expected an object"},
      {"DefaultsNoObject", kConfig, R"({"objects": {"default_attributes": []}})",
       "objects.default_attributes", "expected an object"},
      {"PathsNoObject", kConfig, R"({"objects": {"paths": ["configs"]}})", "objects.paths",
       "expected an object"},
      {"PathsNoList", kConfig, R"({"objects": {"paths": {".json": "configs"}}})",
       "objects.paths['.json']", "expected a list"},
      {"PathNoText", kConfig, R"({"objects": {"paths": {".json": ["configs", 7]}}})",
       "objects.paths['.json'][1]", "expected a string"},
      {"NoEnding", kConfig, R"({"objects": {"paths": {"": ["configs"]}}})", "objects.paths['']",
       "expected a file extension, for example '.json'"},
      {"ConfigsNoList", kConfig, R"({"scene_instances": {"configs": {}}})",
       "scene_instances.configs", "expected a list"},
      {"ConfigNoObject", kConfig, R"({"scene_instances": {"configs": [1]}})",
       "scene_instances.configs[0]", "expected an object"},
      {"ConfigWithoutAttributes", kConfig,
       R"({"objects": {"configs": [{"template_handle": "a"}]}})", "objects.configs[0].attributes",
       "it is missing"},
      {"ConfigWithoutName", kConfig, R"({"objects": {"configs": [{"attributes": {}}]}})",
       "objects.configs[0]", "it has neither 'original_file' nor 'template_handle'; give one"},
      {"HandleNoText", kConfig,
       R"({"objects": {"configs": [{"template_handle": 1, "attributes": {}}]}})",
       "objects.configs[0].template_handle", "expected a string"},
  };
  return all;
}

const std::vector<Fault>& instanceFaults() {
  static const std::vector<Fault> all{
      {"SceneList", kScene, "[]", "the file", "expected an object"},
      {"NoStage", kScene, "{}", "stage_instance",
       "it is missing; a scene without one says \"template_name\": \"NONE\""},
      {"StageNoObject", kScene, R"({"stage_instance": "room"})", "stage_instance",
       "expected an object"},
      {"StageWithoutName", kScene, R"({"stage_instance": {}})", "stage_instance.template_name",
       "it is missing"},
      {"ObjectsNoList", kScene,
       R"({"stage_instance": {"template_name": "NONE"}, "object_instances": {}})",
       "object_instances", "expected a list"},
      {"NameNoText", kScene,
       R"({"stage_instance": {"template_name": "NONE"}, "object_instances": [{"template_name": 1}]})",
       "object_instances[0].template_name", "expected a string"},
      {"EmptyName", kScene, R"({"stage_instance": {"template_name": ""}})",
       "stage_instance.template_name", "is empty, expected a template's name"},
      {"TwoNumbers", kScene,
       R"({"stage_instance": {"template_name": "room", "translation": [1, 2]}})",
       "stage_instance.translation", "it has 2 numbers, expected 3"},
      {"TooFar", kScene,
       R"({"stage_instance": {"template_name": "room", "translation": [0, 1e9, 0]}})",
       "stage_instance.translation[1]", "found 1000000000, expected -1000000 to 1000000"},
      {"NoNumber", kScene,
       R"({"stage_instance": {"template_name": "room", "rotation": [1, 0, "0", 0]}})",
       "stage_instance.rotation[2]", "expected a number"},
      {"ZeroRotation", kScene,
       R"({"stage_instance": {"template_name": "room", "rotation": [0, 0, 0, 0]}})",
       "stage_instance.rotation",
       "it is a quaternion (w, x, y, z) of length 0, which turns to nowhere; [1, 0, 0, 0] leaves "
       "it unrotated"},
      {"ZeroUniformScale", kScene,
       R"({"stage_instance": {"template_name": "room", "uniform_scale": 0}})",
       "stage_instance.uniform_scale", "a scale of 0 flattens it"},
      {"ZeroScale", kScene,
       R"({"stage_instance": {"template_name": "room", "non_uniform_scale": [1, 0, 1]}})",
       "stage_instance.non_uniform_scale", "a scale of 0 flattens it"},
      {"ScaleNoNumber", kScene,
       R"({"stage_instance": {"template_name": "room", "uniform_scale": [2]}})",
       "stage_instance.uniform_scale", "expected a number"},
      {"UnknownOrigin", kScene,
       R"({"stage_instance": {"template_name": "room"}, "translation_origin": "center"})",
       "translation_origin", "'center' is unknown; known are 'COM', 'asset_local' and 'unknown'"},
      {"OriginNoText", kScene,
       R"({"stage_instance": {"template_name": "room"}, "translation_origin": 0})",
       "translation_origin", "expected a string"},
      {"UnknownMotion", kScene,
       R"({"stage_instance": {"template_name": "room", "motion_type": "FROZEN"}})",
       "stage_instance.motion_type",
       "'FROZEN' is unknown; known are 'STATIC', 'KINEMATIC' and 'DYNAMIC'"},
      {"JointNoNumber", kScene,
       R"({"stage_instance": {"template_name": "room"}, "articulated_object_instances":
           [{"template_name": "cupboard", "initial_joint_pose": {"hinge": "open"}}]})",
       "articulated_object_instances[0].initial_joint_pose.hinge", "expected a number"},
      {"JointsNoList", kScene,
       R"({"stage_instance": {"template_name": "room"}, "articulated_object_instances":
           [{"template_name": "cupboard", "initial_joint_pose": 3}]})",
       "articulated_object_instances[0].initial_joint_pose", "expected a list"},
  };
  return all;
}

const std::vector<Fault>& attributeFaults() {
  static const std::vector<Fault> all{
      {"ObjectList", kTable, "[]", "the file", "expected an object"},
      {"AssetNoText", kTable, R"({"render_asset": ["a.glb"]})", "render_asset",
       "expected a string"},
      {"NoAsset", kTable, "{}", "render_asset", "it is missing; name the mesh to place"},
      {"ScaleOfOneNumber", kTable, R"({"render_asset": "a.glb", "scale": 2})", "scale",
       "expected a list"},
      {"FlatScale", kTable, R"({"render_asset": "a.glb", "scale": [1, 1, 0]})", "scale",
       "a scale of 0 flattens it"},
      {"CenterNoList", kTable, R"({"render_asset": "a.glb", "COM": {}})", "COM", "expected a list"},
      {"CollidableNoFlag", kTable, R"({"render_asset": "a.glb", "is_collidable": "yes"})",
       "is_collidable", "expected true or false"},
      {"ShadingNoFlag", kTable, R"({"render_asset": "a.glb", "force_flat_shading": 1})",
       "force_flat_shading", "expected true or false"},
      {"SemanticNoNumber", kTable, R"({"render_asset": "a.glb", "semantic_id": "sofa"})",
       "semantic_id", "expected a number"},
      {"UpAlone", kStage, R"({"render_asset": "../../meshes/room.obj", "up": [0, 0, 1]})", "",
       "up (0, 0, 1) and front (0, 0, -1) must be at right angles; give both"},
      {"NoUp", kStage, R"({"render_asset": "../../meshes/room.obj", "up": [0, 0, 0]})", "",
       "up (0, 0, 0) and front (0, 0, -1) must be at right angles; give both"},
      {"UrdfNoText", kFurniture, R"({"urdf_filepath": 1})", "urdf_filepath", "expected a string"},
      {"FurnitureScale", kFurniture, R"({"uniform_scale": 0})", "uniform_scale",
       "a scale of 0 flattens it"},
  };
  return all;
}

std::string nameOf(const testing::TestParamInfo<Fault>& fault) { return fault.param.name; }

class DatasetFaults : public testing::TestWithParam<Fault> {
 protected:
  SmallDataset small_;
  void breakIt() { small_.write(GetParam().file, GetParam().content); }
  void expectError(const Error& error) const {
    const Fault& fault = GetParam();
    const std::string file = (small_.folder() / fault.file).string();
    EXPECT_EQ(error.where, *fault.where == '\0' ? file : fmt::format("{}: {}", file, fault.where));
    EXPECT_EQ(error.message, fault.message);
    EXPECT_EQ(error.code, ErrorCode::kInvalidInput);
  }
};

class SceneFaults : public DatasetFaults {};

TEST_P(DatasetFaults, AreNamedWithFileAndField) {
  breakIt();
  const auto dataset = bake::SceneDataset::read(small_.config());
  ASSERT_FALSE(dataset);
  expectError(dataset.error());
}

TEST_P(SceneFaults, AreNamedWithFileAndField) {
  breakIt();
  const auto dataset = bake::SceneDataset::read(small_.config());
  ASSERT_TRUE(dataset) << dataset.error().message;
  // What a list of jobs is made from finds them before a bake does.
  const auto survey = dataset->survey("a_home");
  ASSERT_FALSE(survey);
  expectError(survey.error());
  bake::MeshLibrary meshes(bake::datasetMeshOptions());
  const auto scene = dataset->compose("a_home", meshes);
  ASSERT_FALSE(scene);
  expectError(scene.error());
}

INSTANTIATE_TEST_SUITE_P(All, DatasetFaults, testing::ValuesIn(datasetFaults()), nameOf);
INSTANTIATE_TEST_SUITE_P(Instances, SceneFaults, testing::ValuesIn(instanceFaults()), nameOf);
INSTANTIATE_TEST_SUITE_P(Attributes, SceneFaults, testing::ValuesIn(attributeFaults()), nameOf);

TEST(DatasetsThatNameFilesElsewhere, NeedLeaveToReadThem) {
  const SmallDataset small;
  const ScratchFolder elsewhere;
  const std::string mesh = elsewhere.write("secret.obj", objFile(unevenBox())).string();
  const auto name = [&](const std::string& file) {
    small.write("configs/stages/room.stage_config.json",
                R"({"render_asset": ")" + file + R"(", "up": [0, 1, 0], "front": [0, 0, -1]})");
  };
  const auto composed = [&](bool allow_outside) -> Result<bake::ComposedScene> {
    ASSIGN_OR_RETURN(const auto dataset,
                     bake::SceneDataset::read(small.config(), {.allow_outside = allow_outside}));
    const auto survey = dataset.survey("a_home");
    bake::MeshLibrary meshes(bake::datasetMeshOptions());
    auto scene = dataset.compose("a_home", meshes);
    EXPECT_EQ(survey.has_value(), scene.has_value());
    return scene;
  };
  for (const std::string& file :
       {mesh, "../../../../" + elsewhere.path().filename().string() + "/secret.obj"}) {
    name(file);
    const auto refused = composed(false);
    ASSERT_FALSE(refused.has_value()) << file;
    EXPECT_EQ(refused.error().code, ErrorCode::kInvalidInput);
    EXPECT_THAT(refused.error().where, testing::EndsWith("room.stage_config.json"));
    EXPECT_THAT(refused.error().message,
                testing::HasSubstr("lies outside of the folder above the dataset's; put it there, "
                                   "or bake with `allow-outside`"));
    EXPECT_TRUE(composed(true).has_value()) << file;
  }
  // Datasets share their objects with the ones beside them.
  (void)small.scratch().write("beside/room.obj", objFile(unevenBox()));
  name("../../../beside/room.obj");
  EXPECT_TRUE(composed(false).has_value());
}

TEST(DatasetsThatNameFilesElsewhere, NeedLeaveToLookForThem) {
  const SmallDataset small;
  const ScratchFolder elsewhere;
  (void)elsewhere.write("secret.stage_config.json", R"({"render_asset": "x.obj"})");
  const std::string config = R"({"stages": {"paths": {".json": [")" + elsewhere.path().string() +
                             R"(/*", "configs/stages"]}}})";
  const auto path = small.write("far.scene_dataset_config.json", config);
  const auto refused = bake::SceneDataset::read(path);
  ASSERT_FALSE(refused.has_value());
  EXPECT_THAT(refused.error().where, testing::HasSubstr("stages.paths['.json'][0]"));
  EXPECT_THAT(refused.error().message, testing::HasSubstr("lies outside of the folder above"));
  const auto allowed = bake::SceneDataset::read(path, {.allow_outside = true});
  ASSERT_TRUE(allowed.has_value()) << allowed.error().message;
  EXPECT_EQ(allowed->scenes().size(), 2U);
}

TEST(FaultyDataset, OfTheWholeAreNamed) {
  const SmallDataset small;
  bake::MeshLibrary meshes(bake::datasetMeshOptions());
  const auto absent = bake::SceneDataset::read(small.folder() / "no.scene_dataset_config.json");
  ASSERT_FALSE(absent);
  EXPECT_EQ(absent.error().code, ErrorCode::kIo);
  const auto dataset = bake::SceneDataset::read(small.config());
  ASSERT_TRUE(dataset);
  const auto unknown = dataset->compose("a_hose", meshes);
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().message, "it has no scene 'a_hose'; did you mean 'a_home'?");
  const auto nothing = bake::SceneDataset::read(
      small.write("empty.scene_dataset_config.json", R"({"objects": {}})"));
  ASSERT_FALSE(nothing);
  EXPECT_EQ(nothing.error().message,
            "it has neither scene instances nor stages; are the files that its 'paths' name "
            "there?");
  small.write("scenes/a_home.scene_instance.json", "{\"stage_instance\": ");
  const auto truncated = dataset->compose("a_home", meshes);
  ASSERT_FALSE(truncated);
  EXPECT_THAT(truncated.error().message, testing::StartsWith("it is not JSON: "));
}

TEST(FaultyDataset, OfMeshesAndUrdfsAreThoseOfTheImporters) {
  const SmallDataset small;
  bake::MeshLibrary meshes(bake::datasetMeshOptions());
  const auto dataset = bake::SceneDataset::read(small.config());
  ASSERT_TRUE(dataset);
  small.write("urdf/cupboard/cupboard.urdf", "<robot name=");
  const auto urdf = dataset->compose("a_home", meshes);
  ASSERT_FALSE(urdf);
  EXPECT_THAT(urdf.error().where, testing::HasSubstr("cupboard.urdf"));
  small.write("bare/crate.glb", "no mesh");
  bake::MeshLibrary others(bake::datasetMeshOptions());
  const auto mesh = dataset->compose("a_home", others);
  ASSERT_FALSE(mesh);
  EXPECT_THAT(mesh.error().where, testing::HasSubstr("crate.glb"));
}

}  // namespace
}  // namespace galactic::test::dataset_faults_test
