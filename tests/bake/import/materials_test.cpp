// What materials say, as the formats say it.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/stat.h>

#include <algorithm>
#include <chrono>

#include "galactic/bake/triangle_mesh.h"
#include "import_helpers.h"
#include "support/mesh_files.h"
#include "support/scratch_folder.h"

namespace galactic::test::materials_test {
namespace {

using bake::AlphaMode;
using bake::importMesh;
using bake::SourceMaterial;
using testing::ElementsAre;

/// The material of a GLB that has this one (JSON).
SourceMaterial gltfMaterial(std::string_view material) {
  const GltfPieces pieces{
      .nodes = GltfPieces{}.nodes,
      .buffer_uri = {},
      .more = fmt::format(
          R"(,"extensionsUsed":["KHR_materials_pbrSpecularGlossiness"],"materials":[{}])",
          material)};
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
            R"("textures":[{{"extensions":{{"{0}":{{"source":0}}}}}},)"
            R"({{"extensions":{{"{0}":{{"source":0}}}}}}],)"
            R"("images":[{{"uri":"a.image"}}],"extensionsUsed":["{0}"])",
            extension)};
    const auto required = fmt::format(R"(,"extensionsRequired":["{}"])", extension);
    for (const std::string& more : {std::string(), required}) {
      GltfPieces whole = pieces;
      whole.more += more;
      std::string json = gltfFile(unevenBox(), whole);
      const std::string_view primitive_end = R"("indices":0)";
      json.insert(json.find(primitive_end) + primitive_end.size(), R"(,"material":0)");
      const auto asset = importContent("box.glb", glbContainer(json, gltfBuffer(unevenBox())));
      ASSERT_TRUE(asset.has_value()) << asset.error().message;
      EXPECT_EQ(asset->materials[asset->meshes[0].material].base_color_texture, "");
      EXPECT_THAT(asset->warnings,
                  ElementsAre(fmt::format("textures in {} ({}) cannot be read: their surfaces keep "
                                          "their plain color; export them as PNG or JPEG",
                                          format, extension)));
    }
  }
}

TEST(GltfMaterials, KeepQuietAboutImagesThatHaveAnotherInTheirPlace) {
  const GltfPieces pieces{
      .nodes = GltfPieces{}.nodes,
      .buffer_uri = {},
      .more =
          R"(,"textures":[{"extensions":{"EXT_texture_webp":{"source":1}},"source":0}],)"
          R"("images":[{"uri":"a.png"},{"uri":"a.webp"}],"extensionsUsed":["EXT_texture_webp"])"};
  const auto asset = importContent("box.glb", glbFile(unevenBox(), pieces));
  ASSERT_TRUE(asset.has_value()) << asset.error().message;
  EXPECT_THAT(asset->warnings, ElementsAre());
}

TEST(GltfMaterials, OfSpecularGlossinessAreDiffuseColors) {
  const std::string red =
      R"("extensions":{"KHR_materials_pbrSpecularGlossiness":{"diffuseFactor":[1,0,0,0.5]}})";
  EXPECT_THAT(gltfMaterial("{" + red + "}").base_color, ElementsAre(1.F, 0.F, 0.F, 0.5F));
  // What the material says for readers without the extension does not count.
  EXPECT_THAT(gltfMaterial("{" + red + R"(,"pbrMetallicRoughness":{"baseColorFactor":[0,1,0,1]}})")
                  .base_color,
              ElementsAre(1.F, 0.F, 0.F, 0.5F));
  EXPECT_THAT(
      gltfMaterial(R"({"pbrMetallicRoughness":{"baseColorFactor":[0,1,0,0.25]}})").base_color,
      ElementsAre(0.F, 1.F, 0.F, 0.25F));
}

/// A triangle of ASCII FBX with a texture of this name, in whose video is `video`. Another video of
/// that name holds `other`.
std::string fbxWithTexture(std::string_view name, std::string_view video, std::string_view other) {
  const auto content = [](std::string_view base64) {
    return base64.empty() ? std::string() : fmt::format("Content: ,\n\"{}\"\n", base64);
  };
  return fmt::format(
      "; FBX 7.4.0 project file\nFBXHeaderExtension:  {{\nFBXHeaderVersion: 1003\nFBXVersion: "
      "7400\n}}\n"
      "Objects:  {{\nGeometry: 1, \"Geometry::g\", \"Mesh\" {{\n"
      "Vertices: *9 {{\na: 0,0,0,900,0,0,0,900,0\n}}\nPolygonVertexIndex: *3 {{\na: 0,1,-3\n}}\n"
      "LayerElementUV: 0 {{\nVersion: 101\nName: \"UVMap\"\nMappingInformationType: "
      "\"ByPolygonVertex\"\n"
      "ReferenceInformationType: \"Direct\"\nUV: *6 {{\na: 0,0,1,0,0,1\n}}\n}}\n"
      "LayerElementMaterial: 0 {{\nVersion: 101\nName: \"\"\nMappingInformationType: \"AllSame\"\n"
      "ReferenceInformationType: \"IndexToDirect\"\nMaterials: *1 {{\na: 0\n}}\n}}\n"
      "Layer: 0 {{\nVersion: 100\nLayerElement:  {{\nType: \"LayerElementMaterial\"\nTypedIndex: "
      "0\n}}\n"
      "LayerElement:  {{\nType: \"LayerElementUV\"\nTypedIndex: 0\n}}\n}}\n}}\n"
      "Model: 2, \"Model::m\", \"Mesh\" {{\nVersion: 232\n}}\n"
      "Material: 3, \"Material::paint\", \"\" {{\nVersion: 102\nShadingModel: \"phong\"\n}}\n"
      "Texture: 4, \"Texture::t\", \"\" {{\nType: \"TextureVideoClip\"\nVersion: 202\n"
      "FileName: \"C:\\x\\{0}\"\nRelativeFilename: \"{0}\"\n}}\n"
      "Texture: 6, \"Texture::n\", \"\" {{\nType: \"TextureVideoClip\"\nVersion: 202\n"
      "FileName: \"C:\\x\\{0}\"\nRelativeFilename: \"{0}\"\n}}\n"
      "Video: 5, \"Video::v\", \"Clip\" {{\nType: \"Clip\"\nFileName: \"C:\\x\\{0}\"\n"
      "RelativeFilename: \"{0}\"\n{1}}}\n"
      "Video: 7, \"Video::w\", \"Clip\" {{\nType: \"Clip\"\nFileName: \"C:\\x\\{0}\"\n"
      "RelativeFilename: \"{0}\"\n{2}}}\n}}\n"
      "Connections:  {{\nC: \"OO\",2,0\nC: \"OO\",1,2\nC: \"OO\",3,2\n"
      "C: \"OP\",4,3, \"DiffuseColor\"\nC: \"OP\",6,3, \"NormalMap\"\n"
      "C: \"OO\",5,4\nC: \"OO\",7,6\n}}\n",
      name, content(video), content(other));
}

TEST(FbxMaterials, UseTheImagesThatTheFileEmbeds) {
  const auto drawn = [](std::string_view video, std::string_view other) -> std::string {
    const auto asset = importContent("a.fbx", fbxWithTexture("wood.png", video, other));
    EXPECT_TRUE(asset.has_value()) << asset.error().message;
    if (!asset) return {};
    const std::string name = asset->materials[asset->meshes[0].material].base_color_texture;
    if (name.empty()) return asset->warnings.empty() ? "" : asset->warnings.front();
    EXPECT_EQ(name.front(), '*');
    EXPECT_EQ(asset->warnings.size(), 0U);
    const auto& bytes = asset->textures.at(std::stoul(name.substr(1))).bytes;
    return {bytes.begin(), bytes.end()};
  };
  EXPECT_EQ(drawn("aW1hZ2U=", ""), "image");
  // Of two images of one name each texture has its own; one without takes the other's.
  EXPECT_EQ(drawn("aW1hZ2U=", "b3RoZXI="), "image");
  EXPECT_EQ(drawn("", "b3RoZXI="), "other");
  EXPECT_THAT(drawn("", ""),
              testing::HasSubstr("texture 'wood.png' of material 'paint' is missing"));
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

TEST(ObjMaterials, MultiplyATextureOnlyWithAColorThatIsMeant) {
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
                  "into the alpha of its color texture"));
}

TEST(ObjMaterials, TakeTheImageOfTheirStemForATextureThatIsMissing) {
  const ObjImport import = objMaterial("Kd 1 0 0\nmap_Kd absent.png\n");
  EXPECT_EQ(import.material.base_color_texture, "a.png");
  EXPECT_EQ(import.warnings.size(), 1U);
}

/// An OBJ with texture coordinates.
std::string objWithCoordinates(const std::string& head) {
  return head + "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n";
}

bake::SourceMaterial materialOf(const ScratchFolder& folder, const std::string& obj) {
  const auto asset = importMesh(folder.write("model.obj", obj));
  EXPECT_TRUE(asset.has_value()) << asset.error().message;
  if (!asset) return {};
  // Whatever is drawn is among the files, with its hash.
  for (const SourceMaterial& material : asset->materials) {
    const std::string& name = material.base_color_texture;
    const bool is_listed = std::any_of(asset->read.files.begin(), asset->read.files.end(),
                                       [&](const auto& file) { return file.name == name; });
    EXPECT_TRUE(name.empty() || is_listed) << name;
  }
  return asset->materials[asset->meshes[0].material];
}

TEST(ObjTextures, AreFoundByTheNameOfTheMeshWhereNoneIsNamed) {
  const std::string named = "mtllib lost.mtl\nusemtl m\n";
  {
    // As Google Scanned Objects are shared: the MTL is left out.
    const ScratchFolder folder;
    (void)folder.write("texture.png", "image");
    const SourceMaterial material = materialOf(folder, objWithCoordinates(named));
    EXPECT_EQ(material.base_color_texture, "texture.png");
    EXPECT_THAT(material.base_color, ElementsAre(1.F, 1.F, 1.F, 1.F));
    // The mesh's own name comes first.
    (void)folder.write("model.jpg", "image");
    EXPECT_EQ(materialOf(folder, objWithCoordinates("")).base_color_texture, "model.jpg");
    // Nothing to put it on.
    EXPECT_EQ(materialOf(folder, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").base_color_texture, "");
  }
  {
    const ScratchFolder folder;
    (void)folder.write("other.png", "image");
    EXPECT_EQ(materialOf(folder, objWithCoordinates(named)).base_color_texture, "");
  }
}

TEST(ObjTextures, ThatAreMissingGiveWayToTheMeshesNamesakeWhereNoOtherIsMeant) {
  const ScratchFolder folder;
  (void)folder.write("model.mtl", "newmtl m\nmap_Kd model_8k.png\n");
  const std::string obj = objWithCoordinates("mtllib model.mtl\nusemtl m\n");
  EXPECT_EQ(materialOf(folder, obj).base_color_texture, "");
  // A scan with a resized texture.
  (void)folder.write("model.jpg", "image");
  EXPECT_EQ(materialOf(folder, obj).base_color_texture, "model.jpg");
  // Which of two it is, nobody knows.
  (void)folder.write("model.mtl", "newmtl m\nmap_Kd model_8k.png\nnewmtl n\nmap_Kd wall_8k.png\n");
  EXPECT_EQ(materialOf(folder, obj + "usemtl n\nf 1/1 3/3 2/2\n").base_color_texture, "");
  // What is there is drawn.
  (void)folder.write("model.mtl", "newmtl m\nmap_Kd wood.png\n");
  (void)folder.write("wood.png", "image");
  EXPECT_EQ(materialOf(folder, obj).base_color_texture, "wood.png");
}

TEST(ObjMaterials, AreFoundWhateverEndsTheLineThatNamesThem) {
  const ScratchFolder folder;
  (void)folder.write("colors.mtl", "newmtl m\nKd 1 0 0\n");
  (void)folder.write("PAINTS", "newmtl m\nKd 0 1 0\n");
  for (const char* end : {"", " ", " \t ", "\r", " \r"}) {
    for (const char* name : {"colors.mtl", "PAINTS"}) {
      const auto asset = importMesh(folder.write(
          "mug.obj", objWithCoordinates(fmt::format("mtllib {}{}\nusemtl m\n", name, end))));
      ASSERT_TRUE(asset.has_value()) << asset.error().message;
      EXPECT_THAT(asset->warnings, ElementsAre()) << name << " and '" << end << "'";
      const bool is_red = std::string_view(name) == "colors.mtl";
      EXPECT_THAT(asset->materials[asset->meshes[0].material].base_color,
                  ElementsAre(is_red ? 1.F : 0.F, is_red ? 0.F : 1.F, 0.F, 1.F));
      EXPECT_EQ(asset->read.files.size(), 2U);
    }
  }
  // An MTL of any name says what there is to be drawn.
  (void)folder.write("texture.png", "image");
  EXPECT_EQ(materialOf(folder, objWithCoordinates("mtllib PAINTS\nusemtl m\n")).base_color_texture,
            "");
}

TEST(ObjMaterials, ThatAreMissingDrawAWarningWhateverTheirName) {
  for (const char* name : {"lost.mtl", "lost.mtl ", "lost.MTL", "lost"}) {
    const auto asset =
        importContent("mug.obj", objWithCoordinates(fmt::format("mtllib {}\nusemtl m\n", name)));
    ASSERT_TRUE(asset.has_value()) << asset.error().message;
    const std::string trimmed = std::string_view(name).ends_with(' ') ? "lost.mtl" : name;
    EXPECT_THAT(asset->warnings,
                testing::Contains(fmt::format(
                    "material file '{}' is missing: its materials get default colors", trimmed)));
  }
}

TEST(ObjMaterials, ThatAreMissingAreToldOnceWhereANamesakeIsDrawn) {
  const ScratchFolder folder;
  (void)folder.write("texture.png", "image");
  const auto warningsOf = [&](const std::string& head) {
    const auto asset = importMesh(folder.write("mug.obj", objWithCoordinates(head)));
    EXPECT_TRUE(asset.has_value());
    return asset ? asset->warnings : std::vector<std::string>{};
  };
  EXPECT_THAT(warningsOf("mtllib lost.mtl\nusemtl m\n"),
              ElementsAre("its material file 'lost.mtl' is missing: 'texture.png' is drawn on all "
                          "of it"));
  EXPECT_THAT(warningsOf(""), ElementsAre("it has no MTL that names a texture: 'texture.png' is "
                                          "drawn on all of it"));
}

TEST(NamedFiles, OutsideOfTheMeshesFolderAreReadOnlyWhenAllowed) {
  const ScratchFolder folder;
  (void)folder.write("far/lost.mtl", "newmtl m\nmap_Kd wood.png\n");
  (void)folder.write("far/image.png", "image");
  const std::string obj = objWithCoordinates("mtllib ../../../far/lost.mtl\nusemtl m\n");
  const auto mesh = folder.write("a/b/c/model.obj", obj);
  const auto refused = importMesh(mesh);
  ASSERT_TRUE(refused.has_value());
  EXPECT_EQ(refused->read.files.size(), 1U);
  EXPECT_THAT(refused->warnings, testing::Contains(testing::HasSubstr(
                                     "'../../../far/lost.mtl' lies outside the folder "
                                     "of the mesh and is not read")));
  bake::MeshImportOptions options;
  options.allow_outside = true;
  const auto allowed = importMesh(mesh, options);
  ASSERT_TRUE(allowed.has_value());
  EXPECT_EQ(allowed->read.files.size(), 2U);

  // Textures may lie beside the folder, not farther off.
  (void)folder.write("a/b/c/model.mtl", "newmtl m\nmap_Kd ../../../far/image.png\n");
  (void)folder.write("a/b/textures/near.png", "image");
  const auto with_texture = [&](const char* texture, const bake::MeshImportOptions& how) {
    (void)folder.write("a/b/c/model.mtl", fmt::format("newmtl m\nmap_Kd {}\n", texture));
    const auto asset = importMesh(
        folder.write("a/b/c/model.obj", objWithCoordinates("mtllib model.mtl\nusemtl m\n")), how);
    return asset ? asset->materials[asset->meshes[0].material].base_color_texture : "none";
  };
  EXPECT_EQ(with_texture("../../../far/image.png", {}), "");
  EXPECT_EQ(with_texture("../../../far/image.png", options), "../../../far/image.png");
  EXPECT_EQ(with_texture("../textures/near.png", {}), "../textures/near.png");
  const std::string absolute = (folder.path() / "far/image.png").string();
  EXPECT_EQ(with_texture(absolute.c_str(), {}), "");
  EXPECT_EQ(with_texture(absolute.c_str(), options), "../../../far/image.png");

  GltfPieces pieces;
  pieces.buffer_uri = R"("uri":"../../far/a.bin",)";
  (void)folder.write("far/a.bin", gltfBuffer(unevenBox()));
  const auto gltf = folder.write("a/b/box.gltf", gltfFile(unevenBox(), pieces));
  const auto without_buffer = importMesh(gltf);
  ASSERT_FALSE(without_buffer.has_value());
  EXPECT_THAT(without_buffer.error().message,
              testing::HasSubstr("it names '../../far/a.bin', which lies outside its folder"));
  EXPECT_TRUE(importMesh(gltf, options).has_value());
}

TEST(NamedFiles, ThatArePipesOrDevicesAreNotWaitedFor) {
  const ScratchFolder folder;
  for (const char* pipe : {"model.mtl", "wood.png", "a.bin"}) {
    ASSERT_EQ(::mkfifo((folder.path() / pipe).c_str(), 0600), 0) << pipe;
  }
  bake::MeshImportOptions options;
  options.time_limit = std::chrono::seconds(20);
  const auto obj = importMesh(
      folder.write("model.obj", objWithCoordinates("mtllib model.mtl\nusemtl m\n")), options);
  ASSERT_TRUE(obj.has_value()) << obj.error().message;
  EXPECT_EQ(obj->read.files.size(), 1U);
  GltfPieces pieces;
  pieces.buffer_uri = R"("uri":"a.bin",)";
  EXPECT_FALSE(importMesh(folder.write("a.gltf", gltfFile(unevenBox(), pieces)), options));
  options.allow_outside = true;
  const auto zero = importMesh(
      folder.write("zero.obj", objWithCoordinates("mtllib /dev/zero\nusemtl m\n")), options);
  ASSERT_TRUE(zero.has_value()) << zero.error().message;
  EXPECT_EQ(zero->read.files.size(), 1U);
}

/// How the first vertex of a triangle is drawn that its file colors like this: 0xAABBGGRR.
std::uint32_t drawnColor(std::string_view name, const std::string& file) {
  const auto asset = importContent(name, file);
  EXPECT_TRUE(asset.has_value()) << name << ": " << asset.error().message;
  if (!asset) return 0;
  return bake::surfaceOf(*asset, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}).colors.front();
}

std::string plyWithColors(std::string_view type, std::string_view color) {
  return fmt::format(
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
      "z\nproperty {0} red\nproperty {0} green\nproperty {0} blue\nelement face 1\nproperty list "
      "uchar int vertex_indices\nend_header\n0 0 0 {1}\n9 0 0 {1}\n0 9 0 {1}\n3 0 1 2\n",
      type, color);
}

std::string objWithColors(std::string_view color, std::string_view head = "") {
  return fmt::format("{1}v 0 0 0 {0}\nv 9 0 0 {0}\nv 0 9 0 {0}\nf 1 2 3\n", color, head);
}

std::string offWithColors(std::string_view color) {
  return fmt::format("COFF\n3 1 0\n0 0 0 {0}\n9 0 0 {0}\n0 9 0 {0}\n3 0 1 2\n", color);
}

TEST(VertexColors, OfScansAreDrawnAsTheirFilesHaveThem) {
  constexpr std::uint32_t kFile = 0xFF084080;  // 128, 64, 8
  EXPECT_EQ(drawnColor("a.ply", plyWithColors("uchar", "128 64 8")), kFile);
  EXPECT_EQ(drawnColor("b.ply", plyWithColors("float", "0.502 0.251 0.0314")), kFile);
  EXPECT_EQ(drawnColor("a.obj", objWithColors("0.502 0.251 0.0314")), kFile);
  EXPECT_EQ(drawnColor("a.off", offWithColors("0.502 0.251 0.0314 1")), kFile);
  EXPECT_EQ(drawnColor("b.off", offWithColors("128 64 8 255")), kFile);
  // No number is too odd to be drawn somehow.
  EXPECT_EQ(drawnColor("c.ply", plyWithColors("float", "1.005 -1 0")), 0xFF0000FF);
  EXPECT_EQ(drawnColor("d.ply", plyWithColors("float", "1e30 0 0")), 0xFF0000FF);
}

TEST(VertexColors, OfGltfFilesAreLinear) {
  std::string json = gltfFile(unevenBox());
  // The positions again, as colors: the second corner has red 1.5, green 0.25 and blue 1.
  const std::string_view position = R"("POSITION":1)";
  json.insert(json.find(position) + position.size(), R"(,"COLOR_0":1)");
  const auto asset = importContent("box.glb", glbContainer(json, gltfBuffer(unevenBox())));
  ASSERT_TRUE(asset.has_value()) << asset.error().message;
  EXPECT_THAT(asset->meshes[0].colors[1], ElementsAre(1.5F, 0.25F, 1.F, testing::_));
}

}  // namespace
}  // namespace galactic::test::materials_test
