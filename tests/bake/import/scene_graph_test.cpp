// Node transforms, instances, names, materials, textures and the files that were read.
#include <gmock/gmock.h>

#include <cmath>
#include <map>
#include <random>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "bake/import/import_helpers.h"

namespace galactic::test::scene_graph_test {
namespace {

using bake::importMesh;
using bake::placeAndClean;
using testing::ElementsAre;
using testing::HasSubstr;

/// The reader keeps node matrices as floats, so a chain of three 10 m translations under rotations
/// is off by some units in the last place.
constexpr double kNodeTolerance = 2e-5;

WorldPoint rotated(const std::array<double, 4>& q, const WorldPoint& p) {
  // q (x, y, z, w) as glTF has it: p + 2 w (u x p) + 2 u x (u x p)
  const auto cross = [](const WorldPoint& a, const WorldPoint& b) {
    return WorldPoint{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                      a[0] * b[1] - a[1] * b[0]};
  };
  const WorldPoint u{q[0], q[1], q[2]};
  const WorldPoint once = cross(u, p);
  const WorldPoint twice = cross(u, once);
  WorldPoint r{};
  for (std::size_t i = 0; i < 3; ++i) r[i] = p[i] + 2 * q[3] * once[i] + 2 * twice[i];
  return r;
}

struct Trs {
  WorldPoint translation{};
  std::array<double, 4> rotation{0, 0, 0, 1};
  WorldPoint scale{1, 1, 1};

  [[nodiscard]] WorldPoint operator()(const WorldPoint& p) const {
    WorldPoint q = rotated(rotation, {p[0] * scale[0], p[1] * scale[1], p[2] * scale[2]});
    for (std::size_t i = 0; i < 3; ++i) q[i] += translation[i];
    return q;
  }
  [[nodiscard]] bool mirrors() const { return scale[0] * scale[1] * scale[2] < 0; }
  [[nodiscard]] std::string json() const {
    return fmt::format(R"("translation":[{},{},{}],"rotation":[{},{},{},{}],"scale":[{},{},{}])",
                       translation[0], translation[1], translation[2], rotation[0], rotation[1],
                       rotation[2], rotation[3], scale[0], scale[1], scale[2]);
  }
};

Trs randomTrs(std::mt19937& random) {
  std::uniform_real_distribution<double> shift(-10, 10);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> size(0.5, 1.5);
  Trs trs;
  double length = 0;
  for (double& v : trs.translation) v = shift(random);
  for (double& v : trs.rotation) v = normal(random);
  for (const double v : trs.rotation) length += v * v;
  for (double& v : trs.rotation) v /= std::sqrt(length);
  for (double& v : trs.scale) v = size(random) * (random() % 2 == 0 ? 1 : -1);
  return trs;
}

TEST(SceneGraph, ComposesNodeTransformsAsQuaternionArithmeticDoes) {
  constexpr unsigned kSeed = 20240117;
  constexpr int kCases = 100;
  SCOPED_TRACE(fmt::format("seed {}", kSeed));
  std::mt19937 random(kSeed);
  const MeshContent box = unevenBox();
  int mirrored = 0;
  for (int n = 0; n < kCases; ++n) {
    const Trs a = randomTrs(random);
    const Trs b = randomTrs(random);
    const Trs c = randomTrs(random);
    const std::string nodes = fmt::format(
        R"([{{"name":"a","children":[1,2],{}}},{{"name":"b","mesh":0,{}}},{{"name":"c","mesh":0,{}}}])",
        a.json(), b.json(), c.json());
    const auto asset =
        importContent("n.glb", glbFile(box, {.nodes = nodes, .buffer_uri = {}, .more = {}}));
    ASSERT_TRUE(asset.has_value()) << asset.error().message;
    ASSERT_EQ(asset->meshes.size(), 1U) << "instances share their mesh";
    ASSERT_EQ(asset->instances.size(), 2U);
    EXPECT_EQ(asset->instances[0].name, "b");
    EXPECT_EQ(asset->instances[1].name, "c");
    const auto clean = placeAndClean(*asset);
    ASSERT_TRUE(clean.has_value()) << clean.error().message;

    std::vector<WorldTriangle> expected;
    for (const Trs& child : {b, c}) {
      const bool flip = a.mirrors() != child.mirrors();
      mirrored += flip ? 1 : 0;
      for (auto t : box.triangles) {
        if (flip) std::swap(t[1], t[2]);
        WorldTriangle& triangle = expected.emplace_back();
        for (std::size_t i = 0; i < 3; ++i) {
          const auto& p = box.positions[t[i]];
          triangle[i] = a(child(
              {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])}));
        }
      }
    }
    // Rounding may swap nearly equal corners in the order, so triangles are compared in file order.
    const auto& mesh = clean->mesh;
    ASSERT_EQ(mesh.triangles.size(), expected.size());
    for (std::size_t t = 0; t < expected.size(); ++t) {
      for (std::size_t i = 0; i < 3; ++i) {
        const Vec3& v = mesh.vertices[mesh.triangles[t][i]];
        EXPECT_NEAR(static_cast<double>(v.x), expected[t][i][0], kNodeTolerance);
        EXPECT_NEAR(static_cast<double>(v.y), expected[t][i][1], kNodeTolerance);
        EXPECT_NEAR(static_cast<double>(v.z), expected[t][i][2], kNodeTolerance);
      }
    }
  }
  EXPECT_GE(mirrored, 2 * kCases / 10) << "too few mirrored instances to mean anything";
  EXPECT_LE(mirrored, 2 * kCases * 9 / 10);
}

/// Signed volume, positive when triangles are counter-clockwise seen from outside.
double volume(const bake::TriangleMesh& mesh) {
  double sum = 0;
  for (const WorldTriangle& t : worldTriangles(mesh)) {
    sum += t[0][0] * (t[1][1] * t[2][2] - t[1][2] * t[2][1]) -
           t[0][1] * (t[1][0] * t[2][2] - t[1][2] * t[2][0]) +
           t[0][2] * (t[1][0] * t[2][1] - t[1][1] * t[2][0]);
  }
  return sum / 6;
}

TEST(SceneGraph, KeepsTrianglesFacingOutwardsUnderNegativeScales) {
  for (const std::string scale : {"[1,1,1]", "[-1,1,1]", "[-1,-1,1]", "[-1,-1,-1]"}) {
    const auto asset = importContent(
        "m.glb",
        glbFile(unevenBox(),
                {.nodes = R"([{"mesh":0,"scale":)" + scale + "}]", .buffer_uri = {}, .more = {}}));
    ASSERT_TRUE(asset.has_value()) << asset.error().message;
    const auto clean = placeAndClean(*asset);
    ASSERT_TRUE(clean.has_value());
    EXPECT_NEAR(volume(clean->mesh), 1 * 2 * 3, kNodeTolerance) << scale;
  }
}

TEST(SceneGraph, AppliesColladaNodeTransformsBeforeAxesAndUnit) {
  const std::string node = "<translate>100 200 300</translate><rotate>0 0 1 90</rotate>";
  const auto asset = importContent("n.dae", daeFile(unevenBox(), {"Z_UP", "0.01", node}));
  ASSERT_TRUE(asset.has_value()) << asset.error().message;
  const auto clean = placeAndClean(*asset);
  ASSERT_TRUE(clean.has_value());
  // (x, y, z) -> (100 - y, 200 + x, 300 + z) centimeters, Z up -> (x, z, -y) meters.
  const auto& b = clean->mesh.bounds;
  EXPECT_NEAR(static_cast<double>(b.min.x), 1 - 0.0225, kNodeTolerance);
  EXPECT_NEAR(static_cast<double>(b.max.x), 1 - 0.0025, kNodeTolerance);
  EXPECT_NEAR(static_cast<double>(b.min.y), 3.01, kNodeTolerance);
  EXPECT_NEAR(static_cast<double>(b.max.y), 3.04, kNodeTolerance);
  EXPECT_NEAR(static_cast<double>(b.min.z), -2.015, kNodeTolerance);
  EXPECT_NEAR(static_cast<double>(b.max.z), -2.005, kNodeTolerance);
}

constexpr std::string_view kMtl =
    "newmtl oak\nKd 0.25 0.5 0.75\nmap_Kd wood planks.png\nnewmtl steel\nKd 0.5 0.5 0.5\n"
    "map_Kd missing.png\n";
constexpr std::string_view kTexturedObj =
    "mtllib room.mtl\nv 0 0 0\nv 3 0 0\nv 0 0 3\nv 0 3 0\nvt 0 0\nvt 1 0\nvt 0.25 0.75\n"
    "o table\nusemtl oak\nf 1/1 2/2 3/3\no rail\nusemtl steel\nf 1/1 2/2 4/3\n";

TEST(SceneGraph, KeepsNamesMaterialsAndTextureCoordinates) {
  const ScratchFolder folder;
  static_cast<void>(folder.write("room.mtl", kMtl));
  static_cast<void>(folder.write("wood planks.png", "png"));
  const auto asset = importMesh(folder.write("room.obj", kTexturedObj));
  ASSERT_TRUE(asset.has_value()) << asset.error().message;
  EXPECT_EQ(asset->name, "room");
  EXPECT_EQ(asset->format, "Wavefront OBJ");
  ASSERT_EQ(asset->meshes.size(), 2U);
  EXPECT_EQ(asset->meshes[0].name, "table");
  EXPECT_EQ(asset->instances[1].name, "rail");
  const auto& oak = asset->materials[asset->meshes[0].material];
  EXPECT_EQ(oak.name, "oak");
  EXPECT_THAT(oak.base_color, ElementsAre(0.25F, 0.5F, 0.75F, 1.F));
  EXPECT_EQ(oak.base_color_texture, "wood planks.png");
  ASSERT_EQ(asset->meshes[0].uvs.size(), 3U);
  EXPECT_THAT(asset->meshes[0].uvs[2], ElementsAre(0.25F, 0.75F));
}

TEST(SceneGraph, WarnsOfEachMissingTextureByName) {
  const ScratchFolder folder;
  static_cast<void>(folder.write("room.mtl", kMtl));
  static_cast<void>(folder.write("wood planks.png", "png"));
  const auto asset = importMesh(folder.write("room.obj", kTexturedObj));
  ASSERT_TRUE(asset.has_value());
  EXPECT_THAT(asset->warnings,
              ElementsAre("texture 'missing.png' of material 'steel' is missing: its surfaces keep "
                          "their plain color"));
}

TEST(SceneGraph, WarnsOfAMissingMaterialFileOnce) {
  const auto asset =
      importContent("room.obj", "mtllib a.mtl\nv 0 0 0\nv 3 0 0\nv 0 0 3\nf 1 2 3\n");
  ASSERT_TRUE(asset.has_value());
  EXPECT_THAT(asset->warnings, ElementsAre("material file 'a.mtl' is missing: its materials get "
                                           "default colors"));
}

TEST(SceneGraph, ListsTheFilesItReadWithSizesAndHashes) {
  const ScratchFolder folder;
  static_cast<void>(folder.write("meshes/room.mtl", "newmtl oak\nmap_Kd ../a.png\n"));
  static_cast<void>(folder.write("a.png", "picture"));
  const std::string obj = "mtllib room.mtl\nv 0 0 0\nv 3 0 0\nv 0 0 3\nusemtl oak\nf 1 2 3\n";
  const auto asset = importMesh(folder.write("meshes/room.obj", obj));
  ASSERT_TRUE(asset.has_value()) << asset.error().message;
  ASSERT_EQ(asset->read.files.size(), 3U);
  EXPECT_EQ(asset->read.files[0].name, "room.obj") << "the main input comes first";
  EXPECT_EQ(asset->read.files[1].name, "../a.png");
  EXPECT_EQ(asset->read.files[2].name, "room.mtl");
  EXPECT_EQ(asset->read.files[0].bytes, obj.size());
  const XXH128_hash_t hash = XXH3_128bits("picture", 7);
  EXPECT_EQ(asset->read.files[1].hash_low, hash.low64);
  EXPECT_EQ(asset->read.files[1].hash_high, hash.high64);
}

/// A triangle of which a morph target moves the second corner by (1, 2, 3), with weights.
std::string morphFile(std::string_view mesh_weights, std::string_view node_weights) {
  const std::array<float, 18> points{0, 0, 0, 9, 0, 0, 0, 9, 0, 0, 0, 0, 1, 2, 3, 0, 0, 0};
  std::string buffer;
  for (const float value : points) buffer += bytesOf(value);
  return glbContainer(
      fmt::format(
          R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0{}}}],)"
          R"("meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"targets":[{{"POSITION":1}}]}}]{}}}],)"
          R"("accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",)"
          R"("min":[0,0,0],"max":[9,9,0]}},{{"bufferView":0,"byteOffset":36,"componentType":5126,)"
          R"("count":3,"type":"VEC3","min":[0,0,0],"max":[1,2,3]}}],)"
          R"("bufferViews":[{{"buffer":0,"byteLength":72}}],"buffers":[{{"byteLength":72}}]}})",
          node_weights, mesh_weights),
      buffer);
}

TEST(SceneGraph, ShapesMeshesOfGltfFilesByTheWeightsOfTheirMorphTargets) {
  const auto second = [](std::string_view weights) {
    const auto asset = importContent("a.glb", morphFile(weights, ""));
    EXPECT_TRUE(asset.has_value()) << asset.error().message;
    if (!asset) return WorldPoint{};
    EXPECT_THAT(asset->warnings, ElementsAre());
    const Vec3& p = asset->meshes[0].positions[1];
    return WorldPoint{static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
  };
  EXPECT_THAT(second(""), ElementsAre(9, 0, 0));
  EXPECT_THAT(second(R"(,"weights":[0])"), ElementsAre(9, 0, 0));
  EXPECT_THAT(second(R"(,"weights":[1])"), ElementsAre(10, 2, 3));
  EXPECT_THAT(second(R"(,"weights":[-0.5])"), ElementsAre(8.5, -1, -1.5));
}

/// Two triangles as two primitives that share their six points.
std::string sharedPointsFile() {
  std::string buffer;
  for (const float value :
       {0.F, 0.F, 0.F, 9.F, 0.F, 0.F, 0.F, 9.F, 0.F, 0.F, 0.F, 5.F, 8.F, 0.F, 5.F, 0.F, 7.F, 5.F}) {
    buffer += bytesOf(value);
  }
  const std::array<std::uint16_t, 6> indices{3, 4, 5, 2, 0, 1};
  for (const std::uint16_t index : indices) buffer += bytesOf(index);
  return glbContainer(
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)"
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1},)"
      R"({"attributes":{"POSITION":0},"indices":2}]}],)"
      R"("accessors":[{"bufferView":0,"componentType":5126,"count":6,"type":"VEC3",)"
      R"("min":[0,0,0],"max":[9,9,5]},{"bufferView":1,"componentType":5123,"count":3,)"
      R"("type":"SCALAR"},{"bufferView":1,"byteOffset":6,"componentType":5123,"count":3,)"
      R"("type":"SCALAR"}],"bufferViews":[{"buffer":0,"byteLength":72},)"
      R"({"buffer":0,"byteOffset":72,"byteLength":12}],"buffers":[{"byteLength":84}]})",
      buffer);
}

TEST(SceneGraph, LeavesOutVerticesThatOtherMeshesUse) {
  const auto asset = importContent("a.glb", sharedPointsFile());
  ASSERT_TRUE(asset.has_value()) << asset.error().message;
  ASSERT_EQ(asset->meshes.size(), 2U);
  const bake::SourceMesh& first = asset->meshes[0];
  const bake::SourceMesh& second = asset->meshes[1];
  EXPECT_THAT(first.positions, ElementsAre(Vec3{0, 0, 5}, Vec3{8, 0, 5}, Vec3{0, 7, 5}));
  EXPECT_THAT(first.triangles, ElementsAre(bake::Triangle{0, 1, 2}));
  EXPECT_THAT(second.positions, ElementsAre(Vec3{0, 0, 0}, Vec3{9, 0, 0}, Vec3{0, 9, 0}));
  EXPECT_THAT(second.triangles, ElementsAre(bake::Triangle{2, 0, 1}));
}

TEST(SceneGraph, WarnsOfWeightsOfMorphTargetsThatNodesStateOnce) {
  const auto warnings = [](std::string_view weights) {
    const auto asset = importContent("a.glb", morphFile("", weights));
    EXPECT_TRUE(asset.has_value()) << asset.error().message;
    return asset ? asset->warnings : std::vector<std::string>();
  };
  EXPECT_THAT(warnings(R"(,"weights":[0.0],"translation":[1,2,3])"), ElementsAre());
  EXPECT_THAT(warnings(R"(,"weights":[0.5,1],"translation":[1,2,3])"),
              ElementsAre(HasSubstr("weights of morph targets that nodes state are not read")));
}

TEST(SceneGraph, NamesTheBufferOfAGltfAmongItsFiles) {
  const ScratchFolder folder;
  static_cast<void>(folder.write("box 1.bin", gltfBuffer(unevenBox())));
  const auto asset = importMesh(
      folder.write("box.gltf", gltfFile(unevenBox(), {.nodes = GltfPieces{}.nodes,
                                                      .buffer_uri = R"("uri":"box%201.bin",)",
                                                      .more = {}})));
  ASSERT_TRUE(asset.has_value()) << asset.error().message;
  ASSERT_EQ(asset->read.files.size(), 2U);
  EXPECT_EQ(asset->read.files[1].name, "box 1.bin");
}

TEST(SceneGraph, IgnoresPointsAndLinesWithAWarning) {
  const auto asset =
      importContent("room.obj", "v 0 0 0\nv 3 0 0\nv 0 0 3\nf 1 2 3\nl 1 2\nl 2 3\n");
  ASSERT_TRUE(asset.has_value()) << asset.error().message;
  EXPECT_THAT(asset->warnings, testing::Contains(HasSubstr("points or lines: ignored")));
}

TEST(SceneGraph, AsksForTheUnitOfASceneSmallerThanAnyRoom) {
  const auto asset = importContent("cup.obj", "v 0 0 0\nv 0.1 0 0\nv 0 0 0.2\nf 1 2 3\n");
  ASSERT_TRUE(asset.has_value());
  EXPECT_THAT(asset->warnings,
              ElementsAre("the whole scene is only 0.1 x 0 x 0.2 m large: is its unit the meter? "
                          "Give meters per unit with `scale`"));
}

}  // namespace
}  // namespace galactic::test::scene_graph_test
