// Compiled for AVX2: instantiates no library templates, see column_grid_avx2.cpp.
#include "simulation/motion/motion_kernels.h"

#if !defined(__AVX2__)
#pragma GCC diagnostic ignored "-Wpsabi"
#endif
// Each of these needs those before it.
#include "simulation/lanes/lanes_eight.inl"
#include "simulation/lanes/operations.inl"
#include "simulation/motion/motion_kernel.inl"
#include "simulation/motion/shift_kernel.inl"
#include "simulation/motion/step_kernel.inl"

namespace galactic::simulation {

MotionKernels avx2Motion() noexcept {
  return {readKernel,      moveKernel,  placeKernel, shiftFramesKernel,
          putFramesKernel, judgeKernel, shiftKernel, observeKernel};
}

}  // namespace galactic::simulation
