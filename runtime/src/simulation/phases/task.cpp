#include "simulation/phases/task.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "simulation/state/grip_frame.h"

namespace galactic::simulation {
namespace {

float distance(const Vec3& a, const Vec3& b) {
  const Vec3 away = a - b;
  return std::sqrt(dot(away, away));
}

bool holdsAnother(const Env& env) { return env.held >= 0 && !holdsTarget(env); }

EpisodeEnd endOfRearrange(const TaskOptions& task, const Env& env, float transport) {
  const bool is_there = transport < task.success_distance && !holdsTarget(env);
  const bool may_terminate = task.needs_terminate && env.step > task.terminate_after;
  if (may_terminate && env.events.terminates) {
    return is_there ? EpisodeEnd::kSuccess : EpisodeEnd::kWrongTerminate;
  }
  if (!task.needs_terminate && env.events.released_target && is_there) return EpisodeEnd::kSuccess;
  if (task.drop_fails && env.events.released_target && !is_there) return EpisodeEnd::kWrongRelease;
  return EpisodeEnd::kNone;
}

/// How the rules of a task, except for its time limit, end the episode (paper, appendix A).
/// `transport`: the distance from target to goal after the step, meters.
inline EpisodeEnd endOf(const TaskOptions& task, const Env& env, float transport) {
  EpisodeEnd end = EpisodeEnd::kNone;
  switch (task.kind) {
    case TaskKind::kRearrange:
      end = endOfRearrange(task, env, transport);
      break;
    case TaskKind::kMobilePick:
      if (holdsTarget(env)) end = EpisodeEnd::kSuccess;
      break;
    case TaskKind::kNone:
      break;
  }
  const bool fails = task.drop_fails && holdsAnother(env);
  return end == EpisodeEnd::kNone && fails ? EpisodeEnd::kWrongObject : end;
}

bool isLate(const TaskOptions& task, const Env& env) {
  return task.most_steps != 0 && env.step >= task.most_steps;
}

float rewardOf(const TaskOptions& task, const Env& env, const TargetDistances& now,
               float action_change) {
  const float pick = env.events.picked ? task.pick_reward : 0;
  const bool is_overlooked = !task.drop_fails && (env.events.kept_target || holdsAnother(env));
  return pick + task.reach_weight * (env.reach - now.reach) +
         task.transport_weight * (env.transport - now.transport) -
         task.action_weight * action_change - task.slack_penalty -
         (env.refused ? task.bump_penalty : 0.0F) - (env.knocked ? task.knock_penalty : 0.0F) -
         (is_overlooked ? task.drop_penalty : 0.0F);
}

/// The reward for the progress along the way on the floor. It is 0 if the way leads to something
/// else than before, or there is no way before or after the step.
float shapingOf(const TaskOptions& task, const Env& env, const WayLeft& way) {
  const bool is_one_way = env.is_way_to_goal == way.is_to_goal && env.way >= 0 && way.length >= 0;
  if (!is_one_way) return 0;
  return task.geodesic_weight * (env.way - way.length);
}

}  // namespace

PointRows targetsNow(const BatchState& state, std::size_t first) noexcept {
  PointRows targets;
  std::memcpy(targets.data(), state.targets(first), sizeof(targets));
  for (std::size_t e = 0; e < kChunk; ++e) {
    const Env& env = state.env(first + e);
    if (!holdsTarget(env)) continue;
    const Vec3 target = state.heldOrigin(first + e);
    targets[0].values[e] = target.x;
    targets[1].values[e] = target.y;
    targets[2].values[e] = target.z;
  }
  return targets;
}

TargetDistances measureTarget(const BatchState& state, std::size_t n) noexcept {
  const Env& env = state.env(n);
  const Vec3 target =
      holdsTarget(env) ? state.heldOrigin(n) : state.objects(n)[env.target].translation;
  return {distance(gripOrigin(state.grip(n)), target), distance(target, state.goal(n))};
}

Vec3 targetUp(const Model& model, const BatchState& state, std::size_t n) noexcept {
  const Env& env = state.env(n);
  const Pose& resting = state.objects(n)[env.target];
  const Quat now = (holdsTarget(env) ? state.heldPose(n) : resting).rotation;
  const Placement& start = model.placements(model.episodeOf(env.start))[env.target];
  return rotate(now, rotate(conjugate(start.pose.rotation), {0, 1, 0}));
}

WayLeft measureWay(const Model& model, const BatchState& state, std::size_t env_number) noexcept {
  if (model.options.task.geodesic_weight == 0) return {};
  const Env& env = state.env(env_number);
  const Vec3 base = state.base(env_number);
  if (holdsTarget(env)) return {model.geodesic.toGoal(env.start, base).distance, true};
  const Vec3 target = state.objects(env_number)[env.target].translation;
  return {model.geodesic.toTarget(env.start, base, target).distance, false};
}

namespace {

/// What judge() measures for all envs of a chunk.
struct Measured {
  EnvRow change;
  EnvRow reach;
  EnvRow transport;
};

Measured measure(const ChunkStep& step) {
  std::array<std::uint32_t, kChunk> active;
  for (std::size_t e = 0; e < kChunk; ++e) {
    active[e] = step.state.idle()[step.first + e] == 0 ? ~std::uint32_t{0} : 0;
  }
  const PointRows targets = targetsNow(step.state, step.first);
  Measured measured;
  step.model.kernels.judge({.actions = step.chunk.actions().front().values,
                            .last_actions = step.state.lastActions(step.first),
                            .active = active.data(),
                            .joints = step.model.motion.controlled.size(),
                            .grips = step.state.grips(step.first),
                            .targets = targets.front().values,
                            .goals = step.state.goals(step.first),
                            .change = measured.change.values,
                            .reach = measured.reach.values,
                            .transport = measured.transport.values,
                            .envs = kChunk});
  return measured;
}

/// The outcomes of a step for the envs of a chunk.
struct Outcomes {
  std::array<float, kChunk> rewards{};
  std::array<EpisodeEnd, kChunk> endings{};
  std::array<std::uint8_t, kChunk> picks{};
};

void put(const Outcomes& outcomes, BatchState& state, std::size_t first) {
  std::ranges::copy(outcomes.rewards, state.rewards().data() + first);
  std::ranges::copy(outcomes.endings, state.endings().data() + first);
  std::ranges::copy(outcomes.picks, state.picks().data() + first);
  std::uint8_t* dones = state.dones().data() + first;
  std::uint8_t* successes = state.successes().data() + first;
  for (std::size_t e = 0; e < kChunk; ++e) {
    dones[e] = outcomes.endings[e] == EpisodeEnd::kNone ? 0 : 1;
    successes[e] = outcomes.endings[e] == EpisodeEnd::kSuccess ? 1 : 0;
  }
}

void count(EpisodeEnd end, const Env& env, EnvCounters& counters) {
  ++counters.episodes;
  counters.successes += end == EpisodeEnd::kSuccess ? 1 : 0;
  counters.failures += isFailure(end) ? 1U : 0U;
  counters.picks += env.has_picked ? 1U : 0U;
}

/// How the episode ends with this step, if it does; without a task, only its time limit ends it.
inline EpisodeEnd endNow(const TaskOptions& task, bool has_task, const Env& env, float transport) {
  const EpisodeEnd end = has_task ? endOf(task, env, transport) : EpisodeEnd::kNone;
  return end == EpisodeEnd::kNone && isLate(task, env) ? EpisodeEnd::kTimeOut : end;
}

/// The reward of a step with which an episode ends.
float rewardAtEnd(const TaskOptions& task, EpisodeEnd end, float reward) {
  if (end == EpisodeEnd::kSuccess) return reward + task.success_reward;
  return isFailure(end) ? reward - task.failure_penalty : reward;
}

/// The reward for the change of the way along the floor; stores the new way in `env`.
float earnOfWay(const ChunkStep& step, std::size_t n, Env& env) {
  const WayLeft way = measureWay(step.model, step.state, n);
  const float earned = shapingOf(step.model.options.task, env, way);
  env.way = way.length;
  env.is_way_to_goal = way.is_to_goal;
  return earned;
}

/// The cost of carrying the target tilted: 0 when it is upright, the whole penalty when it lies on
/// its side.
float payForTilt(const ChunkStep& step, std::size_t n) {
  if (!holdsTarget(step.state.env(n))) return 0;
  return step.model.options.task.tilt_penalty * (1 - targetUp(step.model, step.state, n).y);
}

}  // namespace

void judge(const ChunkStep& step, std::span<const std::int32_t> resets) noexcept {
  const TaskOptions& task = step.model.options.task;
  // Without a task there is no reward, and only the time limit ends an episode.
  const bool has_task = task.kind != TaskKind::kNone;
  const bool pays_for_ways = has_task && task.geodesic_weight != 0;
  const bool pays_for_tilt = has_task && task.tilt_penalty != 0;
  const std::uint8_t* idle = step.state.idle().data() + step.first;
  // Prefetch the resets of the next chunk.
  if (step.first + kChunk < resets.size()) __builtin_prefetch(&resets[step.first + kChunk]);
  const Measured measured = measure(step);
  Outcomes outcomes;
  for (std::size_t e = 0; e < kChunk; ++e) {
    const std::size_t n = step.first + e;
    if (idle[e] != 0) ++step.state.counters(n).idle_steps;
    const bool begins_anew = n < resets.size() && step.model.startOf(resets[n]);
    if (idle[e] != 0 || begins_anew) continue;
    Env& env = step.state.env(n);
    // The first step of an episode has no previous action.
    const float change = env.step == 0 ? 0 : measured.change.values[e];
    ++env.step;
    const TargetDistances now{measured.reach.values[e], measured.transport.values[e]};
    const EpisodeEnd end = endNow(task, has_task, env, now.transport);
    float reward = has_task ? rewardOf(task, env, now, change) : 0;
    if (pays_for_ways) reward += earnOfWay(step, n, env);
    if (pays_for_tilt) reward -= payForTilt(step, n);
    env.reach = now.reach;
    env.transport = now.transport;
    if (end != EpisodeEnd::kNone) {
      reward = rewardAtEnd(task, end, reward);
      count(end, env, step.state.counters(n));
      outcomes.picks[e] = env.has_picked ? 1 : 0;
    }
    env.reward_sum += static_cast<double>(reward);
    outcomes.rewards[e] = reward;
    outcomes.endings[e] = end;
  }
  put(outcomes, step.state, step.first);
}

}  // namespace galactic::simulation
