#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "common/lfs_pointer.h"
#include "textures/images/image.h"

namespace galactic::bake {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view kPngSignature = "\x89PNG\r\n\x1A\n";
constexpr std::string_view kJpegSignature = "\xFF\xD8\xFF";

struct Signature {
  std::string_view bytes;
  std::size_t offset;
  std::string_view name;
};

/// Other formats that occur in assets, for messages.
constexpr std::array kOtherFormats{
    Signature{"\xABKTX 20\xBB\r\n\x1A\n"sv, 0, "KTX2 (Basis)"},
    Signature{"\xABKTX 11\xBB\r\n\x1A\n"sv, 0, "KTX"},
    Signature{"sB"sv, 0, "Basis Universal"},
    Signature{"WEBP"sv, 8, "WebP"},
    Signature{"DDS "sv, 0, "DDS"},
    Signature{"BM"sv, 0, "BMP"},
    Signature{"GIF8"sv, 0, "GIF"},
    Signature{"II*\0"sv, 0, "TIFF"},
    Signature{"MM\0*"sv, 0, "TIFF"},
    Signature{"8BPS"sv, 0, "PSD"},
    Signature{"ftypavif"sv, 4, "AVIF"},
    Signature{"v/1\x01"sv, 0, "OpenEXR"},
    Signature{"#?RADIANCE"sv, 0, "Radiance HDR"},
    Signature{"TRUEVISION-XFILE.\0"sv, 0, "TGA"},
    Signature{kLfsSignature, 0, kLfsPointer},
};

bool hasAt(std::string_view file, std::size_t offset, std::string_view bytes) {
  return file.size() >= offset && file.substr(offset).starts_with(bytes);
}

std::string otherFormat(std::string_view file) {
  if (file.empty()) return "is empty";
  // A TGA file has its signature at the end.
  constexpr std::string_view kTgaEnd = "TRUEVISION-XFILE.\0"sv;
  if (file.ends_with(kTgaEnd)) return "is TGA; expected PNG or JPEG";
  for (const Signature& format : kOtherFormats) {
    if (hasAt(file, format.offset, format.bytes)) {
      return fmt::format("is {}; expected PNG or JPEG", format.name);
    }
  }
  return "is of an unknown format; expected PNG or JPEG";
}

}  // namespace

std::string sizeFault(std::uint64_t width, std::uint64_t height) {
  if (width == 0 || height == 0) return "is empty";
  if (width <= kLargestImageEdge && height <= kLargestImageEdge &&
      width * height <= kMostImageTexels) {
    return {};
  }
  return fmt::format("has {} x {} texels; expected at most {} a side and {} million in all", width,
                     height, kLargestImageEdge, kMostImageTexels >> 20U);
}

DecodedImage decodeImage(std::span<const std::byte> file) {
  const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
  if (text.starts_with(kPngSignature)) return decodePng(file);
  if (text.starts_with(kJpegSignature)) return decodeJpeg(file);
  return refused(otherFormat(text));
}

}  // namespace galactic::bake
