#include "galactic/debug_views.h"

#include <fmt/format.h>

#include <algorithm>

#include "support/call_check.h"
#include "views/followed_batch.h"

namespace galactic {
namespace {

/// Spheres are placed without rotation, so that their shading looks like light that is fixed in the
/// world.
RigidTransform sphereAt(const Vec3& center_in_world) {
  RigidTransform place;
  place.origin = center_in_world;
  return place;
}

}  // namespace

DebugViews::DebugViews(const DebugModels& models, const BatchSimulator& simulator,
                       const CameraMount& camera, std::size_t envs)
    : world_(simulator.world()),
      models_(views::checkedModels("DebugViews", models, simulator)),
      camera_(simulator, camera),
      body_count_(simulator.bodyCount()) {
  if (envs > simulator.envCount()) {
    detail::refuseCall("DebugViews",
                       fmt::format("found {} envs to show, expected at most the simulator's {}",
                                   envs, simulator.envCount()));
  }
  const Robot& robot = world_.robot();
  spheres_.reserve(robot.spheres().size());
  for (const SphereGroup& group : robot.groups()) {
    const LinkOnBody link = simulator.linkOnBody(group.link);
    for (const SetSphere& sphere : group.spheres) {
      spheres_.push_back({models.sphereModel(DebugSpheres::kRobot, sphere.radius_index), link.body,
                          link.place * sphere.center});
    }
  }
  // The scene, the objects, the goal, the robot's spheres and those of the held object.
  stride_ = 1 + world_.mostObjects() + 1 + spheres_.size() + world_.mostObjectSpheres();
  instances_.resize(envs * stride_);
  views_.resize(envs);
  update(simulator);
}

void DebugViews::update(const BatchSimulator& simulator) {
  views::requireFollowed("DebugViews::update", models_.worldHash(), simulator, views_.size());
  for (std::size_t env = 0; env < views_.size(); ++env) updateEnv(simulator, env);
}

void DebugViews::updateEnv(const BatchSimulator& simulator, std::size_t env) noexcept {
  const std::span<RenderInstance> room = std::span(instances_).subspan(env * stride_, stride_);
  const EnvObjects state = simulator.envObjects(env);
  const std::span<const RigidTransform> bodies =
      simulator.bodyTransforms().subspan(env * body_count_, body_count_);
  const std::span<const Placement> placements = state.present.placements;
  const std::uint32_t target = state.present.target;
  std::size_t count = 0;
  if (const auto scene = models_.sceneModel(state.scene)) room[count++] = {*scene, {}};
  for (std::size_t n = 0; n < state.objects.size(); ++n) {
    if (static_cast<std::int32_t>(n) == state.held) continue;
    const std::uint32_t object = placements[n].object;
    room[count++] = {n == target ? models_.targetModel(object) : models_.boxModel(object),
                     rigidTransform(state.objects[n])};
  }
  room[count++] = {models_.goalModel(placements[target].object), rigidTransform(state.goal)};
  for (const PlacedSphere& sphere : spheres_) {
    room[count++] = {sphere.model, sphereAt(bodies[sphere.body] * sphere.center)};
  }
  if (state.held >= 0) {
    const Placement& held = placements[static_cast<std::size_t>(state.held)];
    for (const SetSphere& sphere : world_.objectOf(held).spheres) {
      room[count++] = {models_.sphereModel(DebugSpheres::kHeld, sphere.radius_index),
                       sphereAt(state.world_from_held * sphere.center)};
    }
  }
  views_[env].instances = room.first(count);
  views_[env].camera = camera_.at(env, bodies, state.scene, simulator.envMoment(env));
}

}  // namespace galactic
