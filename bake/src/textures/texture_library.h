#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <tl/expected.hpp>

#include "galactic/bake/render_textures.h"
#include "textures/isolated_bake.h"

namespace galactic::bake {

using BakedImage = tl::expected<ImageAppearances, std::string>;

/// What to do about an image that another thread is baking.
enum class WhenBusy { kSkip, kWait };

/// bakeIsolated, but once for all threads that have the same library in their options. None where
/// another thread is baking the image and `when_busy` is kSkip.
[[nodiscard]] std::optional<BakedImage> bakeRemembered(std::span<const std::byte> file,
                                                       std::span<const Look> looks,
                                                       const TextureBakeOptions& options,
                                                       const TransferFunction& transfer,
                                                       WhenBusy when_busy);

}  // namespace galactic::bake
