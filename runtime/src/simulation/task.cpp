#include "simulation/task.h"

#include <algorithm>
#include <cmath>

#include "simulation/grip_frame.h"

namespace galactic::simulation {
namespace {

float distance(const Vec3& a, const Vec3& b) {
  const Vec3 away = a - b;
  return std::sqrt(dot(away, away));
}

bool isHeld(const Env& env) { return env.held.object == static_cast<std::int32_t>(env.target); }

Verdict verdictOfRearrange(const TaskOptions& task, const Env& env, float transport) {
  const bool is_there = transport < task.success_distance && !isHeld(env);
  if (task.needs_terminate && env.events.terminates) {
    return is_there ? Verdict::kSuccess : Verdict::kFailure;
  }
  if (!task.needs_terminate && env.events.released_target && is_there) return Verdict::kSuccess;
  if (task.drop_fails && env.events.released_target && !is_there) return Verdict::kFailure;
  return Verdict::kGoesOn;
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
         task.action_weight * action_change - task.slack_penalty;
}

}  // namespace

TargetDistances measureTarget(const BatchState& state, std::size_t env_number) noexcept {
  const Env& env = state.env(env_number);
  const GripFrame& grip = state.grip(env_number);
  const Vec3 target = isHeld(env) ? gripToWorld(grip, env.held.grip_from_object.translation)
                                  : state.objects(env_number)[env.target].translation;
  return {target, distance(gripOrigin(grip), target), distance(target, env.goal)};
}

Verdict verdictOf(const TaskOptions& task, const Env& env, float transport) noexcept {
  const bool holds_another = env.held.object >= 0 && !isHeld(env);
  Verdict verdict = Verdict::kGoesOn;
  switch (task.kind) {
    case TaskKind::kRearrange:
      verdict = verdictOfRearrange(task, env, transport);
      break;
    case TaskKind::kMobilePick:
      if (isHeld(env)) verdict = Verdict::kSuccess;
      break;
    case TaskKind::kNone:
      break;
  }
  const bool fails = task.kind != TaskKind::kNone && task.drop_fails && holds_another;
  if (verdict == Verdict::kGoesOn && fails) return Verdict::kFailure;
  const bool is_late = task.most_steps != 0 && env.step >= task.most_steps;
  return verdict == Verdict::kGoesOn && is_late ? Verdict::kTimeOut : verdict;
}

void judge(const ChunkStep& step, std::span<const std::int32_t> resets) noexcept {
  const TaskOptions& task = step.model.options.task;
  for (std::size_t e = 0; e < kChunk; ++e) {
    const std::size_t n = step.first + e;
    if (n < resets.size() && resets[n] >= 0) {
      step.state.rewards()[n] = 0;
      step.state.dones()[n] = 0;
      step.state.successes()[n] = 0;
      continue;
    }
    Env& env = step.state.env(n);
    const bool is_first = env.step == 0;
    ++env.step;
    const TargetDistances now = measureTarget(step.state, n);
    const Verdict verdict = verdictOf(task, env, now.transport);
    float reward = rewardOf(
        task, env, now, actionChange(step.chunk.actions(e), step.state.lastActions(n), is_first));
    if (verdict == Verdict::kSuccess) reward += task.success_reward;
    if (verdict == Verdict::kFailure) reward -= task.failure_penalty;
    env.reach = now.reach;
    env.transport = now.transport;
    env.counters.successes += verdict == Verdict::kSuccess ? 1 : 0;
    env.counters.failures += verdict == Verdict::kFailure ? 1 : 0;
    env.counters.episodes += verdict == Verdict::kGoesOn ? 0 : 1;
    env.counters.reward += static_cast<double>(reward);
    step.state.rewards()[n] = reward;
    step.state.dones()[n] = verdict == Verdict::kGoesOn ? 0 : 1;
    step.state.successes()[n] = verdict == Verdict::kSuccess ? 1 : 0;
  }
}

}  // namespace galactic::simulation
