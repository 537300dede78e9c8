#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "galactic/error.h"
#include "pictures/image.h"

namespace galactic::pictures {

/// Sixteen bits per pixel, row by row from the top left corner: numbers, not something to look at.
struct DeepImage {
  int width = 0;
  int height = 0;
  std::vector<std::uint16_t> pixels;
};

/// Pixels with alpha, RGBA with R lowest, row by row from the top left corner: a view.
struct AlphaImage {
  int width = 0;
  int height = 0;
  std::span<const std::uint32_t> pixels;
};

/// The bytes of a PNG file, 8-bit sRGB; without alpha where all of it is 255. The same image gives
/// the same bytes. Fails with kInternal when libpng refuses the image.
[[nodiscard]] Result<std::string> encodePng(const AlphaImage& image);

/// The same of an image without alpha.
[[nodiscard]] Result<std::string> encodePng(const Image& image);

/// Writes an image as a PNG file, 8-bit sRGB, replacing an existing file in one go. The same image
/// gives the same bytes. Fails with kIo when the file cannot be written, and kInternal when libpng
/// refuses the image.
[[nodiscard]] Result<void> writePng(const std::filesystem::path& path, const Image& image);

/// The same as a gray PNG of 16 bits, which holds the numbers as they are.
[[nodiscard]] Result<void> writePng(const std::filesystem::path& path, const DeepImage& image);

}  // namespace galactic::pictures
