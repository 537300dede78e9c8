#include "pack_tool/figure/figures_of_pack.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "galactic/schema/pack_generated.h"
#include "pack_tool/figure/shared_textures_of.h"
#include "support/text/counted.h"
#include "support/try.h"

namespace galactic::pack_tool {

namespace {

static_assert(sizeof(Vec3) == sizeof(schema::Vec3));

SurfaceView viewOf(const schema::Surface* surface) {
  if (surface == nullptr) return {};
  const auto& positions = *surface->positions();
  return {{reinterpret_cast<const Vec3*>(positions.Data()), positions.size()},
          {surface->triangles()->data(), surface->triangles()->size()},
          {surface->colors()->data(), surface->colors()->size()}};
}

/// The render meshes of a pack, where it has them and they are wanted.
std::shared_ptr<const RenderMeshes> renderMeshesFor(const PackFile& pack, LayerSet layers) {
  if (!layers.has(FigureLayer::kMesh)) return nullptr;
  return renderMeshesWithTextures(pack);
}

/// Gives a part its render model.
void addRenderModel(Figure& figure, std::size_t part, std::uint32_t number) {
  if (figure.render_meshes) {
    figure.parts[part].render_model = figure.render_meshes->modelOf(number);
  }
}

/// Mean, 95th percentile and maximum.
std::string millimeters(const schema::LengthStatistics* lengths) {
  if (lengths == nullptr) return "-";
  return fmt::format("{:.1f}/{:.1f}/{:.1f} mm", 1e3 * lengths->mean(), 1e3 * lengths->p95(),
                     1e3 * lengths->max());
}

Figure objectFigure(const ObjectSet& set, const ObjectModel& object, const schema::Object& stored,
                    LayerSet layers) {
  Figure figure;
  figure.kind = FigureKind::kObject;
  figure.name = object.name;
  figure.radii = set.radii();
  const schema::SphereSetStatistics& quality = *stored.sphere_statistics();
  const std::string counts = fmt::format("{} ({})", counted(object.spheres.size(), "sphere"),
                                         sphereCounts(object.spheres, set.radii().size()));
  const std::string gap = fmt::format("gap {}", millimeters(quality.gap()));
  figure.caption = fmt::format("{}, {}, protrusion {}: mean/p95/max", counts, gap,
                               millimeters(quality.protrusion()));
  figure.short_caption = {counts, gap};
  FigurePart& part = figure.parts.emplace_back();
  part.name = object.name;
  if (layers.has(FigureLayer::kMesh)) part.surface = viewOf(stored.surface());
  if (layers.has(FigureLayer::kSpheres)) part.spheres = object.spheres;
  if (layers.has(FigureLayer::kBoxes)) part.box = object.box;
  return figure;
}

Result<std::vector<Figure>> objectFigures(const PackFile& pack, const FigureOptions& options) {
  if (!options.joints.values.empty() || options.joints.others != OtherJoints::kStart) {
    return fail(ErrorCode::kInvalidInput, pack.where(),
                "holds objects, which have no joints; leave out --joints and --all-zero");
  }
  ASSIGN_OR_RETURN(const auto set, ObjectSet::from(pack));
  const auto& stored = *pack.root().asset_as_ObjectSet()->objects();
  const auto render_meshes = renderMeshesFor(pack, options.layers);
  std::vector<Figure> figures;
  for (flatbuffers::uoffset_t n = 0; n < stored.size(); ++n) {
    const ObjectModel& object = set.objects()[n];
    if (!options.object.empty() && object.name != options.object) continue;
    figures.push_back(objectFigure(set, object, *stored.Get(n), options.layers));
    figures.back().render_meshes = render_meshes;
    addRenderModel(figures.back(), 0, n);
  }
  if (figures.empty()) {
    return fail(ErrorCode::kInvalidInput, pack.where(),
                fmt::format("has no object \"{}\"; galactic-pack info lists its {}", options.object,
                            counted(stored.size(), "object")));
  }
  return figures;
}

/// The ground that the base covers, a little line for each part of a circle.
Footprint footprintOf(const RobotBase& base) {
  const Vec3& low = base.footprint_min;
  const Vec3& high = base.footprint_max;
  if (!(base.footprint_radius > 0)) {
    return {{low.x, 0, low.z}, {high.x, 0, low.z}, {high.x, 0, high.z}, {low.x, 0, high.z}};
  }
  constexpr int kCorners = 48;
  constexpr double kTurn = 6.283185307179586;
  Footprint circle;
  for (int n = 0; n < kCorners; ++n) {
    const double angle = kTurn * n / kCorners;
    circle.push_back(
        {0.5F * (low.x + high.x) + base.footprint_radius * static_cast<float>(std::cos(angle)), 0,
         0.5F * (low.z + high.z) + base.footprint_radius * static_cast<float>(std::sin(angle))});
  }
  return circle;
}

/// The largest gap and protrusion of all groups.
std::string worstText(const flatbuffers::Vector<flatbuffers::Offset<schema::SphereGroup>>& groups) {
  double gap = 0;
  double protrusion = 0;
  bool measured = false;
  for (const schema::SphereGroup* group : groups) {
    const schema::SphereSetStatistics* quality = group->statistics();
    if (quality == nullptr || quality->gap() == nullptr || quality->protrusion() == nullptr)
      continue;
    measured = true;
    gap = std::max(gap, quality->gap()->max());
    protrusion = std::max(protrusion, quality->protrusion()->max());
  }
  if (!measured) return {};
  return fmt::format(", gap up to {:.1f} mm, protrusion up to {:.1f} mm", 1e3 * gap,
                     1e3 * protrusion);
}

std::vector<FigurePart> robotParts(const Robot& robot, const std::vector<Pose>& world_from_link) {
  std::vector<FigurePart> parts(robot.links().size());
  for (std::size_t n = 0; n < parts.size(); ++n) {
    parts[n].name = robot.linkName(n);
    parts[n].parent = robot.links()[n].parent;
    parts[n].world_from_part = world_from_link[n];
  }
  return parts;
}

void addMarks(const Robot& robot, const std::vector<Pose>& world_from_link, Figure& figure) {
  if (const auto& effector = robot.endEffector()) {
    figure.grasp = {world_from_link[effector->link] * effector->grasp_point,
                    effector->grasp_radius};
  }
  if (const auto& camera = robot.camera()) {
    figure.camera = {world_from_link[camera->link] * camera->link_from_camera,
                     camera->vertical_fov};
  }
  if (robot.base()) figure.footprint = footprintOf(*robot.base());
}

Result<std::vector<Figure>> robotFigures(const PackFile& pack, const FigureOptions& options) {
  if (!options.object.empty()) {
    return fail(ErrorCode::kInvalidInput, pack.where(), "holds a robot; leave out --object");
  }
  ASSIGN_OR_RETURN(const auto robot, Robot::from(pack));
  ASSIGN_OR_RETURN(const auto positions, jointPositions(robot, options.joints, pack.where()));
  const float height = robot.base() ? robot.base()->root_height : 0.0F;
  std::vector<Pose> world_from_link(robot.links().size());
  forwardKinematics(robot.links(), {{0, height, 0}, {}}, positions, world_from_link);

  std::vector<Figure> figures(1);
  Figure& figure = figures.front();
  figure.kind = FigureKind::kRobot;
  figure.name = robot.name();
  figure.radii = robot.radii();
  figure.caption = fmt::format("{} ({}) in {}{}", counted(robot.spheres().size(), "sphere"),
                               sphereCounts(robot.spheres(), robot.radii().size()),
                               counted(robot.groups().size(), "group"),
                               worstText(*pack.root().asset_as_Robot()->groups()));
  figure.parts = robotParts(robot, world_from_link);
  if (options.layers.has(FigureLayer::kMesh)) {
    for (const schema::LinkSurface* surface : *pack.root().asset_as_Robot()->surfaces()) {
      const SurfaceView visual = viewOf(surface->visual());
      figure.parts[surface->link()].surface =
          visual.empty() ? viewOf(surface->collision()) : visual;
    }
  }
  figure.render_meshes = renderMeshesFor(pack, options.layers);
  for (std::uint32_t link = 0; link < figure.parts.size(); ++link) {
    addRenderModel(figure, link, link);
  }
  if (options.layers.has(FigureLayer::kSpheres)) {
    for (const SphereGroup& group : robot.groups()) {
      figure.parts[group.link].spheres = group.spheres;
    }
  }
  addMarks(robot, world_from_link, figure);
  return figures;
}

Result<std::vector<Figure>> sceneFigures(const PackFile& pack, const FigureOptions& options) {
  if (!options.object.empty() || !options.joints.values.empty() ||
      options.joints.others != OtherJoints::kStart) {
    return fail(ErrorCode::kInvalidInput, pack.where(),
                "is a scene; --object, --joints and --all-zero are for objects and robots");
  }
  if (!options.layers.has(FigureLayer::kMesh)) {
    return fail(ErrorCode::kInvalidInput, pack.where(),
                "is a scene, which has neither spheres nor boxes to show; take --what mesh");
  }
  Figure figure;
  figure.kind = FigureKind::kScene;
  figure.name = pack.root().asset_as_Scene()->name()->str();
  figure.render_meshes = renderMeshesFor(pack, options.layers);
  figure.parts.resize(1);
  figure.parts.front().name = figure.name;
  addRenderModel(figure, 0, 0);
  if (!figure.parts.front().render_model) {
    return fail(ErrorCode::kInvalidInput, pack.where(),
                "has no render meshes, only column grids; bake the scene with render meshes, or "
                "export a grid as an OBJ or PLY file");
  }
  return std::vector{std::move(figure)};
}

}  // namespace

Result<std::vector<Figure>> figuresOf(const PackFile& pack, const FigureOptions& options) {
  if (pack.kind() == PackKind::kObjects) return objectFigures(pack, options);
  if (pack.kind() == PackKind::kRobot) return robotFigures(pack, options);
  if (pack.kind() == PackKind::kScene) return sceneFigures(pack, options);
  return fail(
      ErrorCode::kInvalidInput, pack.where(),
      fmt::format("is a pack of kind {}, expected a scene (SCEN), objects (OBJS) or a robot "
                  "(RBOT)",
                  packKindName(pack.kind())));
}

std::string sphereCounts(std::span<const SetSphere> spheres, std::size_t radii) {
  std::vector<std::size_t> counts(radii);
  for (const SetSphere& sphere : spheres) ++counts[sphere.radius_index];
  std::reverse(counts.begin(), counts.end());
  return fmt::format("{}", fmt::join(counts, "+"));
}

void layOutInARow(std::vector<Figure>& figures) {
  std::vector<FigureBounds> bounds;
  float width = 0;
  for (const Figure& figure : figures) {
    bounds.push_back(boundsOf(figure));
    if (!bounds.back().empty()) width += bounds.back().max.x - bounds.back().min.x;
  }
  const float gap = 0.1F * width / static_cast<float>(std::max<std::size_t>(figures.size(), 1));
  float x = 0;
  for (std::size_t n = 0; n < figures.size(); ++n) {
    if (bounds[n].empty()) continue;
    const Vec3& low = bounds[n].min;
    const Vec3& high = bounds[n].max;
    const Vec3 shift{x - low.x, -low.y, -0.5F * (low.z + high.z)};
    for (FigurePart& part : figures[n].parts) {
      part.world_from_part.translation = part.world_from_part.translation + shift;
    }
    x += high.x - low.x + gap;
  }
}

}  // namespace galactic::pack_tool
