// Depth images of the rasterizer against closed forms and against rays in double precision.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "support/oracles/render_ray_caster.h"
#include "support/packs/render_model_builder.h"
#include "support/render_images.h"
#include "support/sanitized.h"

namespace galactic::test::soft_depth_test {
namespace {

/// Meters: what the issue of rendering asks for.
constexpr float kDepthTolerance = 1e-3F;

RenderOptions depthOptions(std::uint32_t width, std::uint32_t height) {
  RenderOptions options;
  options.width = width;
  options.height = height;
  options.backend = RenderBackend::kSoft;
  options.threads = 1;
  return options;
}

/// A wall across the camera's axis, far wider than the image.
RenderModelBuilder wallAt(float x) {
  RenderModelBuilder builder(1.0F / 512);
  builder.model();
  builder.quad({Vec3{x, -60, -60}, {x, -60, 60}, {x, 60, 60}, {x, 60, -60}});
  builder.finish();
  return builder;
}

TEST(SoftDepth, OfAWallAcrossTheAxisIsItsDistanceAtEveryPixel) {
  const RenderModelBuilder builder = wallAt(3);
  RenderLibrary library;
  library.add(builder.meshes());
  for (const float fov : {40.0F, 60.0F, 90.0F, 120.0F}) {
    RenderView view;
    const std::vector<RenderInstance> instances = {{0, {}}};
    view.camera.vertical_fov = radians(fov);
    view.instances = instances;
    const RenderImages images = renderViews(library, depthOptions(128, 96), {&view, 1});
    for (const float depth : images.depth) EXPECT_NEAR(depth, 3, kDepthTolerance) << fov;
  }
}

TEST(SoftDepth, OfASlantedWallFollowsItsPlane) {
  RenderModelBuilder builder;
  builder.model();
  // x = 4 + z / 2, over all heights.
  builder.quad({Vec3{1, -7, -6}, {7, -7, 6}, {7, 7, 6}, {1, 7, -6}}, {.two_sided = true});
  builder.finish();
  RenderLibrary library;
  library.add(builder.meshes());
  const std::vector<RenderInstance> instances = {{0, {}}};
  const RenderView view{{}, instances};
  const RenderImages images = renderViews(library, depthOptions(128, 128), {&view, 1});
  std::size_t covered = 0;
  for (std::uint32_t y = 0; y < 128; ++y) {
    for (std::uint32_t x = 0; x < 128; ++x) {
      const float depth = images.depth[y * 128 + x];
      if (depth == 0) continue;
      ++covered;
      // z = slope * depth at this pixel.
      const float slope = (static_cast<float>(x) + 0.5F - 64) / 64;
      EXPECT_NEAR(depth, 4 / (1 - slope / 2), kDepthTolerance);
    }
  }
  EXPECT_GT(covered, 128 * 128 * 8 / 10);
}

/// A globe of rings x sides quads, radius 1 about the origin.
RenderModelBuilder globe(int rings, int sides) {
  RenderModelBuilder builder(1.0F / 16384);
  builder.model();
  const auto point = [&](int ring, int side) {
    const double polar = std::numbers::pi * ring / rings;
    const double around = 2 * std::numbers::pi * (side % sides) / sides;
    return RenderVertex{{static_cast<float>(std::sin(polar) * std::cos(around)),
                         static_cast<float>(std::cos(polar)),
                         static_cast<float>(std::sin(polar) * std::sin(around))}};
  };
  for (int ring = 0; ring < rings; ++ring) {
    for (int side = 0; side < sides; ++side) {
      const RenderVertex a = point(ring, side);
      const RenderVertex b = point(ring, side + 1);
      const RenderVertex c = point(ring + 1, side + 1);
      const RenderVertex d = point(ring + 1, side);
      if (ring > 0) builder.triangle({a, b, c});
      if (ring + 1 < rings) builder.triangle({a, c, d});
    }
  }
  builder.finish();
  return builder;
}

TEST(SoftDepth, OfAGlobeIsThatOfTheSphereWithinItsFacets) {
  const RenderModelBuilder builder = globe(160, 320);
  RenderLibrary library;
  library.add(builder.meshes());
  const std::vector<RenderInstance> instances = {{0, {.origin = {3, 0, 0}}}};
  RenderView view;
  view.camera.vertical_fov = radians(50);
  view.instances = instances;
  const RenderImages images = renderViews(library, depthOptions(128, 128), {&view, 1});
  std::size_t inside = 0;
  std::size_t outside = 0;
  const double focal = static_cast<double>(64 / std::tan(radians(25)));
  for (std::uint32_t y = 0; y < 128; ++y) {
    for (std::uint32_t x = 0; x < 128; ++x) {
      const double right = (x + 0.5 - 64) / focal;
      const double down = (y + 0.5 - 64) / focal;
      // |t (1, up, right) - center| = 1
      const double a = 1 + right * right + down * down;
      const double square = 9 - a * 8;
      const float depth = images.depth[y * 128 + x];
      if (square < -0.2) {
        EXPECT_EQ(depth, 0);
        ++outside;
      }
      // Near the silhouette a facet's error is as large along the ray as one likes.
      if (square < 0.2) continue;
      EXPECT_NEAR(depth, (3 - std::sqrt(square)) / a, kDepthTolerance);
      ++inside;
    }
  }
  EXPECT_GT(inside, 128 * 128 / 10);
  EXPECT_GT(outside, 128 * 128 / 10);
}

/// Triangles of all sizes and orientations around the origin, two-sided.
RenderModelBuilder clutter(std::mt19937& random, int count) {
  RenderModelBuilder builder(1.0F / 1024);
  builder.model();
  for (int n = 0; n < count; ++n) {
    const Vec3 center{uniform(random, -6, 6), uniform(random, -6, 6), uniform(random, -6, 6)};
    const float size = std::exp(uniform(random, -3, 1.5F));
    std::array<RenderVertex, 3> corners;
    for (RenderVertex& corner : corners) {
      corner.position = center + Vec3{uniform(random, -size, size), uniform(random, -size, size),
                                      uniform(random, -size, size)};
    }
    builder.triangle(corners, {.two_sided = true});
  }
  builder.finish();
  return builder;
}

TEST(SoftDepth, OfRandomTrianglesAgreesWithRays) {
  constexpr std::uint32_t kSeed = 20261;
  constexpr std::uint32_t kEdge = 64;
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  std::size_t same = 0;
  std::size_t near_edge = 0;
  std::size_t covered = 0;
  std::size_t all = 0;
  for (int scene = 0; scene < (kIsSanitized ? 2 : 6); ++scene) {
    const RenderModelBuilder builder = clutter(random, 150);
    const RenderMeshes meshes = builder.meshes();
    RenderLibrary library;
    library.add(meshes);
    const RenderRayCaster caster(meshes, 0);
    RenderView view;
    view.camera.world_from_camera =
        rigidTransform({{uniform(random, -3, 3), uniform(random, -3, 3), uniform(random, -3, 3)},
                        randomRotation(random)});
    view.camera.vertical_fov = radians(uniform(random, 40, 110));
    const std::vector<RenderInstance> instances = {{0, {}}};
    view.instances = instances;
    const RenderOptions options = depthOptions(kEdge, kEdge);
    const RenderImages images = renderViews(library, options, {&view, 1});
    for (std::uint32_t y = 0; y < kEdge; ++y) {
      for (std::uint32_t x = 0; x < kEdge; ++x) {
        const auto depth = static_cast<double>(images.depth[y * kEdge + x]);
        const auto rays = caster.around(view.camera, options, x, y);
        ++all;
        covered += depth > 0 ? 1U : 0U;
        if (std::abs(depth - rays.middle) < static_cast<double>(kDepthTolerance)) {
          ++same;
        } else if (rays.lowest - 1e-3 <= depth && depth <= rays.highest + 1e-3) {
          ++near_edge;
        } else {
          ADD_FAILURE() << "scene " << scene << " pixel " << x << ", " << y << ": depth " << depth
                        << ", rays " << rays.lowest << " to " << rays.highest;
        }
      }
    }
  }
  EXPECT_GT(same, all * 99 / 100);
  EXPECT_EQ(same + near_edge, all);
  EXPECT_GT(covered, all / 10);
}

}  // namespace
}  // namespace galactic::test::soft_depth_test
