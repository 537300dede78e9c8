// Scenes that lie on their side, told by their widest levels.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "import/checks/asset_check.h"
#include "support/source_asset.h"
#include "support/test_meshes.h"

namespace galactic::test::level_floor_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// The inside of a room of 8 x 3 x 6 m, with a table in it, as a glTF file gives it.
bake::SourceAsset room() {
  MeshBuilder builder;
  constexpr float kWall = 0.1F;
  const Vec3 size{8, 3, 6};
  builder.box({0, -kWall, 0}, {size.x, 0, size.z});
  builder.box({0, size.y, 0}, {size.x, size.y + kWall, size.z});
  builder.box({-kWall, 0, 0}, {0, size.y, size.z});
  builder.box({size.x, 0, 0}, {size.x + kWall, size.y, size.z});
  builder.box({0, 0, -kWall}, {size.x, size.y, 0});
  builder.box({0, 0, size.z}, {size.x, size.y, size.z + kWall});
  builder.box({2, 0.7F, 2}, {4, 0.75F, 3});
  bake::SourceAsset asset = sourceAssetOf(builder.build());
  asset.format = "glTF 2.0";
  return asset;
}

/// As a file that has Z up is read: what was up points along Z.
void layOnItsSide(bake::SourceAsset& asset) {
  asset.instances.front().world_from_mesh = {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0};
}

TEST(LevelFloors, ShowThatASceneLiesOnItsSide) {
  bake::SourceAsset asset = room();
  layOnItsSide(asset);
  bake::warnAboutUp(asset);
  // A wall and the floor, each with the edges of the slabs beside it.
  EXPECT_THAT(asset.warnings,
              ElementsAre("the scene seems to lie on its side: its widest level has 26.2 m2, and "
                          "would have 50.8 m2 with the file's Z axis up, as the scans of "
                          "Matterport3D and HM3D have it; give `up` z, or `up` y if it is right"));
}

TEST(LevelFloors, LieInWhatStandsUpright) {
  bake::SourceAsset asset = room();
  bake::warnAboutUp(asset);
  EXPECT_THAT(asset.warnings, IsEmpty());
}

TEST(LevelFloors, AreSeenInMirrorImages) {
  bake::SourceAsset asset = room();
  // Mirrored along X, so that the triangles' order turns around.
  asset.instances.front().world_from_mesh = {-1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0};
  bake::warnAboutUp(asset);
  EXPECT_EQ(asset.warnings.size(), 1U);
}

TEST(LevelFloors, AreNoMatterInOtherFormats) {
  bake::SourceAsset asset = room();
  layOnItsSide(asset);
  asset.format = "STL";
  bake::warnAboutUp(asset);
  EXPECT_THAT(asset.warnings, IsEmpty());
}

TEST(LevelFloors, OfAHighHallMayBeNarrowerThanItsWalls) {
  MeshBuilder builder;
  builder.floor({0, 0, 0}, {4, 0, 9}, 0);
  // A wall that faces along Z and is wider than the floor.
  builder.quad({Vec3{0, 0, 0}, {4, 0, 0}, {4, 20, 0}, {0, 20, 0}});
  bake::SourceAsset hall = sourceAssetOf(builder.build());
  hall.format = "glTF 2.0";
  bake::warnAboutUp(hall);
  EXPECT_THAT(hall.warnings, testing::SizeIs(1)) << "wider by more than half";
  MeshBuilder lower;
  lower.floor({0, 0, 0}, {4, 0, 9}, 0);
  lower.quad({Vec3{0, 0, 0}, {4, 0, 0}, {4, 13, 0}, {0, 13, 0}});
  bake::SourceAsset low = sourceAssetOf(lower.build());
  low.format = "glTF 2.0";
  bake::warnAboutUp(low);
  EXPECT_THAT(low.warnings, IsEmpty());
}

}  // namespace
}  // namespace galactic::test::level_floor_test
