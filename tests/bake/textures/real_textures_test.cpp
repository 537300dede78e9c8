// Textures of the assets that users have.
#include <gmock/gmock.h>

#include "galactic/bake/mesh_import.h"
#include "galactic/bake/render_textures.h"
#include "support/assets.h"

namespace galactic::test::real_textures_test {
namespace {

using bake::BakedMaterials;
using testing::IsEmpty;

/// Imports one file of the assets and bakes its materials.
class RealTextures : public testing::Test {
 protected:
  void SetUp() override {
    for (const char* folder : {"replica_cad", "ycb"}) {
      if (exists(assetsFolder() / folder)) continue;
      GTEST_SKIP() << "set GALACTIC_ASSETS to a folder with replica_cad/ and ycb/ in it";
    }
  }

  static BakedMaterials bakeFile(const std::string& name) {
    const std::filesystem::path path = assetsFolder() / name;
    bake::MeshImportOptions options;
    options.smallest_size = 0;
    const auto asset = bake::importMesh(path, options);
    EXPECT_TRUE(asset.has_value()) << asset.error().message;
    if (!asset) return {};
    const auto baked = bake::bakeMaterials(asset->materials, {asset->textures, path.parent_path()},
                                           {.largest = 256}, 2);
    EXPECT_TRUE(baked.has_value());
    return baked.value_or(BakedMaterials{});
  }
};

TEST_F(RealTextures, OfAReplicaCadObjectAreEmbedded) {
  const BakedMaterials baked = bakeFile("replica_cad/objects/frl_apartment_sofa.glb");
  ASSERT_EQ(baked.textures.size(), 1U);
  EXPECT_EQ(baked.textures[0].size, 256U);
  EXPECT_EQ(baked.texels.size(), textureBytes(256, TexelFormat::kRgba8));
  EXPECT_THAT(baked.warnings, IsEmpty());
}

TEST_F(RealTextures, OfAYcbObjectAreFilesBesideIt) {
  const BakedMaterials baked = bakeFile("ycb/024_bowl/textured.obj");
  ASSERT_EQ(baked.textures.size(), 1U);
  EXPECT_EQ(baked.textures[0].name, "texture_map.png");
  EXPECT_THAT(baked.warnings, IsEmpty());
}

}  // namespace
}  // namespace galactic::test::real_textures_test
