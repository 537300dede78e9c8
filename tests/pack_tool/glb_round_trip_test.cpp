// GLB files as the mesh importer of the bake reads them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "galactic/bake/mesh_import.h"
#include "galactic/bake/surface.h"
#include "pack_tool/asset_packs.h"
#include "pack_tool/figure/figures_of_pack.h"
#include "pack_tool/mesh/figure_glb.h"
#include "support/scratch_folder.h"

namespace galactic::pack_tool {
namespace {

using test::ScratchFolder;
using test::ToyObjects;
using test::ToyPack;
using test::ToyRobot;

constexpr bake::Affine kAsItIs{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
constexpr float kRounding = 1e-5F;

bake::Surface importedOf(const ToyPack& pack, const FigureOptions& options) {
  const ScratchFolder folder;
  const auto figures = figuresOf(*pack, options);
  EXPECT_TRUE(figures.has_value());
  const auto bytes = encodeGlb(*figures);
  EXPECT_TRUE(bytes.has_value());
  bake::MeshImportOptions import;
  import.smallest_size = 0;
  const auto asset = bake::importMesh(folder.write("toys.glb", *bytes), import);
  EXPECT_TRUE(asset.has_value()) << asset.error().message;
  return bake::surfaceOf(*asset, kAsItIs);
}

LayerSet only(FigureLayer layer) {
  LayerSet layers = LayerSet::none();
  layers.add(layer);
  return layers;
}

void expectBounds(const bake::Surface& surface, const FigureBounds& wanted, float tolerance) {
  Vec3 low = surface.positions.front();
  Vec3 high = low;
  for (const Vec3& p : surface.positions) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  EXPECT_NEAR(low.x, wanted.min.x, tolerance);
  EXPECT_NEAR(low.y, wanted.min.y, tolerance);
  EXPECT_NEAR(low.z, wanted.min.z, tolerance);
  EXPECT_NEAR(high.x, wanted.max.x, tolerance);
  EXPECT_NEAR(high.y, wanted.max.y, tolerance);
  EXPECT_NEAR(high.z, wanted.max.z, tolerance);
}

TEST(ExportedGlb, HasTheMeshesOfARobotInItsPose) {
  const ToyPack pack{ToyRobot{}};
  const FigureOptions options{.joints = {.values = {{"lift", 1.25F}}},
                              .layers = only(FigureLayer::kMesh)};
  const bake::Surface surface = importedOf(pack, options);
  EXPECT_EQ(surface.triangles.size(), 24U);
  expectBounds(surface, boundsOf(figuresOf(*pack, options)->front()), kRounding);
}

TEST(ExportedGlb, HasASphereForEachOfThePack) {
  const ToyPack pack{ToyRobot{}};
  const FigureOptions options{.layers = only(FigureLayer::kSpheres)};
  const bake::Surface surface = importedOf(pack, options);
  EXPECT_EQ(surface.triangles.size(), 4U * 320);
  // Flat triangles stay inside the sphere: by up to 3 % of the larger radius, a quarter metre.
  expectBounds(surface, boundsOf(figuresOf(*pack, options)->front()), 0.0075F);
}

TEST(ExportedGlb, KeepsTheColoursOfVertices) {
  ToyObjects toys;
  toys.objects = {{.coloured = true}};
  const ToyPack pack{toys};
  const bake::Surface surface = importedOf(pack, {.layers = only(FigureLayer::kMesh)});
  ASSERT_FALSE(surface.colors.empty());
  EXPECT_THAT(surface.colors, testing::Each(0xff0000ffU));
}

}  // namespace
}  // namespace galactic::pack_tool
