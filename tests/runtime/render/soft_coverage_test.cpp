// Which pixels are drawn: all of a closed room, each once along a shared edge, the same ones with
// and without culling.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include "support/packs/render_model_builder.h"
#include "support/render_images.h"

namespace galactic::test::soft_coverage_test {
namespace {

RenderOptions softOptions(std::uint32_t width, std::uint32_t height) {
  RenderOptions options;
  options.width = width;
  options.height = height;
  options.semantics = true;
  options.backend = RenderBackend::kSoft;
  options.threads = 1;
  return options;
}

/// A box seen from inside; each wall has so many quads along an edge, moved out of the plane at
/// random.
RenderModelBuilder room(std::mt19937& random, int parts, float half) {
  RenderModelBuilder builder(1.0F / 1024);
  builder.model();
  const float bump = parts > 1 ? 0.3F / static_cast<float>(parts) * half : 0;
  std::map<std::array<int, 3>, Vec3> corners;
  const auto corner = [&](std::array<int, 3> at) {
    const auto found = corners.find(at);
    if (found != corners.end()) return found->second;
    const auto place = [&](int n) {
      return half * (2 * static_cast<float>(n) / static_cast<float>(parts) - 1) +
             uniform(random, -bump, bump);
    };
    return corners[at] = builder.snapped({place(at[0]), place(at[1]), place(at[2])});
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const int side : {0, parts}) {
      for (int u = 0; u < parts; ++u) {
        for (int v = 0; v < parts; ++v) {
          const auto at = [&](int du, int dv) {
            std::array<int, 3> place{};
            place[axis] = side;
            place[(axis + 1) % 3] = u + du;
            place[(axis + 2) % 3] = v + dv;
            return corner(place);
          };
          if (side == 0) {
            builder.quad({at(0, 0), at(1, 0), at(1, 1), at(0, 1)});
          } else {
            builder.quad({at(0, 0), at(0, 1), at(1, 1), at(1, 0)});
          }
        }
      }
    }
  }
  builder.finish();
  return builder;
}

TEST(SoftCoverage, AClosedRoomCoversEveryPixelFromAllCamerasInside) {
  constexpr std::uint32_t kSeed = 7001;
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  for (const int parts : {1, 2, 5, 24, 60}) {
    const RenderModelBuilder builder = room(random, parts, 5);
    RenderLibrary library;
    library.add(builder.meshes());
    RenderOptions options = softOptions(96, 64);
    options.near = 0.02F;
    BatchRenderer renderer = makeRenderer(library, options);
    const std::vector<RenderInstance> instances = {{0, {}}};
    std::vector<RenderView> views(60);
    for (RenderView& view : views) {
      // Up to a hand's width from the walls: triangles reach behind the eye and far off the screen.
      const auto place = [&] { return uniform(random, -4, 4); };
      view.camera.world_from_camera =
          rigidTransform({{place(), place(), place()}, randomRotation(random)});
      view.camera.vertical_fov = radians(uniform(random, 20, 150));
      view.instances = instances;
    }
    const RenderImages images = renderViews(renderer, views);
    std::size_t holes = 0;
    for (const float depth : images.depth) holes += depth > 0 ? 0U : 1U;
    EXPECT_EQ(holes, 0U) << parts << " quads along an edge";
  }
}

TEST(SoftCoverage, TrianglesOfAKilometerAroundTheEyeCoverEveryPixel) {
  constexpr std::uint32_t kSeed = 7002;
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  RenderModelBuilder builder(1.0F / 32);
  builder.model();
  // A tetrahedron seen from inside, its corners about a kilometer away.
  const Vec3 a{700, 700, 700};
  const Vec3 b{-700, -700, 700};
  const Vec3 c{-700, 700, -700};
  const Vec3 d{700, -700, -700};
  for (const auto& face :
       {std::array{a, b, c}, std::array{a, d, b}, std::array{a, c, d}, std::array{b, d, c}}) {
    builder.triangle({RenderVertex{face[0]}, {face[1]}, {face[2]}});
  }
  builder.finish();
  RenderLibrary library;
  library.add(builder.meshes());
  RenderOptions options = softOptions(128, 128);
  options.near = 1e-3F;
  BatchRenderer renderer = makeRenderer(library, options);
  const std::vector<RenderInstance> instances = {{0, {}}};
  for (int n = 0; n < 60; ++n) {
    RenderView view;
    // Next to a wall too: the point is at most a tenth of a meter inside of face a b c.
    const float s = uniform(random, 0.1F, 0.5F);
    const float t = uniform(random, 0.1F, 0.4F);
    const Vec3 on_face = a * (1 - s - t) + b * s + c * t;
    const Vec3 inwards = Vec3{1, -1, -1} * 0.577F;
    const Vec3 eye = n % 2 == 0 ? Vec3{uniform(random, -50, 50), 0, 0}
                                : on_face + inwards * uniform(random, 0.01F, 0.1F);
    view.camera.world_from_camera = rigidTransform({eye, randomRotation(random)});
    view.camera.vertical_fov = radians(uniform(random, 1, 170));
    view.instances = instances;
    const RenderImages images = renderViews(renderer, {&view, 1});
    std::size_t holes = 0;
    for (const float depth : images.depth) holes += depth > 0 ? 0U : 1U;
    EXPECT_EQ(holes, 0U) << n;
  }
}

TEST(SoftCoverage, PixelsAlongASharedEdgeBelongToOneOfTwoTriangles) {
  constexpr std::uint32_t kSeed = 7003;
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  std::size_t once = 0;
  std::size_t none = 0;
  for (int n = 0; n < 400; ++n) {
    // A quad in the plane x = 2, cut along its diagonal: three models, the whole and both halves.
    // On every second one all corners lie on pixel centers, so that edges run through others.
    const bool regular = n % 2 == 0;
    const float size = std::exp(uniform(random, -2, 1.2F));
    std::array<Vec3, 4> corners;
    const float turn = uniform(random, 0, 7);
    const Vec3 middle{2, uniform(random, -0.5F, 0.5F), uniform(random, -0.5F, 0.5F)};
    for (std::size_t k = 0; k < 4; ++k) {
      const float angle = turn + 1.5F * static_cast<float>(k);
      Vec3 p = middle + Vec3{0, std::sin(angle), -std::cos(angle)} * -size;
      if (regular) {
        // A pixel is 1/32 m here.
        p.y = (std::round(p.y * 32) + 0.5F) / 32;
        p.z = (std::round(p.z * 32) + 0.5F) / 32;
      }
      corners[k] = p;
    }
    RenderModelBuilder builder;
    const RenderSurface surface{.two_sided = true};
    builder.model();
    builder.quad(corners, surface);
    builder.model();
    builder.triangle({RenderVertex{corners[0]}, {corners[1]}, {corners[2]}}, surface);
    builder.model();
    builder.triangle({RenderVertex{corners[0]}, {corners[2]}, {corners[3]}}, surface);
    builder.finish();
    RenderLibrary library;
    library.add(builder.meshes());
    std::array<RenderView, 3> views;
    const std::array<RenderInstance, 3> instances = {RenderInstance{0, {}}, {1, {}}, {2, {}}};
    for (std::size_t k = 0; k < 3; ++k) views[k].instances = {&instances[k], 1};
    const RenderImages images = renderViews(library, softOptions(128, 128), views);
    for (std::size_t pixel = 0; pixel < 128 * 128; ++pixel) {
      const auto drawn = [&](std::size_t view) {
        return images.depth[view * 128 * 128 + pixel] > 0 ? 1 : 0;
      };
      ASSERT_EQ(drawn(0), drawn(1) + drawn(2)) << n << " pixel " << pixel;
      (drawn(0) == 1 ? once : none) += 1;
    }
  }
  EXPECT_GT(once, (once + none) / 10);
  EXPECT_GT(none, (once + none) / 10);
}

/// Triangles around the eye, from a decimeter to some hundred meters away: most of them have
/// corners behind it or far beside the image.
RenderModelBuilder surroundings(std::mt19937& random, int count) {
  RenderModelBuilder builder(1.0F / 64);
  builder.model();
  for (int n = 0; n < count; ++n) {
    std::array<RenderVertex, 3> corners;
    for (RenderVertex& corner : corners) {
      const float away = std::exp(uniform(random, -2, 6));
      corner.position =
          Vec3{uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1)} * away;
    }
    builder.triangle(corners, {.two_sided = n % 2 == 0});
  }
  builder.finish();
  return builder;
}

TEST(SoftCoverage, WhatLiesBesideTheImageMayReachBehindTheEye) {
  constexpr std::uint32_t kSeed = 1311;
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  std::size_t covered = 0;
  std::size_t all = 0;
  for (const auto& [width, height] : {std::pair{96U, 64U}, {9U, 31U}, {300U, 260U}}) {
    for (int scene = 0; scene < 12; ++scene) {
      const RenderModelBuilder builder = surroundings(random, 12);
      RenderLibrary library;
      library.add(builder.meshes());
      const std::vector<RenderInstance> instances = {{0, {}}};
      std::vector<RenderView> views(4);
      for (RenderView& view : views) {
        view.camera.world_from_camera = rigidTransform({{}, randomRotation(random)});
        view.camera.vertical_fov = radians(uniform(random, 10, 140));
        view.instances = instances;
      }
      RenderOptions options = softOptions(width, height);
      const RenderImages images = renderViews(library, options, views);
      options.culling = false;
      ASSERT_EQ(images, renderViews(library, options, views)) << width << ", scene " << scene;
      all += images.depth.size();
      for (const float depth : images.depth) covered += depth > 0 ? 1U : 0U;
    }
  }
  EXPECT_GT(covered, all / 10);
  EXPECT_LT(covered, all * 9 / 10);
}

/// Many small boxes of clutter within a room, several models, in instances at random.
class SoftCulling : public testing::Test {
 protected:
  static constexpr std::uint32_t kSeed = 7004;

  void SetUp() override {
    RenderModelBuilder walls = room(random_, 24, 4);
    builders_.push_back(std::move(walls));
    for (int n = 0; n < 4; ++n) builders_.push_back(room(random_, 3 + 4 * n, 0.3F));
    for (const RenderModelBuilder& builder : builders_) library_.add(builder.meshes());
    instances_.push_back({0, {}});
    for (std::uint32_t n = 0; n < 40; ++n) {
      const auto place = [&] { return uniform(random_, -3.5F, 3.5F); };
      instances_.push_back(
          {1 + n % 4, rigidTransform({{place(), place(), place()}, randomRotation(random_)})});
    }
  }

  std::vector<RenderView> cameras(std::size_t count) {
    std::vector<RenderView> views(count);
    for (RenderView& view : views) {
      const auto place = [&] { return uniform(random_, -4.5F, 4.5F); };
      view.camera.world_from_camera =
          rigidTransform({{place(), place(), place()}, randomRotation(random_)});
      view.camera.vertical_fov = radians(uniform(random_, 10, 140));
      view.instances = instances_;
    }
    return views;
  }

  std::mt19937 random_{kSeed};
  std::vector<RenderModelBuilder> builders_;
  RenderLibrary library_;
  std::vector<RenderInstance> instances_;
};

TEST_F(SoftCulling, LeavesOutMuchAndChangesNothing) {
  SCOPED_TRACE(kSeed);
  for (const auto& [width, height] : {std::pair{128U, 128U}, {33U, 70U}, {7U, 5U}, {300U, 260U}}) {
    RenderOptions options = softOptions(width, height);
    const std::vector<RenderView> views = cameras(width > 200 ? 4 : 30);
    BatchRenderer with = makeRenderer(library_, options);
    options.culling = false;
    BatchRenderer without = makeRenderer(library_, options);
    EXPECT_EQ(renderViews(with, views), renderViews(without, views)) << width << " x " << height;
    EXPECT_LT(with.statistics().clusters_drawn, without.statistics().clusters_drawn / 2);
    EXPECT_EQ(with.statistics().clusters, without.statistics().clusters);
  }
}

TEST_F(SoftCulling, IsTheSameForModelsFarFromTheOrigin) {
  SCOPED_TRACE(kSeed);
  for (RenderInstance& instance : instances_) {
    instance.world_from_model.origin = instance.world_from_model.origin + Vec3{900, 20, -1300};
  }
  std::vector<RenderView> views = cameras(30);
  for (RenderView& view : views) {
    view.camera.world_from_camera.origin =
        view.camera.world_from_camera.origin + Vec3{900, 20, -1300};
  }
  RenderOptions options = softOptions(128, 128);
  const RenderImages with = renderViews(library_, options, views);
  options.culling = false;
  EXPECT_EQ(with, renderViews(library_, options, views));
}

}  // namespace
}  // namespace galactic::test::soft_coverage_test
