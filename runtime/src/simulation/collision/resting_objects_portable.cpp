#include "simulation/collision/resting_objects_kernel.inl"
#include "simulation/collision/resting_objects_kernels.h"

namespace galactic::simulation {

RestingKernels portableResting() noexcept {
  return {findTouchingKernel, mayTouchKernel, touchesKernel};
}

}  // namespace galactic::simulation
