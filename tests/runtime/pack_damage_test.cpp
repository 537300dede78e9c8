// Damaged packs: each truncation, each extra byte and each flipped bit.
#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <vector>

#include "galactic/pack.h"
#include "galactic/scene.h"
#include "support/scene_pack_builder.h"

namespace galactic::test {
namespace {

constexpr std::size_t kBitsPerByte = 8;

void flip(AlignedBytes& bytes, std::size_t bit) {
  bytes.bytes()[bit / kBitsPerByte] ^= std::byte{1} << (bit % kBitsPerByte);
}

TEST(DamagedPack, IsRefusedAtEachLengthOfATruncation) {
  const AlignedBytes whole = buildPack(smallScene());
  for (std::size_t length = 0; length < whole.size(); ++length) {
    const AlignedBytes part(whole.bytes().first(length));
    for (const Trust trust : {Trust::kVerify, Trust::kTrusted}) {
      const Result<PackFile> pack = PackFile::view(part.bytes(), "short.pack", trust);
      ASSERT_FALSE(pack.has_value()) << length;
      ASSERT_EQ(pack.error().code, ErrorCode::kInvalidInput) << length;
      ASSERT_EQ(pack.error().where, "short.pack") << length;
    }
  }
}

TEST(DamagedPack, IsRefusedWithBytesTooMany) {
  const AlignedBytes whole = buildPack(smallScene());
  for (std::size_t extra = 1; extra <= 64; ++extra) {
    std::vector<std::byte> longer(whole.bytes().begin(), whole.bytes().end());
    longer.resize(longer.size() + extra);
    const AlignedBytes bytes(longer);
    EXPECT_FALSE(PackFile::view(bytes.bytes(), "long.pack").has_value()) << extra;
  }
}

TEST(DamagedPack, IsRefusedAfterEachFlipOfASingleBit) {
  AlignedBytes bytes = buildPack(smallScene());
  for (std::size_t bit = 0; bit < bytes.size() * kBitsPerByte; ++bit) {
    flip(bytes, bit);
    const Result<PackFile> pack = PackFile::view(bytes.bytes(), "flipped.pack");
    ASSERT_FALSE(pack.has_value()) << bit;
    ASSERT_FALSE(pack.error().message.empty());
    flip(bytes, bit);
  }
  EXPECT_TRUE(PackFile::view(bytes.bytes(), "whole.pack").has_value());
}

/// Asks the scene about every cell and beyond; a sanitizer sees a read outside the pack.
void queryEverywhere(const PackFile& pack) {
  const Result<Scene> scene = Scene::from(pack);
  ASSERT_TRUE(scene.has_value());
  for (const ColumnGrid& grid : scene->grids()) {
    const ColumnGridLayout& layout = grid.layout();
    std::vector<float> x, y, z;
    const auto add = [&](float at_x, float at_y, float at_z) {
      x.push_back(at_x);
      y.push_back(at_y);
      z.push_back(at_z);
    };
    for (int k = -1; k <= 4; ++k) {
      for (int i = -1; i <= 6; ++i) {
        for (const float part : {0.0F, 0.1F, 0.45F, 0.8F, 1.0F}) {
          add(layout.min_x + (static_cast<float>(i) + 0.5F) * layout.spacing,
              layout.heights.lo + part * (layout.heights.hi - layout.heights.lo),
              layout.min_z + (static_cast<float>(k) + 0.5F) * layout.spacing);
        }
      }
    }
    for (const float extreme :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
          std::numeric_limits<float>::lowest()}) {
      add(extreme, layout.heights.lo, layout.min_z);
      add(layout.min_x, extreme, layout.min_z);
      add(layout.min_x, layout.heights.lo, extreme);
    }
    std::vector<Clearance> clearance(x.size());
    std::vector<float> down(x.size());
    std::vector<float> up(x.size());
    grid.contact({x, y, z}, {clearance, down, up});
    for (std::size_t n = 0; n < x.size(); ++n) {
      const Contact contact = grid.contact({x[n], y[n], z[n]});
      ASSERT_EQ(contact.clearance, clearance[n]);
      ASSERT_EQ(contact.down, down[n]);
      ASSERT_EQ(contact.up, up[n]);
      ASSERT_GE(contact.down, 0);
      ASSERT_GE(contact.up, 0);
    }
  }
}

TEST(DamagedPack, WithARecomputedHashIsRefusedOrSafeToQueryAfterEachFlip) {
  AlignedBytes bytes = buildPack(smallScene());
  const auto payload = bytes.bytes().subspan(sizeof(PackHeader));
  std::size_t refused = 0;
  const std::size_t bits = payload.size() * kBitsPerByte;
  for (std::size_t bit = 0; bit < bits; ++bit) {
    const std::size_t in_file = sizeof(PackHeader) * kBitsPerByte + bit;
    flip(bytes, in_file);
    const PackHeader header = makePackHeader(PackKind::kScene, payload);
    std::memcpy(bytes.bytes().data(), &header, sizeof(header));
    const Result<PackFile> pack = PackFile::view(bytes.bytes(), "flipped.pack");
    if (pack) {
      queryEverywhere(*pack);
      if (testing::Test::HasFatalFailure()) FAIL() << "after flipping bit " << bit;
    } else {
      ++refused;
      ASSERT_NE(pack.error().message, "");
    }
    flip(bytes, in_file);
  }
  // Both happen: codes may change and stay well-formed, offsets may not.
  EXPECT_GT(refused, bits / 10);
  EXPECT_LT(refused, bits * 9 / 10);
}

}  // namespace
}  // namespace galactic::test
