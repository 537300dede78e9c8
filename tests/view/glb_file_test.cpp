// What GLB files hold is what their validators take.
#include "view/glb_file.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace galactic::test::glb_file_test {
namespace {

using nlohmann::json;

/// Four components that are rounded to floats: some units in the last place of 1.
constexpr double kRounding = 2e-7;

/// Rotations as products of rotations leave them: longer or shorter than one by some roundings.
const std::vector<Quat>& rotationsThatAreOff() {
  static const std::vector<Quat> kRotations{
      {0, 0, 0, 1.0000001F},
      {-1.0000001F, 0, 0, 0},
      {1.00001F, 3e-4F, 0, 0},
      {0.5F, -0.5F, 0.5000003F, 0.5F},
      {0, 0.6F * 0.9999F, 0, 0.8F * 0.9999F},
  };
  return kRotations;
}

void expectUnit(const std::array<float, 4>& q) {
  double squares = 0;
  for (const float part : q) {
    EXPECT_LE(std::fabs(part), 1.0F);
    squares += static_cast<double>(part) * static_cast<double>(part);
  }
  EXPECT_NEAR(std::sqrt(squares), 1, kRounding);
}

/// The JSON and the binary part of a file.
struct Parts {
  json content;
  std::string binary;

  explicit Parts(const std::string& file) {
    constexpr std::size_t kJsonAt = 20;
    constexpr std::size_t kChunkHeader = 8;
    std::uint32_t length = 0;
    std::memcpy(&length, file.data() + kJsonAt - kChunkHeader, sizeof length);
    content = json::parse(file.substr(kJsonAt, length));
    if (file.size() > kJsonAt + length) binary = file.substr(kJsonAt + length + kChunkHeader);
  }
};

TEST(GlbFile, WritesRotationsOfNodesWithLengthOne) {
  GlbFile file;
  for (const Quat& rotation : rotationsThatAreOff()) {
    file.addNode({.name = "node", .parent_from_node = {{}, rotation}});
  }
  const Parts parts(*file.bytes());
  std::size_t turned = 0;
  for (const json& node : parts.content["nodes"]) {
    if (!node.contains("rotation")) continue;
    expectUnit(node["rotation"].get<std::array<float, 4>>());
    ++turned;
  }
  // The first one turns nothing, and is left out as such.
  EXPECT_EQ(turned, rotationsThatAreOff().size() - 1);
}

TEST(GlbFile, WritesRotationsOfKeysWithLengthOne) {
  GlbFile file;
  const std::size_t node = file.addNode({.name = "node"});
  GlbMotion motion{.node = node, .parent_from_node = {}};
  std::vector<float> times;
  for (const Quat& rotation : rotationsThatAreOff()) {
    times.push_back(static_cast<float>(times.size()));
    motion.parent_from_node.push_back({{}, rotation});
  }
  file.addAnimation("run", times, {&motion, 1});
  const Parts parts(*file.bytes());
  const json& animation = parts.content["animations"][0];
  std::size_t keys = 0;
  for (const json& channel : animation["channels"]) {
    if (channel["target"]["path"] != "rotation") continue;
    const json& sampler = animation["samplers"][channel["sampler"].get<std::size_t>()];
    const json& accessor = parts.content["accessors"][sampler["output"].get<std::size_t>()];
    const json& view = parts.content["bufferViews"][accessor["bufferView"].get<std::size_t>()];
    for (; keys < accessor["count"].get<std::size_t>(); ++keys) {
      std::array<float, 4> rotation{};
      std::memcpy(
          rotation.data(),
          parts.binary.data() + view["byteOffset"].get<std::size_t>() + keys * sizeof rotation,
          sizeof rotation);
      expectUnit(rotation);
    }
  }
  EXPECT_EQ(keys, rotationsThatAreOff().size());
}

TEST(GlbFile, WritesARotationThatIsNoneAsNothing) {
  GlbFile file;
  file.addNode({.name = "node", .parent_from_node = {{}, {0, 0, 0, 0}}});
  EXPECT_FALSE(Parts(*file.bytes()).content["nodes"][0].contains("rotation"));
}

}  // namespace
}  // namespace galactic::test::glb_file_test
