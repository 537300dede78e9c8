// The scenes of ReplicaCAD that have their stage, from the real dataset.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "galactic/bake/scene_dataset.h"
#include "galactic/bake/triangle_mesh.h"
#include "support/assets.h"

namespace galactic::test {
namespace {

using bake::ComposedScene;
using bake::MeshLibrary;
using bake::SceneDataset;

constexpr std::string_view kScenesWithStage = "v3_sc1_staging_";

class ReplicaCad : public testing::Test {
 protected:
  void SetUp() override {
    const auto folder = assetsFolder();
    const auto config = folder / "replica_cad" / "replicaCAD.scene_dataset_config.json";
    if (folder.empty() || !std::filesystem::exists(config)) {
      GTEST_SKIP() << "set GALACTIC_ASSETS to a folder with replica_cad/ in it";
    }
    auto read = SceneDataset::read(config);
    ASSERT_TRUE(read) << read.error().where << ": " << read.error().message;
    dataset_.emplace(std::move(*read));
  }

  std::optional<SceneDataset> dataset_;
  MeshLibrary meshes_{bake::datasetMeshOptions()};
};

TEST_F(ReplicaCad, ComposesAllScenesThatHaveTheirStage) {
  std::size_t composed = 0;
  for (const std::string& name : dataset_->scenes()) {
    if (!name.starts_with(kScenesWithStage)) continue;
    SCOPED_TRACE(name);
    const auto scene = dataset_->compose(name, meshes_);
    ASSERT_TRUE(scene) << scene.error().where << ": " << scene.error().message;
    EXPECT_TRUE(scene->has_stage);
    const auto mesh = placeAndClean(scene->scene);
    ASSERT_TRUE(mesh) << mesh.error().message;
    fmt::print("{}: {} instances of {} meshes, {} triangles, {} movable\n", name,
               scene->scene.instances.size(), scene->scene.meshes.size(), mesh->mesh.triangles.size(), scene->movable.size());
    if (composed == 0) {
      for (const auto& m : scene->missing) fmt::print("  missing: {}\n", m);
      for (const auto& m : scene->absent_files) fmt::print("  absent: {}\n", m);
      for (const auto& m : scene->scene.warnings) fmt::print("  warning: {}\n", m);
      for (const auto& m : scene->scene.files) fmt::print("  file: {}\n", m.name);
    }
    ++composed;
  }
  for (const auto& m : dataset_->warnings()) fmt::print("  {}\n", m);
  EXPECT_EQ(composed, 21U);
}

}  // namespace
}  // namespace galactic::test
