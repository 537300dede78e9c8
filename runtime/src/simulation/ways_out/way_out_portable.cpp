#include "simulation/ways_out/way_out_kernels.h"

// Each of these needs the one before it.
#include "simulation/lanes/lanes_eight.inl"
#include "simulation/lanes/operations.inl"
#include "simulation/ways_out/way_out_kernel.inl"
#include "support/processor.h"

namespace galactic::simulation {

WayKernels portableWays() noexcept {
  return {addKernel, addGroupsKernel, shortestKernel, leaveUnblockedKernel};
}

WayKernels wayKernels() noexcept { return detail::hasAvx2() ? avx2Ways() : portableWays(); }

}  // namespace galactic::simulation
