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
  /// Padded to whole groups of lanes.
  const BodySphere* spheres = nullptr;
  std::uint32_t sphere_count = 0;
  FixedFrame grip;
  float forward_step = 0;
  float turn_step = 0;
  /// 0 if no action drives sideways.
  float sideways_step = 0;
  /// The height of the root link above the floor, meters.
  float root_height = 0;
};

/// The number of envs that the widest kernels handle at a time.
inline constexpr std::size_t kMostWidth = 16;

/// One number for each of kMostWidth envs, side by side. In consecutive rows, number n of env e is
/// at [n * kMostWidth + e].
struct alignas(64) EnvRow {
  float values[kMostWidth];
};

/// The numbers of a grip, and how many numbers a GripFrame has room for.
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
  /// Variable v of env e is at variables[v * stride + e].
  float* variables = nullptr;
  std::size_t stride = 0;
};

/// The numbers of a frame: axes x, y, z and origin.
inline constexpr std::size_t kFrameNumbers = 12;

/// The number of rows that hold the frames of root and nodes.
[[nodiscard]] constexpr std::size_t frameRows(std::size_t nodes) {
  return kFrameNumbers * (nodes + 1);
}

/// The output arrays for robots' frames and spheres.
struct BodyArrays {
  /// The frame of the root, then of each node, in the world: frameRows() rows.
  float* frames = nullptr;
  /// Env e, coordinate c (x, y, z), sphere n: centers[(3 * e + c) * sphere_count + n].
  float* centers = nullptr;
  /// world_from_grip as axes x, y, z and origin, then cosine and sine of the base's yaw:
  /// kGripNumbers rows, see EnvRow.
  float* grips = nullptr;
  /// Bounds of each group of eight spheres: env e, bound b of kBounds, group n: bounds[(kBounds * e
  /// + b) * paddedToLanes(groups) + n]; padded with copies of a group. 32-byte aligned. Null if not
  /// wanted.
  float* bounds = nullptr;
  /// Bounds of all spheres: env e, bound b: extents[kExtentStride * e + b]. Written if `bounds` is
  /// not null.
  float* extents = nullptr;
};

/// The bounds of one env, padded to whole lanes.
inline constexpr std::size_t kExtentStride = 8;

/// Actions as a caller passes them, env after env, `count` each, and the rows to write.
struct ActionBatch {
  const float* from = nullptr;
  std::size_t count = 0;
  float* to = nullptr;
  /// kLanes or kMostWidth.
  std::size_t envs = kLanes;
};

/// Envs' candidate poses after their actions: turn, then drive along the new heading, then move the
/// joints, each within its limits. `actions`: rows, each in [-1, 1]; joints first, then forward,
/// then turn (+1: clockwise seen from above), then sideways (+1: to the left) if the robot can.
/// `from` and `to` are arrays of these envs; y is copied.
struct MoveBatch {
  const float* actions = nullptr;
  std::size_t joints = 0;
  PoseArrays from;
  PoseArrays to;
  /// See ActionBatch::envs.
  std::size_t envs = kLanes;
};

/// Writes the frames of envs as consecutive numbers, env after env: kFrameNumbers for the root,
/// then for each node.
struct FrameBatch {
  /// Rows; see frameRows().
  const float* frames = nullptr;
  std::size_t rows = 0;
  /// For each env all bits if its frames are wanted, else none.
  const std::uint32_t* wanted = nullptr;
  /// Env e begins at to[rows * e].
  float* to = nullptr;
  /// See ActionBatch::envs.
  std::size_t envs = kLanes;
};

/// Measures how much the joint actions change, and distances of the target. All arrays are rows.
struct JudgeBatch {
  const float* actions = nullptr;
  /// The joint actions of the previous step; set to `actions` where `active` has all bits set,
  /// unchanged where it has none.
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
  /// See ActionBatch::envs.
  std::size_t envs = kLanes;
};

/// Writes observations, except for the sensed parts. All arrays but `out` are rows.
struct ObserveBatch {
  PoseArrays pose;
  /// The variables that actions move.
  const std::uint32_t* controlled = nullptr;
  std::size_t controlled_count = 0;
  const float* grips = nullptr;
  /// Points in the world: the target to observe, and the target's current place.
  const float* targets = nullptr;
  const float* current_targets = nullptr;
  const float* goals = nullptr;
  /// 1 if something is in the hand; the remaining part of the episode, 0 to 1; 1 if the last step
  /// was refused.
  const float* holds = nullptr;
  const float* left = nullptr;
  const float* bumps = nullptr;
  bool observes_bump = false;
  bool observes_target_goal = false;
  /// Env after env, `out_stride` apart.
  float* out = nullptr;
  std::size_t out_stride = 0;
  /// See ActionBatch::envs.
  std::size_t envs = kLanes;
};

/// Forward kinematics of envs, down to sphere centers and the grip.
struct BodyBatch {
  PoseArrays pose;
  BodyArrays body;
  /// See ActionBatch::envs.
  std::size_t envs = kLanes;
};

/// Moves the frames of envs.
struct FrameShift {
  /// Rows; see frameRows().
  float* frames = nullptr;
  std::size_t rows = 0;
  /// Three rows: along X, Y and Z, meters.
  const float* by = nullptr;
  /// See ActionBatch::envs.
  std::size_t envs = kLanes;
};

/// Moves the spheres of one env. Counts are padded to lanes.
struct SphereShift {
  /// Meters.
  float by_x = 0;
  float by_y = 0;
  float by_z = 0;
  /// The env's part of the arrays in BodyArrays.
  float* centers = nullptr;
  std::size_t sphere_count = 0;
  float* bounds = nullptr;
  std::size_t group_count = 0;
  float* extents = nullptr;
};

/// Kernels for work that is the same for all envs of a chunk. All versions do the same operations
/// in the same order, without contracting any, and agree bit for bit.
struct MotionKernels {
  /// Clamps actions to [-1, 1] and replaces NaN by 0. Returns whether there was any NaN.
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
/// The fastest kernels that this processor can run.
[[nodiscard]] MotionKernels motionKernels() noexcept;

/// Views of the model, which must outlive them.
[[nodiscard]] MotionTables motionTables(const MotionModel& model);

}  // namespace galactic::simulation
