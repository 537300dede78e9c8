#include "simulation/phases/task.h"

#include <algorithm>
#include <cmath>

#include "simulation/state/grip_frame.h"

namespace galactic::simulation {
namespace {

float distance(const Vec3& a, const Vec3& b) {
  const Vec3 away = a - b;
  return std::sqrt(dot(away, away));
}

bool isHeld(const Env& env) { return env.held.object == static_cast<std::int32_t>(env.target); }

EpisodeEnd endOfRearrange(const TaskOptions& task, const Env& env, float transport) {
  const bool is_there = transport < task.success_distance && !isHeld(env);
  if (task.needs_terminate && env.events.terminates) {
    return is_there ? EpisodeEnd::kSuccess : EpisodeEnd::kWrongTerminate;
  }
  if (!task.needs_terminate && env.events.released_target && is_there) return EpisodeEnd::kSuccess;
  if (task.drop_fails && env.events.released_target && !is_there) return EpisodeEnd::kWrongRelease;
  return EpisodeEnd::kNone;
}

/// Sum of the squared changes of the joint actions, which become the last ones. None at the first
/// step of an episode, which has none before it.
float actionChange(std::span<const float> actions, std::span<float> last, bool is_first) {
  float sum = 0;
  for (std::size_t n = 0; n < last.size(); ++n) {
    const float change = actions[n] - last[n];
    sum += change * change;
    last[n] = actions[n];
  }
  return is_first ? 0 : sum;
}

float rewardOf(const TaskOptions& task, const Env& env, const TargetDistances& now,
               float action_change) {
  if (task.kind == TaskKind::kNone) return 0;
  const float pick = env.events.picked ? task.pick_reward : 0;
  return pick + task.reach_weight * (env.reach - now.reach) +
         task.transport_weight * (env.transport - now.transport) -
         task.action_weight * action_change - task.slack_penalty -
         (env.refused ? task.bump_penalty : 0.0F);
}

/// For the part of the way along the floor that is behind now. A step in which the way began to
/// lead elsewhere counts nothing, nor one from or to a place without a way.
float shapingOf(const TaskOptions& task, const Env& env, const WayLeft& way) {
  const bool is_one_way = env.is_way_to_goal == way.is_to_goal && env.way >= 0 && way.length >= 0;
  if (task.kind == TaskKind::kNone || !is_one_way) return 0;
  return task.geodesic_weight * (env.way - way.length);
}

}  // namespace

TargetDistances measureTarget(const BatchState& state, std::size_t env_number) noexcept {
  const Env& env = state.env(env_number);
  const GripFrame& grip = state.grip(env_number);
  const Vec3 target = isHeld(env) ? gripToWorld(grip, env.held.grip_from_object.translation)
                                  : state.objects(env_number)[env.target].translation;
  return {target, distance(gripOrigin(grip), target), distance(target, env.goal)};
}

EpisodeEnd endOf(const TaskOptions& task, const Env& env, float transport) noexcept {
  const bool holds_another = env.held.object >= 0 && !isHeld(env);
  EpisodeEnd end = EpisodeEnd::kNone;
  switch (task.kind) {
    case TaskKind::kRearrange:
      end = endOfRearrange(task, env, transport);
      break;
    case TaskKind::kMobilePick:
      if (isHeld(env)) end = EpisodeEnd::kSuccess;
      break;
    case TaskKind::kNone:
      break;
  }
  const bool fails = task.kind != TaskKind::kNone && task.drop_fails && holds_another;
  if (end == EpisodeEnd::kNone && fails) return EpisodeEnd::kWrongObject;
  const bool is_late = task.most_steps != 0 && env.step >= task.most_steps;
  return end == EpisodeEnd::kNone && is_late ? EpisodeEnd::kTimeOut : end;
}

WayLeft measureWay(const Model& model, const BatchState& state, std::size_t env_number) noexcept {
  if (model.options.task.geodesic_weight == 0) return {};
  const Env& env = state.env(env_number);
  const Vec3 base = state.base(env_number);
  if (isHeld(env)) return {model.geodesic.toGoal(env.start, base).distance, true};
  const Vec3 target = state.objects(env_number)[env.target].translation;
  return {model.geodesic.toTarget(env.start, base, target).distance, false};
}

void judge(const ChunkStep& step, std::span<const std::int32_t> resets) noexcept {
  const TaskOptions& task = step.model.options.task;
  for (std::size_t e = 0; e < kChunk; ++e) {
    const std::size_t n = step.first + e;
    if (n < resets.size() && resets[n] >= 0) {
      step.state.clearOutcome(n);
      continue;
    }
    Env& env = step.state.env(n);
    if (step.state.idle()[n] != 0) {
      step.state.clearOutcome(n);
      ++env.counters.idle_steps;
      continue;
    }
    const bool is_first = env.step == 0;
    ++env.step;
    const TargetDistances now = measureTarget(step.state, n);
    const WayLeft way = measureWay(step.model, step.state, n);
    const EpisodeEnd end = endOf(task, env, now.transport);
    float reward = rewardOf(
        task, env, now, actionChange(step.chunk.actions(e), step.state.lastActions(n), is_first));
    reward += shapingOf(task, env, way);
    if (end == EpisodeEnd::kSuccess) reward += task.success_reward;
    if (isFailure(end)) reward -= task.failure_penalty;
    env.reach = now.reach;
    env.transport = now.transport;
    env.way = way.length;
    env.is_way_to_goal = way.is_to_goal;
    if (end != EpisodeEnd::kNone) {
      ++env.counters.episodes;
      env.counters.successes += end == EpisodeEnd::kSuccess ? 1 : 0;
      env.counters.failures += isFailure(end) ? 1U : 0U;
    }
    env.counters.reward += static_cast<double>(reward);
    step.state.rewards()[n] = reward;
    step.state.dones()[n] = end == EpisodeEnd::kNone ? 0 : 1;
    step.state.successes()[n] = end == EpisodeEnd::kSuccess ? 1 : 0;
    step.state.endings()[n] = end;
  }
}

}  // namespace galactic::simulation
