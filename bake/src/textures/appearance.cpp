#include "textures/appearance.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "galactic/bake/triangle_mesh.h"
#include "textures/images/linear_image.h"
#include "textures/images/mip_chain.h"

namespace galactic::bake {
namespace {

/// A blended surface is drawn if its alpha is at least this.
constexpr float kBlendCutoff = 0.5F;
/// Limits beyond which alpha is stored as 0 or as 255.
constexpr float kNoAlpha = 0.5F / 255;
constexpr float kFullAlpha = 254.5F / 255;

bool isTranslucent(float alpha) { return alpha > kNoAlpha && alpha < kFullAlpha; }

/// Clamps to 0 to 1. NaN becomes 1, like a missing factor.
float unitInterval(float value) { return std::isnan(value) ? 1.F : std::clamp(value, 0.F, 1.F); }

float cutoffOf(const Look& look) {
  if (look.alpha_mode == AlphaMode::kOpaque) return 0;
  return look.alpha_mode == AlphaMode::kMask ? look.alpha_cutoff : kBlendCutoff;
}

/// How much of an image is visible.
struct Visibility {
  float cutoff = 0;
  double coverage = 1;
  double translucent = 0;
};

Visibility visibilityOf(const Image& image, const Look& look) {
  Visibility found{.cutoff = cutoffOf(look)};
  if (found.cutoff <= 0) return found;
  std::array<std::size_t, 256> histogram{};
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) ++histogram[image.rgba[i]];
  std::size_t visible = 0;
  std::size_t translucent = 0;
  std::size_t full = 0;
  for (std::size_t byte = 0; byte < histogram.size(); ++byte) {
    const float alpha = static_cast<float>(byte) / 255.F * look.factor[3];
    if (alpha >= found.cutoff) visible += histogram[byte];
    if (isTranslucent(alpha)) translucent += histogram[byte];
    if (alpha >= kFullAlpha) full += histogram[byte];
  }
  const std::size_t all = image.rgba.size() / 4;
  const bool blends = look.alpha_mode == AlphaMode::kBlend;
  if ((blends ? full : visible) == all) return {};  // nothing is cut out
  found.coverage = static_cast<double>(visible) / static_cast<double>(all);
  if (blends) found.translucent = static_cast<double>(translucent) / static_cast<double>(all);
  return found;
}

/// Whether all texels are equal, in the channels that matter.
bool isUniform(const Image& image, AlphaUse alpha) {
  const std::size_t channels = alpha == AlphaUse::kIgnored ? 3 : 4;
  for (std::size_t i = 4; i < image.rgba.size(); i += 4) {
    if (!std::equal(image.rgba.begin(), image.rgba.begin() + static_cast<std::ptrdiff_t>(channels),
                    image.rgba.begin() + static_cast<std::ptrdiff_t>(i))) {
      return false;
    }
  }
  return true;
}

std::uint32_t uniformColor(const Image& image, const Look& look, AlphaUse alpha,
                           const TransferFunction& transfer) {
  std::array<float, 4> color = look.factor;
  for (std::size_t channel = 0; channel < 3; ++channel) {
    color[channel] *= transfer.linear(image.rgba[channel]);
  }
  color[3] = alpha == AlphaUse::kIgnored ? 1 : color[3] * static_cast<float>(image.rgba[3]) / 255;
  return surfaceColor(color);
}

void multiply(LinearImage& image, const std::array<float, 4>& factor, AlphaUse alpha) {
  const float a = alpha == AlphaUse::kIgnored ? 1.F : factor[3];
  for (LinearTexel& texel : image.texels) {
    for (std::size_t channel = 0; channel < 3; ++channel) texel[channel] *= factor[channel] * a;
    texel[3] *= a;
  }
}

}  // namespace

Look lookOf(const SourceMaterial& material) {
  Look look{.alpha_mode = material.alpha_mode};
  for (std::size_t channel = 0; channel < 4; ++channel) {
    look.factor[channel] = unitInterval(material.base_color[channel]);
  }
  const float cutoff = unitInterval(material.alpha_cutoff);
  if (look.alpha_mode == AlphaMode::kMask && cutoff <= 0) look.alpha_mode = AlphaMode::kOpaque;
  if (look.alpha_mode == AlphaMode::kMask) look.alpha_cutoff = cutoff;
  if (look.alpha_mode == AlphaMode::kOpaque) look.factor[3] = 1;
  return look;
}

Appearance plainAppearance(const Look& look) {
  Appearance plain{.color = surfaceColor(look.factor), .texels = {}};
  const float alpha = look.factor[3];
  const bool blends = look.alpha_mode == AlphaMode::kBlend;
  if (alpha >= (blends ? kFullAlpha : cutoffOf(look))) return plain;
  plain.alpha_cutoff = cutoffOf(look);
  if (blends && isTranslucent(alpha)) plain.translucent = 1;
  return plain;
}

Appearance texturedAppearance(const Image& image, const Look& look,
                              const TextureBakeOptions& options, const TransferFunction& transfer) {
  const Visibility visible = visibilityOf(image, look);
  const AlphaUse alpha = visible.cutoff > 0 ? AlphaUse::kKept : AlphaUse::kIgnored;
  Appearance baked{
      .alpha_cutoff = visible.cutoff, .texels = {}, .translucent = visible.translucent};
  if (isUniform(image, alpha)) {
    baked.color = uniformColor(image, look, alpha, transfer);
    return baked;
  }
  baked.size = std::min(std::bit_ceil(std::max(image.width, image.height)), options.largest);
  LinearImage base = resampled(image, baked.size, alpha, transfer);
  multiply(base, look.factor, alpha);
  baked.texels = encodeMipChain(std::move(base),
                                {.cutoff = visible.cutoff, .coverage = visible.coverage}, transfer);
  const std::uint8_t* mean = &baked.texels[baked.texels.size() - 4];
  baked.color = mean[0] | static_cast<std::uint32_t>(mean[1]) << 8U |
                static_cast<std::uint32_t>(mean[2]) << 16U |
                static_cast<std::uint32_t>(mean[3]) << 24U;
  if (options.format == TexelFormat::kBc1 && visible.cutoff <= 0) {
    baked.format = TexelFormat::kBc1;
    baked.texels = encodeBc1(baked.texels, baked.size);
  }
  return baked;
}

}  // namespace galactic::bake
