// Light that the bake puts into vertex colors.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "render/render_source.h"
#include "render_helpers.h"
#include "support/test_meshes.h"

namespace galactic::test::light_test {
namespace {

using bake::Lighting;
using bake::SourceMesh;
using bake::Triangle;

constexpr std::uint32_t kWhite = 0xFFFFFFFF;

/// A box about the origin; faces outwards.
SourceMesh box(const Vec3& half) {
  SourceMesh mesh;
  mesh.name = "box";
  for (unsigned corner = 0; corner < 8; ++corner) {
    mesh.positions.push_back({(corner & 1U) != 0 ? half.x : -half.x,
                              (corner & 2U) != 0 ? half.y : -half.y,
                              (corner & 4U) != 0 ? half.z : -half.z});
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

/// A level rectangle that faces up, its corner at `corner`, `x` by `z` meters.
SourceMesh level(const Vec3& corner, float x, float z) {
  SourceMesh mesh;
  mesh.name = "level";
  mesh.positions = {corner,
                    {corner.x, corner.y, corner.z + z},
                    {corner.x + x, corner.y, corner.z + z},
                    {corner.x + x, corner.y, corner.z}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

SourceMesh ball(float radius, int rings) {
  return meshOf(MeshBuilder().sphere({0, 0, 0}, radius, rings).build());
}

bake::BakedRenderMeshes bakeLit(const bake::RenderSource& source,
                                Lighting lighting = Lighting::kAll, unsigned threads = 1) {
  // Simplified balls have slivers that face anywhere.
  auto meshes = bake::bakeRenderMeshes(source, {.error = 0, .lighting = lighting}, threads);
  EXPECT_TRUE(meshes.has_value()) << meshes.error().message;
  return meshes ? *std::move(meshes) : bake::BakedRenderMeshes();
}

std::vector<DrawnTriangle> drawnOf(const bake::BakedRenderMeshes& meshes, std::size_t model = 0) {
  return drawnTriangles(meshes.view(), model);
}

/// Unit normal of a drawn triangle.
std::array<double, 3> normalOf(const DrawnTriangle& t) {
  std::array<double, 3> a{};
  std::array<double, 3> b{};
  for (std::size_t n = 0; n < 3; ++n) {
    a[n] = t.corners[1].position[n] - t.corners[0].position[n];
    b[n] = t.corners[2].position[n] - t.corners[0].position[n];
  }
  const std::array<double, 3> c{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                                a[0] * b[1] - a[1] * b[0]};
  const double length = std::hypot(c[0], c[1], c[2]);
  return {c[0] / length, c[1] / length, c[2] / length};
}

/// The gray of a face of a box, the same at all its corners; the axis is 0 to 2.
unsigned grayFacing(const std::vector<DrawnTriangle>& triangles, std::size_t axis, double sign) {
  std::set<std::uint32_t> colors;
  for (const DrawnTriangle& triangle : triangles) {
    if (normalOf(triangle)[axis] * sign < 0.99) continue;
    for (const DrawnCorner& corner : triangle.corners) colors.insert(corner.color);
  }
  EXPECT_EQ(colors.size(), 1U) << "axis " << axis << ", " << sign;
  if (colors.empty()) return 0;
  const std::uint32_t color = *colors.begin();
  EXPECT_EQ(color, 0xFF000000U | (color & 0xFFU) * 0x010101U) << "no gray";
  return color & 0xFFU;
}

TEST(Light, EachFaceOfABoxHasItsOwnAndTheTopTheMost) {
  SourceBuilder builder;
  builder.place(box({0.1F, 0.2F, 0.15F}), builder.material(false));
  const auto triangles = drawnOf(bakeLit(builder.source()));
  ASSERT_EQ(triangles.size(), 12U);
  std::set<unsigned> grays;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) grays.insert(grayFacing(triangles, axis, sign));
  }
  EXPECT_EQ(grays.size(), 6U);
  EXPECT_EQ(*grays.rbegin(), grayFacing(triangles, 1, 1));
  EXPECT_EQ(*grays.begin(), grayFacing(triangles, 1, -1));
  // An eye tells neighbors of one color apart when they differ by some ten of 255.
  for (auto next = std::next(grays.begin()); next != grays.end(); ++next) {
    EXPECT_GE(*next - *std::prev(next), 5U);
  }
  EXPECT_GE(*grays.begin(), 120U) << "dark, but not black";
}

TEST(Light, FollowsTheWayInWhichAPartStands) {
  SourceBuilder upright;
  upright.place(box({0.1F, 0.2F, 0.15F}), upright.material(false));
  // Turned about Z: what was X is up.
  SourceBuilder turned;
  turned.place(box({0.1F, 0.2F, 0.15F}), turned.material(false));
  turned.source().parts[0].light_from_part = {0, -1, 0, 5, 1, 0, 0, 5, 0, 0, 1, 5};
  const auto plain = drawnOf(bakeLit(upright.source()));
  const auto moved = drawnOf(bakeLit(turned.source()));
  EXPECT_EQ(grayFacing(moved, 0, 1), grayFacing(plain, 1, 1));
  EXPECT_EQ(grayFacing(moved, 0, -1), grayFacing(plain, 1, -1));
  EXPECT_EQ(grayFacing(moved, 1, 1), grayFacing(plain, 0, -1));
  EXPECT_EQ(grayFacing(moved, 2, 1), grayFacing(plain, 2, 1));
}

TEST(Light, LinksAreLitAsTheyStandInTheStartPose) {
  SourceBuilder builder;
  const std::uint32_t plastic = builder.material(false);
  builder.place(box({0.1F, 0.2F, 0.15F}), plastic);
  builder.part(1).place(box({0.1F, 0.2F, 0.15F}), plastic);
  bake::FlatKinematics kinematics;
  kinematics.links.resize(2);
  kinematics.links[1].parent = 0;
  kinematics.links[1].type = JointType::kRevolute;
  kinematics.links[1].axis = {0, 0, 1};
  kinematics.links[1].position = 0;
  kinematics.start_positions = {std::numbers::pi_v<float> / 2};
  bake::standInStartPose(builder.source(), kinematics);
  const auto meshes = bakeLit(builder.source());
  const auto base = drawnOf(meshes, 0);
  const auto arm = drawnOf(meshes, 1);
  EXPECT_EQ(grayFacing(arm, 0, 1), grayFacing(base, 1, 1));
  EXPECT_EQ(grayFacing(arm, 1, 1), grayFacing(base, 0, -1));
}

TEST(Light, ChangesNoTriangleAndSplitsNoRoundSurface) {
  SourceBuilder builder;
  const std::uint32_t plastic = builder.material(false);
  builder.place(ball(0.5F, 12), plastic);
  builder.place(box({0.3F, 0.1F, 0.1F}), plastic, movedBy(1, 0, 0));
  const auto plain = bakeLit(builder.source(), Lighting::kNone);
  const auto lit = bakeLit(builder.source());
  EXPECT_TRUE(plain.colors.empty());
  const auto placesOf = [](const bake::BakedRenderMeshes& meshes) {
    std::multiset<std::array<LatticePoint, 3>> places;
    for (const DrawnTriangle& t : drawnOf(meshes)) {
      std::array<LatticePoint, 3> corners{t.corners[0].at, t.corners[1].at, t.corners[2].at};
      std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
      places.insert(corners);
    }
    return places;
  };
  EXPECT_EQ(placesOf(lit), placesOf(plain));
  EXPECT_EQ(openEdges(drawnOf(lit)), 0U);
  // The box has 24 corners instead of 8; the ball keeps its own. Its poles are several places that
  // the lattice makes one.
  const auto cornersOf = [](const bake::BakedRenderMeshes& meshes) {
    std::set<std::pair<LatticePoint, std::uint32_t>> corners;
    for (const DrawnTriangle& t : drawnOf(meshes)) {
      for (const DrawnCorner& corner : t.corners) {
        const bool is_pole = corner.at[0] == 0 && corner.at[2] == 0;
        if (!is_pole) corners.emplace(corner.at, corner.color);
      }
    }
    return corners.size();
  };
  EXPECT_EQ(cornersOf(lit), cornersOf(plain) + 16);
}

TEST(Light, IsKeptAwayByWhatIsNear) {
  SourceBuilder builder;
  const std::uint32_t wood = builder.material(false);
  builder.place(level({-0.1F, 0, -0.1F}, 0.2F, 0.2F), wood);  // under the table
  builder.place(level({3, 0, 3}, 0.2F, 0.2F), wood);          // in the open
  builder.place(box({1, 0.02F, 1}), wood, movedBy(0, 0.3, 0));
  unsigned under = 255;
  unsigned open = 0;
  for (const DrawnTriangle& triangle : drawnOf(bakeLit(builder.source()))) {
    for (const DrawnCorner& corner : triangle.corners) {
      if (corner.position[1] != 0) continue;
      if (corner.position[0] < 1) under = std::min(under, corner.color & 0xFFU);
      if (corner.position[0] > 1) open = std::max(open, corner.color & 0xFFU);
    }
  }
  EXPECT_LT(under + 60, open);
  EXPECT_GT(under, 80U) << "what is dark must still be told apart";
}

TEST(Light, OfASheetSeenFromBothSidesIsThatOfTheBackWhereTheFrontIsCovered) {
  // A floor that faces down, onto a slab: what one sees is its back.
  SourceMesh floor = insideOut(level({-1, 0, -1}, 2, 2));
  const auto grayOfFloor = [&](bool two_sided) {
    SourceBuilder builder;
    const std::uint32_t cloth = builder.material(two_sided);
    builder.place(floor, cloth);
    builder.place(box({1.5F, 0.05F, 1.5F}), builder.material(false), movedBy(0, -0.06, 0));
    for (const DrawnTriangle& triangle : drawnOf(bakeLit(builder.source()))) {
      if (triangle.material == cloth) return triangle.corners[0].color & 0xFFU;
    }
    return 0U;
  };
  EXPECT_GT(grayOfFloor(true), 230U);
  EXPECT_LT(grayOfFloor(false), 130U);
}

TEST(Light, MultipliesColors) {
  SourceBuilder builder;
  SourceMesh mesh = box({0.1F, 0.2F, 0.15F});
  mesh.colors.assign(mesh.positions.size(), {1, 0.2F, 0, 1});
  builder.place(mesh, builder.material(false));
  const auto triangles = drawnOf(bakeLit(builder.source()));
  ASSERT_EQ(triangles.size(), 12U);
  for (const DrawnTriangle& triangle : triangles) {
    for (const DrawnCorner& corner : triangle.corners) {
      const unsigned red = corner.color & 0xFFU;
      EXPECT_LT(red, 255U);
      EXPECT_EQ(corner.color >> 16U & 0xFFU, 0U);
      EXPECT_EQ(corner.color >> 24U, 255U);
      // 0.2 in sRGB is 124 of 255.
      EXPECT_NEAR(corner.color >> 8U & 0xFFU, red * 124.0 / 255, 1);
    }
  }
}

/// Boxes with a plain, a textured and a vertex-colored material, and whether each is lit.
std::array<bool, 3> whichAreLit(Lighting lighting, bool may_hold_light) {
  SourceBuilder builder;
  SourceMesh mesh = box({0.1F, 0.1F, 0.1F});
  const std::array materials{builder.material(false), builder.material(false, true),
                             builder.material(false)};
  builder.place(mesh, materials[0]).place(mesh, materials[1], movedBy(1, 0, 0));
  mesh.colors.assign(mesh.positions.size(), {1, 1, 1, 1});
  builder.place(mesh, materials[2], movedBy(2, 0, 0));
  builder.source().may_hold_light = may_hold_light;
  std::array<bool, 3> lit{};
  for (const DrawnTriangle& triangle : drawnOf(bakeLit(builder.source(), lighting))) {
    for (const DrawnCorner& corner : triangle.corners) {
      if (corner.color != kWhite) lit[triangle.material] = true;
    }
  }
  return lit;
}

TEST(Light, LeavesAloneWhatHasLightOfItsOwn) {
  using Lit = std::array<bool, 3>;
  EXPECT_EQ(whichAreLit(Lighting::kAuto, true), (Lit{true, false, false}));
  EXPECT_EQ(whichAreLit(Lighting::kAuto, false), (Lit{true, true, true}));
  EXPECT_EQ(whichAreLit(Lighting::kAll, true), (Lit{true, true, true}));
  EXPECT_EQ(whichAreLit(Lighting::kNone, true), (Lit{false, false, false}));
  EXPECT_EQ(whichAreLit(Lighting::kNone, false), (Lit{false, false, false}));
}

TEST(Light, DoesNotDependOnThreads) {
  SourceBuilder builder;
  const std::uint32_t wood = builder.material(true);
  for (int n = 0; n < 20; ++n) {
    builder.place(ball(0.1F, 6), wood, movedBy(0.07 * n, 0.05 * (n % 3), 0));
  }
  const auto once = bakeLit(builder.source(), Lighting::kAll, 1);
  for (const unsigned threads : {2U, 7U}) {
    const auto again = bakeLit(builder.source(), Lighting::kAll, threads);
    EXPECT_EQ(again.colors, once.colors);
    EXPECT_EQ(again.vertices, once.vertices);
  }
  EXPECT_GT(std::set(once.colors.begin(), once.colors.end()).size(), 10U);
}

TEST(Light, ManyTrianglesAtOnePlaceShareALight) {
  // A jagged fan: to compare all pairs of its triangles would take long in a larger one.
  SourceMesh fan;
  fan.name = "fan";
  fan.positions.push_back({0, 0, 0});
  constexpr std::uint32_t kCorners = 2000;
  for (std::uint32_t n = 0; n < kCorners; ++n) {
    const double angle = 2 * std::numbers::pi * n / kCorners;
    fan.positions.push_back({static_cast<float>(std::cos(angle)), n % 2 == 0 ? 0.4F : -0.4F,
                             static_cast<float>(std::sin(angle))});
    fan.triangles.push_back({0, 1 + (n + 1) % kCorners, 1 + n});
  }
  SourceBuilder builder;
  builder.place(fan, builder.material(true));
  auto meshes = bake::bakeRenderMeshes(builder.source(), {.error = 0});
  ASSERT_TRUE(meshes);
  std::set<std::uint32_t> middle;
  for (const DrawnTriangle& triangle : drawnOf(*meshes)) {
    for (const DrawnCorner& corner : triangle.corners) {
      if (corner.at == LatticePoint{}) middle.insert(corner.color);
    }
  }
  EXPECT_EQ(middle.size(), 1U);
}

TEST(Light, GoesWithAnyErrorOfSimplification) {
  SourceBuilder builder;
  builder.place(box({0.1F, 0.2F, 0.15F}), builder.material(true));
  for (const double error : {0.49, 0.5, 0.7, 1.0}) {
    const auto meshes = bake::bakeRenderMeshes(builder.source(), {.error = error});
    EXPECT_TRUE(meshes) << meshes.error().text();
  }
}

TEST(Light, PutsUpWithTrianglesOfNoArea) {
  SourceBuilder builder;
  SourceMesh needle = box({0.1F, 0.2F, 0.15F});
  const auto first = static_cast<std::uint32_t>(needle.positions.size());
  needle.positions.insert(needle.positions.end(), {{1, 0, 0}, {2, 0, 0}, {3, 0, 0}});
  needle.triangles.push_back({first, first + 1, first + 2});
  builder.place(needle, builder.material(true));
  const auto triangles = drawnOf(bakeLit(builder.source()));
  ASSERT_EQ(triangles.size(), 13U);
  for (const DrawnTriangle& triangle : triangles) {
    for (const DrawnCorner& corner : triangle.corners) EXPECT_EQ(corner.color >> 24U, 255U);
  }
}

}  // namespace
}  // namespace galactic::test::light_test
