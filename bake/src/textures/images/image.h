#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <tl/expected.hpp>
#include <utility>
#include <vector>

namespace galactic::bake {

/// Limits of a source image: edge in texels, and texels in all. Scans of rooms come with 8192 x
/// 8192.
inline constexpr std::uint32_t kLargestImageEdge = 16384;
inline constexpr std::uint64_t kMostImageTexels = std::uint64_t{1} << 26U;

/// A decoded image: rows from top to bottom, four bytes a texel: R, G, B (sRGB), straight alpha.
struct Image {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<std::uint8_t> rgba;
};

/// An image, or what is wrong with its file: the end of a sentence that begins "the image".
using DecodedImage = tl::expected<Image, std::string>;

/// Decodes PNG (all kinds; 16 bits are rounded to 8; color space chunks are ignored, as glTF
/// demands) and JPEG (gray, YCbCr and RGB, baseline and progressive), told apart by their first
/// bytes. Runs in this process, so it trusts its libraries: see isolated_bake.h. Strict: a file
/// that is cut off or damaged is refused, unless the damage leaves the image alone.
[[nodiscard]] DecodedImage decodeImage(std::span<const std::byte> file);

/// The end of a sentence that begins "the image".
[[nodiscard]] inline tl::unexpected<std::string> refused(std::string why) {
  return tl::unexpected<std::string>(std::move(why));
}

/// Decodes what starts like a PNG. In png_image.cpp, the only file that names libpng.
[[nodiscard]] DecodedImage decodePng(std::span<const std::byte> file);

/// Decodes what starts like a JPEG. In jpeg_image.cpp, the only file that names libjpeg.
[[nodiscard]] DecodedImage decodeJpeg(std::span<const std::byte> file);

/// Why an image of this size is refused; empty when it is not.
[[nodiscard]] std::string sizeFault(std::uint64_t width, std::uint64_t height);

}  // namespace galactic::bake
