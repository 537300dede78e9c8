#include "episodes/prepared_scene.h"

#include <fmt/format.h>

#include <string>
#include <utility>

namespace galactic::bake {

PreparedScene::PreparedScene(const GenerationContext& context, const Scene& scene,
                             SceneDetails details)
    : context_(context),
      scene_(scene),
      details_(std::move(details)),
      floor_(scene, context.world.robot()),
      supports_(scene, {floor_, context.reach}, details_.receptacles, context.options) {}

Result<std::unique_ptr<const PreparedScene>> PreparedScene::prepare(
    const GenerationContext& context, const Scene& scene, SceneDetails details) {
  std::unique_ptr<PreparedScene> prepared(
      new PreparedScene(context, scene, std::move(details)));  // the constructor is private
  if (auto checked = prepared->check(); !checked) return tl::unexpected(checked.error());
  if (auto used = prepared->useMesh(); !used) return tl::unexpected(used.error());
  return prepared;
}

Result<void> PreparedScene::check() const {
  const auto refuse = [this](std::string message) {
    return fail(ErrorCode::kInvalidInput, std::string(scene_.name()), std::move(message));
  };
  const Robot& robot = context_.world.robot();
  if (floor_.places().empty()) {
    return refuse(fmt::format(
        "the robot {} stands nowhere: {} places on the floor were tried in {} headings each, and "
        "in its start pose one of its {} spheres was blocked at each; give a larger scene or a "
        "smaller start pose",
        robot.name(), floor_.tried(), kHeadings, robot.spheres().size()));
  }
  if (!supports_.places().empty()) return {};
  const bool in_receptacles = context_.options.supports == SupportChoice::kReceptacles;
  if (in_receptacles && details_.receptacles.empty()) {
    return refuse("no receptacles of the scene are known; let objects stand on any surface");
  }
  const DistanceRange& heights = context_.options.heights;
  return refuse(fmt::format(
      "no flat surface {}between {} and {} m over the floor is within reach of the {} places to "
      "which the robot {} can drive; change the heights or the robot's start pose",
      in_receptacles ? "in its receptacles " : "", heights.least, heights.most,
      floor_.places().size(), robot.name()));
}

Result<void> PreparedScene::useMesh() {
  if (details_.mesh.triangles.empty()) return {};
  auto rays = SurfaceRays::build(details_.mesh);
  if (!rays) return tl::unexpected(rays.error());
  rays_ = std::make_unique<const SurfaceRays>(std::move(*rays));
  settling_ = std::make_unique<const SettlingScene>(details_.mesh);
  // Both have copies.
  details_.mesh = {};
  return {};
}

Stage PreparedScene::stage() const {
  return {.scene = scene_,
          .objects = context_.world.objects(),
          .robot = context_.world.robot(),
          .floor = floor_,
          .reach = context_.reach,
          .supports = supports_,
          .rays = rays_.get(),
          .settling = settling_.get(),
          .bodies = context_.bodies,
          .options = context_.options};
}

GeneratedScene PreparedScene::summary() const {
  return {.name = std::string(scene_.name()),
          .episodes = 0,
          .floor_places = floor_.places().size(),
          .support_places = supports_.places().size(),
          .surfaces = supports_.surfaceCount(),
          .receptacles = details_.receptacles.size(),
          .has_mesh = settling_ != nullptr};
}

}  // namespace galactic::bake
