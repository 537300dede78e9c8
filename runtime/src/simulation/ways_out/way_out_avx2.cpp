// Compiled for AVX2: instantiates no library templates, see column_grid_avx2.cpp.
#include "simulation/ways_out/way_out_kernels.h"

#if !defined(__AVX2__)
#pragma GCC diagnostic ignored "-Wpsabi"
#endif
// Each of these needs the one before it.
#include "simulation/lanes/lanes_eight.inl"
#include "simulation/lanes/operations.inl"
#include "simulation/ways_out/way_out_kernel.inl"

namespace galactic::simulation {

WayKernels avx2Ways() noexcept {
  return {addKernel, addGroupsKernel, shortestKernel, leaveUnblockedKernel};
}

}  // namespace galactic::simulation
