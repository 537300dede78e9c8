// Which points of meshes make hulls.
#include "dynamics/sources/hull_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "dynamics/world.h"
#include "galactic/bake/mesh_import.h"
#include "support/mesh_files.h"
#include "support/scratch_folder.h"
#include "support/source_asset.h"
#include "support/test_meshes.h"

namespace galactic::test::hull_points_test {
namespace {

using bake::SourceAsset;
using dynamics::checkExtents;
using dynamics::cornersOf;
using dynamics::HullPoints;
using dynamics::piecesOf;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// A box of half a meter, from the origin.
SourceAsset boxAsset() { return sourceAssetOf(MeshBuilder().box({}, {0.5F, 0.5F, 0.5F}).build()); }

void expectSame(const HullPoints& found, const HullPoints& wanted) {
  EXPECT_TRUE(std::ranges::equal(found, wanted, [](const Vec3& a, const Vec3& b) {
    return a.x == b.x && a.y == b.y && a.z == b.z;
  }));
}

/// Places a mesh of one triangle, which has three corners.
void addTriangle(SourceAsset& asset) {
  const auto mesh = static_cast<std::uint32_t>(asset.meshes.size());
  bake::SourceMesh& sheet = asset.meshes.emplace_back();
  sheet.positions = {{}, {1, 0, 0}, {0, 0, 1}};
  sheet.triangles = {{0, 1, 2}};
  asset.instances.push_back({"sheet", mesh, asset.instances.front().world_from_mesh});
}

TEST(Corners, AreThoseOfTrianglesOnly) {
  SourceAsset asset = boxAsset();
  const std::size_t used = asset.meshes.front().positions.size();
  asset.meshes.front().positions.push_back({9, 9, 9});
  asset.meshes.front().positions.push_back({kNaN, 0, 0});
  const HullPoints corners = cornersOf(asset);
  EXPECT_EQ(corners.size(), used);
  for (const Vec3& corner : corners) EXPECT_LE(std::max({corner.x, corner.y, corner.z}), 0.5F);
  // Points that are no numbers crash Bullet's hulls.
  EXPECT_NE(dynamics::makeObjectShape({.hulls = {corners}}), nullptr);
  ASSERT_EQ(piecesOf(asset, false).size(), 1U);
  expectSame(piecesOf(asset, false).front(), corners);
}

TEST(Corners, ReachAsFarAsBakesAllow) {
  constexpr float kFar = 800;
  constexpr float kFarther = 800.1F;
  for (const Vec3& far : {Vec3{kFar, 0, 0}, Vec3{0, -kFar, 0}, Vec3{0, 0, kFar}}) {
    EXPECT_TRUE(checkExtents(std::vector<HullPoints>{{{}, far}}, "mug.glb").has_value());
  }
  for (const Vec3& far : {Vec3{-kFarther, 0, 0}, Vec3{0, kFarther, 0}, Vec3{0, 0, -kFarther}}) {
    const auto refused = checkExtents(std::vector<HullPoints>{{{}}, {{}, far}}, "mug.glb");
    ASSERT_FALSE(refused.has_value());
    EXPECT_EQ(refused.error().code, ErrorCode::kInvalidInput);
    EXPECT_EQ(refused.error().where, "mug.glb");
    EXPECT_EQ(refused.error().message,
              "it reaches 800.1 m from the origin, but only 800 m are possible; is its unit the "
              "meter?");
  }
  EXPECT_FALSE(checkExtents(std::vector<HullPoints>{{{0, kNaN, 0}}}, "mug.glb").has_value());
}

TEST(Corners, LieWhereTheirMeshesArePlaced) {
  SourceAsset asset = boxAsset();
  asset.instances.push_back({"again", 0, {2, 0, 0, 10, 0, 2, 0, 0, 0, 0, 2, 0}});
  const HullPoints corners = cornersOf(asset);
  ASSERT_EQ(corners.size(), 2 * asset.meshes.front().positions.size());
  const auto most =
      std::ranges::max_element(corners, {}, [](const Vec3& corner) { return corner.x; });
  EXPECT_EQ(most->x, 11);
  EXPECT_EQ(piecesOf(asset, false).size(), 2U);
  ASSERT_EQ(piecesOf(asset, true).size(), 1U);
  expectSame(piecesOf(asset, true).front(), corners);
}

TEST(Corners, OfFilesLeaveOutStrayVertices) {
  const ScratchFolder folder;
  MeshContent box = unevenBox();
  const auto clean = bake::importMesh(folder.write("clean.ply", plyAsciiFile(box))).value();
  box.positions.push_back({70, 80, 90});
  const auto stray = bake::importMesh(folder.write("stray.ply", plyAsciiFile(box))).value();
  expectSame(cornersOf(stray), cornersOf(clean));
}

TEST(Pieces, AreThoseThatHaveFourCorners) {
  SourceAsset asset = boxAsset();
  addTriangle(asset);
  EXPECT_EQ(piecesOf(asset, false).size(), 1U);
  EXPECT_EQ(piecesOf(asset, true).front().size(), cornersOf(asset).size());
  asset.meshes.erase(asset.meshes.begin());
  asset.instances = {{"sheet", 0, asset.instances.front().world_from_mesh}};
  EXPECT_TRUE(piecesOf(asset, false).empty());
  EXPECT_TRUE(piecesOf(asset, true).empty());
}

TEST(AHull, OfOneTriangleIsABody) {
  const HullPoints corners{{}, {1, 0, 0}, {0, 0, 1}};
  EXPECT_NE(dynamics::makeObjectShape({.hulls = {corners}}), nullptr);
}

}  // namespace
}  // namespace galactic::test::hull_points_test
