// glTF files of which a reader makes something else, or nothing, where it gets them as they are.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <cstdint>
#include <type_traits>

#include "bake/import/import_helpers.h"

namespace galactic::test::readable_gltf_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// glTF's componentType.
template <class T>
constexpr int kType = std::is_same_v<T, std::int8_t>     ? 5120
                      : std::is_same_v<T, std::uint8_t>  ? 5121
                      : std::is_same_v<T, std::int16_t>  ? 5122
                      : std::is_same_v<T, std::uint16_t> ? 5123
                                                         : 5126;

constexpr std::size_t kAlignment = 4;

/// Elements in a buffer as vertex attributes have to lie: each begins at a multiple of four bytes.
struct Elements {
  int type = 0;
  std::size_t count = 0;
  std::size_t stride = 0;
  std::string kind;
  std::string bytes;
};

template <class T, std::size_t N>
Elements elementsOf(const std::vector<std::array<T, N>>& list) {
  Elements elements{.type = kType<T>,
                    .count = list.size(),
                    .stride = (N * sizeof(T) + kAlignment - 1) / kAlignment * kAlignment,
                    .kind = fmt::format("VEC{}", N),
                    .bytes = {}};
  for (const auto& element : list) {
    std::string bytes = bytesOf(element);
    // What pads them is not 0, so that reading it shows.
    bytes.resize(elements.stride, 'x');
    elements.bytes += bytes;
  }
  return elements;
}

/// A triangle with positions, normals, texture coordinates and the positions of a morph target.
struct Attributes {
  Elements positions;
  Elements normals;
  Elements uvs;
  Elements moved;
};

std::string glbOf(const Attributes& attributes, bool normalized) {
  std::string accessors;
  std::string views;
  std::string buffer;
  for (const Elements* one :
       {&attributes.positions, &attributes.normals, &attributes.uvs, &attributes.moved}) {
    const std::string_view comma = buffer.empty() ? "" : ",";
    accessors += fmt::format(
        R"({}{{"bufferView":{},"componentType":{},"normalized":{},"count":{},"type":"{}"}})", comma,
        std::count(views.begin(), views.end(), '{'), one->type, normalized && one->type != 5126,
        one->count, one->kind);
    views += fmt::format(R"({}{{"buffer":0,"byteOffset":{},"byteLength":{},"byteStride":{}}})",
                         comma, buffer.size(), one->bytes.size(), one->stride);
    buffer += one->bytes;
  }
  std::string json = fmt::format(
      R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],)"
      R"("nodes":[{{"mesh":0,"scale":[8,8,8],"translation":[1,2,3]}}],)"
      R"("extensionsUsed":["KHR_mesh_quantization"],)"
      R"("extensionsRequired":["KHR_mesh_quantization"],)"
      R"("meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2}},)"
      R"("targets":[{{"POSITION":3}}]}}],"weights":[0.5]}}],)"
      R"("accessors":[{}],"bufferViews":[{}],"buffers":[{{"byteLength":{}}}]}})",
      accessors, views, buffer.size());
  return glbContainer(std::move(json), buffer);
}

/// As the specification of glTF has it.
template <class T>
float meant(T value, bool normalized) {
  if (!normalized) return static_cast<float>(value);
  const auto one = static_cast<double>(std::numeric_limits<T>::max());
  return static_cast<float>(std::max(static_cast<double>(value) / one, -1.0));
}

template <class T, std::size_t N>
std::vector<std::array<float, N>> meant(const std::vector<std::array<T, N>>& list,
                                        bool normalized) {
  std::vector<std::array<float, N>> floats;
  for (const auto& element : list) {
    auto& to = floats.emplace_back();
    for (std::size_t n = 0; n < N; ++n) to[n] = meant(element[n], normalized);
  }
  return floats;
}

/// The same triangle in integers and in floats arrives alike.
template <class T>
void expectReadAsFloats(bool normalized) {
  SCOPED_TRACE(fmt::format("type {}{}", kType<T>, normalized ? ", normalized" : ""));
  constexpr T kLow = std::numeric_limits<T>::min();
  constexpr T kHigh = std::numeric_limits<T>::max();
  const std::vector<std::array<T, 3>> positions{{kLow, 0, 3}, {kHigh, 5, 0}, {7, kHigh, kLow}};
  const std::vector<std::array<T, 3>> moved{{1, 2, 3}, {0, kHigh, 0}, {kLow, 0, 1}};
  const std::vector<std::array<T, 2>> uvs{{0, kHigh}, {kLow, 9}, {11, 3}};
  const std::vector<std::array<std::int8_t, 3>> normals{{0, 0, 127}, {0, -128, 0}, {1, 2, 3}};
  const auto read = importContent("a.glb", glbOf({elementsOf(positions), elementsOf(normals),
                                                  elementsOf(uvs), elementsOf(moved)},
                                                 normalized));
  ASSERT_TRUE(read.has_value()) << read.error().text();
  const auto wanted = importContent(
      "a.glb", glbOf({elementsOf(meant(positions, normalized)), elementsOf(meant(normals, true)),
                      elementsOf(meant(uvs, normalized)), elementsOf(meant(moved, normalized))},
                     normalized));
  ASSERT_TRUE(wanted.has_value()) << wanted.error().text();
  const auto position = meant(positions, normalized);
  const auto offset = meant(moved, normalized);
  ASSERT_EQ(wanted->meshes[0].positions.size(), 3U);
  // Half of the morph target is applied; the reader adds it in floats.
  EXPECT_FLOAT_EQ(wanted->meshes[0].positions[1].y, position[1][1] + 0.5F * offset[1][1]);
  EXPECT_EQ(read->meshes[0].positions, wanted->meshes[0].positions);
  EXPECT_EQ(read->meshes[0].uvs, wanted->meshes[0].uvs);
  EXPECT_EQ(read->meshes[0].triangles, wanted->meshes[0].triangles);
  EXPECT_EQ(read->instances[0].world_from_mesh, wanted->instances[0].world_from_mesh);
  EXPECT_THAT(read->warnings, ElementsAre());
}

TEST(QuantizedGltf, IsReadAsTheSameFileInFloats) {
  for (const bool normalized : {false, true}) {
    expectReadAsFloats<std::int8_t>(normalized);
    expectReadAsFloats<std::uint8_t>(normalized);
    expectReadAsFloats<std::int16_t>(normalized);
    expectReadAsFloats<std::uint16_t>(normalized);
  }
}

TEST(QuantizedGltf, IsRejectedWhereItsPositionsAreCutOff) {
  const std::vector<std::array<std::int16_t, 3>> positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const std::vector<std::array<std::int16_t, 2>> uvs{{0, 0}, {1, 0}, {0, 1}};
  Elements cut = elementsOf(positions);
  cut.count = 4;
  const Error error = importError(
      "a.glb", glbOf({cut, elementsOf(positions), elementsOf(uvs), elementsOf(positions)}, true));
  EXPECT_EQ(error.code, ErrorCode::kInvalidInput);
  EXPECT_THAT(error.message, HasSubstr("accessor 0"));
}

/// The inverse matrices of a skin may be left out, and the reader crashes without them.
TEST(SkinnedGltf, StandsWhereItsNodesAreWithAWarning) {
  const std::string joints(8 * 4, '\0');
  std::string weights;
  for (int vertex = 0; vertex < 8; ++vertex) weights += bytesOf(std::array<float, 4>{1, 0, 0, 0});
  const std::string buffer = gltfBuffer(unevenBox()) + joints + weights;
  std::string json = gltfFile(
      unevenBox(), {.nodes = R"([{"mesh":0,"skin":0,"children":[1]},{"translation":[0,3,0]}])",
                    .buffer_uri = {},
                    .more = R"(,"skins":[{"joints":[1]}])"});
  const auto replace = [&json](std::string_view from, const std::string& to) {
    const std::size_t at = json.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    json.replace(at, from.size(), to);
  };
  const std::size_t first = gltfBuffer(unevenBox()).size();
  replace(R"("POSITION":1)", R"("POSITION":1,"JOINTS_0":2,"WEIGHTS_0":3)");
  replace(R"(}],"bufferViews":[)",
          R"(},{"bufferView":2,"componentType":5121,"count":8,"type":"VEC4"},)"
          R"({"bufferView":3,"componentType":5126,"count":8,"type":"VEC4"}],"bufferViews":[)");
  replace(R"(],"buffers":[)",
          fmt::format(R"(,{{"buffer":0,"byteOffset":{},"byteLength":{}}},)"
                      R"({{"buffer":0,"byteOffset":{},"byteLength":{}}}],"buffers":[)",
                      first, joints.size(), first + joints.size(), weights.size()));
  replace(fmt::format(R"("byteLength":{}}}],"skins")", first),
          fmt::format(R"("byteLength":{}}}],"skins")", buffer.size()));
  const auto asset = importContent("a.glb", glbContainer(json, buffer));
  ASSERT_TRUE(asset.has_value()) << asset.error().text();
  EXPECT_EQ(asset->meshes[0].positions.size(), 8U);
  EXPECT_EQ(asset->meshes[0].triangles.size(), unevenBox().triangles.size());
  EXPECT_THAT(asset->warnings, ElementsAre(HasSubstr("skeletons are not read")));
}

}  // namespace
}  // namespace galactic::test::readable_gltf_test
