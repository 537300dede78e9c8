#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <tl/expected.hpp>

#include "textures/image.h"

namespace galactic::bake {

/// An image, or what is wrong with its file: the end of a sentence that begins "the image".
using DecodedImage = tl::expected<Image, std::string>;

/// Decodes PNG (all kinds; 16 bits are rounded to 8; color space chunks are ignored, as glTF
/// demands) and JPEG (gray, YCbCr and RGB, baseline and progressive), told apart by their first
/// bytes. Runs in this process, so it trusts its libraries: see isolated_bake.h. Strict: a file
/// that is cut off or damaged is refused, unless the damage leaves the image alone.
[[nodiscard]] DecodedImage decodeImage(std::span<const std::byte> file);

}  // namespace galactic::bake
