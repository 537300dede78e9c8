#include "dataset/scene_composer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>
#include <utility>

#include "dataset/config/placement.h"
#include "galactic/bake/triangle_mesh.h"
#include "import/affine.h"
#include "import/source_files.h"
#include "robot/robot_parts.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

/// A box, cylinder or sphere as an asset of one mesh.
SourceAsset primitiveAsset(const LinkShape& shape) {
  Surface surface = surfaceOfPrimitive(shape);
  SourceAsset asset;
  SourceMesh& mesh = asset.meshes.emplace_back();
  mesh.name = "primitive";
  mesh.positions = std::move(surface.positions);
  mesh.triangles = std::move(surface.triangles);
  SourceMaterial& material = asset.materials.emplace_back();
  material.name = "URDF";
  material.base_color = shape.color.value_or(kPlainColor);
  asset.instances.push_back({.name = mesh.name, .mesh = 0, .world_from_mesh = kIdentityAffine});
  return asset;
}

}  // namespace

SceneComposer::SceneComposer(const DatasetIndex& index, MeshLibrary& meshes)
    : index_(index), meshes_(meshes), merger_(index.config, result_.scene) {}

std::string SceneComposer::relative(const fs::path& file) const {
  return nameRelativeTo(index_.config, file);
}

void SceneComposer::noteMissing(const std::string& sentence) {
  if (++missing_[sentence] == 1) result_.missing.push_back(sentence);
}

void SceneComposer::noteAbsent(const fs::path& file) { absent_.insert(relative(file)); }

void SceneComposer::noteRead(const fs::path& folder, const ReadFiles& read) {
  for (const SourceFile& file : read.files) merger_.noteFile(folder / file.name, file);
  for (const std::string& name : read.absent) noteAbsent(folder / name);
  if (!read.is_settled) result_.scene.read.is_settled = false;
}

void SceneComposer::noteLooks(const fs::path& file, const std::vector<std::string>& missing) {
  for (const std::string& sentence : missing) {
    std::string told = fmt::format("{}: {}", relative(file), sentence);
    if (looks_.insert(told).second) result_.scene.missing.push_back(std::move(told));
  }
}

void SceneComposer::warnOnce(const std::string& warning) {
  if (warned_.insert(warning).second) result_.scene.warnings.push_back(warning);
}

void SceneComposer::noteWarnings(const fs::path& file, const std::vector<std::string>& warnings) {
  // Some URDFs draw one for each line.
  constexpr std::size_t kMost = 4;
  const std::size_t told = warnings.size() > kMost ? kMost - 1 : warnings.size();
  for (std::size_t n = 0; n < told; ++n) {
    warnOnce(fmt::format("{}: {}", relative(file), warnings[n]));
  }
  if (told < warnings.size()) {
    warnOnce(fmt::format("{}: and {} more warnings", relative(file), warnings.size() - told));
  }
}

std::string SceneComposer::nextName(const std::string& template_name) {
  return fmt::format("{}_:{:04d}", template_name, placed_[template_name]++);
}

Result<void> SceneComposer::noteItem(const PlacedItem& placed) {
  if (!placed.warning.empty()) warnOnce(placed.warning);
  if (placed.entry != nullptr && !placed.entry->config.empty()) {
    RETURN_IF_ERROR(merger_.noteFile(placed.entry->config));
  }
  if (!placed.missing.empty()) noteMissing(placed.missing);
  for (const fs::path& file : placed.absent) noteAbsent(file);
  return {};
}

Result<std::shared_ptr<const SourceAsset>> SceneComposer::load(const fs::path& mesh) {
  auto asset = meshes_.load(mesh);
  if (!asset) return asset;
  noteRead(mesh.parent_path(), (*asset)->read);
  noteLooks(mesh, (*asset)->missing);
  noteWarnings(mesh, (*asset)->warnings);
  return asset;
}

Affine SceneComposer::placement(const SceneItem& item, const TemplateAttributes& attributes,
                                const SourceAsset& asset) const {
  const Affine object_from_asset = objectFromAsset(attributes, item.scale);
  const Affine world_from_object = worldFromObject(item);
  if (item.origin.value_or(default_origin_) == TranslationOrigin::kAssetOrigin) {
    return compose(world_from_object, object_from_asset);
  }
  std::array<double, 3> center{};
  if (attributes.center_of_mass) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      center[axis] = (*attributes.center_of_mass)[axis] * attributes.scale[axis] * item.scale[axis];
    }
  } else {
    center = boxCenter(asset, object_from_asset);
  }
  const Affine centered = translationBy({-center[0], -center[1], -center[2]});
  return compose(world_from_object, compose(centered, object_from_asset));
}

Result<void> SceneComposer::checkDistance(const SceneItem& item, const std::string& what) const {
  double farthest = 0;
  for (const double t : item.translation) farthest = std::max(farthest, std::abs(t));
  if (farthest <= kMaxCoordinate) return {};
  return fail(
      ErrorCode::kInvalidInput, fmt::format("{}: {}", result_.scene.name, what),
      fmt::format("the scene places it {:.6g} m away, at most {} m are possible; correct its "
                  "translation",
                  farthest, kMaxCoordinate));
}

void SceneComposer::addMesh(const fs::path& mesh, const SourceAsset& asset,
                            const Affine& world_from_asset, const std::string& name) {
  const std::uint32_t first = merger_.take(mesh.string(), asset, mesh.parent_path());
  merger_.place(first, asset, world_from_asset, name);
}

Result<void> SceneComposer::place(const PlacedItem& placed) {
  switch (placed.kind) {
    case TemplateKind::kStage:
      return placeStage(placed);
    case TemplateKind::kArticulated:
      return placeArticulated(placed);
    case TemplateKind::kObject:
    case TemplateKind::kScene:
      break;
  }
  return placeObject(placed);
}

Result<void> SceneComposer::placeStage(const PlacedItem& placed) {
  const SceneItem& item = *placed.item;
  const auto asset = load(placed.file);
  if (!asset) return tl::unexpected(asset.error());
  const SceneItem unmoved;
  if (item.translation != unmoved.translation || item.rotation != unmoved.rotation ||
      item.scale != unmoved.scale) {
    warnOnce("the scene moves, turns or scales its stage; as in Habitat, it stays as it is");
  }
  TemplateAttributes attributes = *placed.attributes;
  addMesh(placed.file, **asset, objectFromAsset(attributes, unmoved.scale), placed.entry->name);
  // As in Habitat, a stage's boxes are turned with it and not scaled.
  attributes.scale = unmoved.scale;
  addReceptacles(attributes.receptacles, item.receptacles,
                 {.world_from_parent = objectFromAsset(attributes, unmoved.scale)});
  return {};
}

Result<void> SceneComposer::placeObject(const PlacedItem& placed) {
  const auto& [item, attributes] = std::tie(*placed.item, *placed.attributes);
  const std::string& template_name = placed.entry->name;
  RETURN_IF_ERROR(checkDistance(item, fmt::format("object '{}'", template_name)));
  if (!attributes.collidable) {
    warnOnce(
        fmt::format("object '{}' collides with nothing in Habitat; here it does", template_name));
  }
  const auto asset = load(placed.file);
  if (!asset) return tl::unexpected(asset.error());
  const Affine world_from_mesh = placement(item, attributes, **asset);
  const std::string name = nextName(template_name);
  addMesh(placed.file, **asset, world_from_mesh, name);
  addReceptacles(attributes.receptacles, item.receptacles,
                 {.kind = ReceptacleParent::Kind::kObject,
                  .name = name,
                  .world_from_parent = world_from_mesh});
  return {};
}

void SceneComposer::placeLinks(const ReceptacleParent& placed, const SourceRobot& furniture,
                               const fs::path& urdf) {
  const std::string& name = placed.name;
  for (std::size_t n = 0; n < furniture.links.size(); ++n) {
    const Affine& world_from_link = placed.links[n].world_from_link;
    const std::vector<LinkShape>& shapes = drawnShapes(furniture.links[n]);
    for (std::size_t visual = 0; visual < shapes.size(); ++visual) {
      const LinkShape& shape = shapes[visual];
      if (const auto* mesh = std::get_if<MeshShape>(&shape.geometry); mesh != nullptr) {
        const SourceAsset& asset = furniture.meshes[mesh->mesh];
        const fs::path file = urdf.parent_path() / asset.read.files.front().name;
        // Its points are turned otherwise than those of the same file as an object. Several meshes
        // may stand in the robot's file itself.
        const std::string key =
            fmt::format("URDF {} mesh {}", file.lexically_normal().string(), asset.name);
        const std::uint32_t first = merger_.take(key, asset, urdf.parent_path(), shape.color);
        merger_.place(first, asset, compose(world_from_link, shape.link_from_shape), name);
        continue;
      }
      const SourceAsset asset = primitiveAsset(shape);
      const std::string key = fmt::format("URDF {} link {} visual {}", urdf.string(), n, visual);
      const std::uint32_t first = merger_.take(key, asset, urdf.parent_path());
      merger_.place(first, asset, world_from_link, name);
    }
  }
}

Result<void> SceneComposer::placeArticulated(const PlacedItem& placed) {
  const auto& [item, attributes, urdf] = std::tie(*placed.item, *placed.attributes, placed.file);
  const std::string& template_name = placed.entry->name;
  const std::string what = fmt::format("{} '{}'", namesOf(placed.kind).noun, template_name);
  RETURN_IF_ERROR(checkDistance(item, what));
  const auto furniture = meshes_.loadFurniture(urdf);
  if (!furniture) return tl::unexpected(furniture.error());
  const fs::path folder = urdf.parent_path();
  noteRead(folder, (*furniture)->read);
  noteLooks(urdf, (*furniture)->unreadable);
  for (const SourceAsset& mesh : (*furniture)->meshes) {
    noteLooks(folder / mesh.read.files.front().name, mesh.missing);
  }
  noteWarnings(urdf, (*furniture)->warnings);
  for (const std::string& reference : (*furniture)->missing) {
    noteMissing(fmt::format("{}: its mesh '{}' is missing", what, reference));
  }
  // Neither the center of mass nor a frame: Habitat takes a URDF's root as it is.
  Affine root_from_urdf = kIdentityAffine;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    root_from_urdf[5 * axis] = attributes.scale[axis] * item.scale[axis];
  }
  const Affine world_from_root = compose(worldFromObject(item), root_from_urdf);
  const std::vector<Affine> root_from_link = restPose(**furniture, item.joint_positions);
  ReceptacleParent parent{.kind = ReceptacleParent::Kind::kFurniture,
                          .name = nextName(template_name)};
  parent.links.reserve(root_from_link.size());
  for (std::size_t n = 0; n < root_from_link.size(); ++n) {
    parent.links.push_back(
        {(*furniture)->links[n].name, compose(world_from_root, root_from_link[n])});
  }
  placeLinks(parent, **furniture, urdf);
  addReceptacles(attributes.receptacles, item.receptacles, parent);
  return {};
}

void SceneComposer::addReceptacles(ReceptacleTexts stated, const ReceptacleTexts& over,
                                   const ReceptacleParent& parent) {
  addStated(over, stated);
  PlacedReceptacles placed = placeReceptacles(stated, parent);
  for (const ReceptacleWarning& warning : placed.warnings) {
    warnOnce(fmt::format("{}: {}", relative(warning.file), warning.message));
  }
  std::ranges::move(placed.regions, std::back_inserter(result_.receptacles));
}

Result<ComposedScene> SceneComposer::run(const std::string& name, const SceneLayout& layout,
                                         const std::vector<fs::path>& read) {
  SourceAsset& scene = result_.scene;
  scene.name = name;
  scene.format = "Habitat scene dataset";
  scene.convention = "Y up, meters (Habitat)";
  for (const fs::path& file : read) {
    RETURN_IF_ERROR(merger_.noteFile(file));
  }
  const SceneInstance& instance = *layout.instance;
  default_origin_ = instance.origin;
  result_.has_stage = layout.hasStage();
  if (!instance.stage) warnOnce("the scene says that it has no stage");
  for (const PlacedItem& placed : layout.items) {
    RETURN_IF_ERROR(noteItem(placed));
    // What moves is no part of the scene: its mesh is read for a pack of its own.
    if (placed.file.empty() || placed.moves()) continue;
    RETURN_IF_ERROR(place(placed));
  }
  addReceptacles(instance.receptacles, {}, {.world_from_parent = kIdentityAffine});
  merger_.finish();
  scene.read.absent.assign(absent_.begin(), absent_.end());
  for (std::string& sentence : result_.missing) {
    const unsigned times = missing_.at(sentence);
    if (times > 1) sentence += fmt::format(" ({} times)", times);
  }
  return std::move(result_);
}

}  // namespace galactic::bake
