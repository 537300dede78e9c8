// Batches, threads, processors, cameras that see nothing, and what a renderer says of itself.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "render/soft/soft_engine.h"
#include "runtime/render/mixed_models.h"
#include "support/packs/render_model_builder.h"
#include "support/processor.h"
#include "support/render_images.h"

namespace galactic::test::soft_batch_test {
namespace {

constexpr std::uint32_t kBackground = 0x11223344;

RenderOptions batchOptions(std::uint32_t width, std::uint32_t height, std::uint32_t threads = 1) {
  RenderOptions options;
  options.width = width;
  options.height = height;
  options.semantics = true;
  options.backend = RenderBackend::kSoft;
  options.threads = threads;
  options.background = kBackground;
  return options;
}

/// Clutter with everything that a pack can have: textures, masks, colors, flat surfaces, both
/// kinds of sides, large and small triangles.
class SoftBatch : public testing::Test {
 protected:
  static constexpr std::uint32_t kSeed = 8001;

  void SetUp() override {
    for (int pack = 0; pack < 2; ++pack) {
      RenderModelBuilder builder(1.0F / 1024);
      std::vector<std::uint16_t> materials = {builder.material(0xFF30A0F0)};
      for (const float cutoff : {0.0F, 0.4F}) {
        std::vector<std::uint32_t> texels(64 * 64);
        for (std::uint32_t& texel : texels) texel = static_cast<std::uint32_t>(random_());
        materials.push_back(builder.material(0, builder.texture(64, texels), cutoff));
      }
      builder.semantic("other");
      if (pack == 1) builder.keepColors();
      for (const float reach : {4.0F, 0.5F}) {
        builder.model();
        for (int n = 0; n < 180; ++n) {
          addTriangle(builder, reach, materials[static_cast<std::size_t>(n / 20) % 3]);
        }
      }
      builder.finish();
      builders_.push_back(std::move(builder));
      library_.add(builders_.back().meshes());
    }
    instances_.resize(kViews);
    for (std::vector<RenderInstance>& instances : instances_) {
      for (std::uint32_t n = 0; n < 20; ++n) {
        instances.push_back({n == 0 ? 0 : 1 + n % 3, rigidTransform(randomPose(3))});
      }
    }
    views_.resize(kViews);
    for (std::size_t n = 0; n < kViews; ++n) {
      views_[n].camera.world_from_camera = rigidTransform(randomPose(6));
      views_[n].camera.vertical_fov = radians(uniform(random_, 30, 120));
      views_[n].instances = instances_[n];
    }
  }

  Pose randomPose(float reach) {
    const auto place = [&] { return uniform(random_, -reach, reach); };
    return {{place(), place(), place()}, randomRotation(random_)};
  }

  void addTriangle(RenderModelBuilder& builder, float reach, std::uint16_t material) {
    const auto place = [&](float size) {
      return Vec3{uniform(random_, -size, size), uniform(random_, -size, size),
                  uniform(random_, -size, size)};
    };
    const Vec3 center = place(reach);
    const float size = reach * std::exp(uniform(random_, -4, 0));
    std::array<RenderVertex, 3> corners;
    for (RenderVertex& corner : corners) {
      corner = {center + place(size), uniform(random_, 0, 3), uniform(random_, 0, 3),
                static_cast<std::uint32_t>(random_())};
    }
    builder.triangle(corners, {.material = material,
                               .semantic = static_cast<std::uint16_t>(random_() % 2),
                               .two_sided = random_() % 4 != 0});
  }

  RenderImages drawWith(const RenderOptions& options, render::DrawPane draw) {
    render::SoftEngine engine(library_, options, draw);
    RenderImages images = emptyImages(options, views_.size());
    engine.begin(views_, targetsOf(images));
    engine.end();
    return images;
  }

  static constexpr std::size_t kViews = 24;
  std::mt19937 random_{kSeed};
  std::vector<RenderModelBuilder> builders_;
  RenderLibrary library_;
  std::vector<std::vector<RenderInstance>> instances_;
  std::vector<RenderView> views_;
};

TEST_F(SoftBatch, ShowsTriangleEdgesAndBackground) {
  const RenderImages images = renderViews(library_, batchOptions(128, 128), views_);
  std::size_t drawn = 0;
  for (const float depth : images.depth) drawn += depth > 0 ? 1U : 0U;
  EXPECT_GT(drawn, images.depth.size() / 10);
  EXPECT_LT(drawn, images.depth.size() * 9 / 10);
}

TEST_F(SoftBatch, GivesTheImagesOfItsViewsOneByOne) {
  for (const auto& [width, height] : {std::pair{128U, 128U}, {61U, 90U}}) {
    BatchRenderer renderer = makeRenderer(library_, batchOptions(width, height));
    const RenderImages together = renderViews(renderer, views_);
    const std::size_t pixels = std::size_t{width} * height;
    for (std::size_t n = 0; n < kViews; ++n) {
      const RenderImages one = renderViews(renderer, {&views_[n], 1});
      for (std::size_t p = 0; p < pixels; ++p) {
        ASSERT_EQ(one.depth[p], together.depth[n * pixels + p]);
        ASSERT_EQ(one.semantics[p], together.semantics[n * pixels + p]);
        for (std::size_t c = 0; c < 4; ++c) {
          ASSERT_EQ(one.color[4 * p + c], together.color[4 * (n * pixels + p) + c]);
        }
      }
    }
  }
}

TEST_F(SoftBatch, DoesNotDependOnTheNumberOfThreads) {
  for (const auto& [width, height] : {std::pair{128U, 128U}, {300U, 40U}}) {
    const RenderImages one = renderViews(library_, batchOptions(width, height, 1), views_);
    for (const std::uint32_t threads : {2U, 7U}) {
      BatchRenderer renderer = makeRenderer(library_, batchOptions(width, height, threads));
      for (int round = 0; round < 3; ++round) {
        EXPECT_EQ(renderViews(renderer, views_), one) << threads << " threads";
      }
    }
  }
}

TEST_F(SoftBatch, IsTheSameOnEveryProcessor) {
  if (!detail::hasAvx2()) GTEST_SKIP() << "this processor has no AVX2";
  // Widths that end within each of the blocks that are resolved together, and beside them.
  for (const bool culling : {true, false}) {
    for (const auto& [width, height] :
         {std::pair{128U, 128U}, {61U, 90U}, {59U, 7U}, {52U, 8U}, {270U, 9U}, {1U, 1U}}) {
      RenderOptions options = batchOptions(width, height);
      options.culling = culling;
      const RenderImages portable = drawWith(options, render::drawPanePortable);
      EXPECT_EQ(drawWith(options, render::drawPaneAvx2), portable) << width << " x " << height;
      if (!detail::hasAvx512()) continue;
      EXPECT_EQ(drawWith(options, render::drawPaneAvx512), portable) << width << " x " << height;
    }
  }
}

TEST_F(SoftBatch, DrawsPosedAndAttachedModelsAsInstances) {
  const MixedModels models(random_, 4, views_);
  const RenderOptions options = batchOptions(96, 80);
  const RenderImages images = renderViews(library_, options, models.asInstances());
  EXPECT_EQ(renderViews(library_, options, models.mixed()), images);
}

TEST_F(SoftBatch, NumbersPosedModelsThatHaveNumbers) {
  const MixedModels models(random_, 4, views_);
  expectNumbers(models, [this](const std::vector<RenderView>& views) {
    return renderViews(library_, batchOptions(96, 80), views);
  });
}

TEST_F(SoftBatch, DrawsWithoutCullingTheSameImages) {
  RenderOptions options = batchOptions(128, 128);
  const RenderImages with = renderViews(library_, options, views_);
  options.culling = false;
  EXPECT_EQ(renderViews(library_, options, views_), with);
}

TEST_F(SoftBatch, OfAnySizeDrawsAllPixelsAndNoOthers) {
  for (const auto& [width, height] :
       {std::pair{1U, 1U}, {2U, 3U}, {8U, 8U}, {9U, 7U}, {257U, 3U}, {1U, 600U}, {4096U, 1U}}) {
    const RenderOptions options = batchOptions(width, height);
    const RenderImages images = renderViews(library_, options, {views_.data(), 3});
    for (const float depth : images.depth) ASSERT_GE(depth, 0);
    for (const std::uint32_t id : images.semantics) {
      ASSERT_LT(id, library_.semanticNames().size());
    }
  }
}

TEST_F(SoftBatch, ALargeImageShowsWhatASmallOneShows) {
  // Every fourth pixel of four times the edge lies at most 3/8 of a small pixel beside its own.
  const RenderImages small = renderViews(library_, batchOptions(128, 128), {views_.data(), 8});
  const RenderImages large = renderViews(library_, batchOptions(512, 512), {views_.data(), 8});
  std::size_t same = 0;
  for (std::size_t n = 0; n < small.depth.size(); ++n) {
    const std::size_t x = n % 128;
    const std::size_t y = n / 128;
    const float near_it = large.depth[(4 * y + 2) * 512 + 4 * x + 2];
    same += std::abs(near_it - small.depth[n]) <= 0.02F * small.depth[n] ? 1U : 0U;
  }
  EXPECT_GT(same, small.depth.size() * 9 / 10);
}

TEST_F(SoftBatch, SeesNothingThroughCamerasWithoutMeaning) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinite = std::numeric_limits<float>::infinity();
  std::vector<RenderView> views(9, views_[0]);
  views[0].camera.vertical_fov = kNan;
  views[1].camera.vertical_fov = 0;
  views[2].camera.vertical_fov = 3.15F;
  views[3].camera.vertical_fov = -1;
  views[4].camera.world_from_camera.origin.x = kNan;
  views[5].camera.world_from_camera.y_axis.z = kInfinite;
  views[6].camera.world_from_camera.origin.z = -kInfinite;
  views[7].instances = {};
  std::vector<RenderInstance> broken = instances_[0];
  for (RenderInstance& instance : broken) instance.world_from_model.x_axis.y = kNan;
  views[8].instances = broken;
  const RenderImages images = renderViews(library_, batchOptions(64, 64), views);
  for (const float depth : images.depth) ASSERT_EQ(depth, 0);
  for (const std::uint32_t id : images.semantics) ASSERT_EQ(id, 0U);
  for (std::size_t n = 0; n < images.color.size(); n += 4) {
    ASSERT_EQ(images.color[n], kBackground & 0xFFU);
    ASSERT_EQ(images.color[n + 3], kBackground >> 24U);
  }
}

TEST_F(SoftBatch, SurvivesNumbersOfAnySize) {
  constexpr float kHuge = std::numeric_limits<float>::max();
  std::vector<RenderView> views;
  std::vector<std::vector<RenderInstance>> instances;
  instances.reserve(200);
  for (int n = 0; n < 200; ++n) {
    instances.push_back(instances_[0]);
    const auto number = [&] {
      const float size = std::exp(uniform(random_, -80, 88));
      return random_() % 5 == 0   ? 0
             : random_() % 7 == 0 ? kHuge
             : random_() % 2 == 0 ? size
                                  : -size;
    };
    const auto vector = [&] { return Vec3{number(), number(), number()}; };
    RenderView view = views_[0];
    if (n % 2 == 0) view.camera.world_from_camera = {vector(), vector(), vector(), vector()};
    for (RenderInstance& instance : instances.back()) {
      if (random_() % 2 == 0) instance.world_from_model = {vector(), vector(), vector(), vector()};
    }
    view.camera.vertical_fov = std::min(3.14159F, std::exp(uniform(random_, -80, 1)));
    view.instances = instances.back();
    views.push_back(view);
  }
  RenderOptions options = batchOptions(64, 48);
  for (const float near : {1e-30F, 0.05F, 1e30F}) {
    options.near = near;
    const RenderImages images = renderViews(library_, options, views);
    for (const std::uint32_t id : images.semantics) {
      ASSERT_LT(id, library_.semanticNames().size());
    }
  }
}

TEST_F(SoftBatch, DrawsWhileTheCallerDoesSomethingElse) {
  BatchRenderer renderer = makeRenderer(library_, batchOptions(96, 96, 2));
  const RenderImages expected = renderViews(renderer, views_);
  RenderImages images = emptyImages(renderer.options(), views_.size());
  for (int round = 0; round < 5; ++round) {
    renderer.beginRender(views_, targetsOf(images));
    std::uint64_t sum = 0;
    for (std::uint64_t n = 0; n < 1000; ++n) sum += n * n;
    EXPECT_GT(sum, 0U);
    renderer.endRender();
    EXPECT_EQ(images, expected);
  }
}

TEST_F(SoftBatch, CountsWhatItDrew) {
  RenderOptions options = batchOptions(128, 128);
  options.culling = false;
  BatchRenderer renderer = makeRenderer(library_, options);
  const RenderImages images = renderViews(renderer, views_);
  const RenderStatistics all = renderer.statistics();
  EXPECT_EQ(all.instances, kViews * 20);
  EXPECT_EQ(all.clusters, all.clusters_drawn);
  EXPECT_GT(all.triangles_drawn, 0U);
  // Of each batch anew.
  renderViews(renderer, views_);
  EXPECT_EQ(renderer.statistics().instances, all.instances);
  EXPECT_EQ(renderer.statistics().clusters, all.clusters);
  EXPECT_EQ(renderer.statistics().clusters_drawn, all.clusters_drawn);
  EXPECT_EQ(renderer.statistics().triangles_drawn, all.triangles_drawn);
  options.culling = true;
  options.threads = 3;
  BatchRenderer culling = makeRenderer(library_, options);
  const RenderImages same = renderViews(culling, views_);
  EXPECT_EQ(culling.statistics().clusters, all.clusters);
  EXPECT_LT(culling.statistics().clusters_drawn, all.clusters_drawn);
  EXPECT_LE(culling.statistics().triangles_drawn, all.triangles_drawn);
}

/// FNV-1a.
template <class T>
std::uint64_t digest(const std::vector<T>& values) {
  std::uint64_t hash = 0xCBF29CE484222325U;
  const auto* bytes = reinterpret_cast<const unsigned char*>(values.data());
  for (std::size_t n = 0; n < values.size() * sizeof(T); ++n) {
    hash = (hash ^ bytes[n]) * 0x100000001B3U;
  }
  return hash;
}

TEST_F(SoftBatch, DrawsTheBytesThatItHasAlwaysDrawn) {
  // Cameras by division alone, so that no mathematical library has a say in the views.
  std::vector<RenderInstance> instances = {{0, {}}, {3, {.origin = {1.5F, 0.25F, -0.5F}}}};
  std::vector<RenderView> views(4);
  for (std::size_t n = 0; n < views.size(); ++n) {
    const auto x = static_cast<float>(n);
    views[n].camera.world_from_camera = {
        {0.6F, 0, 0.8F}, {0, 1, 0}, {-0.8F, 0, 0.6F}, {-4 + x, 0.5F - 0.25F * x, -3}};
    views[n].camera.vertical_fov = 1 + 0.25F * x;
    views[n].instances = instances;
  }
  const RenderImages images = renderViews(library_, batchOptions(100, 75), views);
  // When a change is meant to change images, look at them, then write the new numbers here.
  EXPECT_EQ(digest(images.color), 18292753853555835599U);
  EXPECT_EQ(digest(images.depth), 892410985143664461U);
  EXPECT_EQ(digest(images.semantics), 12286742099158423379U);
}

TEST_F(SoftBatch, AFullListOfRecordsChangesNothing) {
  // More triangles in sight than there are records: a wall of triangles a few pixels large in front
  // of another, the farther one drawn first as a model of its own that begins nearer.
  RenderModelBuilder builder(1.0F / 4096);
  const std::uint16_t green = builder.material(0xFF00FF00);
  builder.keepColors();
  builder.model();
  constexpr int kParts = 150;
  for (int wall = 0; wall < 3; ++wall) {
    for (int n = 0; n < kParts; ++n) {
      for (int m = 0; m < kParts; ++m) {
        const auto at = [&](int a, int b) {
          const auto place = [](int k) { return 4.0F * static_cast<float>(k) / kParts - 2; };
          const auto shade = static_cast<std::uint32_t>(random_() % 256);
          return RenderVertex{{2 - 0.02F * static_cast<float>(wall), place(b), place(a)},
                              0,
                              0,
                              shade << 8U | 0xFF000000U};
        };
        const RenderVertex a = at(n, m);
        const RenderVertex b = at(n + 1, m);
        const RenderVertex c = at(n + 1, m + 1);
        const RenderVertex d = at(n, m + 1);
        builder.triangle({a, b, c}, {.material = green});
        builder.triangle({a, c, d}, {.material = green});
      }
    }
  }
  builder.finish();
  RenderLibrary library;
  library.add(builder.meshes());
  const std::vector<RenderInstance> instances = {{0, {}}};
  std::vector<RenderView> views(2, RenderView{{}, instances});
  RenderOptions options = batchOptions(256, 256);
  options.culling = false;
  const RenderImages images = renderViews(library, options, views);
  // The nearest wall alone, with the same colors.
  options.culling = true;
  EXPECT_EQ(renderViews(library, options, views), images);
  for (std::size_t n = 0; n < images.depth.size(); ++n) {
    ASSERT_NEAR(images.depth[n], 1.96F, 1e-3F) << n;
    ASSERT_EQ(images.semantics[n], 1U);
    ASSERT_EQ(images.color[4 * n], 0);
    ASSERT_EQ(images.color[4 * n + 3], 255);
  }
}

TEST(SoftRenderer, SaysWhatItIs) {
  RenderModelBuilder builder;
  builder.model();
  builder.finish();
  RenderLibrary library;
  library.add(builder.meshes());
  const BatchRenderer renderer = makeRenderer(library, batchOptions(8, 8, 2));
  EXPECT_EQ(renderer.backend(), RenderBackend::kSoft);
  EXPECT_THAT(renderer.description(), testing::StartsWith("soft, "));
  EXPECT_THAT(renderer.description(), testing::EndsWith(", 2 threads"));
}

TEST(SoftRenderer, RefusesOptionsOutOfRange) {
  const RenderLibrary library;
  const auto message = [&](const RenderOptions& options) {
    const Result<BatchRenderer> made = BatchRenderer::create(library, options);
    return made ? std::string("none") : made.error().message;
  };
  RenderOptions options = batchOptions(0, 128);
  EXPECT_EQ(message(options), "found images of 0 x 128 pixels; expected 1 to 4096 each");
  options = batchOptions(128, 4097);
  EXPECT_EQ(message(options), "found images of 128 x 4097 pixels; expected 1 to 4096 each");
  options = batchOptions(128, 128);
  options.near = 0;
  EXPECT_EQ(message(options), "found a near plane at 0.000000 m; expected a distance above 0");
  options = batchOptions(128, 128);
  options.color = ColorFormat::kNone;
  options.depth = options.semantics = false;
  EXPECT_EQ(message(options), "found no image to make; expected color, depth or semantics");
  options = batchOptions(128, 128);
  options.color = static_cast<ColorFormat>(7);
  EXPECT_EQ(message(options), "found the color format 7; expected one of ColorFormat: 0, 3 or 4");
  options = batchOptions(128, 128);
  options.backend = static_cast<RenderBackend>(9);
  EXPECT_EQ(message(options), "found the backend 9; expected one of RenderBackend: 0 to 3");
}

}  // namespace
}  // namespace galactic::test::soft_batch_test
