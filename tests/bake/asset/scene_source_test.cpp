// Scenes as they are read: for their bakes, and for episodes in them.
#include "asset/scene_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bake/dataset/small_dataset.h"
#include "support/mesh_files.h"
#include "support/scratch_folder.h"

namespace galactic::test::scene_source_test {
namespace {

namespace fs = std::filesystem;
using bake::ReadLog;
using bake::SceneJob;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

SceneJob jobOfInstance(const SmallDataset& small, const std::string& name) {
  SceneJob job{.input = small.config()};
  job.instance = bake::InstancedScene{name};
  return job;
}

TEST(SceneSource, IsCalledAsItsJobSaysOrAfterItsFileOrInstance) {
  EXPECT_EQ(bake::nameOf(SceneJob{.input = "in/home.glb"}), "home");
  EXPECT_EQ(bake::nameOf(SceneJob{.input = "in/home.glb", .name = "flat"}), "flat");
  EXPECT_EQ(bake::nameOf(jobOfInstance(SmallDataset(), "a_home")), "a_home");
}

TEST(SceneSource, OfAFileIsItsMesh) {
  const SmallDataset small;
  const SceneJob job{.input = small.folder() / "meshes/box.obj"};
  ReadLog log;
  bake::BakeLibraries libraries;
  const auto read = bake::readScene(job, log, libraries);
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read->input, job.input);
  EXPECT_EQ(read->asset.name, "box");
  const auto details = bake::readSceneDetails(job, libraries);
  ASSERT_TRUE(details) << details.error().text();
  EXPECT_THAT(details->mesh.triangles, SizeIs(12));
  EXPECT_THAT(details->receptacles, IsEmpty());
}

TEST(SceneSource, OfAGlbThatLiesOnItsSideDrawsAWarningUnlessItsUpAxisIsGiven) {
  // A floor of 4 x 3 m that faces along Z, as in a file with Z up, and a wall of 1 m.
  const MeshContent room{
      .positions = {{0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {0, 3, 0}, {0, 0, 1}, {4, 0, 1}},
      .triangles = {{0, 1, 2}, {0, 2, 3}, {0, 5, 1}, {0, 4, 5}}};
  const ScratchFolder folder;
  const auto warningsOf = [&](const bake::MeshImportOptions& import) {
    const SceneJob job{.input = folder.write("scan.glb", glbFile(room)), .import = import};
    ReadLog log;
    bake::BakeLibraries libraries;
    const auto read = bake::readScene(job, log, libraries);
    EXPECT_TRUE(read) << read.error().text();
    return read ? read->asset.warnings : std::vector<std::string>();
  };
  EXPECT_THAT(warningsOf({}), Contains(HasSubstr("give `up` z")));
  EXPECT_THAT(warningsOf({.up = bake::UpAxis::kZ}), IsEmpty());
  EXPECT_THAT(warningsOf({.up = bake::UpAxis::kY}), IsEmpty());
}

TEST(SceneSource, OfAnInstanceIsPutTogether) {
  const SmallDataset small;
  small.writeScene("one", R"({"stage_instance": {"template_name": "room"}, "object_instances": [
      {"template_name": "ghost", "motion_type": "STATIC"}],
      "user_defined": {"receptacle_aabb_floor": {"position": [0, 0, 0], "scale": [1, 1, 1]}}})");
  const SceneJob job = jobOfInstance(small, "one");
  ReadLog log;
  bake::BakeLibraries libraries;
  const auto read = bake::readScene(job, log, libraries);
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read->input, small.folder() / "one");
  EXPECT_THAT(read->asset.warnings,
              Contains("object 'ghost': its mesh 'meshes/ghost.glb' is missing"));
  EXPECT_THAT(log.absent(), Contains(small.folder() / "meshes/ghost.glb"));
  const auto details = bake::readSceneDetails(job, libraries);
  ASSERT_TRUE(details) << details.error().text();
  EXPECT_THAT(details->mesh.triangles, Not(IsEmpty()));
  EXPECT_THAT(details->receptacles, SizeIs(1));
}

TEST(SceneSource, OfInstancesOfOneNameHasItsFilesBelowTheDataset) {
  const SmallDataset small;
  small.write("home.scene_dataset_config.json",
              R"({"stages": {"paths": {".json": ["configs/stages"]}},
                  "scene_instances": {"paths": {".json": ["scenes/*/"]}}})");
  for (const char* name : {"one/x", "two/x"}) {
    small.writeScene(name, R"({"stage_instance": {"template_name": "room"}})");
  }
  ReadLog log;
  bake::BakeLibraries libraries;
  const auto read = bake::readScene(jobOfInstance(small, "two_x"), log, libraries);
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read->input, small.folder() / "two_x");
  EXPECT_EQ(read->folder, small.folder());
  for (const bake::SourceFile& file : read->asset.read.files) {
    EXPECT_TRUE(fs::exists(read->folder / file.name)) << file.name;
  }
}

TEST(SceneSource, NamesItsInputWhereItsTrianglesAreNone) {
  const SmallDataset small;
  const fs::path flat = small.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
  bake::BakeLibraries libraries;
  const auto details = bake::readSceneDetails({.input = flat}, libraries);
  ASSERT_FALSE(details);
  EXPECT_THAT(details.error().where, testing::StartsWith(flat.string() + ": "));
  EXPECT_THAT(details.error().message, HasSubstr("degenerate"));
}

}  // namespace
}  // namespace galactic::test::scene_source_test
