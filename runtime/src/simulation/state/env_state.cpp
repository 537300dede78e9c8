#include "simulation/state/env_state.h"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

#include "simulation/state/grip_frame.h"
#include "simulation/state/plain_numbers.h"

namespace galactic::simulation {
namespace {

std::string faultIn(std::string_view field, const Vec3& v) {
  return fmt::format("has {} ({:g}, {:g}, {:g}), expected finite numbers of at most {:g} m", field,
                     v.x, v.y, v.z, kLargestPlain);
}

/// Describes the fault of a pose that is not plain.
std::string faultIn(std::string_view field, const Pose& pose) {
  if (!isPlain(pose.translation)) {
    return faultIn(fmt::format("{}.translation", field), pose.translation);
  }
  const Quat& q = pose.rotation;
  return fmt::format(
      "has {}.rotation ({:g}, {:g}, {:g}, {:g}), expected a unit quaternion: w, x, y, z", field,
      q.w, q.x, q.y, q.z);
}

}  // namespace

EnvObjects envObjectsOf(const Model& model, const BatchState& state, std::size_t n) noexcept {
  const Env& env = state.env(n);
  EnvObjects result{.scene = env.scene,
                    .episode = model.starts[env.start].episode,
                    .present = model.present(model.episodeOf(env.start)),
                    .objects = state.objects(n).first(env.objects),
                    .held = env.held,
                    .world_from_held = {},
                    .has_picked = env.has_picked,
                    .goal = {state.goal(n), model.episodeOf(env.start).goal.rotation}};
  if (env.held >= 0) result.world_from_held = state.heldPose(n);
  return result;
}

EnvState envStateOf(const Model& model, const BatchState& state, std::size_t n) {
  const Env& env = state.env(n);
  const EnvObjects objects = envObjectsOf(model, state, n);
  const Vec3 base = state.base(n);
  EnvState result;
  result.scene = objects.scene;
  result.episode = objects.episode;
  result.step = env.step;
  result.world_from_root = {{base.x, base.y + model.motion.base.root_height, base.z},
                            rotationOfYaw(state.yaw(n))};
  const std::span<const float> start = model.world->robot().startPositions();
  result.joint_positions.assign(start.begin(), start.end());
  for (std::size_t v = 0; v < model.variableCount(); ++v) {
    result.joint_positions[model.motion.variables[v].position] = state.variable(v, n);
  }
  result.world_from_grip = gripPose(state.grip(n));
  result.objects.assign(objects.objects.begin(), objects.objects.end());
  result.held = objects.held;
  if (objects.held >= 0) {
    result.objects[static_cast<std::size_t>(objects.held)] = objects.world_from_held;
  }
  result.target = env.target;
  result.goal = objects.goal;
  result.begun = state.counters(n).begun;
  return result;
}

std::string faultOfNumbers(const FollowedState& state) {
  if (!isPlain(state.world_from_root)) return faultIn("world_from_root", state.world_from_root);
  for (std::size_t n = 0; n < state.joint_positions.size(); ++n) {
    if (isPlain(state.joint_positions[n])) continue;
    return fmt::format("has joint_positions[{}] {:g}, expected a finite number of at most {:g}", n,
                       state.joint_positions[n], kLargestPlain);
  }
  for (std::size_t n = 0; n < state.objects.size(); ++n) {
    if (isPlain(state.objects[n])) continue;
    return faultIn(fmt::format("objects[{}]", n), state.objects[n]);
  }
  return {};
}

std::string faultOfNumbers(const EnvState& state) {
  std::string fault = faultOfNumbers(FollowedState{.world_from_root = state.world_from_root,
                                                   .joint_positions = state.joint_positions,
                                                   .objects = state.objects});
  if (!fault.empty()) return fault;
  if (!isPlain(state.goal.translation)) {
    return faultIn("goal.translation", state.goal.translation);
  }
  if (state.held >= 0 && !isPlain(state.world_from_grip)) {
    return faultIn("world_from_grip", state.world_from_grip);
  }
  return {};
}

}  // namespace galactic::simulation
