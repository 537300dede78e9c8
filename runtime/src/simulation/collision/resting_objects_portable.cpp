#include "column_grid/column_grid_kernels.h"
#include "simulation/collision/resting_objects_kernel.inl"
#include "simulation/collision/resting_objects_kernels.h"

namespace galactic::simulation {

RestingKernels portableResting() noexcept {
  return {findTouchingKernel, mayTouchKernel, touchesKernel};
}

const RestingKernels& restingKernels() noexcept {
  static const RestingKernels kernels = detail::hasAvx2() ? avx2Resting() : portableResting();
  return kernels;
}

}  // namespace galactic::simulation
