// The only file of the bake side that names libpng.
#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstring>

#include "textures/images/image.h"

namespace galactic::bake {
namespace {

/// The state that libpng's callbacks use. Plain data, because libpng reports errors with a long
/// jump.
struct PngInput {
  const std::byte* at = nullptr;
  std::size_t left = 0;
  std::array<char, 128> message{};
};

struct PngHandles {
  png_structp png = nullptr;
  png_infop info = nullptr;

  PngHandles() = default;
  ~PngHandles() { png_destroy_read_struct(&png, &info, nullptr); }
  PngHandles(const PngHandles&) = delete;
  PngHandles& operator=(const PngHandles&) = delete;
  PngHandles(PngHandles&&) = delete;
  PngHandles& operator=(PngHandles&&) = delete;
};

void readBytes(png_structp png, png_bytep to, std::size_t bytes) {
  auto& input = *static_cast<PngInput*>(png_get_io_ptr(png));
  if (bytes > input.left) png_error(png, "it ends too early");
  std::memcpy(to, input.at, bytes);
  input.at += bytes;
  input.left -= bytes;
}

[[noreturn]] void onError(png_structp png, png_const_charp message) {
  auto& input = *static_cast<PngInput*>(png_get_error_ptr(png));
  const std::size_t length = std::min(std::strlen(message), input.message.size() - 1);
  std::memcpy(input.message.data(), message, length);
  input.message[length] = '\0';
  png_longjmp(png, 1);
}

void onWarning(png_structp, png_const_charp) {}

/// Reads up to the first texel. This and the next two functions have no objects with destructors,
/// because errors jump out of them.
bool readHeader(const PngHandles& handles, PngInput& input) {
  png_structp png = handles.png;
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_read_fn(png, &input, readBytes);
  // Fail on damaged chunks, because one may hold the transparency.
  png_set_crc_action(png, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
  // Disable libpng's limits, because sizeFault checks sizes and gives a better message.
  png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
  png_read_info(png, handles.info);
  return true;
}

/// Requests four bytes per texel. Allocates rows, so the size must have been checked.
bool prepareRows(const PngHandles& handles) {
  png_structp png = handles.png;
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_expand(png);
  png_set_scale_16(png);
  png_set_gray_to_rgb(png);
  constexpr png_uint_32 kOpaque = 0xFF;
  png_set_add_alpha(png, kOpaque, PNG_FILLER_AFTER);
  png_set_interlace_handling(png);
  png_read_update_info(png, handles.info);
  return true;
}

bool readRows(const PngHandles& handles, png_bytepp rows) {
  if (setjmp(png_jmpbuf(handles.png)) != 0) return false;
  png_read_image(handles.png, rows);
  return true;
}

tl::unexpected<std::string> broken(const PngInput& input) {
  return refused(fmt::format("is a broken PNG ({})", input.message.data()));
}

}  // namespace

DecodedImage decodePng(std::span<const std::byte> file) {
  PngInput input{.at = file.data(), .left = file.size()};
  PngHandles handles;
  handles.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &input, onError, onWarning);
  if (handles.png != nullptr) handles.info = png_create_info_struct(handles.png);
  if (handles.info == nullptr) return refused("could not be decoded: no memory");
  if (!readHeader(handles, input)) return broken(input);

  Image image{.width = png_get_image_width(handles.png, handles.info),
              .height = png_get_image_height(handles.png, handles.info),
              .rgba = {}};
  if (std::string fault = sizeFault(image.width, image.height); !fault.empty()) {
    return refused(std::move(fault));
  }
  if (!prepareRows(handles)) return broken(input);
  const std::size_t row_bytes = std::size_t{image.width} * 4;
  if (png_get_rowbytes(handles.png, handles.info) != row_bytes) {
    return refused("is a PNG of an unknown kind");
  }
  image.rgba.resize(row_bytes * image.height);
  std::vector<png_bytep> rows(image.height);
  for (std::size_t y = 0; y < rows.size(); ++y) rows[y] = image.rgba.data() + y * row_bytes;
  if (!readRows(handles, rows.data())) return broken(input);
  return image;
}

}  // namespace galactic::bake
