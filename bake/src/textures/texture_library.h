#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <tl/expected.hpp>

#include "galactic/bake/render_textures.h"
#include "textures/isolated_bake.h"

namespace galactic::bake {

/// bakeIsolated, but for images that the options' library knows already.
[[nodiscard]] tl::expected<ImageAppearances, std::string> bakeRemembered(
    std::span<const std::byte> file, std::span<const Look> looks, const TextureBakeOptions& options,
    const TransferFunction& transfer);

}  // namespace galactic::bake
