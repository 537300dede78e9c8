#include "pack_tool/mesh/figure_glb.h"

#include <fmt/format.h>

#include <map>

#include "pack_tool/mesh/sphere_mesh.h"
#include "support/try.h"
#include "view/glb_file.h"
#include "view/render_glb.h"

namespace galactic::pack_tool {

namespace {

/// Linear colors as in pictures: gray, green, blue, orange.
constexpr GlbMaterial kMeshMaterial{"mesh", {0.44F, 0.45F, 0.48F, 1}};
constexpr GlbMaterial kColoredMaterial{"colored mesh", {1, 1, 1, 1}};
constexpr GlbMaterial kRobotSphereMaterial{"robot spheres", {0.02F, 0.43F, 0.07F, 0.45F}};
constexpr GlbMaterial kObjectSphereMaterial{"object spheres", {0.03F, 0.17F, 0.80F, 0.45F}};
constexpr GlbMaterial kBoxMaterial{"boxes", {0.87F, 0.22F, 0.01F, 1}};

/// Turns -Z, where a camera of glTF looks, to +X; +Y stays.
constexpr float kRootHalf = 0.707106781F;
constexpr Quat kCameraTurn{0, -kRootHalf, 0, kRootHalf};

/// Adds what figures have in common when it is first needed.
class FigureWriter {
 public:
  Result<void> write(const Figure& figure) {
    const std::size_t root = file_.addNode({.name = figure.name});
    std::vector<std::size_t> nodes;
    for (const FigurePart& part : figure.parts) {
      const bool carried = part.parent >= 0;
      const auto parent = static_cast<std::size_t>(part.parent);
      const Pose pose = carried
                            ? inverse(figure.parts[parent].world_from_part) * part.world_from_part
                            : part.world_from_part;
      nodes.push_back(file_.addNode(
          {.name = part.name, .parent_from_node = pose, .parent = carried ? nodes[parent] : root}));
      if (auto written = writePart(figure, part, nodes.back()); !written) return written;
    }
    if (figure.grasp) {
      file_.addNode({.name = "grasp point",
                     .parent_from_node = {figure.grasp->center_in_world, {}},
                     .parent = root});
    }
    if (figure.camera) {
      file_.addNode({.name = "camera",
                     .parent_from_node = figure.camera->world_from_camera * Pose{{}, kCameraTurn},
                     .camera_fov = figure.camera->vertical_fov,
                     .parent = root});
    }
    return {};
  }

  [[nodiscard]] Result<std::string> bytes() const { return file_.bytes(); }

 private:
  Result<void> writePart(const Figure& figure, const FigurePart& part, std::size_t node) {
    const std::string name = part.name + " mesh";
    if (part.render_model) {
      const RenderMeshes& meshes = *figure.render_meshes;
      auto written = writerOf(meshes).write(meshes.models[*part.render_model], name, node);
      if (!written) return written;
    } else if (!part.surface.empty()) {
      writeSurface(part.surface, name, node);
    }
    if (!part.spheres.empty()) writeSpheres(figure, part, node);
    if (part.box) writeBox(part, node);
    return {};
  }

  /// The one for all figures that share these meshes, and so their textures.
  RenderGlbWriter& writerOf(const RenderMeshes& meshes) {
    return writers_.try_emplace(&meshes, meshes, file_).first->second;
  }

  void writeSurface(const SurfaceView& surface, const std::string& name, std::size_t node) {
    const std::size_t mesh = addMesh(
        name, {.positions = surface.positions,
               .colors = surface.colors,
               .corners = surface.corners,
               .material = material(surface.colors.empty() ? kMeshMaterial : kColoredMaterial)});
    file_.addNode({.name = name, .mesh = mesh, .parent = node});
  }

  std::size_t addMesh(const std::string& name, const GlbPrimitive& primitive) {
    return file_.addMesh(name, {&primitive, 1});
  }

  void writeBox(const FigurePart& part, std::size_t node) {
    file_.addNode({.name = part.name + " box",
                   .parent_from_node = part.box->pose,
                   .scale = part.box->half_extents,
                   .mesh = unitBox(),
                   .parent = node});
  }

  void writeSpheres(const Figure& figure, const FigurePart& part, std::size_t node) {
    const std::size_t group = file_.addNode({.name = part.name + " spheres", .parent = node});
    for (std::size_t n = 0; n < part.spheres.size(); ++n) {
      const SetSphere& sphere = part.spheres[n];
      file_.addNode({.name = fmt::format("{} sphere {}", part.name, n),
                     .parent_from_node = {sphere.center, {}},
                     .mesh = sphereOf(figure.radii[sphere.radius_index], figure.kind),
                     .parent = group});
    }
  }

  std::size_t material(const GlbMaterial& wanted) {
    const auto [found, added] = materials_.try_emplace(std::string(wanted.name), 0);
    if (added) found->second = file_.addMaterial(wanted);
    return found->second;
  }

  std::size_t sphereOf(float radius, FigureKind kind) {
    const auto [found, added] = spheres_.try_emplace(std::pair(kind, radius), 0);
    if (!added) return found->second;
    const SphereMesh unit = makeSphereMesh();
    std::vector<Vec3> points;
    points.reserve(unit.points.size());
    for (const Vec3& point : unit.points) points.push_back(point * radius);
    found->second = addMesh(
        fmt::format("sphere of {} m", radius),
        {.positions = points,
         .normals = unit.points,
         .corners = unit.corners,
         .material =
             material(kind == FigureKind::kRobot ? kRobotSphereMaterial : kObjectSphereMaterial)});
    return found->second;
  }

  std::size_t unitBox() {
    if (box_) return *box_;
    const auto corners = cornersOf({{}, {1, 1, 1}});
    std::vector<std::uint32_t> ends;
    for (const auto& [from, to] : kBoxEdges) {
      ends.push_back(static_cast<std::uint32_t>(from));
      ends.push_back(static_cast<std::uint32_t>(to));
    }
    box_ = addMesh("box", {.positions = corners,
                           .corners = ends,
                           .shape = GlbShape::kLines,
                           .material = material(kBoxMaterial)});
    return *box_;
  }

  GlbFile file_;
  /// Asked by address, never walked through.
  std::map<const RenderMeshes*, RenderGlbWriter> writers_;
  std::map<std::string, std::size_t> materials_;
  std::map<std::pair<FigureKind, float>, std::size_t> spheres_;
  std::optional<std::size_t> box_;
};

}  // namespace

Result<std::string> encodeGlb(std::span<const Figure> figures) {
  FigureWriter writer;
  for (const Figure& figure : figures) {
    RETURN_IF_ERROR(writer.write(figure));
  }
  return writer.bytes();
}

}  // namespace galactic::pack_tool
