#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <tl/expected.hpp>
#include <utility>
#include <vector>

namespace galactic::bake {

/// Limits for a source image: edge in texels, and total number of texels. Scans of rooms have up to
/// 8192 x 8192.
inline constexpr std::uint32_t kLargestImageEdge = 16384;
inline constexpr std::uint64_t kMostImageTexels = std::uint64_t{1} << 26U;

/// A decoded image: rows from top to bottom, with four bytes per texel: R, G, B (sRGB) and straight
/// alpha.
struct Image {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<std::uint8_t> rgba;
};

/// An image, or the fault of its file, as the end of a sentence that begins with "the image".
using DecodedImage = tl::expected<Image, std::string>;

/// Decodes PNG (all kinds; 16 bits are rounded to 8; color space chunks are ignored, as glTF
/// demands) and JPEG (gray, YCbCr and RGB, baseline and progressive), which it distinguishes by
/// their first bytes. Runs in this process, so it trusts its libraries; see isolated_bake.h.
/// Strict: refuses a truncated or damaged file, unless the damage does not affect the image.
[[nodiscard]] DecodedImage decodeImage(std::span<const std::byte> file);

/// The error for a refused image. `why`: the end of a sentence that begins with "the image".
[[nodiscard]] inline tl::unexpected<std::string> refused(std::string why) {
  return tl::unexpected<std::string>(std::move(why));
}

/// Decodes a file that begins like a PNG. In png_image.cpp, the only file that names libpng.
[[nodiscard]] DecodedImage decodePng(std::span<const std::byte> file);

/// Decodes a file that begins like a JPEG. In jpeg_image.cpp, the only file that names libjpeg.
[[nodiscard]] DecodedImage decodeJpeg(std::span<const std::byte> file);

/// Why an image of this size is refused; empty if it is not.
[[nodiscard]] std::string sizeFault(std::uint64_t width, std::uint64_t height);

}  // namespace galactic::bake
