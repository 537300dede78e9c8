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

/// Envs are stepped this many at a time, so that what they need stays in the nearest cache.
inline constexpr std::size_t kChunk = kMostWidth;

/// Rows of a base: x, y, z and yaw.
inline constexpr std::size_t kBaseRows = 4;

/// A point of each env of a chunk: rows of x, y and z.
using PointRows = std::array<EnvRow, 3>;

/// Where a base stands on its floor.
struct PlanarPose {
  float x = 0;
  float z = 0;
  float yaw = 0;
};

/// What a robot knows by odometry: where it was when it was last asked, and where it took itself to
/// be then.
struct Odometry {
  PlanarPose was;
  PlanarPose believed;
};
inline constexpr std::size_t kOdometryRows = sizeof(Odometry) / sizeof(float);

/// Of rows that begin with those of a base, and go on with variables.
[[nodiscard]] inline PoseArrays posesAt(float* x) {
  return {.x = x,
          .y = x + kChunk,
          .z = x + 2 * kChunk,
          .yaw = x + 3 * kChunk,
          .variables = x + kBaseRows * kChunk,
          .stride = kChunk};
}

/// What happened in one env; added up by SimulationStatistics. Apart from Env, because
/// many steps change nothing of it.
struct alignas(64) EnvCounters {
  /// Episodes begun, and those of them whose turn it was.
  std::uint64_t begun = 0;
  std::uint64_t turns = 0;
  std::uint32_t grasps = 0;
  std::uint32_t drops = 0;
  std::uint32_t restored = 0;
  std::uint32_t episodes = 0;
  std::uint32_t successes = 0;
  std::uint32_t failures = 0;
  std::uint64_t nan_actions = 0;
  /// Steps in which the env was idle.
  std::uint64_t idle_steps = 0;
  /// Episodes that ended and in which the target had been in the hand.
  std::uint32_t picks = 0;
  /// Whether the caller has named the episode that the env is in; else its turn had come.
  bool is_named = false;
};
static_assert(sizeof(EnvCounters) == 64);

/// How moves of an env ended; added up like EnvCounters. Apart from these, because robots that
/// drive slide in most steps: those of a chunk lie together.
struct MoveCounters {
  std::uint32_t refused = 0;
  std::uint32_t slid = 0;
};

/// The object in the hand of an env, if there is one.
struct Held {
  /// A ball around the centers of its spheres: center in the grip's frame, meters.
  Vec3 ball_center;
  float ball_radius = 0;
  /// Which radii of the working set its spheres have, as bits.
  std::uint32_t radii = 0;
  Pose grip_from_object;
};

/// What a step did that decides its reward and the episode's end.
struct StepEvents {
  /// The first time in the episode that the target is in the hand.
  bool picked = false;
  /// The target was released, and rests.
  bool released_target = false;
  /// The hand let go of the target and keeps it, as the task has it.
  bool kept_target = false;
  bool terminates = false;
};

/// What every step reads of one environment, apart from what the motion kernels do: one cache line.
struct alignas(64) Env {
  std::uint32_t scene = 0;
  /// In Model::clearance.
  std::uint32_t clearance_map = kNoClearanceMap;
  /// Index into Model::starts.
  std::uint32_t start = 0;
  std::uint32_t step = 0;
  std::uint32_t objects = 0;
  std::uint32_t target = 0;
  /// The object in the hand, counted in the episode; -1 for none.
  std::int32_t held = -1;
  /// Objects that the hand let go of and that some of the robot's spheres have penetrated since.
  /// Those spheres do not count against them until each is free of it once; else the hand could not
  /// leave them. BatchState::leaving() says which.
  std::uint32_t left = 0;
  /// Of the step before: grip to target, target to goal, meters.
  float reach = 0;
  float transport = 0;
  /// Of the step before, meters: along the floor to what mattered then, which was the goal or the
  /// target; below 0 where none is known.
  float way = -1;
  bool is_way_to_goal = false;
  /// Whether the target was in the hand before in this episode.
  bool has_picked = false;
  /// The last step left the robot where it was: wherever it would have been, it penetrated
  /// something.
  bool refused = false;
  /// The first thing in the way of the last step, or of a part of it, was an object at rest.
  bool knocked = false;
  /// Spheres of the object in the hand have penetrated something ever since it was taken, and do
  /// not count until each is free once. BatchState::ignored() says which.
  bool ignores = false;
  StepEvents events;
  /// Of all episodes.
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

/// Sets what is kept about the spheres of the object in the hand.
void measureHeld(const ObjectModel& object, Held& held) noexcept;

class BatchState;

/// From now on an object of env `n`, which rests elsewhere or is on its way from the hand, rests at
/// `world_from_object`: its pose, and what is in the robot's way.
void restObject(const Model& model, BatchState& state, std::size_t n, std::uint32_t object,
                const Pose& world_from_object) noexcept;
/// The same for all objects of the env that rest and do not rest there yet: `held` does not.
void restObjects(const Model& model, BatchState& state, std::size_t n, std::span<const Pose> poses,
                 std::int32_t held) noexcept;

/// What a BatchState of so many envs allocates, about.
[[nodiscard]] std::size_t stateBytes(const Model& model, std::size_t envs);

/// Everything that changes in a run: N envs, padded to whole chunks with envs that nobody sees.
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
  /// Of the object in the hand of an env, which must hold one.
  [[nodiscard]] Held& held(std::size_t n) { return held_[n]; }
  [[nodiscard]] const Held& held(std::size_t n) const { return held_[n]; }
  /// Where the object in the hand of an env is: world_from_object.
  [[nodiscard]] Pose heldPose(std::size_t n) const {
    return gripPose(grip(n)) * held_[n].grip_from_object;
  }
  /// Its origin alone.
  [[nodiscard]] Vec3 heldOrigin(std::size_t n) const {
    return gripToWorld(grip(n), held_[n].grip_from_object.translation);
  }
  [[nodiscard]] RestingObjects& resting(std::size_t n) { return resting_[n]; }
  [[nodiscard]] const RestingObjects& resting(std::size_t n) const { return resting_[n]; }
  /// World poses of the episode's objects; that of a held one is where it was grasped.
  [[nodiscard]] std::span<const Pose> objects(std::size_t n) const {
    return std::span(objects_).subspan(n * most_objects_, most_objects_);
  }
  /// Every change of an object's pose comes through here. That an object rests somewhere else is
  /// restObject()'s to say, which lets the robot meet it there, too.
  void setObjectPose(std::size_t n, std::size_t object, const Pose& world_from_object) {
    objects_[n * most_objects_ + object] = world_from_object;
    if (object == envs_[n].target) setPoint(targetRow(), n, world_from_object.translation);
  }
  /// Which object is the target, and where it is to go. The objects are where the episode begins.
  void setErrand(std::size_t n, std::uint32_t target, const Vec3& goal) {
    envs_[n].target = target;
    setPoint(goalRow(), n, goal);
    setPoint(targetRow(), n, objects(n)[target].translation);
    setPoint(targetStartRow(), n, objects(n)[target].translation);
  }
  [[nodiscard]] Vec3 goal(std::size_t n) const { return point(goalRow(), n); }
  /// Where the target was when the episode began.
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
  /// Spheres of the held object that do not count yet.
  [[nodiscard]] std::span<std::uint64_t> ignored(std::size_t n) {
    return std::span(ignored_).subspan(n * held_words_, held_words_);
  }
  /// Spheres of the robot that do not count against a resting object yet: an object that the hand
  /// let go of.
  [[nodiscard]] std::span<std::uint64_t> leaving(std::size_t n, std::size_t object) {
    return std::span(leaving_).subspan((n * most_objects_ + object) * body_words_, body_words_);
  }
  [[nodiscard]] std::span<const std::uint64_t> ignored(std::size_t n) const {
    return std::span(ignored_).subspan(n * held_words_, held_words_);
  }
  /// Those of all objects. Shape: objects x words.
  [[nodiscard]] std::span<const std::uint64_t> leaving(std::size_t n) const {
    return std::span(leaving_).subspan(n * most_objects_ * body_words_,
                                       most_objects_ * body_words_);
  }
  [[nodiscard]] std::span<std::uint64_t> leaving(std::size_t n) {
    return std::span(leaving_).subspan(n * most_objects_ * body_words_,
                                       most_objects_ * body_words_);
  }
  /// The action of the step before.
  [[nodiscard]] float lastAction(std::size_t joint, std::size_t n) const {
    return *number(lastActionRow() + joint, n);
  }
  void setLastAction(std::size_t joint, std::size_t n, float action) {
    *number(lastActionRow() + joint, n) = action;
  }
  /// Only where Model::hasOdometry().
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
  /// Of how many steps, the last ones, actions are kept (Model::keptSteps()): 0 where nobody wants
  /// them, and then nobody may ask for any.
  [[nodiscard]] std::size_t keptSteps() const { return kept_steps_; }
  /// What the envs of a chunk from `first` on were asked to do in one of these steps. A step of an
  /// env's episode counts modulo keptSteps(): the last one is so many before the next. Shape:
  /// actions.
  [[nodiscard]] std::span<EnvRow> keptActions(std::size_t first, std::size_t step) {
    return std::span(kept_actions_).subspan(keptRow(first, step), action_count_);
  }
  [[nodiscard]] std::span<const EnvRow> keptActions(std::size_t first, std::size_t step) const {
    return std::span(kept_actions_).subspan(keptRow(first, step), action_count_);
  }
  /// Base and variables of the envs of a chunk from `first` on.
  [[nodiscard]] PoseArrays poses(std::size_t first) { return posesAt(number(0, first)); }
  [[nodiscard]] float variable(std::size_t v, std::size_t n) const {
    return *number(kBaseRows + v, n);
  }
  [[nodiscard]] Vec3 base(std::size_t n) const { return point(0, n); }
  [[nodiscard]] float yaw(std::size_t n) const { return *number(3, n); }
  [[nodiscard]] PlanarPose planarPose(std::size_t n) const {
    return {base(n).x, base(n).z, yaw(n)};
  }

  /// Rows of the chunk whose first env is `first`: what changes with the pose of the robot, which
  /// is base, variables and grip; the parts of it; the points that matter; the joint actions of the
  /// step before.
  [[nodiscard]] std::span<EnvRow> poseRows(std::size_t first) {
    return std::span(rows_).subspan(first / kChunk * row_count_, goalRow());
  }
  [[nodiscard]] const float* grips(std::size_t first) const { return number(gripRow(), first); }
  [[nodiscard]] const float* goals(std::size_t first) const { return number(goalRow(), first); }
  /// Where the target rests, or rested before it was grasped.
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
  /// The last observation of an episode that has ended becomes the final one.
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
  /// Root and nodes of the robot; empty where the run does not want them.
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
  /// Env::has_picked where the last step ended an episode; 0 elsewhere.
  [[nodiscard]] std::span<std::uint8_t> picks() { return picks_; }
  [[nodiscard]] std::span<const std::uint8_t> picks() const { return picks_; }
  /// 1 where an env has had all its episodes, or waits for a reset; see BatchSimulator::idle().
  [[nodiscard]] std::span<std::uint8_t> idle() { return idle_; }
  [[nodiscard]] std::span<const std::uint8_t> idle() const { return idle_; }
  /// As after a step in which no episode ended and nothing was earned.
  void clearOutcome(std::size_t n) {
    rewards_[n] = 0;
    dones_[n] = 0;
    successes_[n] = 0;
    endings_[n] = EpisodeEnd::kNone;
    picks_[n] = 0;
  }
  [[nodiscard]] std::size_t bytes() const;

  /// Asks the memory for what a step of an env reads and writes: a chunk ahead, it is there in
  /// time. There may be no such env. Reads nothing of it: another thread may be at work on it.
  void prefetch(std::size_t n) const noexcept;
  /// The same for what a chunk from env `first` on has in a few lines of its own.
  void prefetchChunk(std::size_t first) const noexcept;
  /// The same for bounds of the objects of a chunk, which its envs know where they are: when its
  /// step begins.
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

  /// All vectors are made once, one after the other, in here.
  std::pmr::monotonic_buffer_resource memory_;
  /// For the bounds that resting objects have where envs do not share them: together, apart from
  /// what is rarely read, so that a step reads them as one stream.
  std::pmr::monotonic_buffer_resource bounds_memory_;
  std::size_t env_count_ = 0;
  std::size_t most_objects_ = 0;
  std::size_t held_words_ = 0;
  std::size_t body_words_ = 0;
  std::size_t variable_count_ = 0;
  /// Of a chunk.
  std::size_t row_count_ = 0;
  std::size_t action_count_ = 0;
  std::size_t kept_steps_ = 0;
  /// Whether steps ask the memory ahead: where there is much to read.
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
  /// of its envs, then goals, targets, where targets were at the start, and last actions; at the
  /// end odometry, where there is any.
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
