#include "simulation/phases/episode_start.h"

#include <algorithm>
#include <optional>

#include "simulation/phases/action_delay.h"
#include "simulation/phases/observe.h"
#include "simulation/phases/robot_noise.h"
#include "simulation/phases/task.h"
#include "simulation/state/episode_order.h"

namespace galactic::simulation {
namespace {

void placeRobot(const Model& model, BatchState& state, std::size_t n, std::uint32_t start) {
  const EpisodeStart& from = model.starts[start];
  const PoseArrays to = state.poses(n);
  *to.x = from.base.x;
  *to.y = from.base.y;
  *to.z = from.base.z;
  *to.yaw = from.yaw;
  const std::size_t variables = model.variableCount();
  for (std::size_t v = 0; v < variables; ++v) {
    to.variables[v * to.stride] = model.start_variables[start * variables + v];
  }
  state.setGrip(n, from.grip);
  const std::size_t bodies = model.bodyCount();
  std::ranges::copy(std::span(model.start_bodies).subspan(start * bodies, bodies),
                    state.bodyTransforms(n).begin());
  for (std::size_t j = 0; j < model.motion.controlled.size(); ++j) state.setLastAction(j, n, 0);
  beginOdometry(model, state, n);
  beginDelay(model, state, n);
}

void placeObjects(const Model& model, BatchState& state, std::size_t n, std::uint32_t start) {
  const std::span<const Placement> placements = model.placements(model.episodeOf(start));
  for (std::uint32_t object = 0; object < placements.size(); ++object) {
    state.setObjectPose(n, object, placements[object].pose);
  }
  state.resting(n).share(model.objectsAt(start));
}

}  // namespace

void takeStock(const Model& model, BatchState& state, std::size_t n) noexcept {
  Env& env = state.env(n);
  const TargetDistances distances = measureTarget(state, n);
  env.reach = distances.reach;
  env.transport = distances.transport;
  const WayLeft way = measureWay(model, state, n);
  env.way = way.length;
  env.is_way_to_goal = way.is_to_goal;
  // Observes the whole chunk; the observations of its other envs do not change.
  observe(model, state, n / kChunk * kChunk);
  sense(model, state, {n, 1});
}

void beginEpisode(const Model& model, BatchState& state, std::size_t n, std::uint32_t start,
                  EpisodeChoice choice) noexcept {
  const Episode& episode = model.episodeOf(start);
  placeRobot(model, state, n, start);
  placeObjects(model, state, n, start);
  const PresentObjects present = model.present(episode);
  Env& env = state.env(n);
  env = {.scene = model.world->sceneIndexOf(episode),
         .clearance_map = model.starts[start].clearance_map,
         .start = start,
         .objects = static_cast<std::uint32_t>(present.placements.size()),
         .target = present.target,
         .events = {},
         .reward_sum = env.reward_sum};
  ++state.counters(n).begun;
  state.counters(n).is_named = choice == EpisodeChoice::kNamed;
  state.held(n) = {};
  state.setErrand(n, present.target, episode.goal.translation);
  std::ranges::fill(state.leaving(n), 0U);
  state.idle()[n] = 0;
  takeStock(model, state, n);
}

void beginNextEpisode(const Model& model, BatchState& state, std::size_t env) noexcept {
  const auto count = static_cast<std::uint32_t>(model.starts.size());
  const std::uint64_t number = model.globalEnv(env);
  const auto next = nthEpisode(model.options, number, state.counters(env).turns, count);
  // An env that never gets an episode needs a place to stand, too.
  const bool has_begun = state.counters(env).begun > 0;
  if (next || !has_begun) {
    const std::uint32_t start = next.value_or(static_cast<std::uint32_t>(number % count));
    beginEpisode(model, state, env, start, EpisodeChoice::kDrawn);
    ++state.counters(env).turns;
  }
  state.idle()[env] = next ? 0 : 1;
}

void renewEpisodes(const ChunkStep& step) noexcept {
  const std::uint8_t* dones = step.state.dones().data() + step.first;
  if (std::all_of(dones, dones + kChunk, [](std::uint8_t done) { return done == 0; })) return;
  for (std::size_t e = 0; e < kChunk; ++e) {
    const std::size_t n = step.first + e;
    if (dones[e] == 0) continue;
    step.state.keepFinalObservation(n);
    if (step.model.options.auto_reset) {
      beginNextEpisode(step.model, step.state, n);
    } else {
      // It stays idle until the caller begins another episode.
      step.state.idle()[n] = 1;
    }
  }
}

void resetEpisodes(const ChunkStep& step, std::span<const std::int32_t> resets) noexcept {
  for (std::size_t n = step.first; n < std::min(step.first + kChunk, resets.size()); ++n) {
    const OptionalIndex start = step.model.startOf(resets[n]);
    if (start) beginEpisode(step.model, step.state, n, *start, EpisodeChoice::kNamed);
  }
}

}  // namespace galactic::simulation
