#include "render/render_source.h"

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "galactic/kinematics.h"
#include "import/affine.h"
#include "render/material_list.h"
#include "robot/robot_parts.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

/// The neutral tint.
constexpr std::array<float, 4> kWhite{1, 1, 1, 1};

/// Assigns semantic ids to names in the order of their first use.
class SemanticNames {
 public:
  explicit SemanticNames(std::vector<std::string>& names) : names_(names) {}

  std::uint32_t numberOf(const std::string& name) {
    constexpr std::size_t kMost = 65535;
    const auto found = numbers_.find(name);
    if (found != numbers_.end()) return found->second;
    if (names_.size() == kMost) names_.emplace_back("others");
    if (names_.size() > kMost) return kMost;
    names_.push_back(name);
    const auto number = static_cast<std::uint32_t>(names_.size() - 1);
    numbers_.emplace(name, number);
    return number;
  }

 private:
  std::vector<std::string>& names_;
  std::map<std::string, std::uint32_t> numbers_;
};

std::string nameOf(const SourceAsset& asset, const SourceInstance& instance) {
  if (!instance.name.empty()) return instance.name;
  const std::string& mesh = asset.meshes[instance.mesh].name;
  return mesh.empty() ? "unnamed" : mesh;
}

std::uint32_t addOwnMesh(Surface surface, RenderSource& source) {
  auto mesh = std::make_unique<SourceMesh>();
  mesh->name = "primitive";
  mesh->positions = std::move(surface.positions);
  mesh->triangles = std::move(surface.triangles);
  source.own_meshes.push_back(std::move(mesh));
  return static_cast<std::uint32_t>(source.own_meshes.size() - 1);
}

/// Places the drawn shapes of a robot's links.
class RobotPlacer {
 public:
  RobotPlacer(const SourceRobot& robot, RenderSource& source)
      : robot_(robot), source_(source), materials_(source) {}

  Result<void> place(const fs::path& folder, const TextureBakeOptions& options, unsigned threads,
                     TextureLibrary* library) {
    placed_.resize(robot_.links.size());
    for (const SourceLink& link : robot_.links) source_.semantics.push_back(link.name);
    // Goes asset by asset, because each has its own embedded images.
    for (std::uint32_t mesh = 0; mesh < robot_.meshes.size(); ++mesh) {
      for (std::size_t link = 0; link < robot_.links.size(); ++link) placeMesh(mesh, link);
      if (source_.materials.size() == source_.baked.materials.size()) continue;
      RETURN_IF_ERROR(
          materials_.bake({robot_.meshes[mesh].textures, folder}, options, threads, library));
    }
    for (std::size_t link = 0; link < robot_.links.size(); ++link) placePrimitives(link);
    RETURN_IF_ERROR(materials_.bake({.folder = folder}, options, threads, library));
    for (std::size_t link = 0; link < robot_.links.size(); ++link) {
      if (placed_[link].empty()) continue;
      source_.parts.push_back(
          {.part = static_cast<std::uint32_t>(link), .meshes = std::move(placed_[link])});
    }
    return {};
  }

 private:
  void placeMesh(std::uint32_t number, std::size_t link) {
    const SourceAsset& asset = robot_.meshes[number];
    for (const LinkShape& shape : drawnShapes(robot_.links[link])) {
      const auto* shape_mesh = std::get_if<MeshShape>(&shape.geometry);
      if (shape_mesh == nullptr || shape_mesh->mesh != number) continue;
      for (const SourceInstance& instance : asset.instances) {
        const SourceMesh& mesh = asset.meshes[instance.mesh];
        placed_[link].push_back(
            {.mesh = &mesh,
             .part_from_mesh = compose(shape.link_from_shape, instance.world_from_mesh),
             .material = materialOf(shape, asset, mesh, robot_.links[link].visuals_are_lost),
             .semantic = static_cast<std::uint32_t>(link)});
      }
    }
  }

  /// Collision meshes that stand in for lost visuals get a plain color, whatever look their files
  /// define.
  std::uint32_t materialOf(const LinkShape& shape, const SourceAsset& asset, const SourceMesh& mesh,
                           bool stands_in) {
    if (stands_in) return materials_.addColor(kPlainColor, isTwoSided(asset, mesh));
    const bool is_two_sided = isTwoSided(asset, mesh);
    if (!shape.texture.empty() && !mesh.uvs.empty()) {
      return materials_.addImage(shape.texture, shape.color.value_or(kWhite), is_two_sided);
    }
    const bool has_own_color = shape.color && (shape.hides_looks || !hasLooks(asset, mesh));
    return has_own_color ? materials_.addColor(*shape.color, is_two_sided)
                         : materials_.add(asset, mesh);
  }

  void placePrimitives(std::size_t link) {
    for (const LinkShape& shape : drawnShapes(robot_.links[link])) {
      if (std::holds_alternative<MeshShape>(shape.geometry)) continue;
      const std::uint32_t own = addOwnMesh(surfaceOfPrimitive(shape), source_);
      placed_[link].push_back(
          {.mesh = source_.own_meshes[own].get(),
           .part_from_mesh = kIdentityAffine,
           .material = materials_.addColor(shape.color.value_or(kPlainColor), false),
           .semantic = static_cast<std::uint32_t>(link)});
    }
  }

  static bool isTwoSided(const SourceAsset& asset, const SourceMesh& mesh) {
    return mesh.material >= asset.materials.size() || asset.materials[mesh.material].two_sided;
  }

  const SourceRobot& robot_;
  RenderSource& source_;
  MaterialList materials_;
  std::vector<std::vector<PlacedMesh>> placed_;
};

}  // namespace

Result<RenderSource> sceneRenderSource(const SourceAsset& scene, const fs::path& folder,
                                       const TextureBakeOptions& options, unsigned threads,
                                       TextureLibrary* library) {
  RenderSource source;
  source.may_hold_light = true;
  SemanticNames semantics(source.semantics);
  MaterialList materials(source);
  RenderPart& part = source.parts.emplace_back();
  part.meshes.reserve(scene.instances.size());
  for (const SourceInstance& instance : scene.instances) {
    const SourceMesh& mesh = scene.meshes[instance.mesh];
    part.meshes.push_back({.mesh = &mesh,
                           .part_from_mesh = instance.world_from_mesh,
                           .material = materials.add(scene, mesh),
                           .semantic = semantics.numberOf(nameOf(scene, instance))});
  }
  if (source.semantics.empty()) source.semantics.push_back(scene.name);
  RETURN_IF_ERROR(materials.bake({scene.textures, folder}, options, threads, library));
  return source;
}

Result<RenderSource> objectRenderSource(const SourceAsset& object, const fs::path& folder,
                                        const TextureBakeOptions& options, unsigned threads,
                                        TextureLibrary* library) {
  auto source = sceneRenderSource(object, folder, options, threads, library);
  if (!source) return source;
  source->may_hold_light = false;
  source->semantics.assign(1, object.name);
  for (PlacedMesh& placed : source->parts.front().meshes) placed.semantic = 0;
  return source;
}

Result<RenderSource> robotRenderSource(const SourceRobot& robot, const fs::path& folder,
                                       const TextureBakeOptions& options, unsigned threads,
                                       TextureLibrary* library) {
  RenderSource source;
  RETURN_IF_ERROR(RobotPlacer(robot, source).place(folder, options, threads, library));
  return source;
}

void standInStartPose(RenderSource& source, const FlatKinematics& kinematics) {
  std::vector<Pose> base_from_link(kinematics.links.size());
  forwardKinematics(kinematics.links, {}, kinematics.start_positions, base_from_link);
  for (RenderPart& part : source.parts) {
    const Quat& rotation = base_from_link[part.part].rotation;
    const std::array<Vec3, 3> columns{rotate(rotation, {1, 0, 0}), rotate(rotation, {0, 1, 0}),
                                      rotate(rotation, {0, 0, 1})};
    for (std::size_t column = 0; column < 3; ++column) {
      part.light_from_part[column] = static_cast<double>(columns[column].x);
      part.light_from_part[4 + column] = static_cast<double>(columns[column].y);
      part.light_from_part[8 + column] = static_cast<double>(columns[column].z);
    }
  }
}

}  // namespace galactic::bake
