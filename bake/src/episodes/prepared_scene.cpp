#include "episodes/prepared_scene.h"

#include <fmt/format.h>

#include <string>
#include <utility>

namespace galactic::bake {
namespace {

/// Grids may reach this far beyond the triangles that they were made of, metres.
constexpr float kGridMargin = 1;

/// The rectangle of a grid; heights are 0.
Bounds groundOf(const ColumnGrid& grid) {
  const ColumnGridLayout& layout = grid.layout();
  const float length = static_cast<float>(layout.columns_x) * layout.spacing;
  const float width = static_cast<float>(layout.columns_z) * layout.spacing;
  return {{layout.min_x, 0, layout.min_z}, {layout.min_x + length, 0, layout.min_z + width}};
}

/// Whether the mesh is about where the grid is: another up axis or unit is not.
bool covers(const Bounds& mesh, const Bounds& grid) {
  return mesh.min.x <= grid.min.x + kGridMargin && mesh.min.z <= grid.min.z + kGridMargin &&
         mesh.max.x >= grid.max.x - kGridMargin && mesh.max.z >= grid.max.z - kGridMargin;
}

}  // namespace

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
  prepared->unusable_ = prepared->whyUnusable();
  if (!prepared->unusable_.empty()) return prepared;
  if (auto used = prepared->useMesh(); !used) return tl::unexpected(used.error());
  return prepared;
}

std::string PreparedScene::whyUnusable() const {
  const Robot& robot = context_.world.robot();
  if (floor_.places().empty()) {
    return fmt::format(
        "the robot {} stands nowhere: {} places on the floor were tried in {} headings each, and "
        "in its start pose one of its {} spheres was blocked at each; give a larger scene or a "
        "smaller start pose",
        robot.name(), floor_.tried(), kHeadings, robot.spheres().size());
  }
  if (!supports_.places().empty()) return {};
  const bool in_receptacles = context_.options.supports == SupportChoice::kReceptacles;
  if (in_receptacles && details_.receptacles.empty()) {
    return "no receptacles of the scene are known: packs hold none, a recipe that names the "
           "scene's "
           "dataset brings them; or let objects stand on any surface";
  }
  const DistanceRange& heights = context_.options.heights;
  return fmt::format(
      "no flat surface {}between {} and {} m over the floor is within reach of the {} places to "
      "which the robot {} can drive; change the heights or the robot's start pose",
      in_receptacles ? "in its receptacles " : "", heights.least, heights.most,
      floor_.places().size(), robot.name());
}

Result<void> PreparedScene::useMesh() {
  if (details_.mesh.triangles.empty()) return {};
  const Bounds& mesh = details_.mesh.bounds;
  const Bounds grid = groundOf(scene_.grids().front());
  if (!covers(mesh, grid)) {
    return fail(ErrorCode::kInvalidInput, std::string(scene_.name()),
                fmt::format("the scene's mesh reaches from x {}, z {} to x {}, z {} m, its column "
                            "grids from x {}, z {} to x {}, z {} m; give the mesh it was baked "
                            "from, in the world's frame",
                            mesh.min.x, mesh.min.z, mesh.max.x, mesh.max.z, grid.min.x, grid.min.z,
                            grid.max.x, grid.max.z));
  }
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
