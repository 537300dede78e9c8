// Decoding of PNG and JPEG, and baking in a process of its own.
#include <gmock/gmock.h>

#include <random>

#include "support/image_files.h"
#include "texture_helpers.h"
#include "textures/images/image.h"
#include "textures/isolated_bake.h"

namespace galactic::test::image_decoder_test {
namespace {

using bake::DecodedImage;
using bake::decodeImage;
using testing::ElementsAre;
using testing::ElementsAreArray;
using testing::HasSubstr;
using testing::StartsWith;

DecodedImage decode(std::string_view file) { return decodeImage(std::as_bytes(std::span(file))); }

std::vector<std::uint8_t> decodedBytes(const std::string& file) {
  const DecodedImage image = decode(file);
  EXPECT_TRUE(image.has_value()) << image.error();
  return image ? image->rgba : std::vector<std::uint8_t>();
}

std::string faultOf(std::string_view file) {
  const DecodedImage image = decode(file);
  EXPECT_FALSE(image.has_value());
  return image ? std::string() : image.error();
}

constexpr PngKind kRgb{.color_type = PNG_COLOR_TYPE_RGB};

TEST(ImageDecoder, ReadsRgbaPngExactlyInterlacedOrNot) {
  const ImageContent image = rgbaImage(13, 9, [](unsigned x, unsigned y) {
    return std::array<std::uint8_t, 4>{
        static_cast<std::uint8_t>(x * 19), static_cast<std::uint8_t>(y * 28),
        static_cast<std::uint8_t>(x ^ y), static_cast<std::uint8_t>(255 - x * y)};
  });
  for (const bool interlaced : {false, true}) {
    const DecodedImage decoded = decode(pngFile(image, {.interlaced = interlaced}));
    ASSERT_TRUE(decoded.has_value()) << decoded.error();
    EXPECT_EQ(decoded->width, 13U);
    EXPECT_EQ(decoded->height, 9U);
    EXPECT_EQ(decoded->rgba, image.bytes);
  }
}

TEST(ImageDecoder, GivesPngWithoutAlphaFullAlpha) {
  EXPECT_THAT(decodedBytes(pngFile({2, 1, {1, 2, 3, 4, 5, 6}}, kRgb)),
              ElementsAre(1, 2, 3, 255, 4, 5, 6, 255));
}

TEST(ImageDecoder, ReadsGrayPngWithAndWithoutAlpha) {
  EXPECT_THAT(decodedBytes(pngFile({2, 1, {7, 200}}, {.color_type = PNG_COLOR_TYPE_GRAY})),
              ElementsAre(7, 7, 7, 255, 200, 200, 200, 255));
  EXPECT_THAT(decodedBytes(pngFile({1, 1, {9, 100}}, {.color_type = PNG_COLOR_TYPE_GRAY_ALPHA})),
              ElementsAre(9, 9, 9, 100));
}

TEST(ImageDecoder, ReadsGrayPngOfOneBitATexel) {
  const std::string file =
      pngFile({4, 1, {0b10100000}}, {.color_type = PNG_COLOR_TYPE_GRAY, .bit_depth = 1});
  EXPECT_THAT(decodedBytes(file),
              ElementsAre(255, 255, 255, 255, 0, 0, 0, 255, 255, 255, 255, 255, 0, 0, 0, 255));
}

TEST(ImageDecoder, ReadsPalettesWithTransparentEntries) {
  const PngKind kind{.color_type = PNG_COLOR_TYPE_PALETTE,
                     .palette = {{10, 20, 30}, {40, 50, 60}},
                     .palette_alpha = {128}};
  EXPECT_THAT(decodedBytes(pngFile({2, 1, {1, 0}}, kind)),
              ElementsAre(40, 50, 60, 255, 10, 20, 30, 128));
}

TEST(ImageDecoder, RoundsSixteenBitsToEight) {
  // 257 is one step of eight bits: 1.4 steps and 1.6 steps.
  const std::string file = pngFile({2, 1, {0x01, 0x68, 0x01, 0x9B}},
                                   {.color_type = PNG_COLOR_TYPE_GRAY, .bit_depth = 16});
  EXPECT_THAT(decodedBytes(file), ElementsAre(1, 1, 1, 255, 2, 2, 2, 255));
}

TEST(ImageDecoder, IgnoresGammaAsGltfDemands) {
  const PngKind kind{.color_type = PNG_COLOR_TYPE_GRAY, .gamma = 1.0};
  EXPECT_THAT(decodedBytes(pngFile({1, 1, {77}}, kind)), ElementsAre(77, 77, 77, 255));
}

/// What a JPEG of quality 100 without subsampling may be off: its transform rounds.
constexpr int kJpegError = 3;

TEST(ImageDecoder, ReadsJpegBaselineProgressiveAndGray) {
  const ImageContent smooth = rgbaImage(40, 24, [](unsigned x, unsigned y) {
    return std::array<std::uint8_t, 4>{static_cast<std::uint8_t>(x * 6),
                                       static_cast<std::uint8_t>(y * 10), 90, 255};
  });
  const ImageContent rgb = withoutAlpha(smooth);
  for (const bool progressive : {false, true}) {
    const auto decoded = decodedBytes(jpegFile(rgb, {.progressive = progressive}));
    ASSERT_EQ(decoded.size(), smooth.bytes.size());
    for (std::size_t i = 0; i < decoded.size(); ++i) {
      ASSERT_NEAR(decoded[i], smooth.bytes[i], kJpegError) << "byte " << i;
    }
  }
  const auto gray = decodedBytes(
      jpegFile({8, 8, std::vector<std::uint8_t>(64, 100)}, {.color_space = JCS_GRAYSCALE}));
  ASSERT_EQ(gray.size(), 256U);
  EXPECT_NEAR(gray[0], 100, 1);
  EXPECT_EQ(gray[0], gray[2]);
  EXPECT_EQ(gray[3], 255);
}

TEST(ImageDecoder, RefusesJpegForPrint) {
  const std::string file =
      jpegFile({8, 8, std::vector<std::uint8_t>(256, 9)}, {.color_space = JCS_CMYK});
  EXPECT_EQ(faultOf(file), "is a JPEG for print (CMYK); expected RGB or gray");
}

TEST(ImageDecoder, NamesOtherFormats) {
  using namespace std::string_view_literals;
  EXPECT_EQ(faultOf(""), "is empty");
  EXPECT_EQ(faultOf("\xABKTX 20\xBB\r\n\x1A\n...."sv), "is KTX2 (Basis); expected PNG or JPEG");
  EXPECT_EQ(faultOf("RIFF....WEBPVP8 "sv), "is WebP; expected PNG or JPEG");
  EXPECT_EQ(faultOf("DDS |..."sv), "is DDS; expected PNG or JPEG");
  EXPECT_EQ(faultOf("..TRUEVISION-XFILE.\0"sv), "is TGA; expected PNG or JPEG");
  EXPECT_EQ(faultOf("version https://git-lfs.github.com/spec/v1\n"sv),
            "is a pointer of Git LFS (fetch it with git lfs pull); expected PNG or JPEG");
  EXPECT_EQ(faultOf("picture"sv), "is of an unknown format; expected PNG or JPEG");
}

void putBigEndian(std::string& file, std::size_t at, std::uint32_t value) {
  for (std::size_t i = 0; i < 4; ++i) {
    file[at + i] = static_cast<char>(value >> (24 - 8 * static_cast<unsigned>(i)));
  }
}

/// CRC-32 of PNG, bit by bit.
std::uint32_t crc32(std::string_view bytes) {
  std::uint32_t crc = ~0U;
  for (const char c : bytes) {
    crc ^= static_cast<std::uint8_t>(c);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1U) ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0U);
  }
  return ~crc;
}

/// A PNG whose header states another size, with a sum that fits.
std::string pngOfDeclaredSize(std::uint32_t width, std::uint32_t height) {
  std::string file = pngFile({1, 1, {1, 2, 3, 4}});
  putBigEndian(file, 16, width);
  putBigEndian(file, 20, height);
  putBigEndian(file, 29, crc32(std::string_view(file).substr(12, 17)));
  return file;
}

TEST(ImageDecoder, RefusesHugeDeclaredSizesBeforeItAllocates) {
  EXPECT_EQ(
      faultOf(pngOfDeclaredSize(2'000'000'000, 2'000'000'000)),
      "has 2000000000 x 2000000000 texels; expected at most 16384 a side and 64 million in all");
  EXPECT_EQ(faultOf(pngOfDeclaredSize(16384, 16384)),
            "has 16384 x 16384 texels; expected at most 16384 a side and 64 million in all");
  EXPECT_THAT(faultOf(pngOfDeclaredSize(0, 5)), StartsWith("is a broken PNG (Invalid IHDR"));
  // Allowed, but the data is not there.
  EXPECT_THAT(faultOf(pngOfDeclaredSize(1024, 1024)), StartsWith("is a broken PNG ("));

  std::string jpeg = jpegFile({8, 8, std::vector<std::uint8_t>(192, 9)});
  const std::size_t frame = jpeg.find("\xFF\xC0");
  ASSERT_NE(frame, std::string::npos);
  for (const std::size_t at : {frame + 5, frame + 7}) {
    jpeg[at] = '\xFF';
    jpeg[at + 1] = '\xDC';
  }
  EXPECT_EQ(faultOf(jpeg),
            "has 65500 x 65500 texels; expected at most 16384 a side and 64 million in all");
}

TEST(ImageDecoder, FindsEveryTruncationOfAPngThatMatters) {
  const std::string file = pngFile(busyImage(11, 7));
  const auto whole = decodedBytes(file);
  std::size_t refused = 0;
  for (std::size_t length = 0; length < file.size(); ++length) {
    const DecodedImage cut = decode(std::string_view(file).substr(0, length));
    if (cut) {
      ASSERT_EQ(cut->rgba, whole) << length;
    } else {
      ++refused;
      ASSERT_FALSE(cut.error().empty());
    }
  }
  // The end chunk of 12 bytes holds nothing.
  EXPECT_GE(refused, file.size() - 16);
}

TEST(ImageDecoder, FindsEveryFlippedBitOfAPngThatMatters) {
  const PngKind kind{.color_type = PNG_COLOR_TYPE_PALETTE,
                     .palette = {{10, 20, 30}, {40, 50, 60}},
                     .palette_alpha = {128}};
  for (const std::string& file : {pngFile(busyImage(11, 7)), pngFile({2, 2, {1, 0, 0, 1}}, kind)}) {
    const auto whole = decodedBytes(file);
    std::size_t refused = 0;
    for (std::size_t bit = 0; bit < file.size() * 8; ++bit) {
      std::string flipped = file;
      flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << (bit % 8)));
      const DecodedImage decoded = decode(flipped);
      if (!decoded) {
        ++refused;
      } else {
        ASSERT_EQ(decoded->rgba, whole) << "bit " << bit;
      }
    }
    EXPECT_GE(refused, (file.size() - 16) * 8);
  }
}

TEST(ImageDecoder, SurvivesTruncatedAndFlippedJpeg) {
  for (const bool progressive : {false, true}) {
    const std::string file =
        jpegFile(withoutAlpha(busyImage(24, 17)), {.progressive = progressive});
    for (std::size_t length = 0; length + 2 < file.size(); ++length) {
      const DecodedImage cut = decode(std::string_view(file).substr(0, length));
      ASSERT_FALSE(cut.has_value()) << length << " of " << file.size();
    }
    std::size_t refused = 0;
    for (std::size_t bit = 0; bit < file.size() * 8; bit += 3) {
      std::string flipped = file;
      flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << (bit % 8)));
      const DecodedImage decoded = decode(flipped);
      if (!decoded) {
        ++refused;
      } else {
        ASSERT_EQ(decoded->rgba.size(), std::size_t{decoded->width} * decoded->height * 4);
      }
    }
    // A JPEG has no check sums, so many flips give another image; both must happen.
    EXPECT_GT(refused, file.size() / 10);
    EXPECT_LT(refused, file.size() * 8 / 3 * 9 / 10);
  }
}

TEST(IsolatedBake, GivesWhatTheSameWorkGivesInThisProcess) {
  const std::string file = pngFile(busyImage(31, 5));
  const bake::TransferFunction transfer;
  const bake::Look white;
  const bake::Look dark{.factor = {0.5F, 0.25F, 1, 1}};
  const std::array looks{white, dark};
  const auto isolated =
      bake::bakeIsolated(std::as_bytes(std::span(file)), looks, {.largest = 16}, transfer);
  ASSERT_TRUE(isolated.has_value()) << isolated.error();
  EXPECT_EQ(isolated->image_bytes, 4U * 31 * 5);
  ASSERT_EQ(isolated->appearances.size(), 2U);
  const DecodedImage image = decode(file);
  ASSERT_TRUE(image.has_value());
  for (std::size_t n = 0; n < 2; ++n) {
    const auto here = bake::texturedAppearance(*image, looks[n], {.largest = 16}, transfer);
    EXPECT_EQ(isolated->appearances[n].texels, here.texels);
    EXPECT_EQ(isolated->appearances[n].color, here.color);
    EXPECT_EQ(isolated->appearances[n].size, 16U);
  }
}

TEST(IsolatedBake, PassesTheDecodersMessageOn) {
  const std::string other = "GIF89a";
  const auto refused = bake::bakeIsolated(std::as_bytes(std::span(other)), {}, {}, {});
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error(), "is GIF; expected PNG or JPEG");
}

}  // namespace
}  // namespace galactic::test::image_decoder_test
