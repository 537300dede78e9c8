#pragma once
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>
// jpeglib.h needs <cstdio> before it.
#include <jpeglib.h>
#include <png.h>

namespace galactic::test {

/// Texels to be written as an image file: rows from the top, channels as the file shall have them,
/// one byte each (two, big-endian, for 16-bit PNG).
struct ImageContent {
  unsigned width = 0;
  unsigned height = 0;
  std::vector<std::uint8_t> bytes;
};

/// What varies between the PNG files of the tests.
struct PngKind {
  int color_type = PNG_COLOR_TYPE_RGBA;
  int bit_depth = 8;
  bool interlaced = false;
  /// For PNG_COLOR_TYPE_PALETTE; alpha is 255 beyond the end of `palette_alpha`.
  std::vector<png_color> palette{};
  std::vector<std::uint8_t> palette_alpha{};
  /// A gAMA chunk, where positive.
  double gamma = 0;
};

/// The bytes of a PNG file. Rows of `image` are packed as the kind says (bit depths under 8 too).
inline std::string pngFile(const ImageContent& image, const PngKind& kind = {}) {
  std::string file;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(
      png, &file,
      [](png_structp writer, png_bytep data, std::size_t size) {
        static_cast<std::string*>(png_get_io_ptr(writer))
            ->append(reinterpret_cast<const char*>(data), size);
      },
      [](png_structp) {});
  png_set_IHDR(png, info, image.width, image.height, kind.bit_depth, kind.color_type,
               kind.interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  if (!kind.palette.empty()) {
    png_set_PLTE(png, info, kind.palette.data(), static_cast<int>(kind.palette.size()));
  }
  if (!kind.palette_alpha.empty()) {
    png_set_tRNS(png, info, kind.palette_alpha.data(), static_cast<int>(kind.palette_alpha.size()),
                 nullptr);
  }
  if (kind.gamma > 0) png_set_gAMA(png, info, kind.gamma);
  const std::size_t row_bytes = image.bytes.size() / image.height;
  std::vector<std::uint8_t> bytes = image.bytes;
  std::vector<png_bytep> rows;
  for (unsigned y = 0; y < image.height; ++y) rows.push_back(bytes.data() + y * row_bytes);
  png_set_rows(png, info, rows.data());
  png_write_png(png, info, PNG_TRANSFORM_IDENTITY, nullptr);
  png_destroy_write_struct(&png, &info);
  return file;
}

/// What varies between the JPEG files of the tests.
struct JpegKind {
  J_COLOR_SPACE color_space = JCS_RGB;
  int quality = 100;
  bool progressive = false;
};

/// The bytes of a JPEG file, colors not subsampled.
inline std::string jpegFile(const ImageContent& image, const JpegKind& kind = {}) {
  jpeg_compress_struct encoder{};
  jpeg_error_mgr errors{};
  encoder.err = jpeg_std_error(&errors);
  jpeg_create_compress(&encoder);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&encoder, &bytes, &size);
  encoder.image_width = image.width;
  encoder.image_height = image.height;
  encoder.in_color_space = kind.color_space;
  encoder.input_components = static_cast<int>(image.bytes.size() / image.width / image.height);
  jpeg_set_defaults(&encoder);
  jpeg_set_quality(&encoder, kind.quality, TRUE);
  for (int i = 0; i < encoder.num_components; ++i) {
    encoder.comp_info[i].h_samp_factor = 1;
    encoder.comp_info[i].v_samp_factor = 1;
  }
  if (kind.progressive) jpeg_simple_progression(&encoder);
  jpeg_start_compress(&encoder, TRUE);
  const std::size_t row_bytes = image.bytes.size() / image.height;
  std::vector<std::uint8_t> copy = image.bytes;
  while (encoder.next_scanline < encoder.image_height) {
    JSAMPROW row = copy.data() + encoder.next_scanline * row_bytes;
    jpeg_write_scanlines(&encoder, &row, 1);
  }
  jpeg_finish_compress(&encoder);
  jpeg_destroy_compress(&encoder);
  std::string file(reinterpret_cast<const char*>(bytes), size);
  std::free(bytes);
  return file;
}

}  // namespace galactic::test
