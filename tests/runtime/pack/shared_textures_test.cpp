// Textures that packs share: every wrong value of their packs, and what is drawn with them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "galactic/render_library.h"
#include "galactic/world_models.h"
#include "runtime/check/pack_damage.h"
#include "runtime/check/pack_offence.h"
#include "support/homes/small_home_models.h"
#include "support/packs/texture_pack_builder.h"

namespace galactic::test::shared_textures_test {
namespace {

using Fields = TexturePackFields;

TEST(TexturePack, IsAcceptedAsItIsMade) {
  const AlignedBytes bytes = buildPack(Fields{});
  const Result<PackFile> pack = PackFile::view(bytes.bytes(), "made.pack");
  ASSERT_TRUE(pack.has_value()) << pack.error().text();
  EXPECT_EQ(pack->kind(), PackKind::kTexture);
}

TEST(TexturePack, IsRefusedWithAnyWrongValue) {
  const auto [low, high] = hashOf(Fields{}.texels);
  const std::string wanted = fmt::format("expected {:016x}{:016x}", high, low);
  expectRefused<Fields>(
      Fields{},
      {{"shared_texture.size", "is 3, expected a power of two up to 4096",
        [](Fields& f) { f.size = 3; }},
       {"shared_texture.size", "is 0, expected a power of two up to 4096",
        [](Fields& f) { f.size = 0; }},
       {"shared_texture.size", "is 8192, expected a power of two up to 4096",
        [](Fields& f) { f.size = 8192; }},
       {"shared_texture.format", "is 2, expected a value up to 1", [](Fields& f) { f.format = 2; }},
       {"shared_texture.texels", "has 19 bytes, expected 20",
        [](Fields& f) { f.texels.pop_back(); }},
       {"shared_texture.texels", "has 20 bytes, expected 84", [](Fields& f) { f.size = 4; }},
       {"shared_texture.hash", "is not that of the texels, " + wanted, [](Fields& f) {
          f.hash = TexelHash{1, 2};
        }}});
}

TEST(DamagedTexturePack, IsRefusedAtEachLengthOfATruncation) {
  expectEachTruncationRefused(buildPack(Fields{}));
}

TEST(DamagedTexturePack, IsRefusedWithBytesTooMany) {
  expectBytesTooManyRefused(buildPack(Fields{}));
}

TEST(SharedTextures, AreFoundByTheirHash) {
  const AlignedBytes bytes = buildPack(Fields{});
  const Result<PackFile> pack = PackFile::view(bytes.bytes(), "made.pack");
  ASSERT_TRUE(pack.has_value());
  SharedTextures textures;
  ASSERT_TRUE(textures.add(*pack).has_value());
  ASSERT_TRUE(textures.add(*pack).has_value()) << "twice is once";
  const auto [low, high] = hashOf(Fields{}.texels);
  const RenderTexture* found = textures.find(low, high);
  ASSERT_NE(found, nullptr);
  EXPECT_EQ(found->name, "oak");
  EXPECT_EQ(found->size, 2U);
  EXPECT_EQ(found->texels.size(), 20U);
  EXPECT_EQ(textures.find(high, low), nullptr);
  EXPECT_EQ(textures.find(low, high + 1), nullptr);
}

TEST(SharedTextures, ComeFromTexturePacksOnly) {
  const AlignedBytes bytes = buildPack(smallScene());
  const Result<PackFile> pack = PackFile::view(bytes.bytes(), "room.pack");
  ASSERT_TRUE(pack.has_value());
  SharedTextures textures;
  const auto added = textures.add(*pack);
  ASSERT_FALSE(added.has_value());
  EXPECT_EQ(added.error().where, "room.pack");
  EXPECT_EQ(added.error().message, "is a pack of kind SCEN, expected a texture (TXTR)");
}

/// A home whose room shows the shared texture.
class HomeWithSharedTexture : public testing::Test {
 protected:
  void SetUp() override {
    home_.scene.render_meshes->textures = {{.name = "wall.png", .shared = hashOf(texture_.texels)}};
    home_.scene.render_meshes->texels.clear();
    home_.scene.render_meshes->materials[0].texture = 0;
  }
  /// The world's packs, those of textures last.
  void open(bool with_texture) {
    const std::vector<std::filesystem::path> paths = pathsOf(with_texture);
    Result<World> world = World::open(paths);
    ASSERT_TRUE(world) << world.error().text();
    world_.emplace(std::move(*world));
  }
  [[nodiscard]] std::vector<std::filesystem::path> pathsOf(bool with_texture) const {
    std::vector<std::filesystem::path> paths;
    for (const ReferenceFields& pack : writePacks(folder_, home_).packs) {
      paths.push_back(folder_.path() / pack.path);
    }
    if (with_texture) paths.push_back(folder_.write("oak.pack", textOf(buildPack(texture_))));
    return paths;
  }

  TexturePackFields texture_;
  WorldFields home_ = smallHomeWorldWithModels();
  ScratchFolder folder_;
  std::optional<World> world_;
};

TEST_F(HomeWithSharedTexture, IsDrawnWithTheTexelsOfTheTexturePack) {
  open(true);
  const auto models = WorldModels::from(*world_);
  ASSERT_TRUE(models.has_value()) << models.error().text();
  const auto scene = PackFile::open(folder_.path() / "scenes/kitchen.pack");
  const auto oak = PackFile::open(folder_.path() / "oak.pack");
  SharedTextures textures;
  ASSERT_TRUE(textures.add(*oak).has_value());
  const auto meshes = renderMeshesOf(*scene, textures);
  ASSERT_TRUE(meshes.has_value() && meshes->has_value());
  ASSERT_EQ((*meshes)->textures.size(), 1U);
  EXPECT_EQ((*meshes)->textures[0].texels.front(), 0x60);
  EXPECT_EQ((*meshes)->materials[0].texture, 0);
  EXPECT_TRUE((*meshes)->missing_textures.empty());
}

TEST_F(HomeWithSharedTexture, OpensWithoutItAndSaysWhatDrawingLacks) {
  open(false);
  const auto models = WorldModels::from(*world_);
  ASSERT_FALSE(models.has_value());
  EXPECT_EQ(models.error().code, ErrorCode::kInvalidInput);
  EXPECT_EQ(models.error().where, (folder_.path() / "scenes/kitchen.pack").string());
  const auto [low, high] = hashOf(texture_.texels);
  EXPECT_EQ(models.error().message,
            fmt::format("shares the texture \"wall.png\" ({:016x}{:016x}), which is in no pack of "
                        "the world; add its texture pack",
                        high, low));
  const auto scene = PackFile::open(folder_.path() / "scenes/kitchen.pack");
  const auto meshes = renderMeshesOf(*scene);
  ASSERT_TRUE(meshes.has_value() && meshes->has_value());
  EXPECT_TRUE((*meshes)->textures.empty());
  EXPECT_EQ((*meshes)->materials[0].texture, -1);
  ASSERT_EQ((*meshes)->missing_textures.size(), 1U);
  EXPECT_EQ((*meshes)->missing_textures[0].name, "wall.png");
}

TEST(SharedTextureOfAPack, HasNoPlaceAmongThePacksOwnTexels) {
  ScenePackFields fields = smallScene();
  fields.render_meshes = smallRenderMeshes();
  fields.render_meshes->textures[0].shared = TexelHash{1, 2};
  expectRefused<ScenePackFields>(
      fields,
      {{"scene.render_meshes.textures[0].first_byte", "is 32 of a shared texture, expected 0",
        [](ScenePackFields& f) { f.render_meshes->textures[0].first_byte = 32; }}});
}

}  // namespace
}  // namespace galactic::test::shared_textures_test
