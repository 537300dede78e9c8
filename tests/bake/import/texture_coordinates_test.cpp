// Where a glTF file has its textures drawn: the coordinates that arrive in the render mesh.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "bake/import/import_helpers.h"
#include "galactic/bake/render_baker.h"
#include "render/render_source.h"
#include "support/oracles/render_mesh_reader.h"

namespace galactic::test::texture_coordinates_test {
namespace {

using bake::importMesh;
using testing::ElementsAre;
using testing::HasSubstr;
using Uv = std::array<double, 2>;

/// Render meshes have steps of 1/65535 of what a cluster covers: at most ten images here.
constexpr double kTolerance = 2e-4;

/// A red texel and a blue one.
std::string png() {
  constexpr std::array<std::uint8_t, 70> kFile{
      0x89, 0x50, 0x4E, 0x47, 0x0D, 0x0A, 0x1A, 0x0A, 0x00, 0x00, 0x00, 0x0D, 0x49, 0x48,
      0x44, 0x52, 0x00, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x01, 0x08, 0x02, 0x00, 0x00,
      0x00, 0x7B, 0x40, 0xE8, 0xDD, 0x00, 0x00, 0x00, 0x0D, 0x49, 0x44, 0x41, 0x54, 0x78,
      0xDA, 0x63, 0xF8, 0xCF, 0x00, 0x04, 0xFF, 0x01, 0x07, 0x00, 0x01, 0xFF, 0x3D, 0x7D,
      0x8C, 0x49, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4E, 0x44, 0xAE, 0x42, 0x60, 0x82};
  return {kFile.begin(), kFile.end()};
}

/// Three pairs as they stand in a file.
template <class T>
std::string pairs(const std::array<T, 6>& values) {
  std::string bytes;
  for (const T value : values) bytes += bytesOf(value);
  return bytes;
}

/// One set of coordinates: its bytes, and the accessor's JSON that says what they are.
struct Set {
  std::string bytes;
  std::string accessor = R"("componentType":5126)";
  std::string view = "";
};

/// A large triangle whose material has this color texture, and these sets of coordinates.
struct Triangle {
  std::vector<Set> sets;
  std::string texture = R"("index":0)";
  /// Further members of the material.
  std::string material = "";

  [[nodiscard]] std::string buffer() const {
    std::string bytes = pairs<float>({0, 0, 0, 9, 0, 0}) + pairs<float>({0, 9, 0, 0, 0, 0});
    for (const Set& set : sets) {
      bytes += set.bytes;
      bytes.resize((bytes.size() + 3) / 4 * 4);
    }
    return bytes + png();
  }

  /// `uri`: of the buffer, with a comma behind it.
  [[nodiscard]] std::string json(std::string_view uri = "") const {
    std::string attributes;
    std::string accessors;
    std::string views;
    std::size_t at = 48;
    for (std::size_t n = 0; n < sets.size(); ++n) {
      attributes += fmt::format(R"(,"TEXCOORD_{}":{})", n, n + 1);
      accessors += fmt::format(R"(,{{"bufferView":{},"count":3,"type":"VEC2",{}}})", n + 1,
                               sets[n].accessor);
      views += fmt::format(R"(,{{"buffer":0,"byteOffset":{},"byteLength":{}{}}})", at,
                           sets[n].bytes.size(), sets[n].view);
      at += (sets[n].bytes.size() + 3) / 4 * 4;
    }
    views += fmt::format(R"(,{{"buffer":0,"byteOffset":{},"byteLength":{}}})", at, png().size());
    return fmt::format(
        R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],)"
        R"("extensionsUsed":["KHR_texture_transform","KHR_materials_pbrSpecularGlossiness"],)"
        R"("meshes":[{{"primitives":[{{"attributes":{{"POSITION":0{}}},"material":0}}]}}],)"
        R"("materials":[{{"pbrMetallicRoughness":{{"baseColorTexture":{{{}}}}}{}}}],)"
        R"("textures":[{{"source":0}}],"images":[{{"bufferView":{},"mimeType":"image/png"}}],)"
        R"("accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",)"
        R"("min":[0,0,0],"max":[9,9,0]}}{}],)"
        R"("bufferViews":[{{"buffer":0,"byteLength":36}}{}],"buffers":[{{{}"byteLength":{}}}]}})",
        attributes, texture, material, sets.size() + 1, accessors, views, uri, buffer().size());
  }
};

/// What is drawn at the triangle's corners (0, 0), (9, 0) and (0, 9); v down from the image's top.
std::array<Uv, 3> drawn(const bake::SourceAsset& asset) {
  std::array<Uv, 3> uvs{};
  const auto source = bake::sceneRenderSource(asset, {}, {});
  EXPECT_TRUE(source);
  const auto meshes = bake::bakeRenderMeshes(*source, {.error = 0.002});
  EXPECT_TRUE(meshes);
  const auto triangles = drawnTriangles(meshes->view(), 0);
  EXPECT_EQ(triangles.size(), 1U);
  for (const DrawnCorner& corner : triangles.at(0).corners) {
    const std::size_t which = corner.position[0] > 4 ? 1 : corner.position[1] > 4 ? 2 : 0;
    uvs[which] = corner.uv;
  }
  return uvs;
}

std::array<Uv, 3> drawn(const Triangle& triangle) {
  const auto asset = importContent("a.glb", glbContainer(triangle.json(), triangle.buffer()));
  EXPECT_TRUE(asset.has_value()) << asset.error().message;
  return asset ? drawn(*asset) : std::array<Uv, 3>{};
}

/// Images repeat, so that all corners may be whole images away from what is expected.
void expectDrawn(const std::array<Uv, 3>& found, const std::array<Uv, 3>& expected) {
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const double images = std::round(found[0][axis] - expected[0][axis]);
    for (std::size_t n = 0; n < 3; ++n) {
      EXPECT_NEAR(found[n][axis], expected[n][axis] + images, kTolerance)
          << "uv"[axis] << " of corner " << n;
    }
  }
}

constexpr std::array<Uv, 3> kCorners{{{0, 0}, {1, 0}, {0, 1}}};
const std::string kFloats = pairs<float>({0, 0, 1, 0, 0, 1});
const std::string kOtherFloats = pairs<float>({0.5F, 0.5F, 0.75F, 0.5F, 0.5F, 0.625F});
constexpr std::array<Uv, 3> kOthers{{{0.5, 0.5}, {0.75, 0.5}, {0.5, 0.625}}};

std::string moved(std::string_view transform, std::string_view more = "") {
  return fmt::format(R"("index":0{},"extensions":{{"KHR_texture_transform":{{{}}}}})", more,
                     transform);
}

TEST(TextureCoordinates, AreThoseOfTheSetThatTheTextureNames) {
  expectDrawn(drawn({.sets = {{kFloats}, {kOtherFloats}}}), kCorners);
  expectDrawn(drawn({.sets = {{kFloats}, {kOtherFloats}}, .texture = R"("index":0,"texCoord":1)"}),
              kOthers);
  // The extension has the last word.
  expectDrawn(drawn({.sets = {{kFloats}, {kOtherFloats}},
                     .texture = moved(R"("texCoord":1)", R"(,"texCoord":0)")}),
              kOthers);
  expectDrawn(drawn({.sets = {{kFloats}, {kOtherFloats}},
                     .material = R"(,"extensions":{"KHR_materials_pbrSpecularGlossiness":)"
                                 R"({"diffuseTexture":{"index":0,"texCoord":1}}})"}),
              kOthers);
}

TEST(TextureCoordinates, AreScaledTurnedAndMovedAsTheTextureSays) {
  expectDrawn(drawn({.sets = {{kFloats}}, .texture = moved(R"("scale":[10,5])")}),
              {{{0, 0}, {10, 0}, {0, 5}}});
  expectDrawn(drawn({.sets = {{kFloats}}, .texture = moved(R"("offset":[0.25,0.5])")}),
              {{{0.25, 0.5}, {1.25, 0.5}, {0.25, 1.5}}});
  // A quarter turn counter-clockwise, as one sees it with v down: right becomes up, down right.
  const double quarter = std::numbers::pi / 2;
  expectDrawn(
      drawn({.sets = {{kFloats}}, .texture = moved(fmt::format(R"("rotation":{})", quarter))}),
      {{{0, 0}, {0, -1}, {1, 0}}});
  // First scaled, then turned, then moved.
  expectDrawn(drawn({.sets = {{kFloats}},
                     .texture = moved(fmt::format(
                         R"("offset":[0.5,0.25],"rotation":{},"scale":[2,4])", quarter))}),
              {{{0.5, 0.25}, {0.5, -1.75}, {4.5, 0.25}}});
  expectDrawn(drawn({.sets = {{kFloats}, {kOtherFloats}},
                     .texture = moved(R"("scale":[2,2],"texCoord":1)")}),
              {{{1, 1}, {1.5, 1}, {1, 1.25}}});
}

TEST(TextureCoordinates, OfIntegersStandForTheShareOfTheLargest) {
  const auto shares = [](int type) {
    return fmt::format(R"("componentType":{},"normalized":true)", type);
  };
  expectDrawn(drawn({.sets = {{pairs<std::uint16_t>({0, 0, 65535, 0, 0, 65535}), shares(5123)}}}),
              kCorners);
  expectDrawn(drawn({.sets = {{pairs<std::uint8_t>({0, 0, 255, 0, 0, 255}), shares(5121)}}}),
              kCorners);
  expectDrawn(drawn({.sets = {{pairs<std::int16_t>({0, 0, 32767, 0, 0, 32767}), shares(5122)}}}),
              kCorners);
  // Bytes that begin at every fourth byte, as they should, and a texture that is moved, too.
  expectDrawn(drawn({.sets = {{std::string("\0\0??\xFF\0??\0\xFF??", 12), shares(5121),
                               R"(,"byteStride":4)"}},
                     .texture = moved(R"("scale":[2,2])")}),
              {{{0, 0}, {2, 0}, {0, 2}}});
  // The third corner is the second one again.
  const std::string sparse =
      R"(,"sparse":{"count":1,"indices":{"bufferView":2,"componentType":5121},)"
      R"("values":{"bufferView":1,"byteOffset":4}})";
  expectDrawn(
      drawn({.sets = {{pairs<std::uint16_t>({0, 0, 65535, 0, 0, 65535}), shares(5123) + sparse},
                      {std::string("\2\0\0\0\0\0", 6), R"("componentType":5121)", ""}}}),
      {{{0, 0}, {1, 0}, {1, 0}}});
}

TEST(TextureCoordinates, AreFoundInBuffersOfAllKinds) {
  const Triangle triangle{
      .sets = {{pairs<std::uint16_t>({0, 0, 65535, 0, 0, 65535}),
                R"("componentType":5123,"normalized":true)"}},
  };
  const ScratchFolder folder;
  (void)folder.write("my buffer.bin", triangle.buffer());
  const auto beside =
      importMesh(folder.write("a.gltf", triangle.json(R"("uri":"my%20buffer.bin",)")));
  ASSERT_TRUE(beside.has_value()) << beside.error().message;
  expectDrawn(drawn(*beside), kCorners);
  // What only the reader gets is no file of the asset.
  ASSERT_EQ(beside->read.files.size(), 2U);
  EXPECT_EQ(beside->read.files[0].name, "a.gltf");
  EXPECT_EQ(beside->read.files[1].name, "my buffer.bin");

  const std::string data =
      "AAAAAAAAAAAAAAAAAAAQQQAAAAAAAAAAAAAAAAAAEEEAAAAAAAAAAAAAAAAAAAAAAAAAAP//AAAAAP//iVBORw0K"
      "GgoAAAANSUhEUgAAAAIAAAABCAIAAAB7QOjdAAAADUlEQVR42mP4zwAE/wEHAAH/PX2MSQAAAABJRU5ErkJggg==";
  const auto inside = importContent(
      "a.gltf",
      triangle.json(fmt::format(R"("uri":"data:application/octet-stream;base64,{}",)", data)));
  ASSERT_TRUE(inside.has_value()) << inside.error().message;
  expectDrawn(drawn(*inside), kCorners);

  // Nothing is read out of reach.
  (void)folder.write("far.bin", triangle.buffer());
  const auto outside =
      importMesh(folder.write("a/b.gltf", triangle.json(R"("uri":"../far.bin",)")));
  ASSERT_FALSE(outside.has_value());
  EXPECT_THAT(outside.error().message, HasSubstr("it names '../far.bin', which lies outside"));
}

TEST(TextureCoordinates, ThatNothingIsWrittenOfStayAsTheyAre) {
  for (const char* texture :
       {R"("index":0,"texCoord":7)", R"("index":0,"texCoord":-1)", R"("index":0,"texCoord":"1")",
        R"("index":0,"extensions":{"KHR_texture_transform":[]})",
        R"("index":0,"extensions":{"KHR_texture_transform":{}})",
        R"("index":0,"extensions":{"KHR_texture_transform":{"offset":[1],"rotation":"1"}})",
        R"("index":0,"extensions":{"KHR_texture_transform":{"scale":[null,2]}})"}) {
    SCOPED_TRACE(texture);
    const Triangle triangle{.sets = {{kFloats}}, .texture = texture};
    const auto asset = importContent("a.glb", glbContainer(triangle.json(), triangle.buffer()));
    if (!asset) continue;  // What the reader does not take it refuses.
    ASSERT_EQ(asset->meshes[0].uvs.size(), 3U);
    expectDrawn(drawn(*asset), kCorners);
  }
}

TEST(TextureCoordinates, ThatAreNoNumbersDrawAWarning) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  const Triangle triangle{.sets = {{pairs<float>({0, 0, kNan, 0, 0, 1})}}};
  const auto asset = importContent("a.glb", glbContainer(triangle.json(), triangle.buffer()));
  ASSERT_TRUE(asset.has_value()) << asset.error().message;
  EXPECT_THAT(asset->warnings,
              ElementsAre(HasSubstr("has 1 corners whose texture coordinates are not finite")));
  // Numbers beyond floats are the largest of them.
  const Triangle huge{.sets = {{kFloats}}, .texture = moved(R"("scale":[1e300,1])")};
  const auto large = importContent("a.glb", glbContainer(huge.json(), huge.buffer()));
  ASSERT_TRUE(large.has_value()) << large.error().message;
  EXPECT_EQ(large->meshes[0].uvs[1][0], std::numeric_limits<float>::max());
}

TEST(TextureCoordinates, OfDamagedFilesAreRefusedOrFinite) {
  const Triangle whole{.sets = {{pairs<std::uint16_t>({0, 0, 65535, 0, 0, 65535}),
                                 R"("componentType":5123,"normalized":true)"}},
                       .texture = moved(R"("scale":[2,2])")};
  const std::string json = whole.json();
  std::size_t refused = 0;
  std::size_t accepted = 0;
  for (std::size_t at = 0; at < json.size(); ++at) {
    if (json[at] < '0' || json[at] > '9') continue;
    std::string changed = json;
    changed[at] = json[at] == '9' ? '0' : '9';
    const auto asset = importContent("a.glb", glbContainer(changed, whole.buffer()));
    ++(asset ? accepted : refused);
    EXPECT_TRUE(asset || asset.error().code != ErrorCode::kInternal) << changed;
  }
  EXPECT_GE(refused, (refused + accepted) / 10);
  EXPECT_GE(accepted, (refused + accepted) / 10);
}

}  // namespace
}  // namespace galactic::test::texture_coordinates_test
