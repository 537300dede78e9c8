// From which sides the pieces of a part are seen.
#include <gtest/gtest.h>

#include "bake/render/render_helpers.h"
#include "support/test_meshes.h"

namespace galactic::test::sides_test {
namespace {

constexpr bool kOneSided = false;
constexpr bool kTwoSided = true;

bake::SourceMesh cube(float size = 0.2F) {
  return meshOf(
      MeshBuilder().box({0.1F, 0.1F, 0.1F}, {0.1F + size, 0.1F + size, 0.1F + size}).build());
}

/// A cube without its lid.
bake::SourceMesh openBox() {
  bake::SourceMesh mesh = cube();
  mesh.triangles.resize(mesh.triangles.size() - 2);
  return mesh;
}

std::vector<DrawnTriangle> baked(const SourceBuilder& builder, double error = 0) {
  const auto meshes =
      bake::bakeRenderMeshes(builder.source(), {.error = error, .lighting = bake::Lighting::kNone});
  EXPECT_TRUE(meshes) << meshes.error().text();
  if (!meshes) return {};
  return drawnTriangles(meshes->view(), 0);
}

std::vector<DrawnTriangle> bakedAlone(const bake::SourceMesh& mesh, bool two_sided,
                                      const bake::Affine& placed = kHere) {
  SourceBuilder builder;
  const std::uint32_t material = builder.material(two_sided);
  return baked(builder.place(mesh, material, placed));
}

TEST(Sides, OfAClosedCubeAreOneAlthoughItsMaterialSaysTwo) {
  const auto triangles = bakedAlone(cube(), kTwoSided);
  EXPECT_EQ(triangles.size(), 12U);
  EXPECT_EQ(twoSidedCount(triangles), 0U);
  EXPECT_NEAR(enclosedVolume(triangles), 0.008, 1e-5);
}

TEST(Sides, OfAnInsideOutCubeAreTurned) {
  const auto triangles = bakedAlone(insideOut(cube()), kTwoSided);
  EXPECT_EQ(twoSidedCount(triangles), 0U);
  EXPECT_NEAR(enclosedVolume(triangles), 0.008, 1e-5);
}

TEST(Sides, OfAnInsideOutCubeStayWhenItsMaterialMeansThem) {
  const auto triangles = bakedAlone(insideOut(cube()), kOneSided);
  EXPECT_EQ(twoSidedCount(triangles), 0U);
  EXPECT_NEAR(enclosedVolume(triangles), -0.008, 1e-5);
}

TEST(Sides, OfAMirroredCubeFaceOutwards) {
  const bake::Affine mirrored{-1, 0, 0, 0.5, 0, 1, 0, 0, 0, 0, 1, 0};
  for (const bool sides : {kOneSided, kTwoSided}) {
    EXPECT_NEAR(enclosedVolume(bakedAlone(cube(), sides, mirrored)), 0.008, 1e-5);
  }
}

TEST(Sides, OfAnOpenBoxStayTwo) {
  const auto triangles = bakedAlone(openBox(), kTwoSided);
  EXPECT_EQ(twoSidedCount(triangles), 10U);
}

TEST(Sides, OfAnOpenBoxStayOneWhenItsMaterialSaysSo) {
  EXPECT_EQ(twoSidedCount(bakedAlone(openBox(), kOneSided)), 0U);
}

TEST(Sides, OfARoomStayTwoForACameraWithinIt) {
  const auto room = meshOf(MeshBuilder().box({0, 0, 0}, {4, 2.5F, 5}).build());
  EXPECT_EQ(twoSidedCount(bakedAlone(room, kTwoSided)), 12U);
  EXPECT_EQ(twoSidedCount(bakedAlone(insideOut(room), kTwoSided)), 12U);
}

TEST(Sides, OfANarrowRoomStayTwoAndOfItsFurnitureAreOne) {
  for (const float width : {0.5F, 1.0F, 1.4F}) {
    const auto corridor = meshOf(MeshBuilder().box({0, 0, 0}, {width, 2.5F, 6}).build());
    for (const bool faces_inward : {false, true}) {
      SourceBuilder builder;
      const std::uint32_t material = builder.material(kTwoSided);
      builder.place(faces_inward ? insideOut(corridor) : corridor, material)
          .place(cube(), material);
      builder.source().rooms = {{{0.03F, 0.02F, 0.03F}, {width - 0.03F, 2.48F, 5.97F}}};
      EXPECT_EQ(twoSidedCount(baked(builder)), 12U) << "width " << width;
    }
  }
}

TEST(Sides, OfACubeOfTwoMaterialsThatMeetAreOne) {
  const bake::SourceMesh whole = cube();
  bake::SourceMesh lower = whole;
  bake::SourceMesh upper = whole;
  lower.triangles.resize(6);
  upper.triangles.erase(upper.triangles.begin(), upper.triangles.begin() + 6);
  SourceBuilder builder;
  const std::uint32_t first = builder.material(kTwoSided);
  const std::uint32_t second = builder.material(kTwoSided);
  const auto triangles = baked(builder.place(lower, first).place(upper, second));
  EXPECT_EQ(triangles.size(), 12U);
  EXPECT_EQ(twoSidedCount(triangles), 0U);
}

TEST(Sides, OfACutOutSurfaceStayTwo) {
  SourceBuilder builder;
  const std::uint32_t leaves = builder.material(kTwoSided, true, 0.5F);
  EXPECT_EQ(twoSidedCount(baked(builder.place(cube(), leaves))), 12U);
}

TEST(Sides, AreDecidedPieceByPiece) {
  SourceBuilder builder;
  const std::uint32_t material = builder.material(kTwoSided);
  const auto triangles =
      baked(builder.place(cube(), material).place(openBox(), material, movedBy(1, 0, 0)));
  EXPECT_EQ(triangles.size(), 22U);
  EXPECT_EQ(twoSidedCount(triangles), 10U);
}

TEST(Sides, OfASheetAndItsBackStayTwo) {
  bake::SourceMesh sheet = meshOf(MeshBuilder().floor({0, 0, 0}, {0.3F, 0, 0.2F}, 0.5F).build());
  const auto front = sheet.triangles;
  for (bake::Triangle t : front) sheet.triangles.push_back({t[0], t[2], t[1]});
  EXPECT_EQ(twoSidedCount(bakedAlone(sheet, kTwoSided)), 4U);
}

TEST(Sides, OfASphereAreOneAfterSimplificationAndItHasNoCrack) {
  const auto sphere = meshOf(MeshBuilder().sphere({0.3F, 0.4F, 0.5F}, 0.2F, 40).build());
  SourceBuilder builder;
  const std::uint32_t material = builder.material(kTwoSided);
  const auto triangles = baked(builder.place(sphere, material), 0.004);
  EXPECT_LT(triangles.size(), sphere.triangles.size() / 2);
  EXPECT_EQ(twoSidedCount(triangles), 0U);
  EXPECT_EQ(openEdges(triangles), 0U);
  EXPECT_NEAR(enclosedVolume(triangles), 4.0 / 3 * 3.14159 * 0.008, 0.0015);
}

}  // namespace
}  // namespace galactic::test::sides_test
