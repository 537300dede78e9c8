#include "simulation/phases/observe.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "simulation/phases/robot_noise.h"
#include "simulation/phases/task.h"
#include "simulation/state/env_moment.h"
#include "simulation/state/episode_draws.h"
#include "simulation/state/grip_frame.h"
#include "support/random_stream.h"

namespace galactic::simulation {
namespace {

/// Appends numbers to a row.
class Row {
 public:
  explicit Row(std::span<float> out) : next_(out.data()) {}

  void add(float value) { *next_++ = value; }

 private:
  float* next_;
};

/// A direction along the floor in the robot's frame: ahead, and to the left.
std::array<float, 2> seenByRobot(const GripFrame& grip, float x, float z) {
  const float cosine = headingCosine(grip);
  const float sine = headingSine(grip);
  return {cosine * x - sine * z, -(sine * x + cosine * z)};
}

/// Where that side of the target points that was up when the episode began, in the robot's frame.
void senseUp(const Model& model, const BatchState& state, std::size_t n, std::span<float> part) {
  const Vec3 up = targetUp(model, state, n);
  const auto [ahead, left] = seenByRobot(state.grip(n), up.x, up.z);
  Row out(part);
  out.add(ahead);
  out.add(up.y);
  // The axes of the base: Z is to the right.
  out.add(-left);
}

/// The resting objects nearest to a point, the nearest first: the ways from there to their boxes.
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
    /// Where there is no object so near: above all of them.
    Vec3 way{0, kFarthestSeen, 0};
  };

  std::size_t count_;
  std::array<Way, kMostNearObjects> ways_{};
};

/// The ways from the hand to the objects nearest to it but the target.
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

/// The ways to target and goal.
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

/// What was asked for in the last steps, the latest first.
void senseLastActions(const Model& model, const BatchState& state, std::size_t n,
                      std::span<float> part) {
  const std::size_t next_step = state.env(n).step + state.keptSteps();
  Row out(part);
  for (std::size_t ago = 1; ago <= model.options.sensors.last_actions; ++ago) {
    for (const EnvRow& action : state.keptActions(n, next_step - ago)) {
      const float value = action.values[n % kChunk];
      // Hands and terminations of steps before the episode.
      out.add(std::isnan(value) ? 0 : value);
    }
  }
}

/// Room for points as robots see them that know by odometry alone where they are.
class BelievedPoints {
 public:
  /// They take the place of those of a batch.
  void put(const BatchState& state, std::size_t first, ObserveBatch& batch) {
    const bool is_one_target = batch.targets == batch.current_targets;
    copy(batch.goals, goals_);
    displace(state, first, goals_);
    batch.goals = goals_.front().values;
    copy(batch.current_targets, current_);
    displace(state, first, current_);
    // What is in the hand is where the hand is.
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

std::vector<ObservationPart> observationParts(std::size_t joints, const SensorSizes& sensors) {
  std::vector<ObservationPart> parts;
  std::size_t first = 0;
  const auto add = [&](const char* name, std::size_t size) {
    parts.push_back({name, first, size});
    first += size;
  };
  add("robot_target", 3);
  add("grip_target", 3);
  add("robot_grip", 3);
  add("robot_goal", 3);
  add("grip_goal", 3);
  add("is_holding", 1);
  add("joints", joints);
  add("time", 3);
  if (sensors.bump != 0) add("bump", sensors.bump);
  if (sensors.target_goal != 0) add("target_goal", sensors.target_goal);
  if (sensors.target_up != 0) add("target_up", sensors.target_up);
  if (sensors.near_objects != 0) add("near_objects", sensors.near_objects);
  if (sensors.laser != 0) add("laser", sensors.laser);
  if (sensors.geodesic != 0) add("geodesic", sensors.geodesic);
  if (sensors.last_actions != 0) add("last_actions", sensors.last_actions);
  return parts;
}

std::size_t sensedSize(const SensorSizes& sensors) {
  return sensors.target_up + sensors.near_objects + sensors.laser + sensors.geodesic +
         sensors.last_actions;
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

void sense(const Model& model, const BatchState& state, std::size_t env_number,
           std::span<float> out) noexcept {
  // Apart from the numbers that place objects.
  constexpr std::uint64_t kLaserSalt = 0x6C617365722D2D31ULL;
  if (model.sensors_first == out.size()) return;
  const Env& env = state.env(env_number);
  const GripFrame grip = state.grip(env_number);
  std::span<float> rest = out.subspan(model.sensors_first);
  // The parts in the order of observationParts.
  const auto next = [&](std::size_t size) {
    const std::span<float> part = rest.first(size);
    rest = rest.subspan(size);
    return part;
  };
  const SensorOptions& sensors = model.options.sensors;
  const EnvMoment moment = momentOf(model, state, env_number);
  if (sensors.target_up) senseUp(model, state, env_number, next(kTargetUpSize));
  if (sensors.near_objects != 0) {
    senseNearObjects(model, state, env_number, next(kWaySize * sensors.near_objects));
  }
  model.laser.scan(
      {.scene = env.scene,
       .base = state.base(env_number),
       .cosine = headingCosine(grip),
       .sine = headingSine(grip),
       .objects = state.resting(env_number),
       .noise = drawnIn(moment, model.laser.noise(), kLaserDraw),
       .random = RandomStream(moment.seed ^ kLaserSalt, moment.env, moment.episode, moment.step)},
      next(model.laser.size()));
  if (sensors.geodesic) senseWays(model, state, env_number, next(sensors::kGeodesicSize));
  if (sensors.last_actions != 0) {
    senseLastActions(model, state, env_number, next(model.actionCount() * sensors.last_actions));
  }
  assert(rest.empty());
}

void senseAll(const ChunkStep& step) noexcept {
  if (step.model.sensors_first == step.model.observation_size) return;
  for (std::size_t e = 0; e < kChunk; ++e) {
    const std::size_t n = step.first + e;
    sense(step.model, step.state, n, step.state.observation(n));
  }
}

}  // namespace galactic::simulation
