#include "render/noise/noise_kernel.inl"
#include "render/noise/noise_kernels.h"

namespace galactic::render {

void addDepthNoisePortable(const DepthNoise& noise, float* depth, std::size_t count) noexcept {
  addDepthNoise(noise, depth, count);
}

void addColorNoisePortable(const ColorNoise& noise, std::uint8_t* color, std::uint32_t channels,
                           std::size_t count) noexcept {
  addColorNoise(noise, color, channels, count);
}

}  // namespace galactic::render
