#pragma once
#include <cstdint>
#include <vector>

#include "galactic/render_meshes.h"
#include "textures/images/linear_image.h"

namespace galactic::bake {

/// How texels become visible.
struct CutOut {
  /// What has less alpha is not there. 0: nothing is cut out, and alpha is stored as 1.
  float cutoff = 0;
  /// Share of texels that every level shall show.
  double coverage = 1;
};

/// All levels from `base` down to one texel, as RenderMeshes stores them with kRgba8: the largest
/// first, without gaps. Where shapes are cut out, alpha of each level is scaled so that its
/// visible share comes as near to the coverage as its texels can, and invisible texels get the
/// colors of visible ones around them. `base.size`: a power of two.
[[nodiscard]] std::vector<std::uint8_t> encodeMipChain(LinearImage base, const CutOut& cut_out,
                                                       const TransferFunction& transfer);

/// The same texture in blocks of kBc1. `rgba`: a chain of encodeMipChain, opaque; `size`: its
/// largest edge. In bc1_blocks.cpp, the only file that names stb_dxt.
[[nodiscard]] std::vector<std::uint8_t> encodeBc1(const std::vector<std::uint8_t>& rgba,
                                                  std::uint32_t size);

}  // namespace galactic::bake
