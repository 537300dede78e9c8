#pragma once
#include <cstdint>

namespace galactic {

/// Images of a batch in the memory of a CUDA device: addresses there, in the layout of
/// RenderTargets; 0 for images that the options do not ask for. color has 3 or 4 bytes a pixel,
/// depth a float, semantics a 32-bit number.
struct DeviceImages {
  std::uint64_t color = 0;
  std::uint64_t depth = 0;
  std::uint64_t semantics = 0;
};

}  // namespace galactic
