#include "pictures/png_file.h"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "support/files/atomic_file.h"

namespace galactic::pictures {
namespace {

/// An image as libpng wants it.
struct RawImage {
  int width = 0;
  int height = 0;
  png_uint_32 format = PNG_FORMAT_RGB;
  const void* pixels = nullptr;
};

Result<std::string> encode(const RawImage& image) {
  png_image png;
  std::memset(&png, 0, sizeof png);
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.width);
  png.height = static_cast<png_uint_32>(image.height);
  png.format = image.format;

  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
  std::string bytes(size, '\0');
  constexpr int kKeepBits = 0;
  constexpr png_int_32 kPackedRows = 0;
  if (png_image_write_to_memory(&png, bytes.data(), &size, kKeepBits, image.pixels, kPackedRows,
                                nullptr) == 0) {
    return fail(ErrorCode::kInternal, "",
                fmt::format("libpng cannot encode an image of {} x {} pixels: {}", image.width,
                            image.height, png.message));
  }
  bytes.resize(size);
  return bytes;
}

Result<void> write(const std::filesystem::path& path, const RawImage& image) {
  auto bytes = encode(image);
  if (!bytes) {
    bytes.error().where = path.string();
    return tl::unexpected(bytes.error());
  }
  return writeFileAtomically(path, {std::as_bytes(std::span(*bytes))});
}

}  // namespace

Result<std::string> encodePng(const AlphaImage& image) {
  static_assert(std::endian::native == std::endian::little, "libpng reads R first");
  constexpr std::uint32_t kOpaque = 255;
  const bool opaque = std::ranges::all_of(
      image.pixels, [](std::uint32_t pixel) { return pixel >> 24U == kOpaque; });
  if (!opaque) return encode({image.width, image.height, PNG_FORMAT_RGBA, image.pixels.data()});
  std::vector<Rgb> pixels;
  pixels.reserve(image.pixels.size());
  for (const std::uint32_t pixel : image.pixels) {
    pixels.push_back({static_cast<std::uint8_t>(pixel), static_cast<std::uint8_t>(pixel >> 8U),
                      static_cast<std::uint8_t>(pixel >> 16U)});
  }
  return encode({image.width, image.height, PNG_FORMAT_RGB, pixels.data()});
}

Result<std::string> encodePng(const Image& image) {
  return encode({image.width(), image.height(), PNG_FORMAT_RGB, image.pixels().data()});
}

Result<void> writePng(const std::filesystem::path& path, const Image& image) {
  static_assert(sizeof(Rgb) == 3, "libpng reads three bytes per pixel");
  return write(path, {image.width(), image.height(), PNG_FORMAT_RGB, image.pixels().data()});
}

Result<void> writePng(const std::filesystem::path& path, const DeepImage& image) {
  return write(path, {image.width, image.height, PNG_FORMAT_LINEAR_Y, image.pixels.data()});
}

}  // namespace galactic::pictures
