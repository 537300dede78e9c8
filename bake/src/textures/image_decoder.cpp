#include "textures/image_decoder.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "import/isolated_process.h"
#include "import/transfer_archive.h"
#include "textures/image_codecs.h"

namespace galactic::bake {
namespace {

using namespace std::string_view_literals;

/// The largest allowed image takes a second to decode and twice its own size.
constexpr ProcessLimits kDecodeLimits{.wall_clock = std::chrono::seconds(60),
                                      .memory = std::uint64_t{2} << 30U};

constexpr std::string_view kPngSignature = "\x89PNG\r\n\x1A\n";
constexpr std::string_view kJpegSignature = "\xFF\xD8\xFF";

struct Signature {
  std::string_view bytes;
  std::size_t offset;
  std::string_view name;
};

/// Formats that people do find in their assets.
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
    Signature{"version https://git-lfs"sv, 0, "a pointer of Git LFS (fetch it with git lfs pull)"},
};

bool hasAt(std::string_view file, std::size_t offset, std::string_view bytes) {
  return file.size() >= offset && file.substr(offset).starts_with(bytes);
}

std::string otherFormat(std::string_view file) {
  if (file.empty()) return "is empty";
  // A TGA has its signature at its end.
  constexpr std::string_view kTgaEnd = "TRUEVISION-XFILE.\0"sv;
  if (file.ends_with(kTgaEnd)) return "is TGA; wanted PNG or JPEG";
  for (const Signature& format : kOtherFormats) {
    if (hasAt(file, format.offset, format.bytes)) {
      return fmt::format("is {}; wanted PNG or JPEG", format.name);
    }
  }
  return "is of an unknown format; wanted PNG or JPEG";
}

std::string failureText(const ProcessFailure& failure) {
  switch (failure.end) {
    case ProcessEnd::kNotStarted:
      return "could not be decoded: no process could be started";
    case ProcessEnd::kTimeLimit:
      return "took too long to decode";
    case ProcessEnd::kMemoryLimit:
      return "needs too much memory to decode";
    case ProcessEnd::kCrashed:
      return fmt::format("crashes its decoder (signal {})", failure.number);
    case ProcessEnd::kFailed:
      break;
  }
  return fmt::format("stops its decoder (exit code {})", failure.number);
}

void sendImage(std::span<const std::byte> file, ProcessChannel& channel) {
  const TransferSink sink = [&](std::span<const std::byte> bytes) { channel.write(bytes); };
  TransferWriter writer(sink);
  const DecodedImage decoded = decodeImage(file);
  writer(decoded.has_value());
  if (decoded) {
    writer(decoded->width, decoded->height, decoded->rgba);
  } else {
    writer(decoded.error());
  }
}

}  // namespace

std::string sizeFault(std::uint64_t width, std::uint64_t height) {
  if (width == 0 || height == 0) return "is empty";
  if (width <= kLargestImageEdge && height <= kLargestImageEdge &&
      width * height <= kMostImageTexels) {
    return {};
  }
  return fmt::format("has {} x {} texels; wanted at most {} a side and {} million in all", width,
                     height, kLargestImageEdge, kMostImageTexels >> 20U);
}

DecodedImage decodeImage(std::span<const std::byte> file) {
  const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
  if (text.starts_with(kPngSignature)) return decodePng(file);
  if (text.starts_with(kJpegSignature)) return decodeJpeg(file);
  return refused(otherFormat(text));
}

DecodedImage decodeIsolated(std::span<const std::byte> file) {
  const auto output =
      runIsolated([&](ProcessChannel& channel) { sendImage(file, channel); }, kDecodeLimits);
  if (!output) return refused(failureText(output.error()));
  TransferReader reader(output->bytes());
  bool decoded = false;
  reader(decoded);
  Image image;
  std::string message;
  if (decoded) {
    reader(image.width, image.height, image.rgba);
  } else {
    reader(message);
  }
  const bool complete = reader.good() && reader.atEnd() &&
                        image.rgba.size() == std::size_t{image.width} * image.height * 4;
  if (!complete) return refused("was not delivered by its decoder");
  if (!decoded) return refused(std::move(message));
  return image;
}

}  // namespace galactic::bake
