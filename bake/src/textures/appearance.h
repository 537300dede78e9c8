#pragma once
#include <array>
#include <cstdint>
#include <tuple>
#include <vector>

#include "galactic/bake/render_textures.h"
#include "galactic/bake/source_asset.h"
#include "textures/images/image.h"
#include "textures/images/transfer_function.h"

namespace galactic::bake {

/// All of a material that its look depends on, besides the image.
struct Look {
  /// Linear RGBA.
  std::array<float, 4> factor{1, 1, 1, 1};
  AlphaMode alpha_mode = AlphaMode::kOpaque;
  /// 0 to 1; of kMask.
  float alpha_cutoff = 0.5F;

  [[nodiscard]] bool operator<(const Look& other) const {
    return std::tie(factor, alpha_mode, alpha_cutoff) <
           std::tie(other.factor, other.alpha_mode, other.alpha_cutoff);
  }
};

/// The look of `material`, alike for materials that differ only in what does not show.
[[nodiscard]] Look lookOf(const SourceMaterial& material);

/// How a material with a certain image or without one is stored.
struct Appearance {
  /// RGBA, sRGB, R lowest.
  std::uint32_t color = 0xFFFFFFFF;
  /// 0: opaque.
  float alpha_cutoff = 0;
  /// 0: no texture, `color` says it all.
  std::uint32_t size = 0;
  TexelFormat format = TexelFormat::kRgba8;
  std::vector<std::uint8_t> texels;
  /// Share of the surface that ought to be translucent, 0 to 1.
  double translucent = 0;
};

/// Without an image.
[[nodiscard]] Appearance plainAppearance(const Look& look);

/// With one. `options` are in range.
[[nodiscard]] Appearance texturedAppearance(const Image& image, const Look& look,
                                            const TextureBakeOptions& options,
                                            const TransferFunction& transfer);

}  // namespace galactic::bake
