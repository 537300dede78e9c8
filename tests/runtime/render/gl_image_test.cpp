// What the OpenGL backend draws, on the software driver.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <numbers>
#include <random>

#include "render/gl/gl_engine.h"
#include "runtime/render/gl_scene.h"
#include "runtime/render/mixed_models.h"

namespace galactic::test::gl_image_test {
namespace {

/// Depths are near / x in 32-bit floats, interpolated by the driver.
constexpr float kDepthTolerance = 1e-3F;

class GlImage : public testing::Test {
 protected:
  void SetUp() override {
    static const std::string obstacle = glObstacle();
    if (!obstacle.empty()) GTEST_SKIP() << obstacle;
  }

  /// The images of an engine made with choices of its own.
  static RenderImages renderTuned(const RenderLibrary& library, const RenderOptions& options,
                                  const render::gl::GlTuning& tuning,
                                  std::span<const RenderView> views,
                                  RenderStatistics* statistics = nullptr) {
    auto engine = render::gl::GlEngine::make(library, options, tuning, render::gl::loadsLibrary);
    if (!engine) throw std::runtime_error(engine.error().message);
    RenderImages images = emptyImages(options, views.size());
    (*engine)->begin(views, targetsOf(images));
    (*engine)->end();
    if (statistics != nullptr) *statistics = (*engine)->statistics();
    return images;
  }
};

RenderOptions allImages() {
  RenderOptions options = glOptions();
  options.semantics = true;
  return options;
}

/// A library of one model, and the builder that owns it.
struct OneModel {
  RenderModelBuilder builder;
  RenderLibrary library;
  std::vector<RenderInstance> instances{{0, {}}};

  void finish() {
    builder.finish();
    library.add(builder.meshes());
  }
  [[nodiscard]] RenderView view(const RenderCamera& camera) const { return {camera, instances}; }
};

std::uint32_t pixelOf(const RenderImages& images, std::size_t pixel) {
  std::uint32_t color = 0;
  std::memcpy(&color, images.color.data() + 4 * pixel, sizeof(color));
  return color;
}

TEST_F(GlImage, AWallHasItsDistanceInEveryPixelAtAnyFieldOfView) {
  OneModel wall;
  wall.builder.model();
  addWall(wall.builder, 2, 7);
  wall.finish();
  for (const float fov : {40.0F, 60.0F, 90.0F, 120.0F}) {
    const std::vector<RenderView> views{wall.view(cameraAt({0, 0, 0}, 0, 0, fov)),
                                        wall.view(cameraAt({-0.5F, 0.1F, 0.2F}, 0, 0, fov))};
    const RenderImages images = renderViews(wall.library, glOptions(), views);
    const std::size_t half = images.depth.size() / 2;
    for (std::size_t i = 0; i < half; ++i) {
      ASSERT_NEAR(images.depth[i], 2, kDepthTolerance) << fov << " degrees, pixel " << i;
      ASSERT_NEAR(images.depth[half + i], 2.5F, kDepthTolerance) << i;
    }
  }
}

TEST_F(GlImage, ASphereHasItsDepthAwayFromItsEdge) {
  OneModel ball;
  ball.builder = RenderModelBuilder(1.0F / 16384);
  ball.builder.model();
  constexpr int kRings = 200;
  const auto at = [](int ring, int turn) {
    const double a = std::numbers::pi * ring / kRings;
    const double b = 2 * std::numbers::pi * turn / kRings;
    return Vec3{static_cast<float>(std::sin(a) * std::cos(b)), static_cast<float>(std::cos(a)),
                static_cast<float>(-std::sin(a) * std::sin(b))};
  };
  for (int ring = 0; ring < kRings; ++ring) {
    for (int turn = 0; turn < kRings; ++turn) {
      ball.builder.quad(
          {{at(ring, turn), at(ring + 1, turn), at(ring + 1, turn + 1), at(ring, turn + 1)}});
    }
  }
  ball.finish();
  const std::vector<RenderView> views{ball.view(cameraAt({-3, 0, 0}, 0, 0, 60))};
  const RenderImages images = renderViews(ball.library, glOptions(), views);
  std::size_t seen = 0;
  for (std::size_t i = 0; i < images.depth.size(); ++i) {
    const double focal = 64 / std::tan(std::numbers::pi / 6);
    const double right = (static_cast<double>(i % 128) + 0.5 - 64) / focal;
    const double up = (64 - (static_cast<double>(i / 128) + 0.5)) / focal;
    // |(-3, 0, 0) + t (1, up, right)| = 1
    const double square = 1 + right * right + up * up;
    const double inner = 9 - 8 * square;
    if (inner < 0.2) continue;
    ++seen;
    // The facets stand inside the sphere, by 1 - cos(pi / 200).
    ASSERT_NEAR(images.depth[i], (3 - std::sqrt(inner)) / square, kDepthTolerance) << i;
  }
  EXPECT_GT(seen, images.depth.size() / 10);
  EXPECT_LT(seen, images.depth.size() * 9 / 10);
}

TEST_F(GlImage, ACheckerboardIsExactWhereATexelIsAPixel) {
  constexpr std::uint32_t kFirst = 0xFF102030;
  constexpr std::uint32_t kSecond = 0xFFF0E0D0;
  OneModel board;
  const std::int32_t texture =
      board.builder.texture(128, GlHome::checkerboard(128, 16, kFirst, kSecond));
  const RenderSurface surface{.material = board.builder.material(0xFFFFFFFF, texture)};
  board.builder.model();
  addWall(board.builder, 1, 1, surface);
  board.finish();
  const std::vector<RenderView> views{board.view(cameraAt({0, 0, 0}))};
  const RenderImages images = renderViews(board.library, glOptions(), views);
  std::map<std::uint32_t, std::size_t> count;
  for (std::size_t i = 0; i < images.depth.size(); ++i) {
    const std::size_t x = i % 128;
    const std::size_t y = i / 128;
    const bool at_edge = x % 8 == 0 || x % 8 == 7 || y % 8 == 0 || y % 8 == 7;
    if (at_edge) continue;
    // Row 0 is the top one, for the texture and for the image.
    ASSERT_EQ(pixelOf(images, i), (x / 8 + y / 8) % 2 == 0 ? kFirst : kSecond) << i;
    ++count[pixelOf(images, i)];
  }
  EXPECT_EQ(count[kFirst], count[kSecond]);
}

TEST_F(GlImage, FarTexturesComeFromSmallerLevels) {
  OneModel board;
  const std::int32_t texture =
      board.builder.texture(256, GlHome::checkerboard(256, 256, 0xFF000000, 0xFFFFFFFF));
  const RenderSurface surface{.material = board.builder.material(0xFFFFFFFF, texture)};
  board.builder.model();
  addWall(board.builder, 1, 1, surface);
  board.finish();
  // Eight texels a pixel: the level in which all are 128.
  const std::vector<RenderView> views{board.view(cameraAt({-3, 0, 0}))};
  const RenderImages images = renderViews(board.library, glOptions(), views);
  EXPECT_EQ(pixelOf(images, 64 * 128 + 64), 0xFF808080);
}

TEST_F(GlImage, CullingDoesNotChangeAnImage) {
  GlHome home;
  const std::vector<RenderView> views = home.views(12);
  RenderOptions options = allImages();
  RenderStatistics culled;
  RenderStatistics whole;
  const RenderImages with = renderTuned(home.library(), options, {}, views, &culled);
  options.culling = false;
  const RenderImages without = renderTuned(home.library(), options, {}, views, &whole);
  EXPECT_EQ(with, without);
  EXPECT_EQ(whole.clusters_drawn, whole.clusters);
  EXPECT_EQ(culled.clusters, whole.clusters);
  EXPECT_EQ(culled.instances, 12U * 21U);
  // Both sides of the question occur.
  EXPECT_GT(culled.clusters_drawn, whole.clusters_drawn / 10);
  EXPECT_LT(culled.clusters_drawn, whole.clusters_drawn * 9 / 10);
  EXPECT_LT(culled.triangles_drawn, whole.triangles_drawn);
}

TEST_F(GlImage, PosedAndAttachedModelsAreDrawnAsInstances) {
  GlHome home;
  std::mt19937 random(31);
  const MixedModels models(random, 5, home.views(10));
  const RenderImages images = renderViews(home.library(), glOptions(), models.asInstances());
  EXPECT_EQ(renderViews(home.library(), glOptions(), models.mixed()), images);
}

TEST_F(GlImage, PosedModelsThatHaveNumbersShowThem) {
  GlHome home;
  std::mt19937 random(32);
  const MixedModels models(random, 5, home.views(10));
  RenderOptions options = glOptions();
  options.semantics = true;
  expectNumbers(models, [&](const std::vector<RenderView>& views) {
    return renderViews(home.library(), options, views);
  });
}

TEST_F(GlImage, ABatchIsItsViewsOneByOne) {
  GlHome home;
  const std::vector<RenderView> views = home.views(7);
  BatchRenderer renderer = makeRenderer(home.library(), allImages());
  const RenderImages batch = renderViews(renderer, views);
  RenderImages singles;
  for (const RenderView& view : views) {
    const RenderImages one = renderViews(renderer, {&view, 1});
    singles.color.insert(singles.color.end(), one.color.begin(), one.color.end());
    singles.depth.insert(singles.depth.end(), one.depth.begin(), one.depth.end());
    singles.semantics.insert(singles.semantics.end(), one.semantics.begin(), one.semantics.end());
  }
  EXPECT_EQ(batch, singles);
  EXPECT_EQ(batch, renderViews(renderer, views));
}

TEST_F(GlImage, RoundsOfAnySizeGiveTheSameImages) {
  GlHome home;
  const std::vector<RenderView> views = home.views(9);
  for (const ColorFormat color : {ColorFormat::kRgba8, ColorFormat::kRgb8}) {
    RenderOptions options = allImages();
    options.width = 61;
    options.height = 37;
    options.color = color;
    const RenderImages whole = renderTuned(home.library(), options, {}, views);
    for (const std::size_t most : {1U, 2U, 4U, 9U}) {
      EXPECT_EQ(renderTuned(home.library(), options, {.most_views = most}, views), whole) << most;
    }
  }
}

TEST_F(GlImage, ImagesOfMorePixelsThanOneRowOfWorkGroupsHasAreWhole) {
  OneModel wall;
  wall.builder.model();
  addWall(wall.builder, 2, 7);
  wall.finish();
  RenderOptions options = glOptions();
  options.color = ColorFormat::kNone;
  options.width = options.height = kLargestImage;
  // Four pixels for each thread, 64 threads for each group: more groups than OpenGL promises to
  // take in one dimension.
  constexpr std::size_t kPromised = 65535;
  ASSERT_GT(std::size_t{options.width} * options.height, 4 * 64 * kPromised);
  const std::vector<RenderView> views{wall.view(cameraAt({0, 0, 0}))};
  const RenderImages images = renderViews(wall.library, options, views);
  const auto is_wall = [](float depth) { return std::abs(depth - 2) < kDepthTolerance; };
  EXPECT_TRUE(std::ranges::all_of(images.depth, is_wall));
}

TEST_F(GlImage, WithoutExtensionsTheImagesAreTheSame) {
  GlHome home;
  const std::vector<RenderView> views = home.views(5);
  EXPECT_EQ(renderTuned(home.library(), allImages(), {.core_only = true}, views),
            renderTuned(home.library(), allImages(), {}, views));
}

TEST_F(GlImage, ThreeBytesAPixelAreTheFirstThreeOfFour) {
  GlHome home;
  const std::vector<RenderView> views = home.views(3);
  RenderOptions options = glOptions();
  options.width = 33;
  options.height = 17;
  const RenderImages four = renderViews(home.library(), options, views);
  options.color = ColorFormat::kRgb8;
  const RenderImages three = renderViews(home.library(), options, views);
  ASSERT_EQ(three.color.size(), four.depth.size() * 3);
  for (std::size_t i = 0; i < three.color.size(); ++i) {
    ASSERT_EQ(three.color[i], four.color[i / 3 * 4 + i % 3]) << i;
  }
  options.color = ColorFormat::kNone;
  EXPECT_EQ(renderViews(home.library(), options, views).depth, four.depth);
  options.semantics = true;
  options.depth = false;
  EXPECT_EQ(renderViews(home.library(), options, views).semantics.size(), four.depth.size());
}

TEST_F(GlImage, WideAndTallImagesShowTheSameAroundTheirMiddle) {
  OneModel wall;
  wall.builder.model();
  addWall(wall.builder, 2, 0.5F);
  wall.finish();
  const std::vector<RenderView> views{wall.view(cameraAt({0, 0, 0}))};
  for (const auto& [width, height] :
       std::array<std::array<std::uint32_t, 2>, 2>{{{160, 64}, {40, 64}}}) {
    RenderOptions options = glOptions();
    options.width = width;
    options.height = height;
    const RenderImages images = renderViews(wall.library, options, views);
    for (std::uint32_t y = 0; y < height; ++y) {
      for (std::uint32_t x = 0; x < width; ++x) {
        // The wall covers a quarter of the height, and as many pixels across.
        const auto inside = [](std::uint32_t at, std::uint32_t size) {
          return 2 * at + 1 > size - 16 && 2 * at + 1 < size + 16;
        };
        const bool covered = inside(x, width) && inside(y, height);
        ASSERT_EQ(images.depth[y * width + x] > 0, covered) << x << ", " << y;
      }
    }
  }
}

TEST_F(GlImage, OneSidedSheetsAreSeenFromOutsideOnlyAndTwoSidedOnesFromBoth) {
  for (const bool two_sided : {false, true}) {
    OneModel sheet;
    sheet.builder.model();
    addWall(sheet.builder, 2, 4, {.two_sided = two_sided});
    sheet.finish();
    const std::vector<RenderView> views{sheet.view(cameraAt({0, 0, 0})),
                                        sheet.view(cameraAt({4, 0, 0}, 180))};
    const RenderImages images = renderViews(sheet.library, glOptions(), views);
    constexpr std::size_t kMiddle = 64 * 128 + 64;
    EXPECT_NEAR(images.depth[kMiddle], 2, kDepthTolerance);
    EXPECT_NEAR(images.depth[128 * 128 + kMiddle], two_sided ? 2 : 0, kDepthTolerance);
  }
}

TEST_F(GlImage, WhatHasTooLittleAlphaIsNotThere) {
  OneModel grille;
  const std::int32_t texture =
      grille.builder.texture(64, GlHome::checkerboard(64, 2, 0x40FFFFFF, 0xFF0000FF));
  const RenderSurface masked{.material = grille.builder.material(0xFFFFFFFF, texture, 0.5F)};
  grille.builder.model();
  addWall(grille.builder, 1, 1, masked);
  addWall(grille.builder, 2, 4, {.material = grille.builder.material(0xFFFF0000)});
  grille.finish();
  const std::vector<RenderView> views{grille.view(cameraAt({0, 0, 0}))};
  const RenderImages images = renderViews(grille.library, glOptions(), views);
  const std::size_t upper_left = 32 * 128 + 32;
  const std::size_t upper_right = 32 * 128 + 96;
  EXPECT_EQ(pixelOf(images, upper_left), 0xFFFF0000);
  EXPECT_NEAR(images.depth[upper_left], 2, kDepthTolerance);
  EXPECT_EQ(pixelOf(images, upper_right), 0xFF0000FF);
  EXPECT_NEAR(images.depth[upper_right], 1, kDepthTolerance);
}

TEST_F(GlImage, SemanticIdsCountOnOverTheModelsOfALibrary) {
  OneModel first;
  first.builder.semantic("door");
  first.builder.model();
  addWall(first.builder, 2, 4, {.semantic = 1});
  first.finish();
  RenderModelBuilder second;
  second.model();
  addWall(second, 1, 0.25F, {.two_sided = true});
  second.finish();
  const std::uint32_t added = first.library.add(second.meshes(), "robot ");
  first.instances.push_back({added, {}});
  const std::vector<RenderView> views{first.view(cameraAt({0, 0, 0})),
                                      first.view(cameraAt({0, 0, 0}, 180))};
  const RenderImages images = renderViews(first.library, allImages(), views);
  const auto& names = first.library.semanticNames();
  EXPECT_EQ(names[images.semantics[64 * 128 + 64]], "robot thing");
  EXPECT_EQ(names[images.semantics[10 * 128 + 10]], "door");
  EXPECT_EQ(names[images.semantics[128 * 128 + 64]], "background");
}

TEST_F(GlImage, VertexColorsMultiplyTheMaterial) {
  OneModel wall;
  wall.builder.keepColors();
  wall.builder.model();
  const std::uint16_t material = wall.builder.material(0xFF804020);
  const auto corner = [](float y, float z) { return RenderVertex{{1, y, z}, 0, 0, 0xFF80FFFF}; };
  wall.builder.triangle({corner(-4, -4), corner(-4, 4), corner(4, 4)}, {.material = material});
  wall.builder.triangle({corner(-4, -4), corner(4, 4), corner(4, -4)}, {.material = material});
  wall.finish();
  const std::vector<RenderView> views{wall.view(cameraAt({0, 0, 0}))};
  const RenderImages images = renderViews(wall.library, glOptions(), views);
  // 0x80 * 0x80 / 255 = 64.25
  EXPECT_EQ(pixelOf(images, 64 * 128 + 64), 0xFF404020);
}

TEST_F(GlImage, NothingIsTheBackgroundWithoutDepth) {
  RenderOptions options = allImages();
  options.background = 0x40302010;
  const RenderLibrary empty;
  BatchRenderer renderer = makeRenderer(empty, options);
  const RenderImages images = renderViews(renderer, std::vector<RenderView>(2));
  for (std::size_t i = 0; i < images.depth.size(); ++i) {
    ASSERT_EQ(pixelOf(images, i), 0x40302010U);
    ASSERT_EQ(images.depth[i], 0);
    ASSERT_EQ(images.semantics[i], 0U);
  }
  EXPECT_TRUE(renderViews(renderer, {}).color.empty());
}

TEST_F(GlImage, DegenerateCamerasAndInstancesShowNothing) {
  OneModel wall;
  wall.builder.model();
  addWall(wall.builder, 2, 4, {.two_sided = true});
  wall.finish();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::vector<RenderView> views(4, wall.view(cameraAt({0, 0, 0})));
  views[0].camera.world_from_camera.origin.y = nan;
  views[1].camera.vertical_fov = 0;
  views[2].camera.vertical_fov = nan;
  std::vector<RenderInstance> broken(1);
  broken[0].world_from_model.x_axis.z = nan;
  views[3].instances = broken;
  views.push_back(wall.view(cameraAt({0, 0, 0})));
  const RenderImages images = renderViews(wall.library, glOptions(), views);
  const std::size_t pixels = images.depth.size() / views.size();
  for (std::size_t i = 0; i < 4 * pixels; ++i) ASSERT_EQ(images.depth[i], 0) << i;
  EXPECT_NEAR(images.depth[4 * pixels + pixels / 2 + 64], 2, kDepthTolerance);
}

TEST_F(GlImage, TrianglesThroughTheNearPlaneAndLargerThanTheImageCoverIt) {
  OneModel room;
  room.builder = RenderModelBuilder(1.0F / 256);
  room.builder.model();
  addBox(room.builder, {0, 0, 0}, 100, 1, {.two_sided = true});
  room.finish();
  std::mt19937 random(11);
  std::vector<RenderView> views;
  for (int i = 0; i < 40; ++i) {
    const auto near_wall = [&] { return uniform(random, -1, 1) < 0 ? 99.97F : -99.97F; };
    const Vec3 eye{near_wall(), i % 2 == 0 ? near_wall() : uniform(random, -99, 99),
                   uniform(random, -99, 99)};
    views.push_back(room.view({rigidTransform({eye, randomRotation(random)}), radians(90)}));
  }
  RenderOptions options = glOptions();
  options.near = 0.01F;
  const RenderImages images = renderViews(room.library, options, views);
  for (std::size_t i = 0; i < images.depth.size(); ++i) ASSERT_GT(images.depth[i], 0) << i;
}

TEST_F(GlImage, CompressedTexturesLookAlikeDecodedOrNot) {
  // Every block: 565 red and green, both orders, all four choices.
  std::vector<std::uint8_t> blocks;
  constexpr std::uint32_t kEdge = 16;
  for (std::uint32_t edge = kEdge; edge > 0; edge /= 2) {
    const std::uint32_t in_row = (edge + 3) / 4;
    for (std::uint32_t i = 0; i < in_row * in_row; ++i) {
      const bool swapped = i % 2 == 1;
      const std::array<std::uint8_t, 2> red{0x00, 0xF8};
      const std::array<std::uint8_t, 2> green{0xE0, 0x07};
      const auto& first = swapped ? green : red;
      const auto& second = swapped ? red : green;
      blocks.insert(blocks.end(), first.begin(), first.end());
      blocks.insert(blocks.end(), second.begin(), second.end());
      for (std::uint8_t row = 0; row < 4; ++row) blocks.push_back(0xE4);
    }
  }
  OneModel wall;
  const RenderSurface surface{.material = wall.builder.material(0xFFFFFFFF)};
  wall.builder.model();
  addWall(wall.builder, 1, 1, surface);
  wall.builder.finish();
  RenderMeshes meshes = wall.builder.meshes();
  meshes.textures.push_back({"blocks", kEdge, TexelFormat::kBc1, blocks});
  meshes.materials[surface.material].texture = 0;
  wall.library.add(std::move(meshes));
  const std::vector<RenderView> views{wall.view(cameraAt({0, 0, 0}))};
  const RenderImages stored = renderTuned(wall.library, glOptions(), {}, views);
  const RenderImages decoded = renderTuned(wall.library, glOptions(), {.core_only = true}, views);
  std::map<std::uint32_t, std::size_t> colors;
  for (std::size_t i = 0; i < stored.color.size(); ++i) {
    // Drivers may round the colors between the two ends.
    ASSERT_NEAR(stored.color[i], decoded.color[i], 2) << i;
  }
  for (std::size_t i = 0; i < stored.depth.size(); ++i) ++colors[pixelOf(decoded, i)];
  EXPECT_GT(colors.size(), 4U);
}

TEST_F(GlImage, ImagesThatStayOnTheDeviceAreTheSameWhateverTheSlices) {
  GlHome home;
  const std::vector<RenderView> views = home.views(11);
  for (const ColorFormat color : {ColorFormat::kRgb8, ColorFormat::kRgba8}) {
    RenderOptions options = allImages();
    options.width = 31;
    options.height = 17;
    options.color = color;
    const RenderImages wanted = renderTuned(home.library(), options, {}, views);
    auto engine = render::gl::GlEngine::make(home.library(), options, {.most_views = 4},
                                             render::gl::loadsLibrary);
    ASSERT_TRUE(engine.has_value());
    const auto layout = (*engine)->drawToDevice(views);
    ASSERT_TRUE(layout.has_value());
    const render::gl::CurrentContext current((*engine)->context());
    const auto differs = [&](const auto& images, std::size_t begin) {
      auto found = images;
      const auto bytes = static_cast<GLsizeiptr>(images.size() * sizeof(images[0]));
      glGetNamedBufferSubData((*engine)->renderer().deviceImages().get(),
                              static_cast<GLintptr>(begin), bytes, found.data());
      return found != images;
    };
    EXPECT_FALSE(differs(wanted.color, layout->color));
    EXPECT_FALSE(differs(wanted.depth, layout->depth));
    EXPECT_FALSE(differs(wanted.semantics, layout->semantics));
  }
}

TEST_F(GlImage, WithoutCudaDeviceImagesAreRefusedInWords) {
  const RenderLibrary library;
  BatchRenderer renderer = makeRenderer(library, glOptions());
  const auto images = renderer.renderToDevice(std::vector<RenderView>(1));
  ASSERT_FALSE(images.has_value());
  EXPECT_EQ(images.error().code, ErrorCode::kUnsupported);
  EXPECT_EQ(images.error().where, "device images");
  RenderOptions options;
  options.backend = RenderBackend::kSoft;
  BatchRenderer soft = makeRenderer(library, options);
  EXPECT_EQ(soft.renderToDevice(std::vector<RenderView>(1)).error().message,
            "the soft backend draws into memory of the processor; use the cuda or the gl backend");
}

}  // namespace
}  // namespace galactic::test::gl_image_test
