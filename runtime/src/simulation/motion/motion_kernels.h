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
  /// 0: no action drives sideways.
  float sideways_step = 0;
  /// Of the root link above the floor, meters.
  float root_height = 0;
};

/// Envs that the widest kernels handle at a time.
inline constexpr std::size_t kMostWidth = 16;

/// One number of each of so many envs, side by side. Of rows one after the other, number n of env e
/// stands at [n * kMostWidth + e].
struct alignas(64) EnvRow {
  float values[kMostWidth];
};

/// What is known of a grip, and how many numbers a GripFrame has room for.
inline constexpr std::size_t kGripNumbers = 14;
inline constexpr std::size_t kGripStride = 16;

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

/// Axes x, y, z and origin of a frame.
inline constexpr std::size_t kFrameNumbers = 12;

/// Rows of the frames of root and nodes.
[[nodiscard]] constexpr std::size_t frameRows(std::size_t nodes) {
  return kFrameNumbers * (nodes + 1);
}

/// Where a robot's frames and spheres go.
struct BodyArrays {
  /// Those of the root, then of each node, in the world: frameRows() rows.
  float* frames = nullptr;
  /// Env e, coordinate c (x, y, z), sphere n: centers[(3 * e + c) * sphere_count + n].
  float* centers = nullptr;
  /// world_from_grip as axes x, y, z and origin, then cosine and sine of the base's yaw:
  /// kGripNumbers rows, see EnvRow.
  float* grips = nullptr;
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

/// Actions as a caller gives them, env after env, `count` each, and the rows that they go to.
struct ActionBatch {
  const float* from = nullptr;
  std::size_t count = 0;
  float* to = nullptr;
  /// kLanes or kMostWidth.
  std::size_t envs = kLanes;
};

/// Envs' candidate poses after their actions: turn, then drive along the new heading, then the
/// joints, each within its limits. `actions`: rows, each in [-1, 1]; joints first, then forward,
/// then turn (+1: clockwise seen from above), then sideways (+1: to the left) where there is such
/// a step. `from` and `to` are arrays of these envs; y is
/// copied.
struct MoveBatch {
  const float* actions = nullptr;
  std::size_t joints = 0;
  PoseArrays from;
  PoseArrays to;
  /// As in an ActionBatch.
  std::size_t envs = kLanes;
};

/// Frames of envs as numbers side by side, env after env: kFrameNumbers for the root, then for each
/// node.
struct FrameBatch {
  /// Rows; see frameRows().
  const float* frames = nullptr;
  std::size_t rows = 0;
  /// Which envs' frames are wanted: all bits of each.
  const std::uint32_t* wanted = nullptr;
  /// From to[rows * e] on.
  float* to = nullptr;
  /// As in an ActionBatch.
  std::size_t envs = kLanes;
};

/// How much the joint actions change, and where the target is. All arrays are rows.
struct JudgeBatch {
  const float* actions = nullptr;
  /// Of the step before; become `actions` where `active` has all bits set, and stay where it has
  /// none.
  float* last_actions = nullptr;
  const std::uint32_t* active = nullptr;
  std::size_t joints = 0;
  const float* grips = nullptr;
  /// Points in the world.
  const float* targets = nullptr;
  const float* goals = nullptr;
  /// Results: the sum of the squared changes of the joint actions, and the distances from grip to
  /// target and from target to goal, meters.
  float* change = nullptr;
  float* reach = nullptr;
  float* transport = nullptr;
  /// As in an ActionBatch.
  std::size_t envs = kLanes;
};

/// Observations but for sensors that look around. All arrays but `out` are rows.
struct ObserveBatch {
  PoseArrays pose;
  /// Variables that actions move.
  const std::uint32_t* controlled = nullptr;
  std::size_t controlled_count = 0;
  const float* grips = nullptr;
  /// Points in the world: the target as it is observed, and where it is.
  const float* targets = nullptr;
  const float* current_targets = nullptr;
  const float* goals = nullptr;
  /// 1 where something is in the hand; which part of the episode is left; 1 where the last step was
  /// refused.
  const float* holds = nullptr;
  const float* left = nullptr;
  const float* bumps = nullptr;
  bool observes_bump = false;
  bool observes_target_goal = false;
  /// Env after env, `out_stride` apart.
  float* out = nullptr;
  std::size_t out_stride = 0;
  /// As in an ActionBatch.
  std::size_t envs = kLanes;
};

/// Forward kinematics of envs, down to sphere centers and the grip.
struct BodyBatch {
  PoseArrays pose;
  BodyArrays body;
  /// As in an ActionBatch.
  std::size_t envs = kLanes;
};

/// Moves the frames of envs.
struct FrameShift {
  /// Rows; see frameRows().
  float* frames = nullptr;
  std::size_t rows = 0;
  /// Three rows: along X, Y and Z, meters.
  const float* by = nullptr;
  /// As in an ActionBatch.
  std::size_t envs = kLanes;
};

/// Moves the spheres of one env. Counts are padded to lanes.
struct SphereShift {
  /// Meters.
  float by_x = 0;
  float by_y = 0;
  float by_z = 0;
  /// As those of the env in BodyArrays.
  float* centers = nullptr;
  std::size_t sphere_count = 0;
  float* bounds = nullptr;
  std::size_t group_count = 0;
  float* extents = nullptr;
};

/// What happens to all envs of a chunk alike. All versions do the same operations in the same
/// order, and none is contracted: they agree bit for bit.
struct MotionKernels {
  /// Actions cut to [-1, 1]; what is not a number becomes 0. Whether there was any.
  bool (*read)(const ActionBatch&) noexcept = nullptr;
  void (*move)(const MotionTables&, const MoveBatch&) noexcept = nullptr;
  void (*place)(const MotionTables&, const BodyBatch&) noexcept = nullptr;
  void (*shift_frames)(const FrameShift&) noexcept = nullptr;
  void (*put_frames)(const FrameBatch&) noexcept = nullptr;
  void (*judge)(const JudgeBatch&) noexcept = nullptr;
  void (*shift)(const SphereShift&) noexcept = nullptr;
  void (*observe)(const ObserveBatch&) noexcept = nullptr;
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
