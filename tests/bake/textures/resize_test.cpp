// Sizes, filters, mip levels and the layout of textures.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <random>

#include "texture_helpers.h"
#include "textures/images/linear_image.h"
#include "textures/images/transfer_function.h"

namespace galactic::test::resize_test {
namespace {

using bake::BakedMaterials;
using testing::ElementsAre;

constexpr std::array<std::uint8_t, 4> kBlack{0, 0, 0, 255};
constexpr std::array<std::uint8_t, 4> kWhite{255, 255, 255, 255};
/// Half the light of white.
constexpr int kMiddle = 188;

ImageContent checkerboard(unsigned size, unsigned field) {
  return rgbaImage(size, size, [&](unsigned x, unsigned y) {
    return (x / field + y / field) % 2 == 0 ? kWhite : kBlack;
  });
}

TEST(TransferFunction, IsItsDefinitionAndUndoesItself) {
  const bake::TransferFunction transfer;
  for (int byte = 0; byte < 256; ++byte) {
    const auto b = static_cast<std::uint8_t>(byte);
    EXPECT_NEAR(static_cast<double>(transfer.linear(b)), srgbToLinear(byte), 1e-7);
    EXPECT_EQ(transfer.encoded(transfer.linear(b)), b);
  }
  // Fine steps: every value goes to the nearest byte.
  constexpr int kSteps = 100'000;
  for (int step = 0; step <= kSteps; ++step) {
    const double linear = static_cast<double>(step) / kSteps;
    constexpr double kHalf = 0.5 + 1e-4;
    ASSERT_NEAR(transfer.encoded(static_cast<float>(linear)), linearToSrgb(linear), kHalf);
  }
  EXPECT_EQ(transfer.encoded(-1), 0);
  EXPECT_EQ(transfer.encoded(2), 255);
  EXPECT_EQ(transfer.encoded(std::nanf("")), 0);
}

TEST(TextureSize, IsTheNextPowerOfTwoUpToTheLargest) {
  struct Case {
    unsigned width, height, largest, size;
  };
  for (const Case& c : {Case{1, 2, 512, 2}, Case{3, 3, 512, 4}, Case{64, 64, 512, 64},
                        Case{100, 7, 512, 128}, Case{256, 256, 512, 256}, Case{257, 10, 512, 512},
                        Case{512, 512, 512, 512}, Case{700, 900, 512, 512},
                        Case{700, 900, 256, 256}, Case{700, 900, 1024, 1024}, Case{40, 40, 1, 1}}) {
    const BakedMaterials baked =
        bakeImage(pngFile(busyImage(c.width, c.height)), {.largest = c.largest});
    ASSERT_EQ(baked.textures.size(), 1U);
    EXPECT_EQ(baked.textures[0].size, c.size) << c.width << " x " << c.height;
    EXPECT_EQ(baked.texels.size(), textureBytes(c.size, TexelFormat::kRgba8));
  }
}

TEST(TextureSize, RefusesALargestThatIsNoPowerOfTwo) {
  for (const std::uint32_t largest : {0U, 3U, 300U, 8192U}) {
    const auto baked = bake::bakeMaterials({}, {}, {.largest = largest});
    ASSERT_FALSE(baked.has_value());
    EXPECT_EQ(baked.error().code, ErrorCode::kInvalidInput);
    EXPECT_EQ(baked.error().message,
              fmt::format("the texture size {} is not allowed; give a power of two from 1 to 4096",
                          largest));
  }
}

TEST(MipChain, KeepsAnImageOfThatSizeExactly) {
  const ImageContent image = busyImage(64, 64);
  const BakedMaterials baked = bakeImage(pngFile(image));
  ASSERT_GE(baked.texels.size(), image.bytes.size());
  EXPECT_TRUE(std::equal(image.bytes.begin(), image.bytes.end(), baked.texels.begin()));
}

TEST(MipChain, HalvesACheckerboardExactlyUntilItIsGrayInLinearLight) {
  const BakedMaterials baked = bakeImage(pngFile(checkerboard(16, 4)));
  ASSERT_EQ(baked.textures[0].size, 16U);
  // Fields of 4 stay sharp for two levels.
  for (const auto& [level, field] : {std::pair{0U, 4U}, {1U, 2U}, {2U, 1U}}) {
    for (unsigned y = 0; y < 4 * field; ++y) {
      for (unsigned x = 0; x < 4 * field; ++x) {
        const int wanted = (x / field + y / field) % 2 == 0 ? 255 : 0;
        ASSERT_THAT(texelAt(baked, 0, level, {x, y}), ElementsAre(wanted, wanted, wanted, 255));
      }
    }
  }
  for (const unsigned level : {3U, 4U}) {
    EXPECT_THAT(texelAt(baked, 0, level, {0, 0}), ElementsAre(kMiddle, kMiddle, kMiddle, 255));
  }
  EXPECT_EQ(baked.materials[0].color, 0xFFBCBCBCU);
}

TEST(Resampling, AveragesAreasInLinearLight) {
  // 6 x 6 to 4 x 4 (the largest allowed): a texel covers 1.5 x 1.5 of the source.
  const ImageContent image = busyImage(6, 6);
  const BakedMaterials baked = bakeImage(pngFile(image), {.largest = 4});
  const auto overlap = [](unsigned result, unsigned source) {
    return std::max(0.0, std::min(1.5 * (result + 1), source + 1.0) -
                             std::max(1.5 * result, static_cast<double>(source)));
  };
  for (unsigned y = 0; y < 4; ++y) {
    for (unsigned x = 0; x < 4; ++x) {
      for (std::size_t channel = 0; channel < 3; ++channel) {
        double sum = 0;
        for (unsigned v = 0; v < 6; ++v) {
          for (unsigned u = 0; u < 6; ++u) {
            sum += overlap(x, u) * overlap(y, v) *
                   srgbToLinear(image.bytes[4 * (std::size_t{v} * 6 + u) + channel]);
          }
        }
        constexpr double kRounding = 0.501;
        EXPECT_NEAR(texelAt(baked, 0, 0, {x, y})[channel], linearToSrgb(sum / 2.25), kRounding);
      }
    }
  }
}

TEST(Resampling, EnlargesLinearlyBetweenCenters) {
  const ImageContent image =
      rgbaImage(3, 1, [](unsigned x, unsigned) { return x == 0 ? kBlack : kWhite; });
  const BakedMaterials baked = bakeImage(pngFile(image));
  ASSERT_EQ(baked.textures[0].size, 4U);
  // Centers of 4 texels at 0.375, 1.125, 1.875, 2.625 of 3: shares of white 0, 0.625, 1, 1.
  const int mixed = static_cast<int>(std::lround(linearToSrgb(0.625)));
  for (unsigned y = 0; y < 4; ++y) {
    EXPECT_EQ(texelAt(baked, 0, 0, {0, y})[0], 0);
    EXPECT_EQ(texelAt(baked, 0, 0, {1, y})[0], mixed);
    EXPECT_EQ(texelAt(baked, 0, 0, {2, y})[0], 255);
    EXPECT_EQ(texelAt(baked, 0, 0, {3, y})[0], 255);
  }
}

TEST(Resampling, KeepsTheMeanOfAnyImageInLinearLight) {
  constexpr std::uint32_t kSeed = 20240611;
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  const auto up_to = [&](std::uint32_t most) {
    return 1 + static_cast<std::uint32_t>(random() % most);
  };
  const bake::TransferFunction transfer;
  for (int round = 0; round < 20; ++round) {
    bake::Image image{.width = up_to(90), .height = up_to(90), .rgba = {}};
    image.rgba.resize(std::size_t{image.width} * image.height * 4);
    for (std::uint8_t& byte : image.rgba) byte = static_cast<std::uint8_t>(random());
    const std::uint32_t size = 1U << (random() % 5);
    if (size > std::min(image.width, image.height)) continue;
    const auto kept = bake::AlphaUse::kKept;
    const bake::LinearImage small = bake::resampled(image, size, kept, transfer);
    double wanted = 0;
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
      wanted += srgbToLinear(image.rgba[i]) * image.rgba[i + 3] / 255;
    }
    double sum = 0;
    for (const bake::LinearTexel& texel : small.texels) sum += static_cast<double>(texel[0]);
    const auto texels = static_cast<double>(image.rgba.size() / 4);
    constexpr double kFloatRounding = 1e-5;
    EXPECT_NEAR(sum / (size * size), wanted / texels, kFloatRounding);
  }
}

TEST(TextureLayout, BeginsEachTextureAtAMultipleOf32) {
  const BakedMaterials baked =
      bakeEmbedded({textured("*0"), textured("*1"), textured("*2")},
                   {embedded(pngFile(busyImage(1, 2))), embedded(pngFile(busyImage(4, 4))),
                    embedded(pngFile(busyImage(2, 2)))});
  ASSERT_EQ(baked.textures.size(), 3U);
  // 2 x 2 + 1 texels are 20 bytes, 4 x 4 + 2 x 2 + 1 are 84.
  EXPECT_EQ(baked.textures[0].first_byte, 0U);
  EXPECT_EQ(baked.textures[1].first_byte, 32U);
  EXPECT_EQ(baked.textures[2].first_byte, 128U);
  EXPECT_EQ(baked.texels.size(), 148U);
  EXPECT_THAT(texelAt(baked, 1, 0, {1, 0}), ElementsAre(7, 0, 200, 255));
  for (std::size_t i = 20; i < 32; ++i) EXPECT_EQ(baked.texels[i], 0) << i;
}

}  // namespace
}  // namespace galactic::test::resize_test
