#include "simulation/motion/motion_kernels.h"

// Each of these needs those before it.
#include "simulation/lanes/lanes_eight.inl"
#include "simulation/lanes/operations.inl"
#include "simulation/motion/motion_kernel.inl"
#include "simulation/motion/shift_kernel.inl"
#include "simulation/motion/step_kernel.inl"
#include "support/processor.h"

namespace galactic::simulation {

MotionKernels portableMotion() noexcept {
  return {readKernel,      moveKernel,  placeKernel, shiftFramesKernel,
          putFramesKernel, judgeKernel, shiftKernel, observeKernel};
}

MotionKernels motionKernels() noexcept {
  if (detail::hasAvx512()) return avx512Motion();
  return detail::hasAvx2() ? avx2Motion() : portableMotion();
}

MotionTables motionTables(const MotionModel& model) {
  return {.variables = model.variables.data(),
          .variable_count = static_cast<std::uint32_t>(model.variables.size()),
          .nodes = model.nodes.data(),
          .node_count = static_cast<std::uint32_t>(model.nodes.size()),
          .spheres = model.spheres.data(),
          .sphere_count = static_cast<std::uint32_t>(model.spheres.size()),
          .grip = model.grip,
          .forward_step = model.base.forward_step,
          .turn_step = model.base.turn_step,
          .sideways_step = model.base.sideways_step,
          .root_height = model.base.root_height};
}

}  // namespace galactic::simulation
