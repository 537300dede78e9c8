// The only file that names libjpeg.
#include <fmt/format.h>

#include <array>
#include <csetjmp>
#include <cstdio>
// These two need <cstdio> before them.
#include <jerror.h>
#include <jpeglib.h>

#include "textures/images/image.h"

namespace galactic::bake {
namespace {

/// libjpeg's error handler and its message. The library's part comes first, so that a pointer to it
/// is also a pointer to the whole. Plain data, because errors jump.
struct JpegErrors {
  jpeg_error_mgr manager;
  std::jmp_buf jump;
  std::array<char, JMSG_LENGTH_MAX> message;
};

struct JpegReader {
  jpeg_decompress_struct decoder{};
  JpegErrors errors{};

  JpegReader() = default;
  ~JpegReader() { jpeg_destroy_decompress(&decoder); }
  JpegReader(const JpegReader&) = delete;
  JpegReader& operator=(const JpegReader&) = delete;
  JpegReader(JpegReader&&) = delete;
  JpegReader& operator=(JpegReader&&) = delete;
};

[[noreturn]] void onError(j_common_ptr decoder) {
  auto& errors = *reinterpret_cast<JpegErrors*>(decoder->err);
  decoder->err->format_message(decoder, errors.message.data());
  std::longjmp(errors.jump, 1);
}

/// The library reports damage as a warning and continues with gray.
void onMessage(j_common_ptr decoder, int level) {
  const int code = decoder->err->msg_code;
  const bool harmless = level >= 0 || code == JWRN_EXTRANEOUS_DATA || code == JWRN_ADOBE_XFORM ||
                        code == JWRN_JFIF_MAJOR;
  if (!harmless) onError(decoder);
}

void onOutput(j_common_ptr) {}

/// Reads up to the first texel. Has no objects with destructors, because errors jump out of it.
bool readHeader(JpegReader& reader, std::span<const std::byte> file) {
  reader.decoder.err = jpeg_std_error(&reader.errors.manager);
  reader.errors.manager.error_exit = onError;
  reader.errors.manager.emit_message = onMessage;
  reader.errors.manager.output_message = onOutput;
  if (setjmp(reader.errors.jump) != 0) return false;
  jpeg_create_decompress(&reader.decoder);
  jpeg_mem_src(&reader.decoder, reinterpret_cast<const unsigned char*>(file.data()), file.size());
  jpeg_read_header(&reader.decoder, TRUE);
  return true;
}

bool readRows(JpegReader& reader, std::uint8_t* rgb) {
  jpeg_decompress_struct& decoder = reader.decoder;
  if (setjmp(reader.errors.jump) != 0) return false;
  decoder.out_color_space = JCS_RGB;
  jpeg_start_decompress(&decoder);
  while (decoder.output_scanline < decoder.output_height) {
    JSAMPROW row = rgb + std::size_t{decoder.output_scanline} * decoder.output_width * 3;
    jpeg_read_scanlines(&decoder, &row, 1);
  }
  // Reads the rest, so that damage at the end is also noticed.
  jpeg_finish_decompress(&decoder);
  return true;
}

tl::unexpected<std::string> broken(const JpegReader& reader) {
  return refused(fmt::format("is a broken JPEG ({})", reader.errors.message.data()));
}

}  // namespace

DecodedImage decodeJpeg(std::span<const std::byte> file) {
  JpegReader reader;
  if (!readHeader(reader, file)) return broken(reader);
  Image image{
      .width = reader.decoder.image_width, .height = reader.decoder.image_height, .rgba = {}};
  if (std::string fault = sizeFault(image.width, image.height); !fault.empty()) {
    return refused(std::move(fault));
  }
  const J_COLOR_SPACE space = reader.decoder.jpeg_color_space;
  if (space == JCS_CMYK || space == JCS_YCCK) {
    return refused("is a JPEG for print (CMYK); expected RGB or gray");
  }
  const std::size_t texels = std::size_t{image.width} * image.height;
  std::vector<std::uint8_t> rgb(texels * 3);
  if (!readRows(reader, rgb.data())) return broken(reader);
  image.rgba.resize(texels * 4);
  for (std::size_t i = 0; i < texels; ++i) {
    for (std::size_t channel = 0; channel < 3; ++channel) {
      image.rgba[4 * i + channel] = rgb[3 * i + channel];
    }
    image.rgba[4 * i + 3] = 0xFF;
  }
  return image;
}

}  // namespace galactic::bake
