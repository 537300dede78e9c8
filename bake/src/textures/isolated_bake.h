#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "textures/appearance.h"

namespace galactic::bake {

/// What one image gives.
struct ImageAppearances {
  /// Of the decoded image.
  std::uint64_t image_bytes = 0;
  /// One for each look.
  std::vector<Appearance> appearances;
};

/// Decodes `file` and bakes it with each of `looks` (texturedAppearance), in a process of its own
/// that is limited in time and memory: whatever the file makes of the image libraries, it costs
/// one message, the end of a sentence that begins "the image". Only the small results come back.
[[nodiscard]] tl::expected<ImageAppearances, std::string> bakeIsolated(
    std::span<const std::byte> file, std::span<const Look> looks, const TextureBakeOptions& options,
    const TransferFunction& transfer);

}  // namespace galactic::bake
