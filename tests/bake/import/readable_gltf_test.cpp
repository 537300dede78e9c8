// glTF files of which a reader makes something else, or nothing, where it gets them as they are.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
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

/// A quantized triangle with a morph target, both in JSON that tests change.
class SparseGltf : public testing::Test {
 protected:
  using Json = nlohmann::json;

  SparseGltf() {
    const std::vector<std::array<std::int16_t, 3>> positions{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
    const std::vector<std::array<std::int16_t, 3>> moved{{0, 0, 8}, {2, 0, 0}};
    for (const auto& p : positions) buffer_ += bytesOf(p);
    buffer_ += bytesOf(std::array<std::uint16_t, 2>{1, 2});
    for (const auto& p : moved) buffer_ += bytesOf(p);
    json_ = Json::parse(
        R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
            "extensionsUsed":["KHR_mesh_quantization"],
            "extensionsRequired":["KHR_mesh_quantization"],
            "meshes":[{"primitives":[{"attributes":{"POSITION":0},"targets":[{"POSITION":1}]}],
                       "weights":[0.5]}],
            "accessors":[
              {"bufferView":0,"componentType":5122,"count":3,"type":"VEC3"},
              {"componentType":5122,"count":3,"type":"VEC3","sparse":{"count":2,
                "indices":{"bufferView":1,"componentType":5123},"values":{"bufferView":2}}}],
            "bufferViews":[{"buffer":0,"byteLength":18},
                           {"buffer":0,"byteOffset":18,"byteLength":4},
                           {"buffer":0,"byteOffset":22,"byteLength":12}],
            "buffers":[{"byteLength":34}]})");
  }

  [[nodiscard]] Result<bake::SourceAsset> read() const {
    return importContent("a.glb", glbContainer(json_.dump(), buffer_));
  }

  /// Of the file with another value at `pointer`; none takes the value away.
  [[nodiscard]] std::string messageWith(const std::string& pointer,
                                        const std::optional<Json>& value) const {
    Json changed = json_;
    const Json::json_pointer at(pointer);
    if (value) {
      changed[at] = *value;
    } else {
      changed[at.parent_pointer()].erase(at.back());
    }
    const Error error = importError("a.glb", glbContainer(changed.dump(), buffer_));
    EXPECT_EQ(error.code, ErrorCode::kInvalidInput);
    return error.message;
  }

  std::string buffer_;
  Json json_;
};

TEST_F(SparseGltf, WithoutABufferViewIsZeroButForItsSparseElements) {
  const auto target = read();
  ASSERT_TRUE(target.has_value()) << target.error().text();
  EXPECT_THAT(target->meshes[0].positions,
              ElementsAre(Vec3{0, 0, 0}, Vec3{4, 0, 4}, Vec3{1, 4, 0}));
  EXPECT_THAT(target->warnings, ElementsAre());
  // The mesh's own likewise.
  json_["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 1;
  json_["meshes"][0]["primitives"][0]["targets"][0]["POSITION"] = 0;
  const auto own = read();
  ASSERT_TRUE(own.has_value()) << own.error().text();
  EXPECT_THAT(own->meshes[0].positions, ElementsAre(Vec3{0, 0, 0}, Vec3{2, 0, 8}, Vec3{2, 2, 0}));
  // A target that moves nothing.
  json_["accessors"][1].erase("sparse");
  json_["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 0;
  json_["meshes"][0]["primitives"][0]["targets"][0]["POSITION"] = 1;
  const auto still = read();
  ASSERT_TRUE(still.has_value()) << still.error().text();
  EXPECT_THAT(still->meshes[0].positions, ElementsAre(Vec3{0, 0, 0}, Vec3{4, 0, 0}, Vec3{0, 4, 0}));
}

TEST_F(SparseGltf, IsRejectedWhereNoBytesBackIt) {
  EXPECT_THAT(messageWith("/accessors/1/count", 4),
              HasSubstr("accessor 1 states 4 elements without a buffer view, and the largest with "
                        "one has 3"));
  EXPECT_THAT(messageWith("/accessors/0/bufferView", std::nullopt),
              HasSubstr("accessor 0 states 3 elements without a buffer view"));
  EXPECT_THAT(
      messageWith("/accessors/1/count", 2),
      HasSubstr("primitive 0 of mesh 0 (morph target 0) has 3 positions and 2 of POSITION"));
  EXPECT_THAT(messageWith("/meshes/0/primitives/0/targets/0/POSITION", 9),
              HasSubstr("(morph target 0) has 3 positions and 0 of POSITION"));
  json_["accessors"].push_back(json_["accessors"][0]);
  EXPECT_THAT(messageWith("/accessors/0/bufferView", std::nullopt),
              HasSubstr("primitive 0 of mesh 0 has its positions in accessor 0, which has neither "
                        "a bufferView nor sparse elements"));
}

TEST_F(SparseGltf, IsRejectedWhereItsElementsAreNoneOfIts) {
  buffer_[18] = 3;
  const auto read_beyond = read();
  ASSERT_FALSE(read_beyond.has_value());
  EXPECT_EQ(read_beyond.error().code, ErrorCode::kInvalidInput);
  EXPECT_THAT(read_beyond.error().message,
              HasSubstr("accessor 1 has a sparse element 3, and 3 elements"));
}

TEST_F(SparseGltf, SaysWhichFieldOfItIsBroken) {
  const std::string sparse = "/accessors/1/sparse";
  EXPECT_THAT(messageWith(sparse + "/count", std::nullopt),
              HasSubstr("accessor 1 is sparse without a count"));
  EXPECT_THAT(messageWith(sparse + "/values", std::nullopt),
              HasSubstr("accessor 1 is sparse without values"));
  EXPECT_THAT(messageWith(sparse + "/indices/componentType", 5130),
              HasSubstr("accessor 1 has sparse indices without a componentType"));
  EXPECT_THAT(messageWith(sparse + "/indices/bufferView", std::nullopt),
              HasSubstr("accessor 1 sparse indices uses buffer view null, and there are 3"));
  EXPECT_THAT(messageWith("/accessors/0/bufferView", -1),
              HasSubstr("accessor 0 uses buffer view -1, and there are 3"));
  for (const auto& [pointer, owner] : std::vector<std::pair<std::string, std::string>>{
           {"/accessors/0", "accessor 0"},
           {"/bufferViews/0", "buffer view 0"},
           {sparse + "/values", "accessor 1 sparse values"}}) {
    EXPECT_THAT(messageWith(pointer + "/byteOffset", -8),
                HasSubstr(owner + " has a byteOffset that is no whole number from 0 on"));
  }
  json_["bufferViews"][0]["byteLength"] = 24;
  EXPECT_THAT(messageWith("/accessors/0/type", "VEC4"),
              HasSubstr("primitive 0 of mesh 0 has its positions in accessor 0, whose type is "
                        "VEC4, expected VEC3"));
}

/// Quantized, so that its JSON is written again for the reader.
TEST_F(SparseGltf, IsRejectedWhereItIsNestedTooDeeply) {
  const auto nested = [&](std::size_t levels) {
    std::string json = json_.dump();
    json.pop_back();
    return json + R"(,"extras":)" + std::string(levels, '[') + std::string(levels, ']') + "}";
  };
  // The document itself is a level.
  const auto deep = importContent("a.glb", glbContainer(nested(999), buffer_));
  EXPECT_TRUE(deep.has_value()) << deep.error().text();
  for (const std::size_t levels : {std::size_t{1000}, std::size_t{100'000}}) {
    const Error error = importError("a.glb", glbContainer(nested(levels), buffer_));
    EXPECT_EQ(error.code, ErrorCode::kInvalidInput);
    EXPECT_EQ(error.message,
              "its JSON nests objects and lists in more than 1000 levels, perhaps in `extras`; "
              "export it again without them");
  }
}

TEST_F(SparseGltf, IsRejectedWhereItsBufferCannotBeDecoded) {
  json_["buffers"][0]["uri"] = "data:;base64,AAAA" + std::string(44, '-');
  const Error error = importError("a.gltf", json_.dump());
  EXPECT_THAT(error.message, HasSubstr("only 3 bytes of its buffer 0 can be read"));
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
