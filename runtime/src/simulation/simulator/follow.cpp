#include "simulation/simulator/follow.h"

#include <algorithm>

#include "simulation/phases/action_delay.h"
#include "simulation/phases/hand.h"
#include "simulation/phases/move.h"
#include "simulation/phases/step.h"
#include "simulation/state/grip_frame.h"

namespace galactic::simulation {
namespace {

/// Makes a candidate of the state's root, upright, and joints.
void propose(const ChunkStep& step, std::size_t e, const FollowedState& state) {
  const PoseArrays to = step.chunk.candidates(e);
  const Pose& root = state.world_from_root;
  *to.x = root.translation.x;
  *to.y = root.translation.y - step.model.motion.base.root_height;
  *to.z = root.translation.z;
  *to.yaw = yawOf(root.rotation);
  for (std::size_t v = 0; v < step.model.variableCount(); ++v) {
    to.variables[v * to.stride] = state.joint_positions[step.model.motion.variables[v].position];
  }
}

/// Makes a candidate of the current pose of an env that does not follow: forward kinematics reads
/// all envs of the chunk.
void proposeCurrent(const ChunkStep& step, std::size_t e) {
  copyPose(step.state.poses(step.first + e), step.chunk.candidates(e), step.model.variableCount());
}

/// Grasps and releases as the hand did. Call after the objects have been moved.
void followHand(const ChunkStep& step, std::size_t e, const FollowedState& state) {
  const std::size_t n = step.first + e;
  Env& env = step.state.env(n);
  const std::size_t terminate = step.model.actionLayout().terminate();
  env.events = {.terminates =
                    arrivedOf(step)[terminate].values[e] >= step.model.options.action.terminate};
  if (env.held >= 0 && env.held != state.held) {
    layDown(step, e, state.objects[static_cast<std::size_t>(env.held)]);
    ++step.state.counters(n).drops;
  }
  if (state.held < 0) return;
  const auto held = static_cast<std::uint32_t>(state.held);
  if (env.held < 0) takeInHand(step, e, held);
  // The object may slip in the hand.
  step.state.held(n).grip_from_object = inverse(gripPose(step.state.grip(n))) * state.objects[held];
  measureHeld(heldModel(step.model, env), step.state.held(n));
}

void takePose(const ChunkStep& step, std::size_t e, const FollowedState& state) {
  const std::size_t n = step.first + e;
  step.state.env(n).refused = state.was_hindered;
  step.state.env(n).knocked = false;
  step.state.moves(n).refused += state.was_hindered ? 1U : 0U;
  copyPose(step.chunk.candidates(e), step.state.poses(n), step.model.variableCount());
  step.state.setGrip(n, step.chunk.grip(e));
}

}  // namespace

void followChunk(const ChunkStep& step, std::span<const float> actions,
                 std::span<const FollowedState> states) noexcept {
  readActions(step, actions);
  keepActions(step);
  const auto is_followed = [&](std::size_t e) {
    const std::size_t n = step.first + e;
    return n < states.size() && step.state.idle()[n] == 0;
  };
  for (std::size_t e = 0; e < kChunk; ++e) {
    if (is_followed(e)) {
      propose(step, e, states[step.first + e]);
    } else {
      proposeCurrent(step, e);
    }
  }
  placeBodies(step);
  EnvMask followed{};
  for (std::size_t e = 0; e < kChunk; ++e) {
    if (!is_followed(e)) continue;
    takePose(step, e, states[step.first + e]);
    followed[e] = ~std::uint32_t{0};
  }
  keepBodies(step, followed);
  // A release overwrites candidates, so this loop runs after all of them have been taken.
  for (std::size_t e = 0; e < kChunk; ++e) {
    if (!is_followed(e)) continue;
    const std::size_t n = step.first + e;
    const FollowedState& state = states[n];
    restObjects(step.model, step.state, n, state.objects, step.state.env(n).held);
    followHand(step, e, state);
  }
  finishStep(step, {});
}

}  // namespace galactic::simulation
