#include "textures/images/mip_chain.h"

#include <algorithm>
#include <cmath>

namespace galactic::bake {
namespace {

/// The least alpha of visible texels that brings the visible share of `level` as near to `coverage`
/// as possible.
float visibleFrom(const LinearImage& level, double coverage) {
  std::vector<float> alphas;
  alphas.reserve(level.texels.size());
  for (const LinearTexel& texel : level.texels) alphas.push_back(texel[3]);
  const auto count = static_cast<double>(alphas.size());
  const auto visible = static_cast<std::size_t>(std::lround(std::clamp(coverage, 0., 1.) * count));
  std::sort(alphas.begin(), alphas.end(), std::greater<>());
  if (visible == 0) return 2 * std::max(alphas.front(), 1.F);
  if (visible == alphas.size()) return alphas.back();
  return 0.5F * (alphas[visible - 1] + alphas[visible]);
}

/// Straight alpha as a byte, on the same side of `cutoff` as `alpha` is of `from`.
std::uint8_t encodedAlpha(float alpha, float from, float cutoff) {
  const int least_visible = static_cast<int>(std::ceil(cutoff * 255));
  const float scaled = from > 0 ? alpha * (cutoff / from) : 1.F;
  const int byte = static_cast<int>(std::lround(std::clamp(scaled, 0.F, 1.F) * 255));
  return static_cast<std::uint8_t>(alpha >= from ? std::max(byte, least_visible)
                                                 : std::min(byte, least_visible - 1));
}

/// Colors without the multiplication by alpha. Where alpha is 0, the color of the next smaller
/// level.
std::vector<std::array<float, 3>> straightColors(const LinearImage& level,
                                                 const std::vector<std::array<float, 3>>& below) {
  const std::size_t size = level.size;
  std::vector<std::array<float, 3>> colors(level.texels.size());
  for (std::size_t i = 0; i < colors.size(); ++i) {
    const LinearTexel& texel = level.texels[i];
    if (texel[3] > 0) {
      colors[i] = {texel[0] / texel[3], texel[1] / texel[3], texel[2] / texel[3]};
    } else if (!below.empty()) {
      colors[i] = below[(i / size / 2) * (size / 2) + i % size / 2];
    }
  }
  return colors;
}

}  // namespace

std::vector<std::uint8_t> encodeMipChain(LinearImage base, const CutOut& cut_out,
                                         const TransferFunction& transfer) {
  std::vector<LinearImage> levels;
  levels.push_back(std::move(base));
  while (levels.back().size > 1) levels.push_back(halved(levels.back()));

  std::vector<std::uint8_t> chain(textureBytes(levels.front().size, TexelFormat::kRgba8));
  std::size_t end = chain.size();
  std::vector<std::array<float, 3>> colors;
  // From the smallest level up, because larger ones take colors from it.
  for (std::size_t n = levels.size(); n-- > 0;) {
    const LinearImage& level = levels[n];
    colors = straightColors(level, colors);
    const float from = cut_out.cutoff > 0 ? visibleFrom(level, cut_out.coverage) : 0;
    end -= level.texels.size() * 4;
    std::uint8_t* to = &chain[end];
    for (std::size_t i = 0; i < level.texels.size(); ++i, to += 4) {
      for (std::size_t channel = 0; channel < 3; ++channel) {
        to[channel] = transfer.encoded(colors[i][channel]);
      }
      to[3] = cut_out.cutoff > 0 ? encodedAlpha(level.texels[i][3], from, cut_out.cutoff) : 0xFF;
    }
  }
  return chain;
}

}  // namespace galactic::bake
