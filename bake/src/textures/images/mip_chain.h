#pragma once
#include <cstdint>
#include <vector>

#include "galactic/render_meshes.h"
#include "textures/images/linear_image.h"

namespace galactic::bake {

/// Which texels are visible.
struct CutOut {
  /// Texels with less alpha are invisible. 0: nothing is cut out, and alpha is stored as 1.
  float cutoff = 0;
  /// Share of texels that should be visible in every level.
  double coverage = 1;
};

/// All levels from `base` down to one texel, as RenderMeshes stores them with kRgba8: largest
/// first, without gaps. With a cutoff, the alpha of each level is scaled so that its visible share
/// comes as near to the coverage as possible, and invisible texels get the colors of visible ones
/// around them. `base.size` must be a power of two.
[[nodiscard]] std::vector<std::uint8_t> encodeMipChain(LinearImage base, const CutOut& cut_out,
                                                       const TransferFunction& transfer);

/// The same texture in blocks of kBc1. `rgba`: an opaque chain from encodeMipChain; `size`: edge of
/// its largest level. In bc1_blocks.cpp, the only file that names stb_dxt.
[[nodiscard]] std::vector<std::uint8_t> encodeBc1(const std::vector<std::uint8_t>& rgba,
                                                  std::uint32_t size);

}  // namespace galactic::bake
