// Primitives of a URDF as surfaces: closed, facing outwards, of the right size.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "bake/robot_description/link_points.h"
#include "robot/robot_parts.h"

namespace galactic::test::link_geometry_test {
namespace {

using bake::BoxShape;
using bake::CylinderShape;
using bake::kTessellationError;
using bake::LinkShape;
using bake::SphereShape;
using bake::Surface;
using bake::surfaceOfShapes;

constexpr bake::Affine kIdentity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
constexpr double kPi = std::numbers::pi;

Surface surfaceOf(LinkShape shape) { return surfaceOfShapes({}, {std::move(shape)}); }

/// Whether each edge is walked once in each direction.
bool isClosed(const Surface& surface) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const bake::Triangle& t : surface.triangles) {
    for (std::size_t n = 0; n < 3; ++n) ++edges[{t[n], t[(n + 1) % 3]}];
  }
  for (const auto& [edge, count] : edges) {
    const auto back = edges.find({edge.second, edge.first});
    if (count != 1 || back == edges.end()) return false;
  }
  return !edges.empty();
}

double volumeOf(const Surface& surface) {
  bake::TriangleMesh mesh;
  mesh.vertices = surface.positions;
  mesh.triangles = surface.triangles;
  return signedVolume(mesh);
}

bake::Bounds boundsOf(const Surface& surface) {
  bake::Bounds bounds{surface.positions.front(), surface.positions.front()};
  for (const Vec3& p : surface.positions) {
    bounds.min = {std::min(bounds.min.x, p.x), std::min(bounds.min.y, p.y),
                  std::min(bounds.min.z, p.z)};
    bounds.max = {std::max(bounds.max.x, p.x), std::max(bounds.max.y, p.y),
                  std::max(bounds.max.z, p.z)};
  }
  return bounds;
}

TEST(LinkGeometry, OfABoxIsExact) {
  const Surface box = surfaceOf({BoxShape{{0.25, 0.5, 1}}, kIdentity, {}});
  EXPECT_EQ(box.positions.size(), 8U);
  EXPECT_EQ(box.triangles.size(), 12U);
  EXPECT_TRUE(isClosed(box));
  EXPECT_NEAR(volumeOf(box), 0.125, 1e-9);
  expectBounds(boundsOf(box), {-0.125, -0.25, -0.5}, {0.125, 0.25, 0.5}, 0);
}

/// From a button to a barrel.
TEST(LinkGeometry, OfCylindersIsClosedAndStaysWithinTheTessellationError) {
  for (const double radius : {0.002, 0.01, 0.05, 0.2}) {
    const double length = 0.3;
    const Surface rod = surfaceOf({CylinderShape{radius, length}, kIdentity, {}});
    EXPECT_TRUE(isClosed(rod)) << radius;
    const double exact = kPi * radius * radius * length;
    // Inside the shape, and not deeper than the chords.
    EXPECT_LT(volumeOf(rod), exact * (1 + 1e-6));
    EXPECT_GT(volumeOf(rod), exact * std::pow(1 - kTessellationError / radius, 2));
    expectBounds(boundsOf(rod), {-radius, -length / 2, -radius}, {radius, length / 2, radius});
    for (const Vec3& p : rod.positions) {
      const double from_axis = std::hypot(static_cast<double>(p.x), static_cast<double>(p.z));
      EXPECT_TRUE(from_axis == 0 || std::abs(from_axis - radius) < 1e-7) << from_axis;
    }
  }
}

TEST(LinkGeometry, OfSpheresIsClosedAndStaysWithinTheTessellationError) {
  for (const double radius : {0.002, 0.01, 0.05, 0.2}) {
    const Surface ball = surfaceOf({SphereShape{radius}, kIdentity, {}});
    EXPECT_TRUE(isClosed(ball)) << radius;
    const double exact = 4.0 / 3 * kPi * std::pow(radius, 3);
    EXPECT_LT(volumeOf(ball), exact * (1 + 1e-6));
    // The middle of a facet lies up to two chords deep: one around, one up.
    EXPECT_GT(volumeOf(ball), exact * std::pow(1 - 2 * kTessellationError / radius, 3));
    expectBounds(boundsOf(ball), {-radius, -radius, -radius}, {radius, radius, radius});
    for (const Vec3& p : ball.positions) {
      const double length =
          std::hypot(static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z));
      EXPECT_NEAR(length, radius, 1e-7);
    }
  }
}

/// How far the facets of a shape are from it: sampled over each triangle.
TEST(LinkGeometry, HasNoFacetFurtherFromTheShapeThanItSays) {
  for (const double radius : {0.005, 0.03, 0.1, 0.25}) {
    const Surface ball = surfaceOf({SphereShape{radius}, kIdentity, {}});
    double deepest = 0;
    ASSERT_FALSE(ball.triangles.empty());
    for (const bake::Triangle& t : ball.triangles) {
      Point3 middle{};
      for (const std::uint32_t corner : t) {
        const Vec3& p = ball.positions[corner];
        middle[0] += static_cast<double>(p.x) / 3;
        middle[1] += static_cast<double>(p.y) / 3;
        middle[2] += static_cast<double>(p.z) / 3;
      }
      deepest = std::max(deepest, radius - std::hypot(middle[0], middle[1], middle[2]));
    }
    EXPECT_LE(deepest, kTessellationError) << radius;
  }
}

TEST(LinkGeometry, IsPlacedTurnedAndMirroredWithItsOutsideOut) {
  // Mirrored along X, then X to Y, Y to Z, Z to X, then moved.
  const bake::Affine mirrored{0, 0, 1, 1, -1, 0, 0, 2, 0, 1, 0, 3};
  const std::vector<bake::LinkShape> shapes{{BoxShape{{0.25, 0.5, 1}}, mirrored, {}},
                                            {CylinderShape{0.05, 0.3}, mirrored, {}},
                                            {SphereShape{0.05}, mirrored, {}}};
  const std::vector<double> volumes{0.125, kPi * 0.0025 * 0.3, 4.0 / 3 * kPi * 0.000125};
  for (std::size_t n = 0; n < shapes.size(); ++n) {
    const Surface surface = surfaceOf(shapes[n]);
    EXPECT_TRUE(isClosed(surface));
    EXPECT_NEAR(volumeOf(surface), volumes[n], 0.01 * volumes[n]) << n;
  }
  expectBounds(boundsOf(surfaceOf(shapes[0])), {0.5, 1.875, 2.75}, {1.5, 2.125, 3.25});
  expectBounds(boundsOf(surfaceOf(shapes[1])), {0.95, 1.95, 2.85}, {1.05, 2.05, 3.15});
}

TEST(LinkGeometry, OfSeveralShapesIsTheirSumWithEachItsColor) {
  const std::array<float, 4> red{1, 0, 0, 1};
  const Surface both = surfaceOfShapes({}, {{BoxShape{{0.1, 0.1, 0.1}}, kIdentity, red},
                                            {BoxShape{{0.2, 0.2, 0.2}}, kIdentity, {}}});
  ASSERT_EQ(both.positions.size(), 16U);
  ASSERT_EQ(both.colors.size(), 16U);
  EXPECT_EQ(both.triangles.size(), 24U);
  EXPECT_EQ(both.colors[0], 0xff0000ffU);
  EXPECT_NE(both.colors[8], both.colors[0]);
  for (std::size_t n = 12; n < 24; ++n) {
    for (const std::uint32_t corner : both.triangles[n]) EXPECT_GE(corner, 8U);
  }
}

TEST(LinkGeometry, OfAMeshIsItsInstancesPlacedAndColored) {
  bake::SourceRobot robot;
  bake::SourceAsset& asset = robot.meshes.emplace_back();
  bake::SourceMesh& mesh = asset.meshes.emplace_back();
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  asset.materials.emplace_back().base_color = {0, 0, 1, 1};
  asset.instances = {{"a", 0, kIdentity}, {"b", 0, {1, 0, 0, 5, 0, 1, 0, 0, 0, 0, 1, 0}}};
  // Millimeters, mirrored.
  const bake::Affine scaled{-1e-3, 0, 0, 0, 0, 1e-3, 0, 0, 0, 0, 1e-3, 0};
  const Surface surface = surfaceOfShapes(robot, {{bake::MeshShape{0}, scaled, {}}});
  EXPECT_EQ(surface.positions.size(), 8U);
  EXPECT_EQ(surface.positions[5], (Vec3{-0.006F, 0, 0}));
  EXPECT_TRUE(isClosed(surface));
  EXPECT_NEAR(volumeOf(surface), 2e-9 / 6, 1e-14);
  EXPECT_EQ(surface.colors[0], 0xffff0000U) << "the material's blue";
  const Surface painted =
      surfaceOfShapes(robot, {{bake::MeshShape{0}, scaled, std::array<float, 4>{0, 1, 0, 1}}});
  EXPECT_EQ(painted.colors[0], 0xff00ff00U) << "the URDF's green";
}

}  // namespace
}  // namespace galactic::test::link_geometry_test
