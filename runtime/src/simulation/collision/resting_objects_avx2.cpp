// Compiled for AVX2. It includes no header whose inline functions it could instantiate: the linker
// may keep one copy of such a function for the whole program, and a copy built here would not run
// on an older processor.
#include "simulation/collision/resting_objects_kernels.h"

#if !defined(__AVX2__)
#pragma GCC diagnostic ignored "-Wpsabi"
#endif
#include "simulation/collision/resting_objects_kernel.inl"

namespace galactic::simulation {

RestingKernels avx2Resting() noexcept {
  return {findTouchingKernel, mayTouchKernel, touchesKernel};
}

}  // namespace galactic::simulation
