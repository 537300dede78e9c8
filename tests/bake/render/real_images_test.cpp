// Real scenes as they are drawn: against rays, and one backend against the other.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "bake/render/ray_depth.h"
#include "bake/render/render_helpers.h"
#include "galactic/bake/mesh_import.h"
#include "render/cuda/kernel_image.h"
#include "render/render_source.h"
#include "runtime/render/cuda/drawn_by_kernels.h"
#include "runtime/render/gl_scene.h"
#include "support/asset_mesh.h"
#include "support/render_images.h"

namespace galactic::test::real_images_test {
namespace {

/// Meters: what is farther off than this is another surface.
constexpr float kSameDepth = 0.01F;
constexpr std::size_t kCameras = 24;

/// A scene as it is drawn, and as rays see it.
struct RealScene {
  bake::BakedRenderMeshes meshes;
  bake::TriangleMesh triangles;
  RenderLibrary library;
  std::vector<RenderInstance> instances{{.model = 0, .world_from_model = {}}};
};

/// `error`: how far simplification may move a surface, meters.
void read(const std::string& relative, double error, RealScene& scene) {
  const std::filesystem::path file = assetsFolder() / relative;
  const auto asset = bake::importMesh(file);
  ASSERT_TRUE(asset) << asset.error().message;
  const auto source = bake::sceneRenderSource(*asset, file.parent_path(), {.largest = 256});
  ASSERT_TRUE(source) << source.error().message;
  auto meshes =
      bake::bakeRenderMeshes(*source, {.error = error, .lighting = bake::Lighting::kNone}, 2);
  ASSERT_TRUE(meshes) << meshes.error().message;
  scene.meshes = std::move(*meshes);
  auto clean = bake::placeAndClean(*asset);
  ASSERT_TRUE(clean);
  scene.triangles = std::move(clean->mesh);
  scene.library.add(scene.meshes.view());
}

/// Cameras at random places with free space around them and a floor below, looking about.
std::vector<RenderView> viewsIn(const RealScene& scene, const RayDepth& rays) {
  constexpr float kFree = 0.4F;
  constexpr float kFloor = 3.0F;
  std::mt19937 random(11);
  const bake::Bounds& box = scene.triangles.bounds;
  std::vector<RenderView> views;
  while (views.size() < kCameras) {
    const Vec3 place{uniform(random, box.min.x, box.max.x), uniform(random, box.min.y, box.max.y),
                     uniform(random, box.min.z, box.max.z)};
    bool is_free = true;
    for (int n = 0; n < 32; ++n) {
      const float near = rays.first(place, rotate(randomRotation(random), {1, 0, 0}), 0);
      is_free = is_free && near > kFree;
    }
    const float below = rays.first(place, {0, -1, 0}, 0);
    if (!is_free || below <= 0 || below > kFloor) continue;
    RenderView& view = views.emplace_back();
    view.camera = cameraAt(place, uniform(random, 0, 360), uniform(random, -40, 20),
                           uniform(random, 40, 100));
    view.instances = scene.instances;
  }
  return views;
}

/// What the pixels of one image are, compared with rays.
struct DepthCounts {
  std::size_t pixels = 0;
  std::size_t off = 0;
  /// Off, and no neighbor's ray meets what was drawn.
  std::size_t off_inside = 0;
  std::size_t empty = 0;
};

bool isSame(float drawn, float wanted) { return std::abs(drawn - wanted) <= kSameDepth; }

/// Whether a pixel lies where something ends in front of something else: a neighbor's ray meets
/// what was drawn here, as far as a slanting surface allows.
bool isAtSilhouette(const std::vector<float>& rays, float drawn, std::size_t at,
                    const RenderOptions& options) {
  constexpr float kSlant = 0.03F;
  const auto width = static_cast<std::ptrdiff_t>(options.width);
  const auto row = static_cast<std::ptrdiff_t>(at) / width;
  const auto column = static_cast<std::ptrdiff_t>(at) % width;
  for (std::ptrdiff_t y = std::max<std::ptrdiff_t>(row - 1, 0);
       y <= std::min<std::ptrdiff_t>(row + 1, static_cast<std::ptrdiff_t>(options.height) - 1);
       ++y) {
    for (std::ptrdiff_t x = std::max<std::ptrdiff_t>(column - 1, 0);
         x <= std::min<std::ptrdiff_t>(column + 1, width - 1); ++x) {
      const float wanted = rays[static_cast<std::size_t>(y * width + x)];
      if (std::abs(drawn - wanted) <= std::max(kSameDepth, kSlant * wanted)) return true;
    }
  }
  return false;
}

/// `images`: of viewsIn() with these options.
DepthCounts compare(const RayDepth& rays, const std::vector<RenderView>& views,
                    const RenderOptions& options, const RenderImages& images) {
  const std::size_t size = std::size_t{options.width} * options.height;
  DepthCounts counts;
  for (std::size_t view = 0; view < views.size(); ++view) {
    const std::vector<float> wanted = rays.image(views[view].camera, options);
    for (std::size_t n = 0; n < size; ++n) {
      const float drawn = images.depth[view * size + n];
      ++counts.pixels;
      counts.empty += wanted[n] == 0 ? 1U : 0U;
      if (isSame(drawn, wanted[n])) continue;
      ++counts.off;
      counts.off_inside += isAtSilhouette(wanted, drawn, n, options) ? 0U : 1U;
    }
  }
  std::printf(
      "%zu pixels, %.4f %% off by more than 1 cm, %zu of them not on silhouettes; %.2f %% "
      "empty\n",
      counts.pixels, 100 * static_cast<double>(counts.off) / static_cast<double>(counts.pixels),
      counts.off_inside,
      100 * static_cast<double>(counts.empty) / static_cast<double>(counts.pixels));
  return counts;
}

/// The rest may be on silhouettes, where a pixel's middle falls to either surface; of pieces seen
/// from inside, which are closed and drawn from outside only, a few pixels are allowed.
void expectLikeRays(const DepthCounts& counts) {
  EXPECT_LT(counts.off * 100, counts.pixels);
  EXPECT_LT(counts.off_inside * 10'000, counts.pixels);
  EXPECT_LT(counts.empty * 2, counts.pixels) << "the cameras look into nothing";
}

DepthCounts compareSoft(const RealScene& scene) {
  const RayDepth rays(scene.triangles);
  const std::vector<RenderView> views = viewsIn(scene, rays);
  const RenderOptions options;
  return compare(rays, views, options, drawWithSoft(scene.library, options, views));
}

TEST(RealImages, OfTheApartmentStageHaveTheDepthsThatRaysMeet) {
  if (!hasAsset(kApartmentStage)) GTEST_SKIP() << "the sc1 stage is not on this machine";
  RealScene scene;
  ASSERT_NO_FATAL_FAILURE(read(kApartmentStage, 0, scene));
  expectLikeRays(compareSoft(scene));
}

TEST(RealImages, OfAScanHaveTheDepthsThatRaysMeet) {
  if (!hasAsset(kScannedRoom)) GTEST_SKIP() << "the scanned room is not on this machine";
  RealScene scene;
  ASSERT_NO_FATAL_FAILURE(read(kScannedRoom, 0, scene));
  expectLikeRays(compareSoft(scene));
}

TEST(RealImages, OfTheCudaKernelsAreThoseOfSoftAndHaveTheDepthsThatRaysMeet) {
  if (render::cuda::kernelImage() == nullptr) GTEST_SKIP() << "built without the kernels";
  if (!hasAsset(kApartmentStage) || !hasAsset(kScannedRoom)) {
    GTEST_SKIP() << "the sc1 stage and the scanned room are not on this machine";
  }
  resetStandin();
  for (const char* relative : {kApartmentStage, kScannedRoom}) {
    RealScene scene;
    ASSERT_NO_FATAL_FAILURE(read(relative, 0, scene));
    const RayDepth rays(scene.triangles);
    const std::vector<RenderView> views = viewsIn(scene, rays);
    RenderOptions options;
    options.semantics = true;
    const RenderImages images = drawWithKernels(scene.library, options, views);
    EXPECT_EQ(images, drawWithSoft(scene.library, options, views)) << relative;
    expectLikeRays(compare(rays, views, options, images));
  }
}

/// Pixels at the edge of two surfaces may fall to either: drivers round positions differently.
void expectAgreement(const std::string& relative) {
  constexpr double kMeanColor = 0.2;
  constexpr double kDeepShare = 0.0005;
  RealScene scene;
  ASSERT_NO_FATAL_FAILURE(read(relative, 0.005, scene));
  const RayDepth rays(scene.triangles);
  const std::vector<RenderView> views = viewsIn(scene, rays);
  RenderOptions options = glOptions();
  const RenderImages gl = renderViews(scene.library, options, views);
  options.backend = RenderBackend::kSoft;
  const RenderImages soft = renderViews(scene.library, options, views);
  double color = 0;
  std::size_t far = 0;
  for (std::size_t n = 0; n < gl.color.size(); ++n) {
    // Alpha tells only whether something is drawn.
    if (n % 4 != 3) color += std::abs(gl.color[n] - soft.color[n]);
  }
  for (std::size_t n = 0; n < gl.depth.size(); ++n) {
    far += isSame(gl.depth[n], soft.depth[n]) ? 0U : 1U;
  }
  const auto pixels = static_cast<double>(gl.depth.size());
  std::printf("%s: mean color difference %.4f of 255, depth off on %.5f %%\n", relative.c_str(),
              color / (3 * pixels), 100 * static_cast<double>(far) / pixels);
  EXPECT_LT(color / (3 * pixels), kMeanColor);
  EXPECT_LT(static_cast<double>(far) / pixels, kDeepShare);
}

TEST(RealImages, OfBothBackendsAgree) {
  GALACTIC_SKIP_WITHOUT_GL();
  if (!hasAsset(kApartmentStage) || !hasAsset(kScannedRoom)) {
    GTEST_SKIP() << "the sc1 stage and the scanned room are not on this machine";
  }
  for (const char* scene : {kApartmentStage, kScannedRoom}) expectAgreement(scene);
}

}  // namespace
}  // namespace galactic::test::real_images_test
