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

/// All properties of a material that affect its look, except the image.
struct Look {
  /// Linear RGBA.
  std::array<float, 4> factor{1, 1, 1, 1};
  AlphaMode alpha_mode = AlphaMode::kOpaque;
  /// Only for kMask; 0 to 1.
  float alpha_cutoff = 0.5F;

  [[nodiscard]] bool operator<(const Look& other) const {
    return std::tie(factor, alpha_mode, alpha_cutoff) <
           std::tie(other.factor, other.alpha_mode, other.alpha_cutoff);
  }
};

/// The look of `material`. It is the same for materials that differ only in invisible properties.
[[nodiscard]] Look lookOf(const SourceMaterial& material);

/// The stored form of a material, with an image or without.
struct Appearance {
  /// RGBA, sRGB, R lowest.
  std::uint32_t color = 0xFFFFFFFF;
  /// 0: opaque.
  float alpha_cutoff = 0;
  /// Edge in texels; 0: no texture, only `color`.
  std::uint32_t size = 0;
  TexelFormat format = TexelFormat::kRgba8;
  std::vector<std::uint8_t> texels;
  /// Share of the surface that should be translucent, 0 to 1.
  double translucent = 0;
};

/// The appearance without an image.
[[nodiscard]] Appearance plainAppearance(const Look& look);

/// The appearance with an image. `options` must be in range.
[[nodiscard]] Appearance texturedAppearance(const Image& image, const Look& look,
                                            const TextureBakeOptions& options,
                                            const TransferFunction& transfer);

}  // namespace galactic::bake
