// What becomes of drawn images: colors, depth and ids as pictures and as numbers.
#include "drawing/frame_images.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace galactic::frame_images_test {
namespace {

using pictures::Image;
using pictures::Rgb;
using testing::ElementsAre;

TEST(FrameImages, ColorsAreTakenAsTheyAre) {
  const std::vector<std::uint8_t> transparent{10, 20, 30, 255, 40, 50, 60, 255};
  const Image rgba = colorPicture({2, 1, ColorFormat::kRgba8, transparent, {}, {}});
  EXPECT_EQ(rgba.width(), 2);
  EXPECT_EQ(rgba.height(), 1);
  EXPECT_EQ(rgba.at(0, 0), (Rgb{10, 20, 30}));
  EXPECT_EQ(rgba.at(1, 0), (Rgb{40, 50, 60}));
  const std::vector<std::uint8_t> packed{1, 2, 3, 4, 5, 6};
  const Image rgb = colorPicture({2, 1, ColorFormat::kRgb8, packed, {}, {}});
  EXPECT_EQ(rgb.at(1, 0), (Rgb{4, 5, 6}));
}

TEST(FrameImages, DepthIsBrightWhereItIsNearAndBlackWhereNothingIs) {
  std::vector<float> depth{1e-6F, kHalfBright, 6, 0};
  const Image picture = depthPicture({4, 1, ColorFormat::kNone, {}, depth, {}});
  EXPECT_EQ(picture.at(0, 0), (Rgb{255, 255, 255}));
  EXPECT_EQ(picture.at(1, 0), (Rgb{128, 128, 128}));
  EXPECT_EQ(picture.at(2, 0), (Rgb{64, 64, 64}));
  EXPECT_EQ(picture.at(3, 0), (Rgb{}));
}

TEST(FrameImages, DepthNumbersAreMillimeters) {
  const std::vector<float> depth{0, 0.0004F, 0.0006F, 1.2345F, 65.534F, 65.5351F, 1e9F};
  const auto numbers = depthNumbers({7, 1, ColorFormat::kNone, {}, depth, {}});
  EXPECT_THAT(numbers.pixels, ElementsAre(0, 0, 1, 1235, 65534, 65535, 65535));
}

TEST(FrameImages, IdsHaveNumbersAndColorsOfTheirOwn) {
  const std::vector<std::uint32_t> ids{0, 1, 2, 70000};
  const DrawnImage image{4, 1, ColorFormat::kNone, {}, {}, ids};
  EXPECT_THAT(semanticNumbers(image).pixels, ElementsAre(0, 1, 2, 65535));
  const Image picture = semanticPicture(image);
  EXPECT_EQ(picture.at(0, 0), (Rgb{}));
  EXPECT_FALSE(picture.at(1, 0) == picture.at(2, 0));
  EXPECT_GE(picture.at(1, 0).r, 64);
}

}  // namespace
}  // namespace galactic::frame_images_test
