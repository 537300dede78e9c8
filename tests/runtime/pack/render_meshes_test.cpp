// Render meshes as the run reads them from packs.
#include "galactic/render_meshes.h"

#include <gtest/gtest.h>

#include "galactic/pack.h"
#include "support/packs/object_pack_builder.h"
#include "support/packs/scene_pack_builder.h"

namespace galactic::test::render_meshes_test {
namespace {

TEST(RenderMeshes, AreWhatThePackHoldsInPlace) {
  ObjectPackFields fields = smallObjects();
  fields.render_meshes = smallRenderMeshes({1});
  const AlignedBytes bytes = buildPack(fields);
  const Result<PackFile> pack = PackFile::view(bytes.bytes(), "made.pack");
  ASSERT_TRUE(pack.has_value()) << pack.error().text();
  const auto meshes = renderMeshesOf(*pack);
  ASSERT_TRUE(meshes.has_value() && meshes->has_value());
  const RenderMeshes& read = **meshes;
  EXPECT_EQ(read.modelOf(1), 0U);
  EXPECT_FALSE(read.modelOf(0));
  EXPECT_FALSE(read.modelOf(2));
  ASSERT_EQ(read.clusters.size(), 2U);
  EXPECT_EQ(read.clusters[1].origin_x, 200);
  EXPECT_EQ(read.clusters[1].material, 1U);
  EXPECT_TRUE(std::ranges::equal(read.vertices, fields.render_meshes->vertices));
  EXPECT_TRUE(std::ranges::equal(read.cluster_bounds, fields.render_meshes->bounds));
  EXPECT_TRUE(std::ranges::equal(read.triangles, fields.render_meshes->triangles));
  ASSERT_EQ(read.textures.size(), 1U);
  EXPECT_EQ(read.textures[0].texels.size(), 20U);
  EXPECT_EQ(read.semantics[1], "chair");
  const auto* first = reinterpret_cast<const std::byte*>(read.vertices.data());
  EXPECT_TRUE(first > bytes.bytes().data() && first < bytes.bytes().data() + bytes.size());
  constexpr std::size_t kAlignment = 32;
  EXPECT_EQ(static_cast<std::size_t>(first - bytes.bytes().data()) % kAlignment, 0U);
}

TEST(RenderMeshes, OfAPackWithoutThemAreNone) {
  const AlignedBytes bytes = buildPack(smallScene());
  const Result<PackFile> pack = PackFile::view(bytes.bytes(), "made.pack");
  ASSERT_TRUE(pack.has_value());
  const auto meshes = renderMeshesOf(*pack);
  ASSERT_TRUE(meshes.has_value());
  EXPECT_FALSE(meshes->has_value());
}

TEST(RenderMeshes, TextureBytesCountAllLevels) {
  EXPECT_EQ(textureBytes(1, TexelFormat::kRgba8), 4U);
  EXPECT_EQ(textureBytes(4, TexelFormat::kRgba8), 4U * (16 + 4 + 1));
  EXPECT_EQ(textureBytes(8, TexelFormat::kBc1), 8U * (4 + 1 + 1 + 1));
}

}  // namespace
}  // namespace galactic::test::render_meshes_test
