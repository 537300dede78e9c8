#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <utility>

#include "textures/image_decoder.h"

namespace galactic::bake {

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
