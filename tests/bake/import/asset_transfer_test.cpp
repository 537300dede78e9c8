#include "import/asset_transfer.h"

#include <gmock/gmock.h>

#include <cstring>
#include <optional>
#include <vector>

namespace galactic::test::asset_transfer_test {
namespace {

using bake::AlphaMode;
using bake::AssetSender;
using bake::receiveAsset;
using bake::SourceAsset;
using bake::SourceMesh;

SourceMesh exampleMesh(std::uint32_t number) {
  SourceMesh mesh;
  mesh.name = "mesh" + std::to_string(number);
  for (std::uint32_t i = 0; i < 3 + number; ++i) {
    mesh.positions.push_back({static_cast<float>(i), 1.5F, -2});
    mesh.uvs.push_back({0.5F, static_cast<float>(i)});
    mesh.colors.push_back({1, 0.5F, 0.25F, 0});
  }
  mesh.triangles = {{0, 1, 2}};
  mesh.material = number;
  return mesh;
}

SourceAsset exampleRest() {
  SourceAsset asset;
  asset.name = "room";
  asset.format = "glTF 2.0";
  asset.convention = "Y up";
  asset.meters_per_unit = 0.25;
  asset.unit_is_stated = true;
  asset.instances = {
      {.name = "n", .mesh = 1, .world_from_mesh = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}}};
  asset.materials.push_back({.name = "oak",
                             .base_color = {0, 1, 0, 1},
                             .base_color_texture = "*0",
                             .two_sided = true,
                             .alpha_mode = AlphaMode::kMask,
                             .alpha_cutoff = 0.25F});
  asset.textures.push_back({.format = "png", .bytes = {1, 2, 3}});
  asset.read.files.push_back({.name = "room.glb", .bytes = 5, .hash_low = 6, .hash_high = 7});
  asset.read.absent = {"room.mtl"};
  asset.missing = {"second"};
  asset.warnings = {"first", "second"};
  return asset;
}

template <class Send>
std::vector<std::byte> sent(const Send& send) {
  std::vector<std::byte> bytes;
  send(AssetSender([&](std::span<const std::byte> piece) {
    bytes.insert(bytes.end(), piece.begin(), piece.end());
  }));
  return bytes;
}

std::vector<std::byte> exampleTransfer() {
  return sent([](const AssetSender& sender) {
    sender.mesh(exampleMesh(0));
    sender.mesh(exampleMesh(1));
    sender.finish(exampleRest());
  });
}

TEST(AssetTransfer, DeliversEveryField) {
  const auto asset = receiveAsset(exampleTransfer());
  ASSERT_TRUE(asset.has_value()) << asset.error().message;
  const SourceAsset expected = exampleRest();
  EXPECT_EQ(asset->name, expected.name);
  EXPECT_EQ(asset->format, expected.format);
  EXPECT_EQ(asset->convention, expected.convention);
  EXPECT_EQ(asset->meters_per_unit, expected.meters_per_unit);
  EXPECT_EQ(asset->unit_is_stated, expected.unit_is_stated);
  ASSERT_EQ(asset->meshes.size(), 2U);
  EXPECT_EQ(asset->meshes[1].name, "mesh1");
  EXPECT_EQ(asset->meshes[1].positions, exampleMesh(1).positions);
  EXPECT_EQ(asset->meshes[1].uvs, exampleMesh(1).uvs);
  EXPECT_EQ(asset->meshes[1].colors, exampleMesh(1).colors);
  EXPECT_EQ(asset->meshes[1].triangles, exampleMesh(1).triangles);
  EXPECT_EQ(asset->meshes[1].material, 1U);
  ASSERT_EQ(asset->instances.size(), 1U);
  EXPECT_EQ(asset->instances[0].name, "n");
  EXPECT_EQ(asset->instances[0].mesh, 1U);
  EXPECT_EQ(asset->instances[0].world_from_mesh, expected.instances[0].world_from_mesh);
  ASSERT_EQ(asset->materials.size(), 1U);
  EXPECT_EQ(asset->materials[0].name, "oak");
  EXPECT_EQ(asset->materials[0].base_color, expected.materials[0].base_color);
  EXPECT_EQ(asset->materials[0].base_color_texture, "*0");
  EXPECT_EQ(asset->materials[0].alpha_mode, AlphaMode::kMask);
  EXPECT_EQ(asset->materials[0].alpha_cutoff, 0.25F);
  EXPECT_TRUE(asset->materials[0].two_sided);
  ASSERT_EQ(asset->textures.size(), 1U);
  EXPECT_EQ(asset->textures[0].format, "png");
  EXPECT_EQ(asset->textures[0].bytes, expected.textures[0].bytes);
  ASSERT_EQ(asset->read.files.size(), 1U);
  EXPECT_EQ(asset->read.files[0].name, "room.glb");
  EXPECT_EQ(asset->read.files[0].bytes, 5U);
  EXPECT_EQ(asset->read.files[0].hash_low, 6U);
  EXPECT_EQ(asset->read.files[0].hash_high, 7U);
  EXPECT_EQ(asset->read.absent, expected.read.absent);
  EXPECT_EQ(asset->missing, expected.missing);
  EXPECT_EQ(asset->warnings, expected.warnings);
}

TEST(AssetTransfer, DeliversAnErrorInsteadOfTheMeshesSentBefore) {
  const auto bytes = sent([](const AssetSender& sender) {
    sender.mesh(exampleMesh(0));
    sender.fail({.code = ErrorCode::kUnsupported, .where = "a.glb", .message = "is odd"});
  });
  const auto asset = receiveAsset(bytes);
  ASSERT_FALSE(asset.has_value());
  EXPECT_EQ(asset.error().code, ErrorCode::kUnsupported);
  EXPECT_EQ(asset.error().where, "a.glb");
  EXPECT_EQ(asset.error().message, "is odd");
}

TEST(AssetTransfer, RefusesEveryTruncationAndAnyFurtherByte) {
  std::vector<std::byte> bytes = exampleTransfer();
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    // A block of exactly this size, so that a sanitizer sees any read beyond it.
    const std::vector<std::byte> cut(bytes.begin(),
                                     bytes.begin() + static_cast<std::ptrdiff_t>(size));
    const auto asset = receiveAsset(cut);
    ASSERT_FALSE(asset.has_value()) << "accepted " << size << " of " << bytes.size() << " bytes";
    EXPECT_EQ(asset.error().code, ErrorCode::kInternal);
  }
  bytes.push_back({});
  EXPECT_FALSE(receiveAsset(bytes).has_value());
}

TEST(Transfer, TellsZeroFromNothing) {
  const std::string bytes =
      bake::bytesOf(std::optional<std::uint32_t>{0}, std::optional<std::uint32_t>{});
  bake::TransferReader reader(std::as_bytes(std::span(bytes)));
  std::optional<std::uint32_t> zero;
  std::optional<std::uint32_t> nothing = 7;
  reader(zero, nothing);
  EXPECT_TRUE(reader.good() && reader.atEnd());
  EXPECT_EQ(zero, 0U);
  EXPECT_EQ(nothing, std::nullopt);
}

TEST(AssetTransfer, SurvivesAnyLengthField) {
  const std::vector<std::byte> bytes = exampleTransfer();
  const std::uint64_t huge = ~std::uint64_t{0} / 3;
  int refused = 0;
  for (std::size_t at = 0; at + sizeof(huge) <= bytes.size(); ++at) {
    std::vector<std::byte> changed = bytes;
    std::memcpy(changed.data() + at, &huge, sizeof(huge));
    refused += receiveAsset(changed) ? 0 : 1;
  }
  EXPECT_GE(refused, static_cast<int>(bytes.size() / 10)) << "no length field was hit";
  EXPECT_LE(refused, static_cast<int>(bytes.size() * 9 / 10)) << "no plain value was hit";
}

}  // namespace
}  // namespace galactic::test::asset_transfer_test
