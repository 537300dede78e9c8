// GLB files against the rules of glTF 2.0 and against what was to be written.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <map>
#include <set>

#include "pack_tool/asset_packs.h"
#include "pack_tool/describe/pack_description.h"
#include "pack_tool/figure/figures_of_pack.h"
#include "pack_tool/mesh/figure_glb.h"
#include "pack_tool/mesh/sphere_mesh.h"

namespace galactic::pack_tool::glb_test {
namespace {

using test::ToyObject;
using test::ToyObjects;
using test::ToyPack;
using test::ToyRobot;
using testing::Contains;

constexpr float kRounding = 1e-6F;

/// A GLB file taken apart, with the checks that hold for each.
struct Glb {
  Json json;
  std::string binary;

  explicit Glb(const std::string& file) {
    const auto number = [&file](std::size_t offset) {
      std::uint32_t value = 0;
      std::memcpy(&value, file.data() + offset, sizeof value);
      return value;
    };
    EXPECT_EQ(file.substr(0, 4), "glTF");
    EXPECT_EQ(number(4), 2U);
    EXPECT_EQ(number(8), file.size());
    const std::size_t json_bytes = number(12);
    EXPECT_EQ(file.substr(16, 4), "JSON");
    EXPECT_EQ(json_bytes % 4, 0U);
    json = Json::parse(file.substr(20, json_bytes));
    const std::size_t chunk = 20 + json_bytes;
    if (chunk == file.size()) return;
    EXPECT_EQ(number(chunk) % 4, 0U);
    EXPECT_EQ(file.substr(chunk + 4, 4), std::string("BIN\0", 4));
    binary = file.substr(chunk + 8);
    EXPECT_EQ(binary.size(), number(chunk));
    EXPECT_EQ(json.at("buffers").at(0).at("byteLength"), binary.size());
  }

  [[nodiscard]] std::span<const char> bytesOf(const Json& accessor, std::size_t element) const {
    const Json& view = json.at("bufferViews").at(accessor.at("bufferView").get<std::size_t>());
    const auto offset = view.at("byteOffset").get<std::size_t>();
    const auto length = view.at("byteLength").get<std::size_t>();
    EXPECT_EQ(offset % 4, 0U);
    EXPECT_EQ(length, accessor.at("count").get<std::size_t>() * element);
    EXPECT_LE(offset + length, binary.size());
    return std::span(binary).subspan(offset, length);
  }

  template <class T>
  [[nodiscard]] std::vector<T> read(std::size_t index) const {
    const Json& accessor = json.at("accessors").at(index);
    const auto bytes = bytesOf(accessor, sizeof(T));
    std::vector<T> values(bytes.size() / sizeof(T));
    std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
  }

  /// The world pose of each node by its name; scales are left out.
  [[nodiscard]] std::map<std::string, Pose> poses() const {
    std::map<std::string, Pose> found;
    for (const Json& root : json.at("scenes").at(0).at("nodes")) {
      collect(root.get<std::size_t>(), {}, found);
    }
    return found;
  }

  void collect(std::size_t index, const Pose& parent, std::map<std::string, Pose>& found) const {
    const Json& node = json.at("nodes").at(index);
    Pose pose;
    if (node.contains("translation")) {
      const Json& t = node.at("translation");
      pose.translation = {t.at(0).get<float>(), t.at(1).get<float>(), t.at(2).get<float>()};
    }
    if (node.contains("rotation")) {
      const Json& r = node.at("rotation");
      pose.rotation = {r.at(0).get<float>(), r.at(1).get<float>(), r.at(2).get<float>(),
                       r.at(3).get<float>()};
    }
    const Pose world = parent * pose;
    found[node.at("name").get<std::string>()] = world;
    if (!node.contains("children")) return;
    for (const Json& child : node.at("children")) collect(child.get<std::size_t>(), world, found);
  }
};

Glb glbOf(const ToyPack& pack, const FigureOptions& options = {}) {
  auto figures = figuresOf(*pack, options);
  EXPECT_TRUE(figures.has_value());
  const auto bytes = encodeGlb(*figures);
  EXPECT_TRUE(bytes.has_value());
  return Glb(*bytes);
}

/// Numbers as floats: the file has the shortest text that reads back to them.
std::array<float, 3> floatsOf(const Json& list) { return list.get<std::array<float, 3>>(); }

void checkMesh(const Glb& glb, const Json& primitive) {
  const Json& attributes = primitive.at("attributes");
  const auto index = attributes.at("POSITION").get<std::size_t>();
  const auto positions = glb.read<Vec3>(index);
  Vec3 low = positions.front();
  Vec3 high = low;
  for (const Vec3& p : positions) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  const Json& accessor = glb.json.at("accessors").at(index);
  EXPECT_EQ(floatsOf(accessor.at("min")), (std::array{low.x, low.y, low.z}));
  EXPECT_EQ(floatsOf(accessor.at("max")), (std::array{high.x, high.y, high.z}));
  const auto corners = glb.read<std::uint32_t>(primitive.at("indices").get<std::size_t>());
  EXPECT_EQ(corners.size() % (primitive.at("mode") == 4 ? 3 : 2), 0U);
  for (const std::uint32_t corner : corners) EXPECT_LT(corner, positions.size());
  EXPECT_LT(primitive.at("material").get<std::size_t>(), glb.json.at("materials").size());
  for (const char* other : {"NORMAL", "COLOR_0"}) {
    if (!attributes.contains(other)) continue;
    const Json& more = glb.json.at("accessors").at(attributes.at(other).get<std::size_t>());
    EXPECT_EQ(more.at("count"), positions.size());
  }
}

TEST(Glb, KeepsTheRulesOfTheFormat) {
  const ToyPack objects{ToyObjects{{{.colored = true}}}};
  const ToyPack robot{ToyRobot{}};
  for (const Glb& glb : {glbOf(objects), glbOf(robot)}) {
    EXPECT_EQ(glb.json.at("asset").at("version"), "2.0");
    EXPECT_FALSE(glb.json.at("meshes").empty());
    for (const Json& mesh : glb.json.at("meshes")) {
      ASSERT_EQ(mesh.at("primitives").size(), 1U);
      checkMesh(glb, mesh.at("primitives").at(0));
    }
    // Each node but the roots has exactly one parent.
    std::multiset<std::size_t> children;
    for (const Json& node : glb.json.at("nodes")) {
      if (!node.contains("children")) continue;
      for (const Json& child : node.at("children")) children.insert(child.get<std::size_t>());
    }
    EXPECT_EQ(children.size(), std::set(children.begin(), children.end()).size());
    EXPECT_EQ(children.size() + glb.json.at("scenes").at(0).at("nodes").size(),
              glb.json.at("nodes").size());
  }
}

TEST(Glb, SharesOneMeshForAllSpheresOfARadius) {
  const ToyPack pack{ToyRobot{}};
  const Glb glb = glbOf(pack);
  std::map<std::string, int> uses;
  for (const Json& node : glb.json.at("nodes")) {
    if (!node.contains("mesh")) continue;
    const Json& mesh = glb.json.at("meshes").at(node.at("mesh").get<std::size_t>());
    ++uses[mesh.at("name").get<std::string>()];
  }
  EXPECT_EQ(uses["sphere of 0.05 m"], 3);
  EXPECT_EQ(uses["sphere of 0.25 m"], 1);
}

TEST(Glb, PutsLinksAndSpheresWhereTheFigureHasThem) {
  const ToyPack pack{ToyRobot{}};
  const FigureOptions options{.joints = {.values = {{"lift", 1}, {"reach", -0.5F}}}};
  const auto figures = figuresOf(*pack, options);
  ASSERT_TRUE(figures.has_value());
  const auto poses = glbOf(pack, options).poses();
  const auto expectNear = [](const Vec3& a, const Vec3& b) {
    EXPECT_NEAR(a.x, b.x, kRounding);
    EXPECT_NEAR(a.y, b.y, kRounding);
    EXPECT_NEAR(a.z, b.z, kRounding);
  };
  int spheres = 0;
  for (const FigurePart& part : figures->front().parts) {
    SCOPED_TRACE(part.name);
    const Pose& pose = poses.at(part.name);
    // A point off the origin sees the rotation too.
    expectNear(pose * Vec3{1, 2, 3}, part.world_from_part * Vec3{1, 2, 3});
    for (std::size_t n = 0; n < part.spheres.size(); ++n, ++spheres) {
      expectNear(poses.at(part.name + " sphere " + std::to_string(n)).translation,
                 part.world_from_part * part.spheres[n].center);
    }
  }
  EXPECT_EQ(spheres, 4);
  expectNear(poses.at("grasp point").translation, figures->front().grasp->center_in_world);
  // A camera of glTF looks along its -Z, one of a robot along its +X.
  const CameraMark& camera = *figures->front().camera;
  expectNear(poses.at("camera") * Vec3{0, 0, -1}, camera.world_from_camera * Vec3{1, 0, 0});
  expectNear(poses.at("camera") * Vec3{0, 1, 0}, camera.world_from_camera * Vec3{0, 1, 0});
}

TEST(Glb, WritesColorsLinear) {
  const ToyPack pack{ToyObjects{{{.colored = true}}}};
  const Glb glb = glbOf(pack);
  const Json& attributes = glb.json.at("meshes").at(0).at("primitives").at(0).at("attributes");
  using Color = std::array<std::uint16_t, 4>;
  const auto colors = glb.read<Color>(attributes.at("COLOR_0").get<std::size_t>());
  EXPECT_THAT(colors, testing::Each((Color{65535, 0, 0, 65535})));
}

TEST(Glb, ScalesTheUnitBoxToTheObjects) {
  const ToyPack pack{ToyObjects{}};
  const Glb glb = glbOf(pack, {.object = "block"});
  for (const Json& node : glb.json.at("nodes")) {
    if (node.at("name") != "block box") continue;
    EXPECT_EQ(floatsOf(node.at("scale")), (std::array{0.05F, 0.1F, 0.03F}));
    return;
  }
  FAIL() << "no node of the box";
}

TEST(Glb, WithoutAnythingShownHasNodesOnly) {
  const ToyPack pack{ToyObjects{}};
  const Glb glb = glbOf(pack, {.layers = LayerSet::none()});
  EXPECT_FALSE(glb.json.contains("meshes"));
  EXPECT_FALSE(glb.json.contains("buffers"));
  EXPECT_EQ(glb.json.at("nodes").size(), 4U);
}

TEST(SphereMesh, IsClosedAndFacesOutwards) {
  const SphereMesh mesh = makeSphereMesh();
  EXPECT_EQ(mesh.points.size(), 162U);
  ASSERT_EQ(mesh.corners.size(), 3U * 320);
  for (const Vec3& point : mesh.points) EXPECT_NEAR(dot(point, point), 1, kRounding);
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (std::size_t n = 0; n < mesh.corners.size(); n += 3) {
    const Vec3& a = mesh.points[mesh.corners[n]];
    const Vec3& b = mesh.points[mesh.corners[n + 1]];
    const Vec3& c = mesh.points[mesh.corners[n + 2]];
    EXPECT_GT(dot(cross(b - a, c - a), a), 0);
    for (std::size_t e = 0; e < 3; ++e) {
      edges.emplace(mesh.corners[n + e], mesh.corners[n + (e + 1) % 3]);
    }
  }
  // Closed: each edge runs once in each direction.
  EXPECT_EQ(edges.size(), 3U * 320);
  for (const auto& [from, to] : edges) EXPECT_THAT(edges, Contains(std::pair(to, from)));
}

}  // namespace
}  // namespace galactic::pack_tool::glb_test
