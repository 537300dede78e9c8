#include <fmt/format.h>

#include <memory>
#include <string>
#include <utility>

#include "galactic/debug_views.h"
#include "layout/render_mesh_builder.h"
#include "support/call_check.h"
#include "support/try.h"
#include "views/grid_surface.h"
#include "views/shapes.h"

namespace galactic {
namespace {

/// The semantic ids, in the order of the names in PartList.
enum Semantic : std::uint16_t { kGrid, kRobotSphere, kHeldSphere, kRestingBox, kGoal };

Result<std::size_t> gridIndexOf(const World& world, float radius) {
  if (radius == 0) return 0;
  if (const auto index = world.scenes().front().gridIndex(radius)) return *index;
  std::string known;
  for (const float one : world.radii())
    known += fmt::format("{}{}", known.empty() ? "" : ", ", one);
  return fail(
      ErrorCode::kInvalidInput, "debug view",
      fmt::format("found a radius of {} m; expected one of the world's: {}", radius, known));
}

/// Collects parts and numbers them in the order in which they are added.
class PartList {
 public:
  PartList() {
    source_.materials = {{.name = "debug"}};
    source_.semantics = {"grid", "robot sphere", "held sphere", "resting box", "goal"};
  }

  /// Returns the number of the part.
  std::uint32_t add(RenderSurface surface, Semantic semantic) {
    const std::uint32_t number = count();
    surface.semantic = semantic;
    RenderPart& part = source_.parts.emplace_back();
    part.part = number;
    part.source_triangles = static_cast<std::uint32_t>(surface.corners.size() / 3);
    part.surfaces.push_back(std::move(surface));
    return number;
  }
  [[nodiscard]] std::uint32_t count() const {
    return static_cast<std::uint32_t>(source_.parts.size());
  }
  [[nodiscard]] const RenderMeshSource& source() const { return source_; }

 private:
  RenderMeshSource source_;
};

/// The box of each object that the episodes use.
std::vector<OrientedBox> boxesOf(const World& world) {
  std::vector<OrientedBox> boxes;
  for (std::uint32_t n = 0; n < world.episodes().objectNames().size(); ++n) {
    boxes.push_back(world.object(n).box);
  }
  return boxes;
}

}  // namespace

Result<DebugModels> DebugModels::from(const World& world, const DebugOptions& options) {
  ASSIGN_OR_RETURN(const std::size_t grid, gridIndexOf(world, options.radius));
  DebugModels models;
  models.world_hash_ = world.hash();
  PartList parts;
  for (const Scene& scene : world.scenes()) {
    parts.add(views::gridSurface(scene.grids()[grid]), kGrid);
  }
  models.first_robot_sphere_ = parts.count();
  for (const float radius : world.radii()) {
    parts.add(views::sphereSurface(radius, kDebugRobot.color), kRobotSphere);
  }
  models.first_held_sphere_ = parts.count();
  for (const float radius : world.radii()) {
    parts.add(views::sphereSurface(radius, kDebugHeld.color), kHeldSphere);
  }
  const std::vector<OrientedBox> boxes = boxesOf(world);
  models.first_box_ = parts.count();
  for (const OrientedBox& box : boxes)
    parts.add(views::boxSurface(box, kDebugObject.color), kRestingBox);
  models.first_target_ = parts.count();
  for (const OrientedBox& box : boxes)
    parts.add(views::boxSurface(box, kDebugTask.color), kRestingBox);
  models.first_goal_ = parts.count();
  for (const OrientedBox& box : boxes)
    parts.add(views::boxFrameSurface(box, kDebugTask.color), kGoal);

  ASSIGN_OR_RETURN(RenderMeshStorage built, buildRenderMeshes(parts.source()));
  auto memory = std::make_shared<const RenderMeshStorage>(std::move(built));
  auto library = std::make_shared<RenderLibrary>();
  library->add(memory->view());
  library->keep(std::move(memory));
  models.library_ = std::move(library);
  return models;
}

std::optional<std::uint32_t> DebugModels::sceneModel(std::uint32_t scene) const {
  // Scenes come first, so their number is that of the first sphere.
  detail::checkIndex("DebugModels::sceneModel", "scene", scene, first_robot_sphere_);
  if (library_->model(scene).cluster_count == 0) return std::nullopt;
  return scene;
}

std::uint32_t DebugModels::boxModel(std::uint32_t object) const {
  detail::checkIndex("DebugModels::boxModel", "object", object, objectCount());
  return first_box_ + object;
}

std::uint32_t DebugModels::targetModel(std::uint32_t object) const {
  detail::checkIndex("DebugModels::targetModel", "object", object, objectCount());
  return first_target_ + object;
}

std::uint32_t DebugModels::goalModel(std::uint32_t object) const {
  detail::checkIndex("DebugModels::goalModel", "object", object, objectCount());
  return first_goal_ + object;
}

std::uint32_t DebugModels::sphereModel(DebugSpheres whose, std::uint32_t radius_index) const {
  detail::checkIndex("DebugModels::sphereModel", "radius", radius_index,
                     first_held_sphere_ - first_robot_sphere_);
  return (whose == DebugSpheres::kRobot ? first_robot_sphere_ : first_held_sphere_) + radius_index;
}

}  // namespace galactic
