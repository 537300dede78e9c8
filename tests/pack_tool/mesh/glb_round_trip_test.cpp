// GLB files as the mesh importer of the bake reads them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "galactic/bake/mesh_import.h"
#include "galactic/bake/render_textures.h"
#include "galactic/bake/triangle_mesh.h"
#include "pack_tool/asset_packs.h"
#include "pack_tool/figure/figures_of_pack.h"
#include "pack_tool/mesh/figure_glb.h"
#include "pack_tool/painted_meshes.h"
#include "support/packs/scene_pack_builder.h"
#include "support/scratch_folder.h"

namespace galactic::pack_tool::glb_round_trip_test {
namespace {

using test::paintedMeshes;
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
  // Flat triangles stay inside the sphere: by up to 3 % of the larger radius, a quarter meter.
  expectBounds(surface, boundsOf(figuresOf(*pack, options)->front()), 0.0075F);
}

TEST(ExportedGlb, KeepsTheColorsOfVertices) {
  ToyObjects toys;
  toys.objects = {{.colored = true}};
  const ToyPack pack{toys};
  const bake::Surface surface = importedOf(pack, {.layers = only(FigureLayer::kMesh)});
  ASSERT_FALSE(surface.colors.empty());
  EXPECT_THAT(surface.colors, testing::Each(0xff0000ffU));
}

/// What the importer makes of the export of a pack with render meshes.
bake::SourceAsset importedAsset(const PackFile& pack, const FigureOptions& options = {}) {
  const ScratchFolder folder;
  const auto figures = figuresOf(pack, options);
  EXPECT_TRUE(figures.has_value());
  const auto bytes = encodeGlb(*figures);
  EXPECT_TRUE(bytes.has_value());
  bake::MeshImportOptions import;
  import.smallest_size = 0;
  auto asset = bake::importMesh(folder.write("toys.glb", *bytes), import);
  EXPECT_TRUE(asset.has_value()) << asset.error().message;
  return std::move(*asset);
}

/// The material of the first mesh that is called so.
const bake::SourceMaterial& materialOf(const bake::SourceAsset& asset, std::string_view name) {
  const auto found = std::ranges::find(asset.materials, name, &bake::SourceMaterial::name);
  EXPECT_NE(found, asset.materials.end()) << name;
  return *found;
}

test::AlignedBytes paintedScene(const test::Painting& painting) {
  test::ScenePackFields scene = test::smallScene();
  scene.render_meshes = paintedMeshes(painting);
  return buildPack(scene);
}

TEST(ExportedRenderMeshes, HaveTheTrianglesAndNamesOfAScene) {
  const test::AlignedBytes bytes = paintedScene({});
  const auto pack = PackFile::view(bytes.bytes(), "kitchen.pack");
  ASSERT_TRUE(pack.has_value());
  const bake::SourceAsset asset = importedAsset(*pack);
  const bake::Surface surface = bake::surfaceOf(asset, kAsItIs);
  EXPECT_EQ(surface.triangles.size(), 6U);
  expectBounds(surface, {{0, 0, 0}, {2, 1, 1}}, kRounding);
  std::vector<std::string> names;
  for (const bake::SourceInstance& instance : asset.instances) names.push_back(instance.name);
  EXPECT_THAT(names, testing::UnorderedElementsAre("wall", "plant", "floor"));
}

TEST(ExportedRenderMeshes, KeepMaterials) {
  const test::AlignedBytes bytes = paintedScene({});
  const auto pack = PackFile::view(bytes.bytes(), "kitchen.pack");
  ASSERT_TRUE(pack.has_value());
  const bake::SourceAsset asset = importedAsset(*pack);
  const bake::SourceMaterial& leaf = materialOf(asset, "leaf");
  EXPECT_EQ(leaf.alpha_mode, bake::AlphaMode::kMask);
  EXPECT_EQ(leaf.alpha_cutoff, 0.5F);
  EXPECT_TRUE(leaf.two_sided);
  const bake::SourceMaterial& wood = materialOf(asset, "wood");
  EXPECT_EQ(wood.alpha_mode, bake::AlphaMode::kOpaque);
  EXPECT_FALSE(wood.two_sided);
  const bake::SourceMaterial& paint = materialOf(asset, "paint");
  EXPECT_TRUE(paint.base_color_texture.empty());
  EXPECT_NEAR(paint.base_color[0], 0.52712F, 1e-4);
}

TEST(ExportedRenderMeshes, KeepTheTexelsOfTextures) {
  const RenderMeshStorage storage = test::paintedStorage();
  const test::AlignedBytes bytes = paintedScene({});
  const auto pack = PackFile::view(bytes.bytes(), "kitchen.pack");
  ASSERT_TRUE(pack.has_value());
  const bake::SourceAsset asset = importedAsset(*pack);
  const auto baked = bake::bakeMaterials(asset.materials, {.embedded = asset.textures}, {});
  ASSERT_TRUE(baked.has_value()) << baked.error().message;
  EXPECT_THAT(baked->warnings, testing::IsEmpty());
  ASSERT_EQ(baked->textures.size(), 2U);
  for (const char* name : {"wood", "leaf"}) {
    const auto& material = *std::ranges::find(baked->materials, name, &bake::BakedMaterial::name);
    ASSERT_GE(material.texture, 0);
    const auto& texture = baked->textures[static_cast<std::size_t>(material.texture)];
    const bool wood = material.name == "wood";
    const RenderMeshes meshes = storage.view();
    const RenderTexture& wanted = meshes.textures[wood ? 0 : 1];
    ASSERT_EQ(texture.size, wanted.size);
    // The level that came from the pack; what alpha hides has no color that matters.
    for (std::size_t n = 0; n < std::size_t{4} * wanted.size * wanted.size; ++n) {
      if (!wood && wanted.texels[n / 4 * 4 + 3] == 0) continue;
      ASSERT_EQ(baked->texels[texture.first_byte + n], wanted.texels[n]) << name << ' ' << n;
    }
  }
}

TEST(ExportedRenderMeshes, KeepTextureCoordinatesAndColors) {
  const test::AlignedBytes bytes = paintedScene({.colored = true});
  const auto pack = PackFile::view(bytes.bytes(), "kitchen.pack");
  ASSERT_TRUE(pack.has_value());
  const bake::SourceAsset asset = importedAsset(*pack);
  for (const bake::SourceMesh& mesh : asset.meshes) {
    if (asset.materials[mesh.material].name == "paint") continue;
    ASSERT_EQ(mesh.uvs.size(), mesh.positions.size());
    for (std::size_t n = 0; n < mesh.uvs.size(); ++n) {
      // The image lies from x = 0 to the far edge twice, its top at y = 1.
      const float width = asset.materials[mesh.material].name == "leaf" ? 1 : 2;
      EXPECT_NEAR(mesh.uvs[n][0], 2 * mesh.positions[n].x / width, kRounding);
      EXPECT_NEAR(mesh.uvs[n][1], mesh.positions[n].y, kRounding);
    }
    ASSERT_EQ(mesh.colors.size(), mesh.positions.size());
  }
}

TEST(ExportedRenderMeshes, StandAtTheLinksOfARobot) {
  ToyRobot toy;
  toy.render_meshes = paintedMeshes({.parts = {0, 4}});
  const ToyPack pack{toy};
  FigureOptions options{.layers = only(FigureLayer::kMesh)};
  const bake::Surface surface = bake::surfaceOf(importedAsset(*pack, options), kAsItIs);
  // Six of the base, six of the head two meters above it, and the surface of the upper arm, which
  // has no render model.
  EXPECT_EQ(surface.triangles.size(), 6U + 6 + 12);
  float top = 0;
  for (const Vec3& p : surface.positions) top = std::max(top, p.y);
  // Root height, neck, and the wall's height.
  EXPECT_NEAR(top, 0.5F + 2 + 1, kRounding);
}

}  // namespace
}  // namespace galactic::pack_tool::glb_round_trip_test
