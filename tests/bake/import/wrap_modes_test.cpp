// Textures that a file clamps or mirrors at their edges, where renderers repeat them.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "import_helpers.h"

namespace galactic::test::wrap_modes_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using Corners = std::array<std::array<float, 2>, 3>;

constexpr Corners kInside{{{0, 0}, {1, 0}, {0.5F, 1}}};
constexpr Corners kBesideTheImage{{{0, 0}, {1.5F, 0}, {0.5F, 1}}};
constexpr Corners kAboveTheImage{{{0, 0}, {1, 0}, {0.5F, -0.5F}}};

/// The warnings that are meant here: others tell that the image is missing.
std::vector<std::string> wrapWarnings(const Result<bake::SourceAsset>& asset) {
  EXPECT_TRUE(asset.has_value()) << asset.error().message;
  std::vector<std::string> found;
  if (!asset) return found;
  for (const std::string& warning : asset->warnings) {
    if (warning.find("clamped or mirrored") != std::string::npos) found.push_back(warning);
  }
  return found;
}

std::string warningOf(std::string_view material) {
  return fmt::format(
      "the texture of material '{}' is clamped or mirrored in its file, and texture coordinates "
      "lie beyond its edges, where it is drawn repeated; export them from 0 to 1",
      material);
}

/// What is said of a triangle twice in a GLB, whose texture has this sampler (JSON).
std::vector<std::string> ofGltf(std::string_view sampler, const Corners& corners) {
  std::string buffer = bytesOf(std::array<float, 9>{0, 0, 0, 1, 0, 0, 0, 1, 0});
  for (const auto& corner : corners) buffer += bytesOf(corner[0]) + bytesOf(corner[1]);
  const std::string json = fmt::format(
      R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0,1]}}],)"
      R"("nodes":[{{"mesh":0}},{{"mesh":1}}],"meshes":[{{"primitives":[{0}]}},{{"primitives":[{0}]}}],)"
      R"("accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",)"
      R"("min":[0,0,0],"max":[1,1,0]}},)"
      R"({{"bufferView":1,"componentType":5126,"count":3,"type":"VEC2"}}],)"
      R"("bufferViews":[{{"buffer":0,"byteLength":36}},)"
      R"({{"buffer":0,"byteOffset":36,"byteLength":24}}],"buffers":[{{"byteLength":60}}],)"
      R"("images":[{{"uri":"a.png"}}],"samplers":[{1}],"textures":[{{"source":0,"sampler":0}}],)"
      R"("materials":[{{"name":"poster",)"
      R"("pbrMetallicRoughness":{{"baseColorTexture":{{"index":0}}}}}}]}})",
      R"({"attributes":{"POSITION":0,"TEXCOORD_0":1},"material":0})", sampler);
  return wrapWarnings(importContent("a.glb", glbContainer(json, buffer)));
}

TEST(WrapModes, ThatDoNotRepeatAreToldOfWhereTextureCoordinatesLieBeyondTheEdges) {
  constexpr std::string_view kClamped = R"({"wrapS":33071,"wrapT":33071})";
  constexpr std::string_view kMirroredAlongU = R"({"wrapS":33648})";
  for (const Corners& beyond : {kBesideTheImage, kAboveTheImage}) {
    EXPECT_THAT(ofGltf(kClamped, beyond), ElementsAre(warningOf("poster")));
    EXPECT_THAT(ofGltf("{}", beyond), IsEmpty());
    EXPECT_THAT(ofGltf(R"({"wrapS":10497,"wrapT":10497})", beyond), IsEmpty());
  }
  EXPECT_THAT(ofGltf(kMirroredAlongU, kBesideTheImage), ElementsAre(warningOf("poster")));
  EXPECT_THAT(ofGltf(kMirroredAlongU, kAboveTheImage), IsEmpty());
  EXPECT_THAT(ofGltf(kClamped, kInside), IsEmpty());
}

TEST(WrapModes, OfAnObjAreItsClamp) {
  const ScratchFolder folder;
  (void)folder.write("a.mtl",
                     "newmtl poster\nmap_Kd -clamp on a.png\nnewmtl tiles\nmap_Kd a.png\n");
  const std::string content =
      "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1.5 0\nvt 0 1\n"
      "usemtl poster\nf 1/1 2/2 3/3\nusemtl tiles\nf 1/1 3/3 2/2\n";
  EXPECT_THAT(wrapWarnings(bake::importMesh(folder.write("a.obj", content))),
              ElementsAre(warningOf("poster")));
}

}  // namespace
}  // namespace galactic::test::wrap_modes_test
