#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "textures/appearance.h"

namespace galactic::bake {

/// The result of baking one image.
struct ImageAppearances {
  /// Size of the decoded image.
  std::uint64_t image_bytes = 0;
  /// One for each look.
  std::vector<Appearance> appearances;
};

/// Decodes `file` and bakes it with each of `looks` (texturedAppearance) in a separate process with
/// limited time and memory. Whatever the file does to the image libraries, it only results in an
/// error message, the end of a sentence that begins with "the image". Only the small results are
/// sent back.
[[nodiscard]] tl::expected<ImageAppearances, std::string> bakeIsolated(
    std::span<const std::byte> file, std::span<const Look> looks, const TextureBakeOptions& options,
    const TransferFunction& transfer);

}  // namespace galactic::bake
