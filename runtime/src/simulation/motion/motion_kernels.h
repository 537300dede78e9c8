#pragma once
#include <cstddef>
#include <cstdint>

#include "simulation/motion/motion_model.h"

namespace galactic::simulation {

/// The tables of a MotionModel as bare pointers: the code built for AVX2 must not instantiate
/// library templates, which the linker could then share with code for any processor.
struct MotionTables {
  const MotionVariable* variables = nullptr;
  std::uint32_t variable_count = 0;
  const MotionNode* nodes = nullptr;
  std::uint32_t node_count = 0;
  /// Padded to whole lanes.
  const BodySphere* spheres = nullptr;
  std::uint32_t sphere_count = 0;
  FixedFrame grip;
  float forward_step = 0;
  float turn_step = 0;
  /// Of the root link above the floor, meters.
  float root_height = 0;
};

/// Poses of eight or more envs, one array element per env; base in the world frame.
struct PoseArrays {
  float* x = nullptr;
  /// Height of the floor under the base.
  float* y = nullptr;
  float* z = nullptr;
  /// Radians, in [-pi, pi).
  float* yaw = nullptr;
  /// Variable v of env e stands at variables[v * stride + e].
  float* variables = nullptr;
  std::size_t stride = 0;
};

/// Where a robot's frames go: for each env its own row.
struct BodyArrays {
  /// Env e, coordinate c (x, y, z), sphere n: centers[(3 * e + c) * sphere_count + n].
  float* centers = nullptr;
  /// From grips[kGripStride * e] on: world_from_grip of env e as axes x, y, z and origin, then
  /// cosine and sine of the base's yaw.
  float* grips = nullptr;
  /// From bodies[12 * (nodes + 1) * e] on: axes x, y, z and origin of the root, then of each node,
  /// in the world. Null when nobody wants them.
  float* bodies = nullptr;
  /// Bounds of each eight spheres: env e, bound b of kBounds, group n:
  /// bounds[(kBounds * e + b) * paddedToLanes(groups) + n]; padded with copies of a group. 32-byte
  /// aligned. Null when nobody wants them.
  float* bounds = nullptr;
  /// Bounds of all spheres: env e, bound b: extents[kExtentStride * e + b]. Wanted where bounds
  /// are.
  float* extents = nullptr;
};

/// Bounds of one env, padded to whole lanes.
inline constexpr std::size_t kExtentStride = 8;

/// Fourteen numbers, padded to whole lanes.
inline constexpr std::size_t kGripStride = 16;

/// Envs that the widest kernels handle at a time.
inline constexpr std::size_t kMostWidth = 16;

/// What the kernels need beside their results; aligned to 64 bytes, or to 32 for batches that are
/// no multiple of kMostWidth. Shape: frameScratchSize floats.
[[nodiscard]] constexpr std::size_t frameScratchSize(std::size_t nodes) {
  return (nodes + 2) * 12 * kMostWidth;
}

/// Envs' candidate poses after their actions: turn, then drive along the new heading, then the
/// joints, each within its limits. `actions`: env after env, `action_count` each, in [-1, 1];
/// joints first, then forward, then turn (+1: clockwise seen from above). `from` and `to` are
/// arrays of these envs; y is copied.
struct MoveBatch {
  const float* actions = nullptr;
  std::size_t action_count = 0;
  PoseArrays from;
  PoseArrays to;
  /// A multiple of kLanes; of kMostWidth where the widest vectors are to be used.
  std::size_t envs = kLanes;
};

/// Forward kinematics of envs, down to sphere centers and the grip.
struct BodyBatch {
  PoseArrays pose;
  BodyArrays body;
  float* scratch = nullptr;
  /// As in a MoveBatch.
  std::size_t envs = kLanes;
};

/// The kernels of the motion of a robot. All versions do the same operations in the same
/// order, and none is contracted: they agree bit for bit.
struct MotionKernels {
  void (*move)(const MotionTables&, const MoveBatch&) noexcept = nullptr;
  void (*place)(const MotionTables&, const BodyBatch&) noexcept = nullptr;
};

/// For any processor.
[[nodiscard]] MotionKernels portableMotion() noexcept;
/// For processors with AVX2.
[[nodiscard]] MotionKernels avx2Motion() noexcept;
/// For processors with AVX-512: see detail::hasAvx512().
[[nodiscard]] MotionKernels avx512Motion() noexcept;
/// The fastest one that this processor can run.
[[nodiscard]] MotionKernels motionKernels() noexcept;

/// Views into the model, which must outlive them.
[[nodiscard]] MotionTables motionTables(const MotionModel& model);

}  // namespace galactic::simulation
