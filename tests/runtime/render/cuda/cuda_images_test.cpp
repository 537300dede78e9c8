// The images of the cuda backend's kernels, run on the processor, against those of `soft`: every
// bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "drawn_by_kernels.h"
#include "runtime/render/mixed_models.h"
#include "support/packs/render_model_builder.h"

namespace galactic::test::cuda_images_test {
namespace {

RenderOptions imageOptions(std::uint32_t width, std::uint32_t height) {
  RenderOptions options;
  options.width = width;
  options.height = height;
  options.semantics = true;
  options.background = 0x11223344;
  return options;
}

/// Clutter with everything that a pack can have: textures, masks, colors, light, flat surfaces,
/// both kinds of sides; triangles from hair to walls, and some without any area.
class CudaImages : public testing::Test {
 protected:
  static constexpr std::uint32_t kSeed = 16016;
  static constexpr std::size_t kViews = 10;

  void SetUp() override {
    if (!hasKernels()) GTEST_SKIP() << "built without the kernels";
    resetStandin();
    for (int pack = 0; pack < 3; ++pack) addPack(pack);
    instances_.resize(kViews);
    views_.resize(kViews);
    for (std::size_t n = 0; n < kViews; ++n) {
      for (std::uint32_t m = 0; m < 12; ++m) {
        instances_[n].push_back(
            {(m * 7 + static_cast<std::uint32_t>(n)) % 9, rigidTransform(randomPose(2.5F))});
      }
      views_[n].camera.world_from_camera = rigidTransform(randomPose(3.5F));
      views_[n].camera.vertical_fov = radians(uniform(random_, 30, 120));
      views_[n].instances = instances_[n];
    }
  }

  void addPack(int pack) {
    RenderModelBuilder builder(1.0F / 1024);
    std::vector<std::uint16_t> materials = {builder.material(0xFF30A0F0)};
    for (const float cutoff : {0.0F, 0.4F}) {
      std::vector<std::uint32_t> texels(std::size_t{64} * 64);
      for (std::uint32_t& texel : texels) texel = static_cast<std::uint32_t>(random_());
      materials.push_back(builder.material(0, builder.texture(64, texels), cutoff));
    }
    builder.semantic("other");
    if (pack != 0) builder.keepColors();
    for (const float reach : {3.0F, 1.0F, 0.3F}) {
      builder.model();
      for (int n = 0; n < 180; ++n) {
        addTriangle(builder, reach, materials[static_cast<std::size_t>(n / 20) % 3], pack == 2);
      }
    }
    builder.finish();
    builders_.push_back(std::move(builder));
    library_.add(builders_.back().meshes());
  }

  Pose randomPose(float reach) {
    const auto place = [&] { return uniform(random_, -reach, reach); };
    return {{place(), place(), place()}, randomRotation(random_)};
  }

  void addTriangle(RenderModelBuilder& builder, float reach, std::uint16_t material, bool gray) {
    const auto place = [&](float size) {
      return Vec3{uniform(random_, -size, size), uniform(random_, -size, size),
                  uniform(random_, -size, size)};
    };
    const Vec3 center = place(reach);
    const float size = reach * std::exp(uniform(random_, -5, 0));
    std::array<RenderVertex, 3> corners;
    for (RenderVertex& corner : corners) {
      const auto shade = static_cast<std::uint32_t>(random_()) & 0xFFU;
      const std::uint32_t color = gray ? 0xFF000000U | shade << 16U | shade << 8U | shade
                                       : static_cast<std::uint32_t>(random_());
      corner = {center + place(size), uniform(random_, 0, 3), uniform(random_, 0, 3), color};
    }
    if (random_() % 16 == 0) corners[2] = corners[random_() % 2];
    builder.triangle(corners, {.material = material,
                               .semantic = static_cast<std::uint16_t>(random_() % 2),
                               .two_sided = random_() % 4 != 0});
  }

  void expectEqualToSoft(const RenderOptions& options) {
    const RenderImages soft = drawWithSoft(library_, options, views_);
    const RenderImages kernels = drawWithKernels(library_, options, views_);
    EXPECT_EQ(soft.depth, kernels.depth);
    EXPECT_EQ(soft.semantics, kernels.semantics);
    EXPECT_EQ(soft.color, kernels.color);
  }

  std::mt19937 random_{kSeed};
  std::vector<RenderModelBuilder> builders_;
  RenderLibrary library_;
  std::vector<std::vector<RenderInstance>> instances_;
  std::vector<RenderView> views_;
};

TEST_F(CudaImages, ShowTrianglesAndBackground) {
  const RenderImages images = drawWithKernels(library_, imageOptions(128, 128), views_);
  std::size_t drawn = 0;
  for (const float depth : images.depth) drawn += depth > 0 ? 1U : 0U;
  EXPECT_GT(drawn, images.depth.size() / 10);
  EXPECT_LT(drawn, images.depth.size() * 9 / 10);
}

TEST_F(CudaImages, EqualThoseOfSoftInAnySize) {
  for (const auto& [width, height] : std::vector<std::pair<std::uint32_t, std::uint32_t>>{
           {128, 128}, {64, 64}, {1, 1}, {61, 90}, {300, 270}}) {
    SCOPED_TRACE(testing::Message() << width << " x " << height);
    expectEqualToSoft(imageOptions(width, height));
  }
}

TEST_F(CudaImages, EqualThoseOfSoftWithAnyImagesLeftOut) {
  RenderOptions options = imageOptions(64, 64);
  options.color = ColorFormat::kRgb8;
  expectEqualToSoft(options);
  options.color = ColorFormat::kNone;
  expectEqualToSoft(options);
  options.depth = false;
  expectEqualToSoft(options);
  options = imageOptions(64, 64);
  options.semantics = false;
  expectEqualToSoft(options);
}

TEST_F(CudaImages, EqualThoseOfSoftAtAnyNearPlane) {
  for (const float near : {0.001F, 0.3F, 2.0F}) {
    RenderOptions options = imageOptions(64, 64);
    options.near = near;
    expectEqualToSoft(options);
  }
}

TEST_F(CudaImages, DoNotDependOnCulling) {
  RenderOptions options = imageOptions(96, 96);
  const RenderImages culled = drawWithKernels(library_, options, views_);
  options.culling = false;
  EXPECT_EQ(culled, drawWithKernels(library_, options, views_));
}

TEST_F(CudaImages, OfPosedAndAttachedModelsEqualThoseOfInstances) {
  views_[4].camera.vertical_fov = 0;
  const MixedModels models(random_, 9, views_);
  const RenderOptions options = imageOptions(96, 80);
  const RenderImages soft = drawWithSoft(library_, options, models.asInstances());
  EXPECT_EQ(drawWithKernels(library_, options, models.asInstances()), soft);
  EXPECT_EQ(drawWithKernels(library_, options, models.mixed()), soft);
  // Slices of few views.
  EXPECT_EQ(drawWithKernels(library_, options, models.mixed(), 200'000), soft);
  const RenderImages numbered = drawWithSoft(library_, options, models.numbered());
  EXPECT_NE(numbered, soft);
  EXPECT_EQ(drawWithKernels(library_, options, models.numbered()), numbered);
  RenderOptions ids_alone = options;
  ids_alone.color = ColorFormat::kNone;
  EXPECT_EQ(drawWithKernels(library_, ids_alone, models.numbered()).semantics, numbered.semantics);
}

TEST_F(CudaImages, DoNotDependOnBlocksThreadsAndTheirOrder) {
  const RenderOptions options = imageOptions(80, 72);
  const RenderImages images = drawWithKernels(library_, options, views_);
  Standin& standin = resetStandin();
  for (const std::uint32_t threads : {8U, 32U, 256U}) {
    standin.threads = threads;
    EXPECT_EQ(images, drawWithKernels(library_, options, views_)) << threads;
  }
  standin.threads = 128;
  standin.stride = 77;
  standin.first = 31;
  standin.backwards = true;
  EXPECT_EQ(images, drawWithKernels(library_, options, views_));
}

TEST_F(CudaImages, DoNotDependOnHowTheBatchIsCut) {
  const RenderOptions options = imageOptions(72, 80);
  const RenderImages images = drawWithKernels(library_, options, views_);
  for (const std::size_t bytes : {std::size_t{1}, std::size_t{200'000}}) {
    auto engine = makeEngine(library_, options, bytes);
    ASSERT_TRUE(engine) << engine.error().message;
    RenderImages cut = emptyImages(options, views_.size());
    (*engine)->begin(views_, targetsOf(cut));
    (*engine)->end();
    EXPECT_GT((*engine)->sliceCount(), 1U);
    EXPECT_EQ(images, cut);
  }
}

TEST_F(CudaImages, ShowNothingWhereTheCameraIsNone) {
  views_[3].camera.vertical_fov = 0;
  views_[4].camera.world_from_camera.origin.x = std::numeric_limits<float>::infinity();
  views_[5].instances = {};
  instances_[6][0].world_from_model.origin.x = std::numeric_limits<float>::quiet_NaN();
  expectEqualToSoft(imageOptions(40, 40));
}

TEST_F(CudaImages, OfThousandsOfTinyTrianglesAndOfHugeOnesEqualThoseOfSoft) {
  RenderModelBuilder builder(1.0F / 1024);
  const auto floor = [&](float height, int cells, float half) {
    builder.model();
    const float cell = 2 * half / static_cast<float>(cells);
    for (int n = 0; n < cells * cells; ++n) {
      const float x = static_cast<float>(n % cells) * cell - half;
      const int row = n / cells;
      const float z = static_cast<float>(row) * cell - half;
      builder.quad({{{x, height, z},
                     {x, height, z + cell},
                     {x + cell, height, z + cell},
                     {x + cell, height, z}}},
                   {.two_sided = n % 2 == 0});
    }
  };
  floor(-1, 90, 4);
  floor(1, 2, 30);
  builder.finish();
  RenderLibrary library;
  library.add(builder.meshes());
  const std::array<RenderInstance, 3> instances{RenderInstance{0, {}}, RenderInstance{1, {}},
                                                RenderInstance{1, {.origin = {0, -2.5F, 0}}}};
  std::vector<RenderView> views(4);
  for (RenderView& view : views) {
    view.camera.world_from_camera = rigidTransform({{0, 0, 0}, randomRotation(random_)});
    view.instances = instances;
  }
  const RenderOptions options = imageOptions(128, 128);
  EXPECT_EQ(drawWithSoft(library, options, views), drawWithKernels(library, options, views));
}

/// How many triangles need more than one thread: those that reach over 64 pixels, and those that
/// the near plane cuts.
struct LargeAndCut {
  int large = 0;
  int cut = 0;
};

LargeAndCut countLarge(const std::vector<std::array<Vec3, 3>>& triangles, const RenderView& view,
                       const RenderOptions& options) {
  const RigidTransform camera_from_world = inverse(view.camera.world_from_camera);
  const float focal =
      static_cast<float>(options.height) / 2 / std::tan(view.camera.vertical_fov / 2);
  LargeAndCut counts;
  for (const auto& triangle : triangles) {
    int in_front = 0;
    std::array<float, 2> low{1e9F, 1e9F};
    std::array<float, 2> high{-1e9F, -1e9F};
    for (const Vec3& corner : triangle) {
      const Vec3 at = camera_from_world * corner;
      if (at.x < options.near) continue;
      ++in_front;
      const std::array<float, 2> pixel{focal * at.z / at.x, focal * at.y / at.x};
      for (std::size_t n = 0; n < 2; ++n) {
        low[n] = std::min(low[n], pixel[n]);
        high[n] = std::max(high[n], pixel[n]);
      }
    }
    counts.cut += in_front == 1 || in_front == 2 ? 1 : 0;
    const bool is_large = high[0] - low[0] > 65 || high[1] - low[1] > 65;
    counts.large += in_front == 3 && is_large ? 1 : 0;
  }
  return counts;
}

TEST_F(CudaImages, OfMoreLargeAndClippedTrianglesThanAreDrawnTogetherEqualThoseOfSoft) {
  // Few corners, so that all triangles are in one cluster.
  std::vector<Vec3> corners(40);
  for (Vec3& corner : corners) {
    corner = {uniform(random_, -4, 4), uniform(random_, -4, 4), uniform(random_, -4, 4)};
  }
  RenderModelBuilder builder(1.0F / 1024);
  builder.model();
  std::vector<std::array<Vec3, 3>> triangles(120);
  for (auto& triangle : triangles) {
    std::array<RenderVertex, 3> vertices;
    for (std::size_t n = 0; n < 3; ++n) {
      triangle[n] = corners[random_() % corners.size()];
      vertices[n] = {triangle[n], 0, 0, 0xFFFFFFFF};
    }
    builder.triangle(vertices, {.two_sided = true});
  }
  builder.finish();
  RenderLibrary library;
  library.add(builder.meshes());
  ASSERT_EQ(builder.meshes().clusters.size(), 1U);
  const std::array<RenderInstance, 1> instances{RenderInstance{0, {}}};
  const RenderOptions options = imageOptions(200, 160);
  std::vector<RenderView> views(8);
  int many_large = 0;
  int many_cut = 0;
  for (RenderView& view : views) {
    view.camera.world_from_camera = rigidTransform(randomPose(4));
    view.instances = instances;
    const LargeAndCut counts = countLarge(triangles, view, options);
    many_large += counts.large > 48 ? 1 : 0;
    many_cut += counts.cut > 8 ? 1 : 0;
  }
  EXPECT_GT(many_large, 0);
  EXPECT_GT(many_cut, 0);
  EXPECT_EQ(drawWithSoft(library, options, views), drawWithKernels(library, options, views));
}

}  // namespace
}  // namespace galactic::test::cuda_images_test
