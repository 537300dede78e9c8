// What materials say, as the formats say it.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "import_helpers.h"
#include "support/mesh_files.h"
#include "support/scratch_folder.h"

namespace galactic::test {
namespace {

using bake::AlphaMode;
using bake::importMesh;
using bake::SourceMaterial;
using testing::ElementsAre;

/// The material of a GLB that has this one (JSON).
SourceMaterial gltfMaterial(std::string_view material) {
  const GltfPieces pieces{.nodes = GltfPieces{}.nodes,
                          .buffer_uri = {},
                          .more = fmt::format(R"(,"materials":[{}])", material)};
  std::string json = gltfFile(unevenBox(), pieces);
  const std::string_view primitive_end = R"("indices":0)";
  json.insert(json.find(primitive_end) + primitive_end.size(), R"(,"material":0)");
  const auto asset = importContent("box.glb", glbContainer(json, gltfBuffer(unevenBox())));
  EXPECT_TRUE(asset.has_value()) << asset.error().message;
  return asset ? asset->materials[asset->meshes[0].material] : SourceMaterial{};
}

TEST(GltfMaterials, SayWhatTheirAlphaMeans) {
  EXPECT_EQ(gltfMaterial(R"({"name":"plain"})").alpha_mode, AlphaMode::kOpaque);
  const SourceMaterial leaf = gltfMaterial(R"({"alphaMode":"MASK"})");
  EXPECT_EQ(leaf.alpha_mode, AlphaMode::kMask);
  EXPECT_EQ(leaf.alpha_cutoff, 0.5F);
  const SourceMaterial net = gltfMaterial(R"({"alphaMode":"MASK","alphaCutoff":0.25})");
  EXPECT_EQ(net.alpha_mode, AlphaMode::kMask);
  EXPECT_EQ(net.alpha_cutoff, 0.25F);
  const SourceMaterial glass = gltfMaterial(
      R"({"alphaMode":"BLEND","pbrMetallicRoughness":{"baseColorFactor":[1,1,1,0.5]}})");
  EXPECT_EQ(glass.alpha_mode, AlphaMode::kBlend);
  EXPECT_THAT(glass.base_color, ElementsAre(1.F, 1.F, 1.F, 0.5F));
}

TEST(GltfMaterials, LoseImagesInOtherFormatsWithAWarning) {
  for (const auto& [extension, format] :
       {std::pair{"KHR_texture_basisu", "KTX2"}, {"EXT_texture_webp", "WebP"}}) {
    const GltfPieces pieces{
        .nodes = GltfPieces{}.nodes,
        .buffer_uri = {},
        .more = fmt::format(
            R"(,"materials":[{{"pbrMetallicRoughness":{{"baseColorTexture":{{"index":0}}}}}}],)"
            R"("textures":[{{"extensions":{{"{0}":{{"source":0}}}}}}],)"
            R"("images":[{{"uri":"a.image"}}],"extensionsUsed":["{0}"],"extensionsRequired":["{0}"])",
            extension)};
    std::string json = gltfFile(unevenBox(), pieces);
    const std::string_view primitive_end = R"("indices":0)";
    json.insert(json.find(primitive_end) + primitive_end.size(), R"(,"material":0)");
    const auto asset = importContent("box.glb", glbContainer(json, gltfBuffer(unevenBox())));
    ASSERT_TRUE(asset.has_value()) << asset.error().message;
    EXPECT_EQ(asset->materials[asset->meshes[0].material].base_color_texture, "");
    EXPECT_THAT(asset->warnings,
                ElementsAre(fmt::format("textures in {} ({}) cannot be read: their surfaces keep "
                                        "their plain colour; export them as PNG or JPEG",
                                        format, extension)));
  }
}

/// The only named material of an OBJ whose MTL has these lines; "a.png" and "b.png" exist.
struct ObjImport {
  SourceMaterial material;
  std::vector<std::string> warnings;
};

ObjImport objMaterial(std::string_view lines) {
  const ScratchFolder folder;
  static_cast<void>(folder.write("a.png", "picture"));
  static_cast<void>(folder.write("b.png", "picture"));
  static_cast<void>(folder.write("a.mtl", fmt::format("newmtl paint\n{}", lines)));
  const auto asset = importMesh(folder.write(
      "a.obj", "mtllib a.mtl\nv 0 0 0\nv 3 0 0\nv 0 0 3\nvt 0 0\nusemtl paint\nf 1/1 2/1 3/1\n"));
  EXPECT_TRUE(asset.has_value()) << asset.error().message;
  if (!asset) return {};
  return {asset->materials[asset->meshes[0].material], asset->warnings};
}

TEST(ObjMaterials, MultiplyATextureOnlyWithAColourThatIsMeant) {
  const auto factor = [](std::string_view lines) { return objMaterial(lines).material.base_color; };
  EXPECT_THAT(factor("map_Kd a.png\n"), ElementsAre(1.F, 1.F, 1.F, 1.F));
  EXPECT_THAT(factor("Kd 0 0 0\nmap_Kd a.png\n"), ElementsAre(1.F, 1.F, 1.F, 1.F));
  EXPECT_THAT(factor("Kd 0.5 1 1\nmap_Kd a.png\n"), ElementsAre(0.5F, 1.F, 1.F, 1.F));
  EXPECT_THAT(factor("Kd 0 0 0\n"), ElementsAre(0.F, 0.F, 0.F, 1.F));
}

TEST(ObjMaterials, BlendWhereOpacityLiesBetweenItsEnds) {
  const SourceMaterial glass = objMaterial("Kd 1 1 1\nd 0.25\n").material;
  EXPECT_EQ(glass.alpha_mode, AlphaMode::kBlend);
  EXPECT_EQ(glass.base_color[3], 0.25F);
  // Scans come with "Tr 1" and mean opaque.
  for (const char* lines : {"Kd 1 1 1\n", "Kd 1 1 1\nd 1\n", "Kd 1 1 1\nTr 1.0\n"}) {
    const SourceMaterial solid = objMaterial(lines).material;
    EXPECT_EQ(solid.alpha_mode, AlphaMode::kOpaque) << lines;
    EXPECT_EQ(solid.base_color[3], 1.F) << lines;
  }
}

TEST(ObjMaterials, UseTheAlphaOfTheirTextureWhenTheySaySo) {
  const ObjImport leaf = objMaterial("map_Kd a.png\nmap_d a.png\n");
  EXPECT_EQ(leaf.material.alpha_mode, AlphaMode::kBlend);
  EXPECT_THAT(leaf.warnings, ElementsAre());
  const ObjImport other = objMaterial("map_Kd a.png\nmap_d b.png\n");
  EXPECT_EQ(other.material.alpha_mode, AlphaMode::kOpaque);
  EXPECT_THAT(
      other.warnings,
      ElementsAre("the opacity texture 'b.png' of material 'paint' is not used; put opacity "
                  "into the alpha of its colour texture"));
}

TEST(ObjMaterials, NameNoTextureThatIsMissing) {
  const ObjImport import = objMaterial("Kd 1 0 0\nmap_Kd absent.png\n");
  EXPECT_EQ(import.material.base_color_texture, "");
  EXPECT_EQ(import.warnings.size(), 1U);
}

}  // namespace
}  // namespace galactic::test
