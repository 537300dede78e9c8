#include <algorithm>

#include "simulation/phases/episode_start.h"
#include "simulation/simulator/saved_state.h"

namespace galactic::simulation {
namespace {

void restoreRobot(const Model& model, BatchState& state, std::size_t n, const SavedEnv& saved) {
  const PoseArrays to = state.poses(n);
  *to.x = saved.base.x;
  *to.y = saved.base.y;
  *to.z = saved.base.z;
  *to.yaw = saved.yaw;
  for (std::size_t v = 0; v < saved.variables.size(); ++v) {
    to.variables[v * to.stride] = saved.variables[v];
  }
  state.setGrip(n, saved.grip);
  if (model.hasOdometry()) state.setOdometry(n, {state.planarPose(n), saved.believed});
  if (!state.bodyTransforms(n).empty()) {
    std::ranges::copy(saved.bodies, state.bodyTransforms(n).begin());
  }
}

void restoreActions(const Model& model, BatchState& state, std::size_t n, const SavedEnv& saved) {
  const std::size_t actions = model.actionCount();
  for (std::size_t k = 0; k < saved.kept_actions.size(); ++k) {
    state.keptActions(n, saved.env.step + k / actions)[k % actions].values[n % kChunk] =
        saved.kept_actions[k];
  }
  for (std::size_t j = 0; j < saved.last_actions.size(); ++j) {
    state.setLastAction(j, n, saved.last_actions[j]);
  }
}

/// Restores the hand, and which spheres do not count yet.
void restoreHand(const Model& model, BatchState& state, std::size_t n, const SavedEnv& saved) {
  Env& env = state.env(n);
  env.held = saved.env.held;
  env.left = saved.env.left;
  state.held(n) = saved.held;
  if (env.held >= 0) measureHeld(heldModel(model, env), state.held(n));
  std::ranges::copy(saved.ignored, state.ignored(n).begin());
  env.ignores = env.held >= 0 && !isEmpty(saved.ignored);
  std::ranges::copy(saved.leaving, state.leaving(n).begin());
}

/// Call after restoreHand().
void restoreObjects(const Model& model, BatchState& state, std::size_t n, const SavedEnv& saved) {
  const Env& env = state.env(n);
  RestingObjects& resting = state.resting(n);
  for (std::uint32_t object = 0; object < env.objects; ++object) {
    const Pose& pose = saved.objects[object];
    const bool is_held = static_cast<std::int32_t>(object) == env.held;
    const bool has_moved = !(pose == state.objects(n)[object]);
    // Objects stay shared with other envs as long as none of them has moved.
    if (has_moved && !is_held) {
      restObject(model, state, n, object, pose);
      continue;
    }
    state.setObjectPose(n, object, pose);
    if (is_held) resting.remove(object);
  }
}

/// Restores the env's counters, and what its last step returned.
void restoreRecord(BatchState& state, std::size_t n, const SavedEnv& saved) {
  state.counters(n) = saved.counters;
  state.moves(n) = saved.moves;
  state.idle()[n] = saved.is_idle ? 1 : 0;
  state.rewards()[n] = saved.reward;
  state.endings()[n] = saved.ending;
  state.dones()[n] = saved.ending == EpisodeEnd::kNone ? 0 : 1;
  state.successes()[n] = saved.ending == EpisodeEnd::kSuccess ? 1 : 0;
  state.picks()[n] = saved.had_picked ? 1 : 0;
  std::ranges::copy(saved.final_observation, state.finalObservation(n).begin());
}

}  // namespace

void restoreEnv(const Model& model, BatchState& state, std::size_t n, const SavedEnv& saved) {
  // Sets everything that follows from the episode; the rest is restored below.
  beginEpisode(model, state, n, saved.env.start, EpisodeChoice::kDrawn);
  Env& env = state.env(n);
  env.step = saved.env.step;
  env.has_picked = saved.env.has_picked;
  env.refused = saved.env.refused;
  env.reward_sum = saved.env.reward_sum;
  restoreRobot(model, state, n, saved);
  restoreActions(model, state, n, saved);
  restoreHand(model, state, n, saved);
  state.setErrand(n, env.target, saved.goal);
  state.setTargetStart(n, saved.target_start);
  restoreObjects(model, state, n, saved);
  restoreRecord(state, n, saved);
  takeStock(model, state, n);
}

}  // namespace galactic::simulation
