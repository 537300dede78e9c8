// What a dataset offers, and what becomes of it in a scene.
#include "dataset/scene_dataset.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <thread>
#include <vector>

#include "bake/dataset/small_dataset.h"
#include "galactic/bake/triangle_mesh.h"
#include "render/render_source.h"
#include "support/assets.h"

namespace galactic::test::scene_dataset_test {
namespace {

using bake::ComposedScene;
using bake::MeshLibrary;
using bake::SceneDataset;
using bake::SourceAsset;
using bake::SourceInstance;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsSupersetOf;

using Points = std::vector<std::array<double, 3>>;

/// Files hold coordinates as floats and text of six digits.
constexpr double kTolerance = 1e-5;

/// The names of the scenes of a dataset with these handles.
std::vector<std::string> namesOfScenes(const std::vector<std::string>& handles) {
  std::string scenes;
  for (const std::string& handle : handles) {
    scenes += fmt::format(
        R"({}{{"template_handle": "{}.scene_instance.json", "attributes":
            {{"stage_instance": {{"template_name": "room"}}}}}})",
        scenes.empty() ? "" : ",", handle);
  }
  const ScratchFolder folder;
  const auto config = folder.write(
      "d.scene_dataset_config.json",
      fmt::format(R"({{"stages": {{"configs": [{{"template_handle": "room", "attributes": {{}}}}]}},
                       "scene_instances": {{"configs": [{}]}}}})",
                  scenes));
  const auto dataset = SceneDataset::read(config);
  EXPECT_TRUE(dataset) << dataset.error().message;
  return dataset ? dataset->scenes() : std::vector<std::string>{};
}

std::string textOf(const Error& error) { return error.text(); }

TEST(SceneNames, HaveAsManyFoldersAsTellThemApart) {
  EXPECT_THAT(namesOfScenes({"a/x", "b/y"}), ElementsAre("x", "y"));
  EXPECT_THAT(namesOfScenes({"a/x", "b/x", "b/y"}), ElementsAre("a_x", "b_x", "y"));
  EXPECT_THAT(namesOfScenes({"a/c/x", "b/c/x", "b/d/x"}), ElementsAre("a_c_x", "b_c_x", "d_x"));
  EXPECT_THAT(namesOfScenes({"1/2/3/4/5/6/7/8/x", "0/2/3/4/5/6/7/8/x"}),
              ElementsAre("0_2_3_4_5_6_7_8_x", "1_2_3_4_5_6_7_8_x"));
}

TEST(SceneNames, DifferAlsoWhereFoldersAndNamesAreJoinedAlike) {
  // What is called so keeps its name.
  EXPECT_THAT(namesOfScenes({"a/x", "b/x", "b/a_x"}), ElementsAre("a_x", "a_x_2", "b_x"));
  EXPECT_THAT(namesOfScenes({"a/b_x", "a_b/x", "c/b_x", "c/x"}),
              ElementsAre("a_b_x", "a_b_x_2", "c_b_x", "c_x"));
}

TEST(SceneNames, LeadOutOfNoFolder) {
  EXPECT_THAT(namesOfScenes({"../../../evil/x", "b/./x", "/home/me/x"}),
              ElementsAre("b_x", "evil_x", "me_x"));
  EXPECT_THAT(namesOfScenes({"../x", "../../x", "a/x"}), ElementsAre("a_x", "x", "x_2"));
}

ComposedScene composed(const SmallDataset& small, const std::string& name = "a_home") {
  const auto dataset = SceneDataset::read(small.config());
  EXPECT_TRUE(dataset) << textOf(dataset.error());
  MeshLibrary meshes(bake::datasetMeshOptions());
  auto scene = dataset->compose(name, meshes);
  EXPECT_TRUE(scene) << textOf(scene.error());
  return scene ? std::move(*scene) : ComposedScene{};
}

const SourceInstance& instanceNamed(const SourceAsset& scene, std::string_view name) {
  for (const SourceInstance& instance : scene.instances) {
    if (instance.name == name) return instance;
  }
  ADD_FAILURE() << "no instance " << name;
  return scene.instances.front();
}

/// The corners of unevenBox(), each changed by `change`.
template <class Change>
Points changedCorners(const Change& change) {
  Points corners = boxCorners();
  for (auto& corner : corners) corner = change(corner);
  return corners;
}

double errorOf(const SourceAsset& scene, std::string_view name, const Points& wanted) {
  return farthestCorner(placedVertices(scene, instanceNamed(scene, name)), wanted);
}

TEST(SceneDataset, KnowsItsScenesAndWarnsOfWhatItsPathsMiss) {
  const SmallDataset small;
  small.writeScene("b_home", SmallDataset::kScene);
  const auto dataset = SceneDataset::read(small.config());
  ASSERT_TRUE(dataset) << textOf(dataset.error());
  EXPECT_THAT(dataset->scenes(), ElementsAre("a_home", "b_home"));
  EXPECT_EQ(dataset->folder(), small.folder());
  EXPECT_THAT(
      dataset->warnings(),
      ElementsAre("objects.paths['.json'][1]: '../elsewhere/*.object_config.json' finds no "
                  ".object_config.json file",
                  "objects.configs[3].original_file: 'nowhere' is in none of the paths; it is "
                  "left out"));
}

TEST(SceneDataset, PlacesWhatDoesNotMove) {
  const ComposedScene scene = composed(SmallDataset());
  std::vector<std::string> names;
  for (const SourceInstance& instance : scene.scene.instances) names.push_back(instance.name);
  EXPECT_THAT(names,
              ElementsAre("room", "table_:0000", "table_:0001", "crate_:0000", "high_table_:0000",
                          "made_here_:0000", "cupboard_:0000", "cupboard_:0000"));
  EXPECT_TRUE(scene.has_stage);
  EXPECT_EQ(scene.scene.name, "a_home");
}

TEST(SceneDataset, ReadsNoMeshOfWhatMoves) {
  const SmallDataset small;
  small.write("meshes/cut.glb", "glTF");
  small.write("configs/objects/small/mug.object_config.json",
              R"({"render_asset": "../../../meshes/cut.glb"})");
  small.writeScene("one", R"({"stage_instance": {"template_name": "room"}, "object_instances": [
      {"template_name": "mug", "motion_type": "DYNAMIC"}, {"template_name": "mug"},
      {"template_name": "cup", "motion_type": "DYNAMIC"}]})");
  const ComposedScene scene = composed(small, "one");
  EXPECT_EQ(scene.scene.instances.size(), 1U);
  EXPECT_THAT(scene.scene.warnings, testing::IsEmpty());
  for (const bake::SourceFile& file : scene.scene.read.files) {
    EXPECT_THAT(file.name, testing::Not(testing::AnyOf("meshes/cut.glb", "meshes/box.obj")));
  }
}

TEST(SceneDataset, PlacesTheCenterOfMassOrTheOriginOfTheAsset) {
  const SmallDataset small;
  const ComposedScene scene = composed(small);
  // A quarter turn about Y takes (x, y, z) to (z, y, -x).
  EXPECT_LT(errorOf(scene.scene, "table_:0000", changedCorners([](const auto& p) {
                      return std::array{p[2] - 2 + 1, p[1] - 0.5, -(p[0] - 0.25) + 2};
                    })),
            kTolerance);
  EXPECT_LT(errorOf(scene.scene, "table_:0001", changedCorners([](const auto& p) {
                      return std::array{p[0] + 3, p[1], p[2] + 2};
                    })),
            kTolerance)
      << "the dataset's default is asset_local";
  small.writeScene("cup", R"({"stage_instance": {"template_name": "NONE"}, "object_instances": [
      {"template_name": "cup", "motion_type": "STATIC", "translation": [0, 1, 0],
       "translation_origin": "com"}]})");
  EXPECT_LT(errorOf(composed(small, "cup").scene, "cup_:0000", changedCorners([](const auto& p) {
                      return std::array{p[0] - 1, p[1], p[2] - 1};
                    })),
            kTolerance)
      << "the layer moves the cup's center of mass";
}

TEST(SceneDataset, AppliesScalesAndFrames) {
  const ComposedScene scene = composed(SmallDataset());
  EXPECT_LT(errorOf(scene.scene, "crate_:0000", changedCorners([](const auto& p) {
                      return std::array{0.5 * p[0], 0.5 * p[1], 0.5 * p[2]};
                    })),
            kTolerance);
  EXPECT_LT(errorOf(scene.scene, "high_table_:0000", changedCorners([](const auto& p) {
                      return std::array{p[0], 3 * p[1], p[2]};
                    })),
            kTolerance);
}

TEST(SceneDataset, LeavesTheStageWhereItIsAsHabitatDoes) {
  const SmallDataset small;
  small.writeScene("moved", R"({"stage_instance": {"template_name": "room",
      "translation": [1, 2, 3], "rotation": [0, 1, 0, 0], "translation_origin": "COM"}})");
  const ComposedScene scene = composed(small, "moved");
  EXPECT_LT(errorOf(scene.scene, "room", boxCorners()), kTolerance);
  EXPECT_THAT(scene.scene.warnings,
              ElementsAre("the scene moves, turns or scales its stage; as in Habitat, it stays as "
                          "it is"));
}

TEST(SceneDataset, TakesTheCenterOfTheBoxWhereTheLastLayerStatesNoCenterOfMass) {
  const SmallDataset small;
  // The layer of high_table states a scale only.
  small.writeScene("high", R"({"stage_instance": {"template_name": "NONE"}, "object_instances": [
      {"template_name": "high_table", "motion_type": "STATIC", "translation_origin": "COM"}]})");
  const ComposedScene scene = composed(small, "high");
  EXPECT_LT(errorOf(scene.scene, "high_table_:0000", changedCorners([](const auto& p) {
                      return std::array{p[0] - 1, 3 * (p[1] - 1.25), p[2] - 2.5};
                    })),
            kTolerance);
}

TEST(SceneDataset, PlacesFurnitureInItsRestPose) {
  const ComposedScene scene = composed(SmallDataset());
  std::vector<Points> placed;
  for (const SourceInstance& instance : scene.scene.instances) {
    if (instance.name == "cupboard_:0000") placed.push_back(placedVertices(scene.scene, instance));
  }
  ASSERT_EQ(placed.size(), 2U);
  // Scale 2 of the template times 0.5 of the instance; the box is 1 x 2 x 3 and 1 m along z.
  Points base;
  for (const double x : {-0.5, 0.5}) {
    for (const double y : {-1.0, 1.0}) {
      for (const double z : {-0.5, 2.5}) base.push_back({x, y + 1, z});
    }
  }
  EXPECT_LT(farthestCorner(placed[0], base), kTolerance);
  // The hinge is at the limit nearest to zero.
  const double c = std::cos(0.5);
  const double s = std::sin(0.5);
  EXPECT_LT(farthestCorner(
                placed[1], changedCorners([&](const auto& p) {
                  return std::array{1 + c * p[0] - s * p[1], 1 + s * p[0] + c * p[1], 2 * p[2]};
                })),
            kTolerance);
}

TEST(SceneDataset, TakesTheStatedJointPositionsOfFurniture) {
  for (const std::string_view pose : {"[1.25]", R"({"hinge": 1.25})", R"({"joint_00": 1.25})"}) {
    SCOPED_TRACE(pose);
    const SmallDataset small;
    small.writeScene("posed", fmt::format(R"({{"stage_instance": {{"template_name": "room"}},
      "articulated_object_instances": [{{"template_name": "cupboard", "uniform_scale": 0.5,
        "initial_joint_pose": {}}}]}})",
                                          pose));
    const ComposedScene scene = composed(small, "posed");
    const double c = std::cos(1.25);
    const double s = std::sin(1.25);
    EXPECT_LT(
        farthestCorner(placedVertices(scene.scene, scene.scene.instances.back()),
                       changedCorners([&](const auto& p) {
                         return std::array{1 + c * p[0] - s * p[1], s * p[0] + c * p[1], 2 * p[2]};
                       })),
        kTolerance);
  }
}

/// Furniture of two meshes, named a and m, that stand in its file: boxes as wide as stated.
std::string mjcfOfBoxes(double a, double m) {
  const auto mesh = [](std::string_view name, double width) {
    return fmt::format(
        "<mesh name='{0}' vertex='0 0 0 {1} 0 0 0 1 0 {1} 1 0 0 0 1 {1} 0 1 0 1 1 {1} 1 1'/>", name,
        width);
  };
  return fmt::format(
      "<mujoco><asset>{}{}</asset><worldbody><body name='b'><geom type='mesh' mesh='a'/>"
      "<geom type='mesh' mesh='m'/></body></worldbody></mujoco>",
      mesh("a", a), mesh("m", m));
}

TEST(SceneDataset, PlacesFurnitureWhoseMeshesStandInItsFile) {
  const SmallDataset small;
  small.write("urdf/first.xml", mjcfOfBoxes(1, 2));
  small.write("urdf/second.xml", mjcfOfBoxes(3, 4));
  for (const std::string name : {"first", "second"}) {
    small.write("urdf/cupboard/" + name + ".ao_config.json",
                fmt::format(R"({{"urdf_filepath": "../{}.xml"}})", name));
  }
  small.writeScene("inline", R"({"stage_instance": {"template_name": "NONE"},
      "articulated_object_instances": [{"template_name": "first"}, {"template_name": "second"}]})");
  auto config = std::string(SmallDataset::kConfig);
  config.replace(config.find(R"({".urdf": ["urdf/*/"]})"), 22, R"({".json": ["urdf/*/"]})");
  small.write("home.scene_dataset_config.json", config);
  const ComposedScene scene = composed(small, "inline");
  EXPECT_THAT(scene.missing, testing::IsEmpty());
  std::vector<double> widths;
  for (const SourceInstance& instance : scene.scene.instances) {
    double width = 0;
    for (const auto& corner : placedVertices(scene.scene, instance)) {
      width = std::max(width, corner[0]);
    }
    widths.push_back(width);
  }
  EXPECT_THAT(widths, ElementsAre(1, 2, 3, 4)) << "each has its own, whatever it is named";
}

TEST(SceneDataset, SaysWhatLacksAndWhereItWasLookedFor) {
  const ComposedScene scene = composed(SmallDataset());
  EXPECT_THAT(scene.missing,
              ElementsAre("object 'ghost': its mesh 'meshes/ghost.glb' is missing (2 times)",
                          "object 'lamp' is in none of the dataset's paths",
                          "articulated object 'cupboard': its mesh 'handle.glb' is missing"));
  // A URDF's mesh is looked for in all folders above it, too.
  EXPECT_THAT(scene.scene.read.absent,
              IsSupersetOf({"configs/objects/big/lamp.object_config.json",
                            "configs/objects/small/lamp.object_config.json", "meshes/ghost.glb",
                            "urdf/cupboard/handle.glb", "urdf/handle.glb", "handle.glb"}));
}

TEST(SceneDataset, ListsEveryFileThatWasReadOnce) {
  const ComposedScene scene = composed(SmallDataset());
  std::vector<std::string> names;
  for (const bake::SourceFile& file : scene.scene.read.files) {
    names.push_back(file.name);
    EXPECT_GT(file.bytes, 0U) << file.name;
    EXPECT_NE(file.hash_low, 0U) << file.name;
  }
  EXPECT_THAT(
      names,
      ElementsAre("bare/crate.glb", "configs/objects/big/shelf.object_config.json",
                  "configs/objects/big/table.object_config.json",
                  "configs/objects/small/cup.object_config.json",
                  "configs/objects/small/ghost.object_config.json",
                  "configs/stages/room.stage_config.json", "home.scene_dataset_config.json",
                  "meshes/box.mtl", "meshes/box.obj", "meshes/room.obj",
                  "scenes/a_home.scene_instance.json", "urdf/cupboard/cupboard.ao_config.json",
                  "urdf/cupboard/cupboard.urdf", "urdf/cupboard/door.obj"));
}

TEST(SceneDataset, HoldsEachMeshOnceHoweverOftenItIsPlaced) {
  const SmallDataset small;
  std::string items;
  for (int i = 0; i < 10; ++i) {
    items += fmt::format(R"({}{{"template_name": "table", "motion_type": "STATIC"}})",
                         i == 0 ? "" : ", ");
  }
  small.writeScene("tables", fmt::format(R"({{"stage_instance": {{"template_name": "NONE"}},
      "object_instances": [{}, {{"template_name": "high_table", "motion_type": "STATIC"}}]}})",
                                         items));
  const ComposedScene scene = composed(small, "tables");
  EXPECT_FALSE(scene.has_stage);
  EXPECT_EQ(scene.scene.instances.size(), 11U);
  EXPECT_EQ(scene.scene.meshes.size(), 1U);
  const auto box = bake::importMesh(small.folder() / "meshes/box.obj", bake::datasetMeshOptions());
  ASSERT_TRUE(box);
  EXPECT_EQ(scene.scene.materials.size(), box->materials.size());
  EXPECT_THAT(scene.scene.warnings, testing::Contains("the scene says that it has no stage"));
}

TEST(SceneDataset, KeepsMaterialsTexturesAndSemanticsApart) {
  const SmallDataset small;
  const auto textured = [&](const std::string& name, const std::string& uri) {
    GltfPieces pieces;
    pieces.more = fmt::format(
        R"(,"materials":[{{"name":"{}","pbrMetallicRoughness":{{"baseColorTexture":{{"index":0}}}}}}],)"
        R"("textures":[{{"source":0}}],"images":[{{"uri":"{}"}}])",
        name, uri);
    // Mesh 0 refers to material 0.
    std::string json = gltfFile(unevenBox(), pieces);
    const std::string_view primitive = R"("indices":0)";
    json.insert(json.find(primitive) + primitive.size(), R"(,"material":0)");
    small.write("bare/" + name + ".glb", glbContainer(json, gltfBuffer(unevenBox())));
  };
  // Two that carry their image themselves, and one whose image lies beside it.
  const std::string image = "data:image/png;base64,iVBORw0KGgo=";
  textured("crate", image);
  textured("crute", image);
  textured("crote", "../meshes/paint.png");
  small.write("meshes/paint.png", "no image, but a file");
  small.writeScene("three", R"({"stage_instance": {"template_name": "room"}, "object_instances": [
      {"template_name": "crate", "motion_type": "STATIC"},
      {"template_name": "crute", "motion_type": "STATIC"},
      {"template_name": "crote", "motion_type": "STATIC"},
      {"template_name": "crate", "motion_type": "STATIC"}]})");
  const SourceAsset scene = composed(small, "three").scene;
  ASSERT_EQ(scene.instances.size(), 5U);
  EXPECT_EQ(scene.textures.size(), 2U);
  std::vector<std::string> names;
  std::vector<std::string> textures;
  for (std::size_t i = 1; i < 5; ++i) {
    const auto& material = scene.materials.at(scene.meshes.at(scene.instances[i].mesh).material);
    names.push_back(material.name);
    textures.push_back(material.base_color_texture);
  }
  EXPECT_THAT(names, ElementsAre("crate", "crute", "crote", "crate"));
  EXPECT_THAT(textures, ElementsAre("*0", "*1", "meshes/paint.png", "*0"));
  bake::TextureBakeOptions options;
  SourceAsset plain = scene;
  for (auto& material : plain.materials) material.base_color_texture.clear();
  const auto source = bake::sceneRenderSource(plain, small.folder(), options);
  ASSERT_TRUE(source) << textOf(source.error());
  EXPECT_THAT(source->semantics,
              ElementsAre("room", "crate_:0000", "crute_:0000", "crote_:0000", "crate_:0001"));
}

TEST(SceneDataset, OfStagesAloneHasThemAsScenes) {
  const ScratchFolder folder;
  const auto config = folder.write(
      "scans.scene_dataset_config.json",
      R"({"stages": {"paths": {".glb": ["train/*/*.basis.glb"], ".obj": ["train/*"]}}})");
  static_cast<void>(folder.write("train/0/abc.basis.glb", glbFile(unevenBox())));
  static_cast<void>(folder.write("train/0/abc.semantic.glb", glbFile(unevenBox())));
  static_cast<void>(folder.write("train/1/xyz.obj", objFile(unevenBox())));
  const auto dataset = SceneDataset::read(config);
  ASSERT_TRUE(dataset) << textOf(dataset.error());
  ASSERT_THAT(dataset->scenes(), ElementsAre("abc", "xyz")) << "as of a folder and in episodes";
  MeshLibrary meshes(bake::datasetMeshOptions());
  const auto scan = dataset->compose("abc", meshes);
  ASSERT_TRUE(scan) << textOf(scan.error());
  // As Habitat does, a bare GLB is taken for Z up.
  EXPECT_LT(errorOf(scan->scene, "abc", changedCorners([](const auto& p) {
                      return std::array{p[0], p[2], -p[1]};
                    })),
            kTolerance);
  const auto other = dataset->compose("xyz", meshes);
  ASSERT_TRUE(other) << textOf(other.error());
  EXPECT_LT(errorOf(other->scene, "xyz", boxCorners()), kTolerance);
}

TEST(SceneDataset, HasEachScanOnce) {
  const ScratchFolder folder;
  const auto config =
      folder.write("scans.scene_dataset_config.json", R"({"stages": {"paths": {".glb": ["*/"]}}})");
  for (const char* file : {"0/abc.basis.glb", "0/abc.glb", "1/xyz.basis.glb", "2/v1.5.glb"}) {
    static_cast<void>(folder.write(file, glbFile(unevenBox())));
  }
  static_cast<void>(folder.write("1/xyz.stage_config.json", R"({"up": [0, 1, 0]})"));
  const auto dataset = SceneDataset::read(config);
  ASSERT_TRUE(dataset) << textOf(dataset.error());
  EXPECT_THAT(dataset->scenes(), ElementsAre("abc", "v1.5", "xyz"));
  MeshLibrary meshes(bake::datasetMeshOptions());
  const auto plain = dataset->compose("abc", meshes);
  ASSERT_TRUE(plain) << textOf(plain.error());
  EXPECT_EQ(plain->scene.read.files.front().name, "0/abc.glb");
  const auto upright = dataset->compose("xyz", meshes);
  ASSERT_TRUE(upright) << textOf(upright.error());
  EXPECT_LT(errorOf(upright->scene, "xyz", boxCorners()), kTolerance) << "its attributes count";
}

TEST(SceneDataset, TurnsAPublishedStageThatLiesOnItsSide) {
  const auto room = assetsFolder() / "scenes" / "habitat_simple_room";
  if (!std::filesystem::exists(room / "simple_room.glb")) {
    GTEST_SKIP() << "set GALACTIC_ASSETS to a folder with scenes/habitat_simple_room/ in it";
  }
  const ScratchFolder folder;
  const auto config = folder.write(
      "rooms.scene_dataset_config.json",
      fmt::format(R"({{"stages": {{"paths": {{".glb": ["{}/simple_*"]}}}}}})", room.string()));
  const auto dataset = SceneDataset::read(config, {.allow_outside = true});
  ASSERT_TRUE(dataset) << textOf(dataset.error());
  MeshLibrary meshes(bake::datasetMeshOptions());
  const auto scene = dataset->compose("simple_room", meshes);
  ASSERT_TRUE(scene) << textOf(scene.error());
  const auto mesh = placeAndClean(scene->scene);
  ASSERT_TRUE(mesh) << textOf(mesh.error());
  // The file has x -5.25 to 5.28, y -5.4 to 5.45, z -0.06 to 2.15, and z is up.
  constexpr float kRounding = 0.01F;
  EXPECT_NEAR(mesh->mesh.bounds.min.y, -0.0614F, kRounding);
  EXPECT_NEAR(mesh->mesh.bounds.max.y, 2.15F, kRounding);
  EXPECT_NEAR(mesh->mesh.bounds.min.z, -5.45F, kRounding);
  EXPECT_NEAR(mesh->mesh.bounds.max.x, 5.28F, kRounding);
}

TEST(SceneDataset, TakesTheFirstOfSeveralMeaningsAndSaysSo) {
  const SmallDataset small;
  small.write("configs/objects/small/table.object_config.json",
              R"({"render_asset": "../../../meshes/room.obj"})");
  small.writeScene("doubt", R"({"stage_instance": {"template_name": "NONE"}, "object_instances": [
      {"template_name": "table", "motion_type": "STATIC"},
      {"template_name": "small/table", "motion_type": "STATIC"},
      {"template_name": "HEL", "motion_type": "STATIC"}]})");
  const ComposedScene scene = composed(small, "doubt");
  EXPECT_THAT(scene.scene.warnings,
              testing::Contains("object 'table' may be several; "
                                "'configs/objects/big/table.object_config.json' is taken, the "
                                "first"));
  ASSERT_EQ(scene.scene.instances.size(), 3U);
  const auto& mesh = scene.scene.meshes.at(scene.scene.instances[0].mesh);
  EXPECT_EQ(scene.scene.materials.at(mesh.material).name, "wood") << "box.obj, not room.obj";
  EXPECT_NE(scene.scene.instances[1].mesh, scene.scene.instances[0].mesh);
  EXPECT_EQ(scene.scene.instances[2].name, "shelf_:0000");
}

TEST(SceneDataset, DoesNotDependOnTheOrderOfScenesOrOnTheLibrary) {
  const SmallDataset small;
  small.writeScene("b_home", R"({"stage_instance": {"template_name": "room"}, "object_instances": [
      {"template_name": "made_here", "motion_type": "STATIC"},
      {"template_name": "crate", "motion_type": "STATIC"},
      {"template_name": "table", "motion_type": "STATIC"}]})");
  const auto dataset = SceneDataset::read(small.config());
  ASSERT_TRUE(dataset) << textOf(dataset.error());
  const auto digest = [&](const std::string& name, MeshLibrary& meshes) {
    const auto scene = dataset->compose(name, meshes);
    EXPECT_TRUE(scene) << textOf(scene.error());
    std::string text;
    for (const SourceInstance& instance : scene->scene.instances) {
      text += fmt::format("{} {} {}\n", instance.name, instance.mesh,
                          fmt::join(instance.world_from_mesh, " "));
    }
    for (const auto& mesh : scene->scene.meshes) {
      text += fmt::format("{} {} {}\n", mesh.name, mesh.positions.size(), mesh.material);
    }
    for (const auto& file : scene->scene.read.files) {
      text += fmt::format("{} {} {}\n", file.name, file.hash_low, file.hash_high);
    }
    return text;
  };
  MeshLibrary shared(bake::datasetMeshOptions());
  MeshLibrary keeps_nothing(bake::datasetMeshOptions(), 0);
  const std::string a = digest("a_home", shared);
  const std::string b = digest("b_home", shared);
  EXPECT_NE(a, b);
  EXPECT_EQ(digest("b_home", keeps_nothing), b);
  EXPECT_EQ(digest("a_home", keeps_nothing), a);
  EXPECT_EQ(digest("a_home", shared), a);
  // Several threads, one of which reads each file.
  MeshLibrary contended(bake::datasetMeshOptions());
  std::vector<std::string> digests(6);
  std::vector<std::thread> threads;
  for (std::size_t n = 0; n < digests.size(); ++n) {
    threads.emplace_back(
        [&, n] { digests[n] = digest(n % 2 == 0 ? "a_home" : "b_home", contended); });
  }
  for (std::thread& thread : threads) thread.join();
  for (std::size_t n = 0; n < digests.size(); ++n) EXPECT_EQ(digests[n], n % 2 == 0 ? a : b);
}

TEST(SceneDataset, FingerprintChangesWithTheTemplatesThatAreThere) {
  const SmallDataset small;
  const auto fingerprint = [&] { return SceneDataset::read(small.config())->fingerprint(); };
  const std::uint64_t before = fingerprint();
  small.write("configs/objects/big/table.object_config.json",
              R"({"render_asset": "../../../meshes/room.obj"})");
  EXPECT_EQ(fingerprint(), before) << "what a file says is the business of its hash";
  small.write("configs/objects/big/lamp.object_config.json", "{}");
  EXPECT_NE(fingerprint(), before);
}

/// The grids, which have no names for what is in a scene, would only say that all of it is large.
TEST(SceneDataset, NamesWhatIsPlacedTooFarAway) {
  const SmallDataset small;
  small.writeScene("far", R"({"stage_instance": {"template_name": "room"}, "object_instances": [
      {"template_name": "table", "motion_type": "STATIC", "translation": [0, 5000, 0]}]})");
  const auto dataset = SceneDataset::read(small.config());
  ASSERT_TRUE(dataset) << textOf(dataset.error());
  MeshLibrary meshes(bake::datasetMeshOptions());
  const auto scene = dataset->compose("far", meshes);
  ASSERT_FALSE(scene);
  EXPECT_EQ(textOf(scene.error()),
            "far: object 'table': the scene places it 5000 m away, at most 800 m are possible; "
            "correct its translation");
}

}  // namespace
}  // namespace galactic::test::scene_dataset_test
