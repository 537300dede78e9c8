#include "galactic/world_views.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "support/call_check.h"
#include "support/random_stream.h"
#include "views/camera_offset.h"
#include "views/camera_sight.h"
#include "views/followed_batch.h"

namespace galactic {
namespace {

/// The frame on the floor under the root: Y up, X ahead of the robot.
RigidTransform baseFrame(const RigidTransform& root, float root_height) {
  const float length = std::sqrt(root.x_axis.x * root.x_axis.x + root.x_axis.z * root.x_axis.z);
  const float scale = length > 0 ? 1 / length : 0;
  const Vec3 ahead{root.x_axis.x * scale, 0, root.x_axis.z * scale};
  const Vec3 up{0, 1, 0};
  return {ahead, up, cross(ahead, up), root.origin - up * root_height};
}

/// A number that is the same for the same camera in the same place, and different otherwise.
std::uint64_t numberOfPlace(std::uint64_t camera, const RigidTransform& place) {
  std::uint64_t number = camera;
  for (const Vec3& v : {place.x_axis, place.y_axis, place.z_axis, place.origin}) {
    // 0 and -0 are the same place.
    for (const float one : {v.x, v.y, v.z}) {
      number = mix(number ^ std::bit_cast<std::uint32_t>(one + 0)) + 1;
    }
  }
  return number;
}

}  // namespace

std::optional<CameraMount> robotCamera(const Robot& robot) {
  if (!robot.camera()) return std::nullopt;
  return CameraMount{.frame = CameraFrame::kLink,
                     .link = robot.camera()->link,
                     .frame_from_camera = robot.camera()->link_from_camera,
                     .vertical_fov = robot.camera()->vertical_fov};
}

MountedCamera::MountedCamera(const BatchSimulator& simulator, const CameraMount& mount)
    : world_(simulator.world()),
      frame_(mount.frame),
      keeps_sight_(mount.frame == CameraFrame::kBase && mount.keeps_sight),
      on_body_(simulator.linkOnBody(mount.frame == CameraFrame::kLink ? mount.link : 0)),
      frame_from_camera_(rigidTransform(mount.frame_from_camera)),
      env_count_(simulator.envCount()),
      vertical_fov_(mount.vertical_fov),
      root_height_(world_.robot().base() ? world_.robot().base()->root_height : 0),
      jitter_(mount.jitter),
      number_(mount.number),
      numbers_{mount.number} {
  if (frame_ == CameraFrame::kWorld) place(mount.world_from_camera);
}

void MountedCamera::place(std::span<const RigidTransform> world_from_camera) {
  if (frame_ != CameraFrame::kWorld) {
    detail::refuseCall("MountedCamera::place",
                       "found a camera on the robot, expected one of CameraFrame::kWorld");
  }
  const std::size_t count = world_from_camera.size();
  if (count != 1 && count != env_count_) {
    detail::refuseCall("MountedCamera::place",
                       fmt::format("found {} places, expected one for all envs, or one for each "
                                   "of {}",
                                   count, env_count_));
  }
  orThrow(checkPlaces("MountedCamera::place", world_from_camera));
  world_from_camera_.assign(world_from_camera.begin(), world_from_camera.end());
  numbers_.clear();
  for (const RigidTransform& place : world_from_camera_) {
    numbers_.push_back(numberOfPlace(number_, place));
  }
}

RenderCamera MountedCamera::at(std::size_t env, std::span<const RigidTransform> bodies,
                               std::uint32_t scene, const EnvMoment& moment) const noexcept {
  const RigidTransform mounted = withoutJitter(env, bodies, scene);
  if (!jitter_.isOn()) return {mounted, vertical_fov_};
  return {mounted * rigidTransform(drawOffset(jitter_, number(env), moment)),
          vertical_fov_ + drawFovOffset(jitter_, number(env), moment)};
}

RigidTransform MountedCamera::withoutJitter(std::size_t env, std::span<const RigidTransform> bodies,
                                            std::uint32_t scene) const noexcept {
  if (frame_ == CameraFrame::kWorld) {
    return world_from_camera_[world_from_camera_.size() == 1 ? 0 : env];
  }
  const RigidTransform link = bodies[on_body_.body] * on_body_.place;
  const RigidTransform frame = frame_ == CameraFrame::kLink ? link : baseFrame(link, root_height_);
  const RigidTransform wanted = frame * frame_from_camera_;
  if (keeps_sight_) {
    return inSight(world_.scenes()[scene], frame.origin, wanted).world_from_camera;
  }
  return wanted;
}

WorldViews::WorldViews(const WorldModels& models, const BatchSimulator& simulator,
                       const CameraMount& camera, const ViewContent& content)
    : models_(views::checkedModels("WorldViews", models, simulator)),
      camera_(simulator, camera),
      stride_(simulator.world().mostObjects()),
      posed_(simulator.envCount() * stride_),
      posed_semantics_(content.ids == ObjectIds::kObjects ? posed_.size() : 0),
      bodies_(simulator.bodyTransforms().size()),
      views_(simulator.envCount()) {
  scenes_.resize(simulator.world().scenes().size());
  for (std::uint32_t scene = 0; scene < scenes_.size(); ++scene) {
    if (const auto model = models.sceneModel(scene)) scenes_[scene].push_back({*model, {}});
  }
  const std::span<const LinkModel> links =
      content.robot ? std::span(models.links()) : std::span<const LinkModel>();
  links_.reserve(links.size());
  for (const LinkModel& link : links) {
    const LinkOnBody on_body = simulator.linkOnBody(link.link);
    links_.push_back({link.model, static_cast<std::uint32_t>(on_body.body), on_body.place});
  }
  const std::size_t body_count = simulator.bodyCount();
  for (std::size_t env = 0; env < views_.size(); ++env) {
    views_[env].attached = links_;
    views_[env].bodies = std::span(bodies_).subspan(env * body_count, body_count);
  }
  update(simulator);
}

void WorldViews::update(const BatchSimulator& simulator) {
  views::requireFollowed("WorldViews::update", models_.worldHash(), simulator, views_.size());
  std::ranges::copy(simulator.bodyTransforms().first(bodies_.size()), bodies_.begin());
  for (std::size_t env = 0; env < views_.size(); ++env) updateEnv(simulator, env);
}

void WorldViews::updateEnv(const BatchSimulator& simulator, std::size_t env) noexcept {
  const std::span<PosedModel> room = std::span(posed_).subspan(env * stride_, stride_);
  const std::span<std::uint32_t> ids =
      posed_semantics_.empty() ? std::span<std::uint32_t>()
                               : std::span(posed_semantics_).subspan(env * stride_, stride_);
  const EnvObjects state = simulator.envObjects(env);
  const std::size_t names = models_.library().semanticNames().size();
  std::size_t count = 0;
  for (std::size_t n = 0; n < state.objects.size(); ++n) {
    const auto model = models_.objectModel(state.present.placements[n].object);
    if (!model) continue;
    const bool is_held = static_cast<std::int32_t>(n) == state.held;
    if (!ids.empty()) ids[count] = static_cast<std::uint32_t>(names + n);
    room[count++] = {*model, is_held ? state.world_from_held : state.objects[n]};
  }
  RenderView& view = views_[env];
  view.instances = scenes_[state.scene];
  view.posed = room.first(count);
  view.posed_semantics = ids.first(ids.empty() ? 0 : count);
  view.noise = {simulator.envMoment(env), camera_.number(env)};
  view.camera = camera_.at(env, view.bodies, state.scene, view.noise.moment);
}

}  // namespace galactic
