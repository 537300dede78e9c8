#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

#include "galactic/pose.h"
#include "simulation/collision/resting_objects.h"
#include "simulation/state/grip_frame.h"
#include "simulation/state/model.h"

namespace galactic::simulation {

/// Envs are stepped this many at a time, so that their data stays in the nearest cache.
inline constexpr std::size_t kChunk = kMostWidth;

/// Rows that hold a base: x, y, z and yaw.
inline constexpr std::size_t kBaseRows = 4;

/// One point for each env of a chunk: rows of x, y and z.
using PointRows = std::array<EnvRow, 3>;

/// The pose of a base on its floor.
struct PlanarPose {
  float x = 0;
  float z = 0;
  float yaw = 0;
};

/// The odometry of a robot as of its last update: where it was, and where it believed to be.
struct Odometry {
  PlanarPose was;
  PlanarPose believed;
};
inline constexpr std::size_t kOdometryRows = sizeof(Odometry) / sizeof(float);

/// Pose arrays over rows that begin with those of a base and continue with the variables.
[[nodiscard]] inline PoseArrays posesAt(float* x) {
  return {.x = x,
          .y = x + kChunk,
          .z = x + 2 * kChunk,
          .yaw = x + 3 * kChunk,
          .variables = x + kBaseRows * kChunk,
          .stride = kChunk};
}

/// Counts of what happened in one env; SimulationStatistics adds them up. Kept apart from Env
/// because many steps change none of them.
struct alignas(64) EnvCounters {
  /// Episodes begun, and how many of them began in their turn (not at the caller's request).
  std::uint64_t begun = 0;
  std::uint64_t turns = 0;
  std::uint32_t grasps = 0;
  std::uint32_t drops = 0;
  std::uint32_t restored = 0;
  std::uint32_t episodes = 0;
  std::uint32_t successes = 0;
  std::uint32_t failures = 0;
  std::uint64_t nan_actions = 0;
  /// Steps that the env spent idle.
  std::uint64_t idle_steps = 0;
  /// Ended episodes in which the target had been in the hand.
  std::uint32_t picks = 0;
  /// Whether the caller named the episode that the env is in; otherwise it began in its turn.
  bool is_named = false;
};
static_assert(sizeof(EnvCounters) == 64);

/// How the moves of an env ended; added up like EnvCounters. Kept apart from these, with those of a
/// chunk side by side, because robots that drive slide in most steps.
struct MoveCounters {
  std::uint32_t refused = 0;
  std::uint32_t slid = 0;
};

/// The object in the hand of an env, if any.
struct Held {
  /// A ball that contains the centers of its spheres: center in the grip's frame, meters.
  Vec3 ball_center;
  float ball_radius = 0;
  /// The radii of the working set that its spheres have, as bits.
  std::uint32_t radii = 0;
  Pose grip_from_object;
};

/// Events of a step that decide its reward and the end of the episode.
struct StepEvents {
  /// The target came into the hand for the first time in the episode.
  bool picked = false;
  /// The target was released and came to rest.
  bool released_target = false;
  /// The action let go of the target, but the task makes the hand keep it.
  bool kept_target = false;
  bool terminates = false;
};

/// What every step reads of one env besides what the motion kernels read: one cache line.
struct alignas(64) Env {
  std::uint32_t scene = 0;
  /// Number of its floor's map in Model::clearance.
  std::uint32_t clearance_map = kNoClearanceMap;
  /// Index into Model::starts.
  std::uint32_t start = 0;
  std::uint32_t step = 0;
  std::uint32_t objects = 0;
  std::uint32_t target = 0;
  /// Index, in the episode, of the object in the hand; -1 for none.
  std::int32_t held = -1;
  /// Number of objects that the hand let go of and that some of the robot's spheres have penetrated
  /// ever since. Such a sphere does not count against the object until it has been free of it once;
  /// otherwise the hand could not withdraw. BatchState::leaving() has the spheres.
  std::uint32_t left = 0;
  /// Distances after the previous step: grip to target, target to goal, meters.
  float reach = 0;
  float transport = 0;
  /// Length of the way along the floor after the previous step, meters: to the goal if
  /// `is_way_to_goal`, else to the target; negative if no way is known.
  float way = -1;
  bool is_way_to_goal = false;
  /// Whether the target has been in the hand in this episode.
  bool has_picked = false;
  /// The last step left the robot where it was: it would have penetrated something wherever it
  /// went.
  bool refused = false;
  /// A resting object was the first obstacle in the way of the last step, or of a part of it.
  bool knocked = false;
  /// Some spheres of the object in the hand have penetrated something ever since it was taken. Such
  /// a sphere does not count until it has been free once. BatchState::ignored() has the spheres.
  bool ignores = false;
  StepEvents events;
  /// Sum over all episodes.
  double reward_sum = 0;
};
static_assert(sizeof(Env) == 64);

/// The object in the env's hand, which must not be empty.
[[nodiscard]] inline const ObjectModel& heldModel(const Model& model, const Env& env) {
  return model.object(env.start, static_cast<std::uint32_t>(env.held));
}

/// Whether the target is in the hand.
inline bool holdsTarget(const Env& env) {
  return env.held == static_cast<std::int32_t>(env.target);
}

/// Computes the ball and the radii in `held` from the spheres of `object`.
void measureHeld(const ObjectModel& object, Held& held) noexcept;

class BatchState;

/// Lays an object of env `n`, which rests elsewhere or comes from the hand, to rest at
/// `world_from_object`: sets its pose, and makes it an obstacle for the robot there.
void restObject(const Model& model, BatchState& state, std::size_t n, std::uint32_t object,
                const Pose& world_from_object) noexcept;
/// The same for all objects of the env but the held one; those that rest at their pose already stay
/// as they are.
void restObjects(const Model& model, BatchState& state, std::size_t n, std::span<const Pose> poses,
                 std::int32_t held) noexcept;

/// About how many bytes a BatchState of this many envs allocates.
[[nodiscard]] std::size_t stateBytes(const Model& model, std::size_t envs);

/// Everything that changes in a run: N envs, padded to whole chunks with envs that callers never
/// see.
class BatchState {
 public:
  BatchState(const Model& model, std::size_t envs);

  [[nodiscard]] std::size_t envCount() const { return env_count_; }
  /// A multiple of kChunk.
  [[nodiscard]] std::size_t paddedCount() const { return envs_.size(); }

  [[nodiscard]] Env& env(std::size_t n) { return envs_[n]; }
  [[nodiscard]] const Env& env(std::size_t n) const { return envs_[n]; }
  [[nodiscard]] EnvCounters& counters(std::size_t n) { return counters_[n]; }
  [[nodiscard]] const EnvCounters& counters(std::size_t n) const { return counters_[n]; }
  [[nodiscard]] MoveCounters& moves(std::size_t n) { return moves_[n]; }
  [[nodiscard]] const MoveCounters& moves(std::size_t n) const { return moves_[n]; }
  /// The object in the hand of an env, which must hold one.
  [[nodiscard]] Held& held(std::size_t n) { return held_[n]; }
  [[nodiscard]] const Held& held(std::size_t n) const { return held_[n]; }
  /// The pose of the object in the hand of an env: world_from_object.
  [[nodiscard]] Pose heldPose(std::size_t n) const {
    return gripPose(grip(n)) * held_[n].grip_from_object;
  }
  /// The origin of that pose.
  [[nodiscard]] Vec3 heldOrigin(std::size_t n) const {
    return gripToWorld(grip(n), held_[n].grip_from_object.translation);
  }
  [[nodiscard]] RestingObjects& resting(std::size_t n) { return resting_[n]; }
  [[nodiscard]] const RestingObjects& resting(std::size_t n) const { return resting_[n]; }
  /// World poses of the episode's objects; a held one has the pose at which it was grasped.
  [[nodiscard]] std::span<const Pose> objects(std::size_t n) const {
    return std::span(objects_).subspan(n * most_objects_, most_objects_);
  }
  /// Every change of an object's pose goes through here. To lay an object to rest elsewhere, call
  /// restObject(), which also makes it an obstacle there.
  void setObjectPose(std::size_t n, std::size_t object, const Pose& world_from_object) {
    objects_[n * most_objects_ + object] = world_from_object;
    if (object == envs_[n].target) setPoint(targetRow(), n, world_from_object.translation);
  }
  /// Sets which object is the target, and its goal. The objects must be where they are when the
  /// episode begins.
  void setErrand(std::size_t n, std::uint32_t target, const Vec3& goal) {
    envs_[n].target = target;
    setPoint(goalRow(), n, goal);
    setPoint(targetRow(), n, objects(n)[target].translation);
    setPoint(targetStartRow(), n, objects(n)[target].translation);
  }
  [[nodiscard]] Vec3 goal(std::size_t n) const { return point(goalRow(), n); }
  /// The target's origin when the episode began.
  [[nodiscard]] Vec3 targetStart(std::size_t n) const { return point(targetStartRow(), n); }
  void setTargetStart(std::size_t n, const Vec3& place) { setPoint(targetStartRow(), n, place); }

  [[nodiscard]] GripFrame grip(std::size_t n) const {
    GripFrame grip{};
    const float* numbers = number(gripRow(), n);
    for (std::size_t k = 0; k < kGripNumbers; ++k) grip[k] = numbers[k * kChunk];
    return grip;
  }
  void setGrip(std::size_t n, const GripFrame& grip) {
    float* numbers = number(gripRow(), n);
    for (std::size_t k = 0; k < kGripNumbers; ++k) numbers[k * kChunk] = grip[k];
  }
  /// Spheres of the held object that do not count yet, as bits.
  [[nodiscard]] std::span<std::uint64_t> ignored(std::size_t n) {
    return std::span(ignored_).subspan(n * held_words_, held_words_);
  }
  /// Spheres of the robot that do not yet count against a resting object that the hand let go of,
  /// as bits.
  [[nodiscard]] std::span<std::uint64_t> leaving(std::size_t n, std::size_t object) {
    return std::span(leaving_).subspan((n * most_objects_ + object) * body_words_, body_words_);
  }
  [[nodiscard]] std::span<const std::uint64_t> ignored(std::size_t n) const {
    return std::span(ignored_).subspan(n * held_words_, held_words_);
  }
  /// The same for all objects. Shape: objects x words.
  [[nodiscard]] std::span<const std::uint64_t> leaving(std::size_t n) const {
    return std::span(leaving_).subspan(n * most_objects_ * body_words_,
                                       most_objects_ * body_words_);
  }
  [[nodiscard]] std::span<std::uint64_t> leaving(std::size_t n) {
    return std::span(leaving_).subspan(n * most_objects_ * body_words_,
                                       most_objects_ * body_words_);
  }
  /// The action of the previous step.
  [[nodiscard]] float lastAction(std::size_t joint, std::size_t n) const {
    return *number(lastActionRow() + joint, n);
  }
  void setLastAction(std::size_t joint, std::size_t n, float action) {
    *number(lastActionRow() + joint, n) = action;
  }
  /// Only if Model::hasOdometry().
  [[nodiscard]] Odometry odometry(std::size_t n) const {
    const float* row = number(row_count_ - kOdometryRows, n);
    return {.was = {row[0], row[kChunk], row[2 * kChunk]},
            .believed = {row[3 * kChunk], row[4 * kChunk], row[5 * kChunk]}};
  }
  void setOdometry(std::size_t n, const Odometry& odometry) {
    float* row = number(row_count_ - kOdometryRows, n);
    for (const PlanarPose& pose : {odometry.was, odometry.believed}) {
      for (const float value : {pose.x, pose.z, pose.yaw}) {
        *row = value;
        row += kChunk;
      }
    }
  }
  /// The number of past steps whose actions are kept (Model::keptSteps()). If it is 0,
  /// keptActions() must not be called.
  [[nodiscard]] std::size_t keptSteps() const { return kept_steps_; }
  /// The actions requested of the envs of the chunk that begins at `first` in one of these steps.
  /// Steps of an env's episode are stored modulo keptSteps(), so the oldest one stands where the
  /// next will. Shape: actions.
  [[nodiscard]] std::span<EnvRow> keptActions(std::size_t first, std::size_t step) {
    return std::span(kept_actions_).subspan(keptRow(first, step), action_count_);
  }
  [[nodiscard]] std::span<const EnvRow> keptActions(std::size_t first, std::size_t step) const {
    return std::span(kept_actions_).subspan(keptRow(first, step), action_count_);
  }
  /// Base and variables of the envs of the chunk that begins at `first`.
  [[nodiscard]] PoseArrays poses(std::size_t first) { return posesAt(number(0, first)); }
  [[nodiscard]] float variable(std::size_t v, std::size_t n) const {
    return *number(kBaseRows + v, n);
  }
  [[nodiscard]] Vec3 base(std::size_t n) const { return point(0, n); }
  [[nodiscard]] float yaw(std::size_t n) const { return *number(3, n); }
  [[nodiscard]] PlanarPose planarPose(std::size_t n) const {
    return {base(n).x, base(n).z, yaw(n)};
  }

  /// The rows of the chunk whose first env is `first`. These hold what changes with the robot's
  /// pose: base, variables and grip. The next functions return the grip, the goal and target
  /// points, and the joint actions of the previous step.
  [[nodiscard]] std::span<EnvRow> poseRows(std::size_t first) {
    return std::span(rows_).subspan(first / kChunk * row_count_, goalRow());
  }
  [[nodiscard]] const float* grips(std::size_t first) const { return number(gripRow(), first); }
  [[nodiscard]] const float* goals(std::size_t first) const { return number(goalRow(), first); }
  /// The place where the target rests, or rested before it was grasped.
  [[nodiscard]] const float* targets(std::size_t first) const { return number(targetRow(), first); }
  [[nodiscard]] const float* targetStarts(std::size_t first) const {
    return number(targetStartRow(), first);
  }
  [[nodiscard]] float* lastActions(std::size_t first) { return number(lastActionRow(), first); }

  [[nodiscard]] std::span<float> observation(std::size_t n) {
    return std::span(observations_).subspan(n * observation_size_, observation_size_);
  }
  [[nodiscard]] std::span<const float> observation(std::size_t n) const {
    return std::span(observations_).subspan(n * observation_size_, observation_size_);
  }
  [[nodiscard]] std::span<float> finalObservation(std::size_t n) {
    return std::span(final_observations_).subspan(n * observation_size_, observation_size_);
  }
  /// Keeps the last observation of an ended episode as the final one.
  void keepFinalObservation(std::size_t n) {
    std::ranges::copy(observation(n), finalObservation(n).begin());
  }
  [[nodiscard]] std::span<const float> finalObservation(std::size_t n) const {
    return std::span(final_observations_).subspan(n * observation_size_, observation_size_);
  }
  [[nodiscard]] std::span<const float> observations() const {
    return std::span(observations_).first(env_count_ * observation_size_);
  }
  [[nodiscard]] std::span<const float> finalObservations() const {
    return std::span(final_observations_).first(env_count_ * observation_size_);
  }
  /// Transforms of the robot's root and nodes; empty unless SimulationOptions::body_transforms is
  /// set.
  [[nodiscard]] std::span<RigidTransform> bodyTransforms(std::size_t n) {
    return std::span(bodies_).subspan(n * body_count_, body_count_);
  }
  [[nodiscard]] std::span<const RigidTransform> bodyTransforms(std::size_t n) const {
    return std::span(bodies_).subspan(n * body_count_, body_count_);
  }
  [[nodiscard]] std::span<const RigidTransform> bodyTransforms() const {
    return std::span(bodies_).first(env_count_ * body_count_);
  }
  [[nodiscard]] std::span<float> rewards() { return rewards_; }
  [[nodiscard]] std::span<const float> rewards() const { return rewards_; }
  [[nodiscard]] std::span<std::uint8_t> dones() { return dones_; }
  [[nodiscard]] std::span<const std::uint8_t> dones() const { return dones_; }
  [[nodiscard]] std::span<std::uint8_t> successes() { return successes_; }
  [[nodiscard]] std::span<const std::uint8_t> successes() const { return successes_; }
  [[nodiscard]] std::span<EpisodeEnd> endings() { return endings_; }
  [[nodiscard]] std::span<const EpisodeEnd> endings() const { return endings_; }
  /// Env::has_picked of each env whose episode the last step ended; 0 for the others.
  [[nodiscard]] std::span<std::uint8_t> picks() { return picks_; }
  [[nodiscard]] std::span<const std::uint8_t> picks() const { return picks_; }
  /// 1 for each env that has played all its episodes or waits for a reset; see
  /// BatchSimulator::idle().
  [[nodiscard]] std::span<std::uint8_t> idle() { return idle_; }
  [[nodiscard]] std::span<const std::uint8_t> idle() const { return idle_; }
  /// Sets the outcome to that of a step that ended no episode and earned no reward.
  void clearOutcome(std::size_t n) {
    rewards_[n] = 0;
    dones_[n] = 0;
    successes_[n] = 0;
    endings_[n] = EpisodeEnd::kNone;
    picks_[n] = 0;
  }
  [[nodiscard]] std::size_t bytes() const;

  /// Prefetches what a step of env `n` reads and writes; one chunk ahead is early enough. There may
  /// be no such env. Reads none of its data, as another thread may be working on it.
  void prefetch(std::size_t n) const noexcept;
  /// The same for the few cache lines that belong to the chunk that begins at env `first`.
  void prefetchChunk(std::size_t first) const noexcept;
  /// The same for the bounds of the objects of a chunk. Reads from its envs where these bounds are,
  /// so call it only when the chunk's own step begins.
  void prefetchBounds(std::size_t first) const noexcept;

 private:
  [[nodiscard]] std::size_t gripRow() const { return kBaseRows + variable_count_; }
  [[nodiscard]] std::size_t goalRow() const { return gripRow() + kGripNumbers; }
  [[nodiscard]] std::size_t targetRow() const { return goalRow() + 3; }
  [[nodiscard]] std::size_t targetStartRow() const { return targetRow() + 3; }
  [[nodiscard]] std::size_t lastActionRow() const { return targetStartRow() + 3; }

  [[nodiscard]] std::size_t keptRow(std::size_t first, std::size_t step) const {
    return (first / kChunk * kept_steps_ + step % kept_steps_) * action_count_;
  }
  [[nodiscard]] const float* number(std::size_t row, std::size_t n) const {
    return rows_.data()[n / kChunk * row_count_ + row].values + n % kChunk;
  }
  [[nodiscard]] float* number(std::size_t row, std::size_t n) {
    return rows_.data()[n / kChunk * row_count_ + row].values + n % kChunk;
  }
  [[nodiscard]] Vec3 point(std::size_t row, std::size_t n) const {
    const float* x = number(row, n);
    return {x[0], x[kChunk], x[2 * kChunk]};
  }
  void setPoint(std::size_t row, std::size_t n, const Vec3& p) {
    float* x = number(row, n);
    x[0] = p.x;
    x[kChunk] = p.y;
    x[2 * kChunk] = p.z;
  }

  /// Memory of all vectors, which are made once, one after the other.
  std::pmr::monotonic_buffer_resource memory_;
  /// Memory of the bounds of resting objects that envs do not share: kept apart from what is rarely
  /// read, so that a step reads the bounds as one stream.
  std::pmr::monotonic_buffer_resource bounds_memory_;
  std::size_t env_count_ = 0;
  std::size_t most_objects_ = 0;
  std::size_t held_words_ = 0;
  std::size_t body_words_ = 0;
  std::size_t variable_count_ = 0;
  /// Rows per chunk.
  std::size_t row_count_ = 0;
  std::size_t action_count_ = 0;
  std::size_t kept_steps_ = 0;
  /// Whether steps prefetch: only worthwhile if there is much to read.
  bool asks_ahead_ = false;
  std::size_t observation_size_ = 0;
  std::size_t body_count_ = 0;
  std::pmr::vector<Env> envs_{&memory_};
  std::pmr::vector<EnvCounters> counters_{&memory_};
  std::pmr::vector<MoveCounters> moves_{&memory_};
  std::pmr::vector<Held> held_{&memory_};
  std::pmr::vector<RestingObjects> resting_{&memory_};
  std::pmr::vector<Pose> objects_{&memory_};
  std::pmr::vector<std::uint64_t> ignored_{&memory_};
  std::pmr::vector<std::uint64_t> leaving_{&memory_};
  /// Chunk after chunk, so that a step reads them as one stream: x, y, z, yaw, variables and grip
  /// of its envs, then goals, targets, where targets were at the start, last actions and, if the
  /// model has it, odometry.
  std::pmr::vector<EnvRow> rows_{&memory_};
  /// Shape: chunks x kept steps x actions.
  std::pmr::vector<EnvRow> kept_actions_{&memory_};
  std::pmr::vector<float> observations_{&memory_};
  std::pmr::vector<float> final_observations_{&memory_};
  std::pmr::vector<RigidTransform> bodies_{&memory_};
  std::pmr::vector<float> rewards_{&memory_};
  std::pmr::vector<std::uint8_t> dones_{&memory_};
  std::pmr::vector<std::uint8_t> successes_{&memory_};
  std::pmr::vector<EpisodeEnd> endings_{&memory_};
  std::pmr::vector<std::uint8_t> picks_{&memory_};
  std::pmr::vector<std::uint8_t> idle_{&memory_};
};

}  // namespace galactic::simulation
