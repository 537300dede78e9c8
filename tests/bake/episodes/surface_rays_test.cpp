#include "episodes/home/surface_rays.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "made_world.h"
#include "support/oracles/box_oracle.h"

namespace galactic::test::surface_rays_test {
namespace {

using bake::Footprint;
using bake::SurfaceRays;

constexpr float kFlat = 0.002F;

bool isEven(const bake::TriangleMesh& mesh, const Footprint& print, float surface) {
  return MemoryPack::opened(SurfaceRays::build(mesh)).isEven(print, surface, kFlat);
}

/// A rectangle of 20 by 10 cm around the origin.
Footprint printAtOrigin() { return {.half_length = 0.1F, .half_width = 0.05F, .heights = {}}; }

TEST(SurfaceRays, SeeGapsThatAreNarrowerThanAColumn) {
  MeshBuilder whole;
  whole.floor({-1, 0, -1}, {1, 0, 1}, 0.7F);
  EXPECT_TRUE(isEven(whole.build(), printAtOrigin(), 0.7F));
  // From 0.03 on there is nothing for 1.2 cm.
  MeshBuilder split;
  split.floor({-1, 0, -1}, {0.03F, 0, 1}, 0.7F).floor({0.042F, 0, -1}, {1, 0, 1}, 0.7F);
  EXPECT_FALSE(isEven(split.build(), printAtOrigin(), 0.7F));
  MeshBuilder sloped;
  sloped.quad({Vec3{-1, 0.4F, -1}, {-1, 0.4F, 1}, {1, 1.0F, 1}, {1, 1.0F, -1}});
  EXPECT_FALSE(isEven(sloped.build(), printAtOrigin(), 0.7F));
}

TEST(SurfaceRays, DoNotMindWhichSideOfATriangleIsUp) {
  MeshBuilder turned;
  turned.quad({Vec3{-1, 0.7F, -1}, {1, 0.7F, -1}, {1, 0.7F, 1}, {-1, 0.7F, 1}});
  EXPECT_TRUE(isEven(turned.build(), printAtOrigin(), 0.7F));
}

TEST(SurfaceRays, AgreeWithTheCornersOfFootprintsOnATable) {
  MeshBuilder table;
  table.box({0, 0.7F, 0}, {1, 0.74F, 1});
  const auto rays = MemoryPack::opened(SurfaceRays::build(table.build()));
  std::mt19937 random(5);
  constexpr int kCases = 4000;
  int even = 0;
  for (int n = 0; n < kCases; ++n) {
    const double yaw = 2 * std::numbers::pi * uniform(random);
    const double x = 1.4 * uniform(random) - 0.2;
    const double z = 1.4 * uniform(random) - 0.2;
    const double length = 0.01 + 0.2 * uniform(random);
    const double width = 0.01 + 0.2 * uniform(random);
    // Half the extents along x and z of the turned rectangle; the table is convex.
    const double half_x = length * std::abs(std::cos(yaw)) + width * std::abs(std::sin(yaw));
    const double half_z = length * std::abs(std::sin(yaw)) + width * std::abs(std::cos(yaw));
    const double inside = std::min({x - half_x, 1 - x - half_x, z - half_z, 1 - z - half_z});
    constexpr double kRounding = 1e-5;
    if (std::abs(inside) < kRounding) continue;
    const Footprint print{.x = static_cast<float>(x),
                          .z = static_cast<float>(z),
                          .half_length = static_cast<float>(length),
                          .half_width = static_cast<float>(width),
                          .along_x = static_cast<float>(std::cos(yaw)),
                          .along_z = static_cast<float>(-std::sin(yaw)),
                          .heights = {}};
    const bool found = rays.isEven(print, 0.74F, kFlat);
    EXPECT_EQ(found, inside > 0) << x << ", " << z;
    if (found) ++even;
  }
  EXPECT_GT(even, kCases / 10);
  EXPECT_LT(even, kCases * 9 / 10);
}

}  // namespace
}  // namespace galactic::test::surface_rays_test
