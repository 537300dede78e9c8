// Compiled for AVX2, so it instantiates no library templates; see column_grid_avx2.cpp.
#include "render/noise/noise_kernels.h"

#if !defined(__AVX2__)
#pragma GCC diagnostic ignored "-Wpsabi"
#endif
#include "render/noise/noise_kernel.inl"

namespace galactic::render {

void addDepthNoiseAvx2(const DepthNoise& noise, float* depth, std::size_t count) noexcept {
  addDepthNoise(noise, depth, count);
}

void addColorNoiseAvx2(const ColorNoise& noise, std::uint8_t* color, std::uint32_t channels,
                       std::size_t count) noexcept {
  addColorNoise(noise, color, channels, count);
}

}  // namespace galactic::render
