// All scenes of ReplicaCAD that have their stage, as the kernels of the cuda backend draw them:
// every bit as `soft` does.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "bake/render/render_helpers.h"
#include "dataset/scene_dataset.h"
#include "render/render_source.h"
#include "runtime/render/cuda/drawn_by_kernels.h"
#include "runtime/render/gl_scene.h"
#include "support/assets.h"

namespace galactic::test::replica_cad_images_test {
namespace {

constexpr std::uint32_t kSeed = 61;
/// Few and small, as there are many scenes: each has all that it places in its list.
constexpr std::size_t kViews = 4;
constexpr std::uint32_t kEdge = 96;

/// Cameras at the height of a robot's head, anywhere in the apartment, looking about.
std::vector<RenderView> viewsIn(std::mt19937& random,
                                const std::vector<RenderInstance>& instances) {
  std::vector<RenderView> views(kViews);
  for (RenderView& view : views) {
    const Vec3 place{uniform(random, -2.2F, 4.2F), uniform(random, 0.4F, 1.6F),
                     uniform(random, -4.2F, 7.7F)};
    view.camera = cameraAt(place, uniform(random, 0, 360), uniform(random, -40, 20),
                           uniform(random, 40, 100));
    view.instances = instances;
  }
  return views;
}

class ReplicaCadImages : public testing::Test {
 protected:
  void SetUp() override {
    if (!hasKernels()) GTEST_SKIP() << "built without the kernels";
    const auto config = assetsFolder() / "replica_cad" / "replicaCAD.scene_dataset_config.json";
    if (!std::filesystem::exists(config)) {
      GTEST_SKIP() << "set GALACTIC_ASSETS to a folder with replica_cad/ in it";
    }
    auto read = bake::SceneDataset::read(config);
    ASSERT_TRUE(read) << read.error().message;
    dataset_.emplace(std::move(*read));
    resetStandin();
  }

  /// Draws some views of a scene both ways.
  void compare(const std::string& name, std::mt19937& random) {
    SCOPED_TRACE(name);
    const auto scene = dataset_->compose(name, meshes_);
    ASSERT_TRUE(scene) << scene.error().message;
    const auto source = bake::sceneRenderSource(scene->scene, dataset_->folder(), {.largest = 64});
    ASSERT_TRUE(source) << source.error().message;
    const auto meshes =
        bake::bakeRenderMeshes(*source, {.error = 0.005, .lighting = bake::Lighting::kNone}, 2);
    ASSERT_TRUE(meshes) << meshes.error().message;
    RenderLibrary library;
    library.add(meshes->view());
    RenderOptions options;
    options.width = options.height = kEdge;
    options.semantics = true;
    const std::vector<RenderInstance> instances{{.model = 0, .world_from_model = {}}};
    const std::vector<RenderView> views = viewsIn(random, instances);
    const RenderImages soft = drawWithSoft(library, options, views);
    const RenderImages kernels = drawWithKernels(library, options, views);
    EXPECT_EQ(soft.depth, kernels.depth);
    EXPECT_EQ(soft.semantics, kernels.semantics);
    EXPECT_EQ(soft.color, kernels.color);
    ++scenes_;
    pixels_ += soft.depth.size();
    empty_ += static_cast<std::size_t>(std::count(soft.depth.begin(), soft.depth.end(), 0.0F));
    triangles_ += library.model(0).triangles;
  }

  std::optional<bake::SceneDataset> dataset_;
  bake::MeshLibrary meshes_{bake::datasetMeshOptions()};
  std::size_t scenes_ = 0;
  std::size_t pixels_ = 0;
  std::size_t empty_ = 0;
  std::size_t triangles_ = 0;
};

TEST_F(ReplicaCadImages, OfTheCudaKernelsAreThoseOfSoftInEveryScene) {
  std::mt19937 random(kSeed);
  for (const std::string& name : dataset_->scenes()) {
    if (!name.starts_with("v3_sc1_staging_")) continue;
    ASSERT_NO_FATAL_FAILURE(compare(name, random));
  }
  std::printf("seed %u: %zu scenes of %zu triangles, %zu pixels, %.1f %% empty\n", kSeed, scenes_,
              scenes_ == 0 ? 0 : triangles_ / scenes_, pixels_,
              100 * static_cast<double>(empty_) / static_cast<double>(pixels_));
  EXPECT_GT(scenes_, 0U);
  EXPECT_LT(empty_ * 2, pixels_) << "the cameras look into nothing";
}

}  // namespace
}  // namespace galactic::test::replica_cad_images_test
