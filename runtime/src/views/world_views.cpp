#include "galactic/world_views.h"

#include <cassert>
#include <cmath>

#include "views/camera_sight.h"

namespace galactic {
namespace {

/// The frame on the floor under the root: Y up, X where the robot looks.
RigidTransform baseFrame(const RigidTransform& root, float root_height) {
  const float length = std::sqrt(root.x_axis.x * root.x_axis.x + root.x_axis.z * root.x_axis.z);
  const float scale = length > 0 ? 1 / length : 0;
  const Vec3 ahead{root.x_axis.x * scale, 0, root.x_axis.z * scale};
  const Vec3 up{0, 1, 0};
  return {ahead, up, cross(ahead, up), root.origin - up * root_height};
}

}  // namespace

std::optional<CameraMount> robotCamera(const Robot& robot) {
  if (!robot.camera()) return std::nullopt;
  return CameraMount{.frame = CameraFrame::kLink,
                     .link = robot.camera()->link,
                     .frame_from_camera = robot.camera()->link_from_camera,
                     .vertical_fov = robot.camera()->vertical_fov};
}

MountedCamera::MountedCamera(const World& world, const BatchSimulator& simulator,
                             const CameraMount& mount)
    : world_(&world),
      frame_(mount.frame),
      keeps_sight_(mount.frame == CameraFrame::kBase && mount.keeps_sight),
      on_body_(simulator.linkOnBody(mount.frame == CameraFrame::kLink ? mount.link : 0)),
      frame_from_camera_(rigidTransform(mount.frame_from_camera)),
      vertical_fov_(mount.vertical_fov),
      root_height_(world.robot().base() ? world.robot().base()->root_height : 0) {}

RenderCamera MountedCamera::at(std::span<const RigidTransform> bodies,
                               std::uint32_t scene) const noexcept {
  RenderCamera camera{frame_from_camera_, vertical_fov_};
  if (frame_ == CameraFrame::kWorld) return camera;
  const RigidTransform link = bodies[on_body_.body] * on_body_.place;
  const RigidTransform frame = frame_ == CameraFrame::kLink ? link : baseFrame(link, root_height_);
  camera.world_from_camera = frame * frame_from_camera_;
  if (keeps_sight_) {
    camera.world_from_camera =
        inSight(world_->scenes()[scene], frame.origin, camera.world_from_camera).world_from_camera;
  }
  return camera;
}

WorldViews::WorldViews(const World& world, const WorldModels& models,
                       const BatchSimulator& simulator, const CameraMount& camera)
    : models_(&models),
      camera_(world, simulator, camera),
      stride_(1 + world.mostObjects() + models.links().size()),
      instances_(simulator.envCount() * stride_),
      views_(simulator.envCount()) {
  assert(!simulator.bodyTransforms().empty());
  links_.reserve(models.links().size());
  for (const LinkModel& link : models.links()) {
    links_.push_back({link.model, simulator.linkOnBody(link.link)});
  }
  update(simulator);
}

void WorldViews::update(const BatchSimulator& simulator) noexcept {
  for (std::size_t env = 0; env < views_.size(); ++env) updateEnv(simulator, env);
}

void WorldViews::updateEnv(const BatchSimulator& simulator, std::size_t env) noexcept {
  const std::span<RenderInstance> room = std::span(instances_).subspan(env * stride_, stride_);
  const EnvObjects state = simulator.envObjects(env);
  const std::span<const RigidTransform> bodies =
      simulator.bodyTransforms().subspan(env * simulator.bodyCount(), simulator.bodyCount());
  std::size_t count = 0;
  if (const auto scene = models_->sceneModel(state.scene)) room[count++] = {*scene, {}};
  for (std::size_t n = 0; n < state.objects.size(); ++n) {
    const auto model = models_->objectModel(state.placements[n].object);
    if (!model) continue;
    const bool is_held = static_cast<std::int32_t>(n) == state.held;
    room[count++] = {*model, rigidTransform(is_held ? state.world_from_held : state.objects[n])};
  }
  for (const PlacedLink& link : links_) {
    room[count++] = {link.model, bodies[link.on_body.body] * link.on_body.place};
  }
  views_[env].instances = room.first(count);
  views_[env].camera = camera_.at(bodies, state.scene);
}

}  // namespace galactic
