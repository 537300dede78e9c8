#include "simulation/phases/hand.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "simulation/collision/grasp_query.h"
#include "simulation/phases/action_delay.h"
#include "simulation/phases/contacts.h"
#include "simulation/phases/object_placement.h"
#include "simulation/state/env_moment.h"
#include "simulation/state/grip_frame.h"
#include "support/random_stream.h"

namespace galactic::simulation {
namespace {

void grasp(const ChunkStep& step, std::size_t e) {
  const std::size_t n = step.first + e;
  const std::uint32_t start = step.state.env(n).start;
  const OptionalIndex object = nearestToGrasp(
      step.state.resting(n), {gripOrigin(step.state.grip(n)), step.model.motion.grasp_radius},
      step.model.options.action.grasp_shape,
      [&](std::uint32_t index) -> const ObjectModel& { return step.model.object(start, index); },
      [&](std::uint32_t index) -> const Pose& { return step.state.objects(n)[index]; });
  if (object) takeInHand(step, e, *object);
}

/// Whether the task lets the held object rest at `pose`.
bool mayRestAt(const ChunkStep& step, std::size_t n, const Pose& pose) {
  const Env& env = step.state.env(n);
  const TaskOptions& task = step.model.options.task;
  if (task.drop_fails || task.kind != TaskKind::kRearrange || !holdsTarget(env)) return true;
  const Vec3 away = pose.translation - step.state.goal(n);
  return dot(away, away) < task.success_distance * task.success_distance;
}

/// Marks the robot's spheres that penetrate the object that the hand let go of: they do not count
/// against it until they are free of it.
void beginToLeave(const ChunkStep& step, std::size_t e, std::uint32_t object) {
  // The chunk's spheres are those of a candidate that may have been refused.
  const std::size_t group = e / kLanes * kLanes;
  step.model.kernels.place(step.model.tables, {.pose = step.state.poses(step.first + group),
                                               .body = step.chunk.bodies(group)});
  const std::size_t n = step.first + e;
  const RestingBox& box = step.state.resting(n).box(object);
  const bool any = overlapping(box, step.chunk.spheres(e), step.state.leaving(n, object));
  step.state.env(n).left += any ? 1U : 0U;
}

void release(const ChunkStep& step, std::size_t e) {
  const std::size_t n = step.first + e;
  Env& env = step.state.env(n);
  EnvCounters& counters = step.state.counters(n);
  RestingObjects& resting = step.state.resting(n);
  const ObjectModel& object = heldModel(step.model, env);
  const Pose released = step.state.heldPose(n);
  const EnvMoment moment = momentOf(step.model, step.state, n);
  RandomStream random(moment.seed, moment.env, moment.episode, moment.step);
  const Landing landing = placeObject({step.model.scenes[env.scene], resting}, object, released,
                                      random, step.model.options.placement, step.chunk.placement());
  const auto held = static_cast<std::size_t>(env.held);
  const Pose rest = landing.placed ? landing.pose : step.state.objects(n)[held];
  if (!mayRestAt(step, n, rest)) {
    env.events.kept_target = true;
    return;
  }
  layDown(step, e, rest);
  ++(landing.placed ? counters.drops : counters.restored);
}

}  // namespace

void takeInHand(const ChunkStep& step, std::size_t e, std::uint32_t object) noexcept {
  const std::size_t n = step.first + e;
  Env& env = step.state.env(n);
  RestingObjects& resting = step.state.resting(n);
  const Pose& before = step.state.objects(n)[object];
  env.held = static_cast<std::int32_t>(object);
  Held& held = step.state.held(n);
  held = {};
  held.grip_from_object = inverse(gripPose(step.state.grip(n))) * before;
  measureHeld(heldModel(step.model, env), held);
  resting.remove(object);
  const std::span<std::uint64_t> leaving = step.state.leaving(n, object);
  if (!isEmpty(leaving)) --env.left;
  std::ranges::fill(leaving, 0U);
  const SphereBatch spheres =
      holdSpheres(heldModel(step.model, env), before, step.chunk.placement().spheres);
  const std::span<std::uint64_t> ignored = step.state.ignored(n);
  penetrating({step.model.scenes[env.scene], resting}, spheres, step.chunk.collision(), ignored);
  env.ignores = !isEmpty(ignored);
  ++step.state.counters(n).grasps;
  env.events.picked = object == env.target && !env.has_picked;
  env.has_picked = env.has_picked || env.events.picked;
}

void layDown(const ChunkStep& step, std::size_t e, const Pose& world_from_object) noexcept {
  const std::size_t n = step.first + e;
  Env& env = step.state.env(n);
  const auto object = static_cast<std::uint32_t>(env.held);
  restObject(step.model, step.state, n, object, world_from_object);
  beginToLeave(step, e, object);
  env.events.released_target = object == env.target;
  env.held = -1;
  env.ignores = false;
}

void useHands(const ChunkStep& step) noexcept {
  const ActionOptions& options = step.model.options.action;
  const ActionLayout layout = step.model.actionLayout();
  const EnvRow& values = arrivedOf(step)[layout.hand()];
  const EnvRow& terminates = arrivedOf(step)[layout.terminate()];
  const std::uint8_t* idle = step.state.idle().data() + step.first;
  // What a hand does next is unpredictable, so there is no branch on it except for the few hands
  // that do something.
  unsigned grasps = 0;
  unsigned releases = 0;
  for (std::size_t e = 0; e < kChunk; ++e) {
    if (idle[e] != 0) continue;
    Env& env = step.state.env(step.first + e);
    env.events = {.terminates = terminates.values[e] >= options.terminate};
    const auto is_empty = static_cast<unsigned>(env.held < 0);
    const auto opens = static_cast<unsigned>(values.values[e] < options.release);
    const auto closes = static_cast<unsigned>(values.values[e] >= options.grasp);
    grasps |= (is_empty & closes) << e;
    releases |= (~is_empty & opens) << e;
  }
  for (unsigned left = grasps | releases; left != 0; left &= left - 1) {
    const auto e = static_cast<std::size_t>(std::countr_zero(left));
    (grasps >> e & 1U) != 0 ? grasp(step, e) : release(step, e);
  }
}

}  // namespace galactic::simulation
