#include "textures/isolated_bake.h"

#include <fmt/format.h>

#include <system_error>
#include <utility>

#include "galactic/error.h"
#include "import/isolated_process.h"
#include "import/transfer_archive.h"
#include "textures/images/image.h"

namespace galactic::bake {

template <class Archive>
void transferFields(Archive& archive, Is<Appearance> auto& appearance) {
  archive(appearance.color, appearance.alpha_cutoff, appearance.size, appearance.format,
          appearance.texels, appearance.translucent);
}

namespace {

/// The largest allowed image takes a few seconds, and a few times its own size in memory.
constexpr ProcessLimits kBakeLimits{.wall_clock = std::chrono::seconds(120),
                                    .memory = std::uint64_t{3} << 30U};

std::string failureText(const ProcessFailure& failure) {
  switch (failure.end) {
    case ProcessEnd::kNotStarted:
      // A fault of the machine is no reason to bake without the image.
      throw ErrorException({ErrorCode::kUnsupported, "an image of a texture",
                            fmt::format("no process can be started to decode it: {}",
                                        std::generic_category().message(failure.number))});
    case ProcessEnd::kTimeLimit:
      return "takes too long to decode";
    case ProcessEnd::kMemoryLimit:
      return "needs too much memory to decode";
    case ProcessEnd::kCrashed:
      return fmt::format("crashes its decoder (signal {})", failure.number);
    case ProcessEnd::kFailed:
      break;
  }
  return fmt::format("stops its decoder (exit code {})", failure.number);
}

}  // namespace

tl::expected<ImageAppearances, std::string> bakeIsolated(std::span<const std::byte> file,
                                                         std::span<const Look> looks,
                                                         const TextureBakeOptions& options,
                                                         const TransferFunction& transfer) {
  const IsolatedWork work = [&](ProcessChannel& channel) {
    const TransferSink sink = [&](std::span<const std::byte> bytes) { channel.write(bytes); };
    TransferWriter writer(sink);
    const DecodedImage image = decodeImage(file);
    if (!image) {
      writer(std::uint64_t{0}, image.error());
      return;
    }
    writer(std::uint64_t{image->rgba.size()});
    for (const Look& look : looks) {
      writer(texturedAppearance(*image, look, options, transfer));
    }
  };
  const auto output = runIsolated(work, kBakeLimits);
  if (!output) return tl::unexpected(failureText(output.error()));
  TransferReader reader(output->bytes());
  ImageAppearances baked;
  std::string fault;
  reader(baked.image_bytes);
  if (baked.image_bytes == 0) {
    reader(fault);
  } else {
    baked.appearances.resize(looks.size());
    for (Appearance& appearance : baked.appearances) reader(appearance);
  }
  if (!reader.good() || !reader.atEnd()) fault = "was not delivered by its decoder";
  if (!fault.empty()) return tl::unexpected(std::move(fault));
  return baked;
}

}  // namespace galactic::bake
