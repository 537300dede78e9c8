// Colored surfaces of assets.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "galactic/bake/triangle_mesh.h"
#include "support/source_asset.h"

namespace galactic::test::surface_test {
namespace {

using bake::append;
using bake::Surface;
using bake::surfaceColor;
using bake::surfaceOf;
using testing::ElementsAre;

constexpr bake::Affine kIdentity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
/// What parts without a color get among parts with one: linear 0.6.
constexpr std::uint32_t kNeutral = 0xffcbcbcb;

TEST(SurfaceColor, IsSrgbWithRedLowestAndLinearAlpha) {
  EXPECT_EQ(surfaceColor({0, 0, 0, 0}), 0U);
  EXPECT_EQ(surfaceColor({1, 1, 1, 1}), 0xffffffffU);
  EXPECT_EQ(surfaceColor({1, 0, 0, 1}), 0xff0000ffU);
  EXPECT_EQ(surfaceColor({0, 0, 1, 0.5F}), 0x80ff0000U);
  // IEC 61966-2-1: linear 0.2159 is code 128, 0.001 is on the straight piece.
  EXPECT_EQ(surfaceColor({0.2159F, 0.001F, 0, 1}), 0xff000380U);
  EXPECT_EQ(surfaceColor({-3, 7, 0, 2}), 0xff00ff00U) << "held in 0 to 1";
}

bake::SourceAsset triangle() {
  bake::SourceAsset asset;
  bake::SourceMesh& mesh = asset.meshes.emplace_back();
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  asset.materials.emplace_back().base_color = {1, 0.2159F, 0, 1};
  asset.instances.push_back({"", 0, kIdentity});
  return asset;
}

TEST(Surface, TakesTheMaterialTimesTheVertexColors) {
  bake::SourceAsset asset = triangle();
  EXPECT_THAT(surfaceOf(asset, kIdentity).colors, testing::Each(0xff0080ffU));
  asset.meshes[0].colors = {{1, 1, 1, 1}, {0, 1, 1, 1}, {1, 0, 1, 0}};
  EXPECT_THAT(surfaceOf(asset, kIdentity).colors,
              ElementsAre(0xff0080ffU, 0xff008000U, 0x000000ffU));
  const std::array<float, 4> blue{0, 0, 1, 1};
  EXPECT_THAT(surfaceOf(asset, kIdentity, &blue).colors, testing::Each(0xffff0000U));
}

TEST(Surface, PlacesInstancesAndKeepsMirroredOnesOutsideOut) {
  bake::SourceAsset asset = triangle();
  asset.instances.push_back({"", 0, {-1, 0, 0, 5, 0, 1, 0, 0, 0, 0, 1, 0}});
  const Surface surface = surfaceOf(asset, {2, 0, 0, 0, 0, 2, 0, 1, 0, 0, 2, 0});
  EXPECT_THAT(surface.positions, ElementsAre(Vec3{0, 1, 0}, Vec3{2, 1, 0}, Vec3{0, 3, 0},
                                             Vec3{10, 1, 0}, Vec3{8, 1, 0}, Vec3{10, 3, 0}));
  EXPECT_THAT(surface.triangles, ElementsAre(bake::Triangle{0, 1, 2}, bake::Triangle{3, 5, 4}));
}

TEST(Surface, AppendsPartsWithAndWithoutColors) {
  Surface plain;
  plain.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  plain.triangles = {{0, 1, 2}};
  Surface red = plain;
  red.colors.assign(3, 0xff0000ff);

  Surface all;
  EXPECT_TRUE(all.empty());
  append(all, plain);
  EXPECT_TRUE(all.colors.empty());
  append(all, red);
  append(all, plain);
  EXPECT_FALSE(all.empty());
  EXPECT_THAT(all.colors, ElementsAre(kNeutral, kNeutral, kNeutral, 0xff0000ff, 0xff0000ff,
                                      0xff0000ff, kNeutral, kNeutral, kNeutral));
  EXPECT_THAT(all.triangles, ElementsAre(bake::Triangle{0, 1, 2}, bake::Triangle{3, 4, 5},
                                         bake::Triangle{6, 7, 8}));
}

}  // namespace
}  // namespace galactic::test::surface_test
