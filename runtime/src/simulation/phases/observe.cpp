#include "simulation/phases/observe.h"

#include <algorithm>

#include "simulation/phases/task.h"
#include "simulation/state/grip_frame.h"
#include "support/random_stream.h"

namespace galactic::simulation {
namespace {

/// Appends numbers to a row.
class Row {
 public:
  explicit Row(std::span<float> out) : next_(out.data()) {}

  void add(float value) { *next_++ = value; }
  void add(const Vec3& v) {
    add(v.x);
    add(v.y);
    add(v.z);
  }

 private:
  float* next_;
};

/// The frame of the base: on the floor under the root, turned by the yaw only.
struct RobotFrame {
  Vec3 base;
  float sine = 0;
  float cosine = 1;

  [[nodiscard]] Vec3 fromWorld(const Vec3& point) const {
    const Vec3 away = point - base;
    return {cosine * away.x - sine * away.z, away.y, sine * away.x + cosine * away.z};
  }
};

/// The ways to target and goal, at the end of the row.
void senseWays(const Model& model, const BatchState& state, std::size_t n, std::span<float> row) {
  const Env& env = state.env(n);
  const GripFrame& grip = state.grip(n);
  const RobotFrame robot{{}, headingSine(grip), headingCosine(grip)};
  Row out(row.last(sensors::kGeodesicSize));
  const auto add = [&](const sensors::Way& way) {
    const Vec3 direction = robot.fromWorld({way.x, 0, way.z});
    out.add(way.distance);
    out.add(direction.x);
    // The sine of the angle to the left.
    out.add(-direction.z);
  };
  const Vec3 base = state.base(n);
  const bool is_held = env.held.object == static_cast<std::int32_t>(env.target);
  const Vec3 target = state.objects(n)[env.target].translation;
  add(is_held ? sensors::Way{.distance = 0} : model.geodesic.toTarget(env.start, base, target));
  add(model.geodesic.toGoal(env.start, base));
}

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
  if (sensors.laser != 0) add("laser", sensors.laser);
  if (sensors.geodesic != 0) add("geodesic", sensors.geodesic);
  return parts;
}

void observe(const Model& model, const BatchState& state, std::size_t env_number,
             std::span<float> out) noexcept {
  const Env& env = state.env(env_number);
  const GripFrame& grip = state.grip(env_number);
  const RobotFrame robot{state.base(env_number), headingSine(grip), headingCosine(grip)};
  const TaskOptions& task = model.options.task;
  const Vec3 target =
      task.observes_current_target ? measureTarget(state, env_number).target : env.target_start;
  Row row(out);
  row.add(robot.fromWorld(target));
  row.add(worldToGrip(grip, target));
  row.add(robot.fromWorld(gripOrigin(grip)));
  row.add(robot.fromWorld(env.goal));
  row.add(worldToGrip(grip, env.goal));
  row.add(env.held.object >= 0 ? 1.0F : 0.0F);
  for (const std::uint32_t variable : model.motion.controlled) {
    row.add(state.variable(variable, env_number));
  }
  const float left = task.most_steps == 0 ? 1.0F
                                          : 1.0F - static_cast<float>(env.step) /
                                                       static_cast<float>(task.most_steps);
  for (const float scale : {1.0F, 5.0F, 50.0F}) row.add(std::min(1.0F, scale * left));
  if (model.options.sensors.bump) row.add(env.refused ? 1.0F : 0.0F);
  if (model.options.sensors.target_goal) {
    const RobotFrame turned{{}, robot.sine, robot.cosine};
    row.add(turned.fromWorld(env.goal - measureTarget(state, env_number).target));
  }
}

void observeAll(const ChunkStep& step) noexcept {
  for (std::size_t e = 0; e < kChunk; ++e) {
    const std::size_t n = step.first + e;
    observe(step.model, step.state, n, step.state.observation(n));
  }
}

void sense(const Model& model, const BatchState& state, std::size_t env_number,
           std::span<float> out) noexcept {
  // Apart from the numbers that place objects.
  constexpr std::uint64_t kLaserSalt = 0x6C617365722D2D31ULL;
  if (model.sensors_first == out.size()) return;
  const Env& env = state.env(env_number);
  const GripFrame& grip = state.grip(env_number);
  const std::span<float> row = out.subspan(model.sensors_first);
  if (model.options.sensors.geodesic) senseWays(model, state, env_number, row);
  model.laser.scan({.scene = env.scene,
                    .base = state.base(env_number),
                    .cosine = headingCosine(grip),
                    .sine = headingSine(grip),
                    .objects = state.resting(env_number),
                    .random = RandomStream(model.options.seed ^ kLaserSalt,
                                           model.globalEnv(env_number), env.ordinal, env.step)},
                   row.first(model.laser.size()));
}

void senseAll(const ChunkStep& step) noexcept {
  for (std::size_t e = 0; e < kChunk; ++e) {
    const std::size_t n = step.first + e;
    sense(step.model, step.state, n, step.state.observation(n));
  }
}

}  // namespace galactic::simulation
