#include "simulation/env_state.h"

#include <cmath>

#include "simulation/grip_frame.h"

namespace galactic::simulation {

EnvState envStateOf(const Model& model, const BatchState& state, std::size_t n) {
  const Env& env = state.env(n);
  const GripFrame& grip = state.grip(n);
  const Vec3 base = state.base(n);
  const float half_yaw = 0.5F * state.yaw(n);
  EnvState result;
  result.scene = env.scene;
  result.episode = model.starts[env.start].episode;
  result.step = env.step;
  result.world_from_root = {{base.x, base.y + model.motion.base.root_height, base.z},
                            {0, std::sin(half_yaw), 0, std::cos(half_yaw)}};
  const std::span<const float> start = model.world->robot().startPositions();
  result.joint_positions.assign(start.begin(), start.end());
  for (std::size_t v = 0; v < model.variableCount(); ++v) {
    result.joint_positions[model.motion.variables[v].position] = state.variable(v, n);
  }
  result.world_from_grip = gripPose(grip);
  const std::span<const Pose> objects = state.objects(n).first(env.objects);
  result.objects.assign(objects.begin(), objects.end());
  result.held = env.held.object;
  if (env.held.object >= 0) {
    result.objects[static_cast<std::size_t>(env.held.object)] =
        result.world_from_grip * env.held.grip_from_object;
  }
  result.target = env.target;
  result.goal = model.episodeOf(env.start).goal;
  return result;
}

}  // namespace galactic::simulation
