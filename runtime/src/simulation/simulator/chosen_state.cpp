#include "simulation/simulator/chosen_state.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "simulation/collision/grasp_query.h"
#include "simulation/collision/resting_box.h"
#include "simulation/phases/contacts.h"
#include "simulation/phases/episode_start.h"
#include "simulation/phases/move.h"
#include "simulation/phases/object_placement.h"
#include "simulation/state/env_state.h"
#include "simulation/state/grip_frame.h"
#include "support/option_rules.h"

namespace galactic::simulation {
namespace {

/// A root that is tilted further, radians, is in another frame, or its quaternion in another order.
constexpr float kMostTilt = 0.1F;
/// More than a pose can lose on its way through other frames and files, meters.
constexpr float kGraspSlack = 1e-3F;

/// The angle between the rotated vertical axis and the world's, radians.
float tiltOf(const Quat& rotation) {
  return 2 * std::asin(std::min(1.0F, std::hypot(rotation.x, rotation.z)));
}

}  // namespace

std::string faultOf(const Model& model, const EnvState& state) {
  if (!model.startOf(state.episode)) {
    return fmt::format("is in episode {}, which there is not or which cannot be started",
                       state.episode);
  }
  const Episode& episode = model.world->episodes().episodes()[state.episode];
  const std::size_t objects = model.placements(episode).size();
  const std::size_t positions = model.world->robot().positionCount();
  if (state.objects.size() != objects) {
    return fmt::format("has {} objects, and its episode {}", state.objects.size(), objects);
  }
  if (state.joint_positions.size() != positions) {
    return fmt::format("has {} joint positions, and the robot {}", state.joint_positions.size(),
                       positions);
  }
  if (state.held < -1 || state.held >= static_cast<std::int64_t>(objects)) {
    return fmt::format("holds object {} of {}", state.held, objects);
  }
  if (state.target != model.present(episode).target) {
    return fmt::format("has the target {}, and that of its episode, {}, is {}; set both",
                       state.target, state.episode, model.present(episode).target);
  }
  if (std::string fault = faultOfStep(model, state.step); !fault.empty()) return fault;
  if (std::string fault = faultOfNumbers(state); !fault.empty()) return fault;
  const float tilt = tiltOf(state.world_from_root.rotation);
  if (tilt > kMostTilt) {
    return fmt::format(
        "has world_from_root.rotation tilted by {:.2f} rad, expected at most {}: "
        "robots stand upright; quaternions are w, x, y, z",
        tilt, kMostTilt);
  }
  if (findsPaths(model.options) && !(state.goal.translation == episode.goal.translation)) {
    return "has another goal than its episode, and ways along the floor (geodesic) are known to "
           "the goals of episodes alone";
  }
  return {};
}

StateChooser::StateChooser(const Model& model) : model_(model), state_(model, 1), chunk_(model) {
  for (std::size_t n = 0; n < state_.paddedCount(); ++n) {
    beginEpisode(model_, state_, n, 0, EpisodeChoice::kDrawn);
  }
}

std::optional<SavedEnv> StateChooser::choose(const EnvState& chosen) {
  // faultOf() has checked that there is one.
  beginEpisode(model_, state_, 0, *model_.startOf(chosen.episode), EpisodeChoice::kDrawn);
  if (chosen.held >= 0 && !touchesHeld(chosen)) return std::nullopt;
  restObjects(model_, state_, 0, chosen.objects, chosen.held);
  if (!standOnFloor(chosen)) return std::nullopt;
  setVariables(chosen);
  placeBodies(step());
  if (chosen.held >= 0) fillHand(chosen);
  leaveWhatIsInReach();
  if (!isFree(step(), 0)) return std::nullopt;
  return taken(chosen);
}

void StateChooser::addBodies(SavedEnv& saved) {
  restoreEnv(model_, state_, 0, saved);
  copyPose(state_.poses(0), chunk_.candidates(0), model_.variableCount());
  placeBodies(step());
  keepBodies(step(), {~std::uint32_t{0}});
  const std::span<const RigidTransform> bodies = state_.bodyTransforms(0);
  saved.bodies.assign(bodies.begin(), bodies.end());
}

/// Uses the wider of the two grasp rules, so that states can be moved from one to the other.
bool StateChooser::touchesHeld(const EnvState& chosen) const {
  const auto object = static_cast<std::uint32_t>(chosen.held);
  const RestingBox box =
      restingBox(model_.object(state_.env(0).start, object).box, chosen.objects[object]);
  const float reach = model_.motion.grasp_radius + kGraspSlack;
  return squaredDistance(box, chosen.world_from_grip.translation) < reach * reach;
}

bool StateChooser::standOnFloor(const EnvState& chosen) {
  const Pose& root = chosen.world_from_root;
  const Vec3 base{root.translation.x, root.translation.y - model_.motion.base.root_height,
                  root.translation.z};
  const FloorUnder under =
      floorUnder(model_.scenes[state_.env(0).scene], base, model_.options.ground);
  const float yaw = wrappedAngle(yawOf(root.rotation));
  for (const PoseArrays& pose : {chunk_.candidates(0), state_.poses(0)}) {
    *pose.x = base.x;
    *pose.y = under.height;
    *pose.z = base.z;
    *pose.yaw = yaw;
  }
  chunk_.floor(0) = under.floor;
  return under.floor == Floor::kCarries;
}

void StateChooser::setVariables(const EnvState& chosen) {
  const PoseArrays pose = chunk_.candidates(0);
  for (std::size_t v = 0; v < model_.variableCount(); ++v) {
    pose.variables[v * pose.stride] = within(
        model_.motion.variables[v], chosen.joint_positions[model_.motion.variables[v].position]);
  }
}

void StateChooser::fillHand(const EnvState& chosen) {
  const auto object = static_cast<std::uint32_t>(chosen.held);
  Env& env = state_.env(0);
  RestingObjects& resting = state_.resting(0);
  env.held = chosen.held;
  resting.remove(object);
  Held& held = state_.held(0);
  held = {};
  held.grip_from_object = inverse(chosen.world_from_grip) * chosen.objects[object];
  measureHeld(heldModel(model_, env), held);
  const std::span<std::uint64_t> ignored = state_.ignored(0);
  penetrating({model_.scenes[env.scene], resting}, heldSpheres(step(), 0), chunk_.collision(),
              ignored);
  env.ignores = !isEmpty(ignored);
}

/// Treats objects in reach of the hand as after a release: see Env::left.
void StateChooser::leaveWhatIsInReach() {
  Env& env = state_.env(0);
  const RestingObjects& resting = state_.resting(0);
  const Vec3 hand = gripOrigin(chunk_.grip(0));
  const float radius = model_.motion.grasp_radius;
  for (std::uint32_t object = 0; object < env.objects; ++object) {
    if (!resting.isResting(object)) continue;
    const RestingBox& box = resting.box(object);
    const float squared =
        squaredGraspDistance(model_.object(env.start, object), box, state_.objects(0)[object], hand,
                             model_.options.action.grasp_shape);
    if (!(squared < radius * radius)) continue;
    if (overlapping(box, chunk_.spheres(0), state_.leaving(0, object))) ++env.left;
  }
}

/// Whether the target has been in the hand: it is now, or it is not at its start pose although the
/// episode has had steps.
bool StateChooser::hasPicked(const EnvState& chosen) const {
  const Env& env = state_.env(0);
  if (holdsTarget(env)) return true;
  const Placement& start = model_.placements(model_.episodeOf(env.start))[env.target];
  return chosen.step > 0 && !(chosen.objects[env.target] == start.pose);
}

SavedEnv StateChooser::taken(const EnvState& chosen) {
  const Env& env = state_.env(0);
  keepBodies(step(), {~std::uint32_t{0}});
  SavedEnv saved;
  saved.env.start = env.start;
  saved.env.step = chosen.step;
  saved.env.objects = env.objects;
  saved.env.held = env.held;
  saved.env.left = env.left;
  saved.env.has_picked = hasPicked(chosen);
  saved.held = state_.held(0);
  saved.goal = chosen.goal.translation;
  // For a held target, this is its place at the start of the episode.
  saved.target_start = state_.objects(0)[env.target].translation;
  saved.base = chunk_.base(0);
  const PoseArrays pose = chunk_.candidates(0);
  saved.yaw = *pose.yaw;
  saved.believed = {saved.base.x, saved.base.z, saved.yaw};
  saved.grip = chunk_.grip(0);
  for (std::size_t v = 0; v < model_.variableCount(); ++v) {
    saved.variables.push_back(pose.variables[v * pose.stride]);
  }
  saved.last_actions.assign(model_.motion.controlled.size(), 0);
  const auto copy = [](const auto& from, auto& to) { to.assign(from.begin(), from.end()); };
  copy(state_.ignored(0), saved.ignored);
  copy(state_.leaving(0).first(env.objects * model_.bodyWords()), saved.leaving);
  copy(state_.objects(0).first(env.objects), saved.objects);
  copy(state_.bodyTransforms(0), saved.bodies);
  return saved;
}

}  // namespace galactic::simulation
