#include "simulation/phases/observe.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "simulation/phases/robot_noise.h"
#include "simulation/phases/task.h"
#include "simulation/state/env_moment.h"
#include "simulation/state/episode_draws.h"
#include "simulation/state/grip_frame.h"
#include "support/random_stream.h"

namespace galactic::simulation {
namespace {

/// Objects further from the hand than this are not observed, meters.
constexpr float kFarthestSeen = 1;

/// Appends numbers to a row.
class Row {
 public:
  explicit Row(std::span<float> out) : next_(out.data()) {}

  void add(float value) { *next_++ = value; }

 private:
  float* next_;
};

/// Turns a direction along the floor into the robot's frame: ahead, and to the left.
std::array<float, 2> seenByRobot(const GripFrame& grip, float x, float z) {
  const float cosine = headingCosine(grip);
  const float sine = headingSine(grip);
  return {cosine * x - sine * z, -(sine * x + cosine * z)};
}

/// The current direction of the side of the target that was up when the episode began, in the
/// robot's frame.
void senseUp(const Model& model, const BatchState& state, std::size_t n, std::span<float> part) {
  const Vec3 up = targetUp(model, state, n);
  const auto [ahead, left] = seenByRobot(state.grip(n), up.x, up.z);
  Row out(part);
  out.add(ahead);
  out.add(up.y);
  // In the base's frame, Z points to the right.
  out.add(-left);
}

/// Vectors from a point to the boxes of the resting objects nearest to it, the nearest first.
class NearestWays {
 public:
  explicit NearestWays(std::size_t count) : count_(count) {}

  void add(const Vec3& way) {
    const float squared = dot(way, way);
    if (!(squared < ways_[count_ - 1].squared)) return;
    std::size_t at = count_ - 1;
    for (; at > 0 && squared < ways_[at - 1].squared; --at) ways_[at] = ways_[at - 1];
    ways_[at] = {squared, way};
  }

  [[nodiscard]] const Vec3& operator[](std::size_t n) const { return ways_[n].way; }

 private:
  struct Way {
    float squared = kFarthestSeen * kFarthestSeen;
    /// Stands for an object if there are too few within reach: straight up, as far as the farthest.
    Vec3 way{0, kFarthestSeen, 0};
  };

  std::size_t count_;
  std::array<Way, kMostNearObjects> ways_{};
};

/// Writes the vectors from the hand to the objects nearest to it, without the target.
void senseNearObjects(const Model& model, const BatchState& state, std::size_t n,
                      std::span<float> part) {
  const std::size_t count = model.options.sensors.near_objects;
  const Env& env = state.env(n);
  const GripFrame grip = state.grip(n);
  const Vec3 hand = gripOrigin(grip);
  const RestingObjects& resting = state.resting(n);
  NearestWays nearest(count);
  for (std::uint32_t object = 0; object < env.objects; ++object) {
    if (object == env.target || !resting.isResting(object)) continue;
    nearest.add(nearestPoint(resting.box(object), hand) - hand);
  }
  Row out(part);
  for (std::size_t at = 0; at < count; ++at) {
    const Vec3& way = nearest[at];
    const auto [ahead, left] = seenByRobot(grip, way.x, way.z);
    out.add(ahead);
    out.add(way.y);
    out.add(-left);
  }
}

/// Writes the laser's distances to its surroundings.
void senseLaser(const Model& model, const BatchState& state, std::size_t n, std::span<float> part) {
  // Separates these random numbers from those that place objects.
  constexpr std::uint64_t kLaserSalt = 0x6C617365722D2D31ULL;
  const GripFrame grip = state.grip(n);
  const EnvMoment moment = momentOf(model, state, n);
  model.laser.scan(
      {.scene = state.env(n).scene,
       .base = state.base(n),
       .cosine = headingCosine(grip),
       .sine = headingSine(grip),
       .objects = state.resting(n),
       .noise = drawnIn(moment, model.laser.noise(), kLaserDraw),
       .random = RandomStream(moment.seed ^ kLaserSalt, moment.env, moment.episode, moment.step)},
      part);
}

/// Writes length and direction of the ways to target and goal.
void senseWays(const Model& model, const BatchState& state, std::size_t n, std::span<float> part) {
  const Env& env = state.env(n);
  const GripFrame grip = state.grip(n);
  Row out(part);
  const auto add = [&](const sensors::Way& way) {
    out.add(way.distance);
    const auto [ahead, left] = seenByRobot(grip, way.x, way.z);
    out.add(ahead);
    out.add(left);
  };
  const Vec3 base = state.base(n);
  const Vec3 target = state.objects(n)[env.target].translation;
  add(holdsTarget(env) ? sensors::Way{.distance = 0}
                       : model.geodesic.toTarget(env.start, base, target));
  add(model.geodesic.toGoal(env.start, base));
}

/// Writes the actions that were asked for in the last steps, the latest first.
void senseLastActions(const Model& model, const BatchState& state, std::size_t n,
                      std::span<float> part) {
  const std::size_t next_step = state.env(n).step + state.keptSteps();
  Row out(part);
  for (std::size_t ago = 1; ago <= model.options.sensors.last_actions; ++ago) {
    for (const EnvRow& action : state.keptActions(n, next_step - ago)) {
      const float value = action.values[n % kChunk];
      // NaN: the hand and terminate actions of steps before the episode.
      out.add(std::isnan(value) ? 0 : value);
    }
  }
}

/// Everything that the sizes of parts depend on.
struct Asked {
  const SensorOptions& sensors;
  std::size_t joints = 0;
  std::size_t actions = 0;
  /// Elements of a laser scan.
  std::size_t laser = 0;
};

/// A part of an observation.
struct ObservedPart {
  const char* name;
  /// Its number of elements; 0 if it is not observed.
  std::size_t (*size)(const Asked& asked);
  /// See SensedPart. Null if the kernels write it.
  void (*write)(const Model& model, BatchState& state, EnvRange envs,
                const SensedPart& part) = nullptr;
};

/// Writes a part for several envs with a function that writes it for one.
template <auto kSense>
void each(const Model& model, BatchState& state, EnvRange envs, const SensedPart& part) {
  for (std::size_t n = envs.first; n < envs.first + envs.count; ++n) {
    kSense(model, state, n, state.observation(n).subspan(part.first, part.size));
  }
}

template <std::size_t kCount>
std::size_t always(const Asked& /*asked*/) {
  return kCount;
}

template <std::size_t kCount, bool SensorOptions::*kOption>
std::size_t where(const Asked& asked) {
  return asked.sensors.*kOption ? kCount : 0;
}

/// All parts, in their order in a row. The kernels write the first ones, whose order here must be
/// the kernels'.
constexpr std::array kParts{
    ObservedPart{"robot_target", always<3>},
    ObservedPart{"grip_target", always<3>},
    ObservedPart{"robot_grip", always<3>},
    ObservedPart{"robot_goal", always<3>},
    ObservedPart{"grip_goal", always<3>},
    ObservedPart{"is_holding", always<1>},
    ObservedPart{"joints", [](const Asked& asked) { return asked.joints; }},
    ObservedPart{"time", always<3>},
    ObservedPart{"bump", where<1, &SensorOptions::bump>},
    ObservedPart{"target_goal", where<3, &SensorOptions::target_goal>},
    ObservedPart{"target_up", where<3, &SensorOptions::target_up>, each<senseUp>},
    ObservedPart{"near_objects",
                 [](const Asked& asked) { return std::size_t{3} * asked.sensors.near_objects; },
                 each<senseNearObjects>},
    ObservedPart{"laser", [](const Asked& asked) { return asked.laser; }, each<senseLaser>},
    ObservedPart{"geodesic", where<sensors::kGeodesicSize, &SensorOptions::geodesic>,
                 each<senseWays>},
    ObservedPart{"last_actions",
                 [](const Asked& asked) { return asked.actions * asked.sensors.last_actions; },
                 each<senseLastActions>},
};

/// Points as seen by robots that know their place from odometry only.
class BelievedPoints {
 public:
  /// Replaces the points of a batch with the believed ones.
  void put(const BatchState& state, std::size_t first, ObserveBatch& batch) {
    const bool is_one_target = batch.targets == batch.current_targets;
    copy(batch.goals, goals_);
    displace(state, first, goals_);
    batch.goals = goals_.front().values;
    copy(batch.current_targets, current_);
    displace(state, first, current_);
    // A robot knows where the object in its hand is.
    for (std::size_t e = 0; e < kChunk; ++e) {
      const Env& env = state.env(first + e);
      if (!holdsTarget(env)) continue;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        current_[axis].values[e] = batch.current_targets[axis * kChunk + e];
      }
    }
    batch.current_targets = current_.front().values;
    if (is_one_target) {
      batch.targets = current_.front().values;
      return;
    }
    copy(batch.targets, starts_);
    displace(state, first, starts_);
    batch.targets = starts_.front().values;
  }

 private:
  static void copy(const float* from, PointRows& to) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::copy_n(from + axis * kChunk, kChunk, to[axis].values);
    }
  }

  PointRows goals_;
  PointRows current_;
  PointRows starts_;
};

}  // namespace

void layOutObservation(std::size_t laser_size, Model& model) {
  const Asked asked{.sensors = model.options.sensors,
                    .joints = model.motion.controlled.size(),
                    .actions = model.actionCount(),
                    .laser = laser_size};
  for (const ObservedPart& part : kParts) {
    const std::size_t size = part.size(asked);
    if (size == 0) continue;
    const std::size_t first = model.observation_size;
    model.observation.push_back({part.name, first, size});
    model.observation_size += size;
    if (part.write != nullptr) model.sensed.push_back({first, size, part.write});
  }
}

void observe(const Model& model, BatchState& state, std::size_t first) noexcept {
  const TaskOptions& task = model.options.task;
  const SensorOptions& sensors = model.options.sensors;
  EnvRow holds;
  EnvRow left;
  EnvRow bumps;
  for (std::size_t e = 0; e < kChunk; ++e) {
    const Env& env = state.env(first + e);
    holds.values[e] = env.held >= 0 ? 1.0F : 0.0F;
    bumps.values[e] = env.refused ? 1.0F : 0.0F;
    left.values[e] = task.most_steps == 0 ? 1.0F
                                          : 1.0F - static_cast<float>(env.step) /
                                                       static_cast<float>(task.most_steps);
  }
  const bool is_target_wanted =
      task.observes_current_target || sensors.target_goal || model.hasOdometry();
  PointRows now;
  if (is_target_wanted) now = targetsNow(state, first);
  ObserveBatch batch{
      .pose = state.poses(first),
      .controlled = model.motion.controlled.data(),
      .controlled_count = model.motion.controlled.size(),
      .grips = state.grips(first),
      .targets = task.observes_current_target ? now.front().values : state.targetStarts(first),
      .current_targets = now.front().values,
      .goals = state.goals(first),
      .holds = holds.values,
      .left = left.values,
      .bumps = bumps.values,
      .observes_bump = sensors.bump,
      .observes_target_goal = sensors.target_goal,
      .out = state.observation(first).data(),
      .out_stride = model.observation_size,
      .envs = kChunk};
  BelievedPoints believed;
  if (model.hasOdometry()) believed.put(state, first, batch);
  model.kernels.observe(batch);
}

void sense(const Model& model, BatchState& state, EnvRange envs) noexcept {
  for (const SensedPart& part : model.sensed) part.write(model, state, envs, part);
}

}  // namespace galactic::simulation
