#include "dataset/scene_composer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <system_error>
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

bool isFile(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

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

const DatasetTemplate* SceneComposer::lookUp(TemplateKind kind, const SceneItem& item) {
  const DatasetBlock& block = index_.block(kind);
  const TemplateKindNames& names = namesOf(kind);
  const FoundTemplate found = block.templates.find(item.template_name);
  if (found.found == nullptr) {
    noteMissing(
        fmt::format("{} '{}' is in none of the dataset's paths", names.noun, item.template_name));
    for (const SearchedFolder& searched : block.searched) {
      noteAbsent(index_.folder / searched.folder / (item.template_name + searched.ending));
    }
  } else if (found.ambiguous) {
    warnOnce(fmt::format("{} '{}' may be several; '{}' is taken, the first", names.noun,
                         item.template_name, found.found->handle));
  }
  return found.found;
}

Result<SceneComposer::Attributes> SceneComposer::attributesOf(const DatasetTemplate& entry,
                                                              TemplateKind kind) {
  const std::string key = fmt::format("{}:{}", static_cast<unsigned>(kind), entry.handle);
  const auto known = attributes_.find(key);
  if (known != attributes_.end()) return known->second;
  ASSIGN_OR_RETURN(auto read, readAttributes(entry, index_.block(kind), kind));
  if (!entry.config.empty()) {
    RETURN_IF_ERROR(merger_.noteFile(entry.config));
  }
  auto attributes = std::make_shared<const TemplateAttributes>(std::move(read));
  attributes_.emplace(key, attributes);
  return attributes;
}

Result<fs::path> SceneComposer::meshOf(const DatasetTemplate& entry,
                                       const TemplateAttributes& attributes, TemplateKind kind) {
  ASSIGN_OR_RETURN(auto mesh, meshFileOf(entry, attributes));
  RETURN_IF_ERROR(index_.checkReach(mesh, placeOf(entry)));
  if (isFile(mesh)) return mesh;
  noteMissing(fmt::format("{} '{}': its mesh '{}' is missing", namesOf(kind).noun, entry.name,
                          relative(mesh)));
  noteAbsent(mesh);
  return fs::path();
}

Result<std::shared_ptr<const SourceAsset>> SceneComposer::load(const fs::path& mesh) {
  auto asset = meshes_.load(mesh);
  if (!asset) return asset;
  for (const SourceFile& file : (*asset)->files) {
    merger_.noteFile(mesh.parent_path() / file.name, file);
  }
  for (const std::string& file : (*asset)->absent_files) noteAbsent(mesh.parent_path() / file);
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

Result<void> SceneComposer::placeStage(const SceneItem& item) {
  result_.has_stage = false;
  const DatasetTemplate* entry = lookUp(TemplateKind::kStage, item);
  if (entry == nullptr) return {};
  const auto attributes = attributesOf(*entry, TemplateKind::kStage);
  if (!attributes) return tl::unexpected(attributes.error());
  ASSIGN_OR_RETURN(const auto mesh, meshOf(*entry, **attributes, TemplateKind::kStage));
  if (mesh.empty()) return {};
  const auto asset = load(mesh);
  if (!asset) return tl::unexpected(asset.error());
  const SceneItem unmoved;
  if (item.translation != unmoved.translation || item.rotation != unmoved.rotation ||
      item.scale != unmoved.scale) {
    warnOnce("the scene moves, turns or scales its stage; as in Habitat, it stays as it is");
  }
  addMesh(mesh, **asset, objectFromAsset(**attributes, unmoved.scale), entry->name);
  result_.has_stage = true;
  // As in Habitat, a stage's boxes are turned with it and not scaled.
  TemplateAttributes unscaled = **attributes;
  unscaled.scale = unmoved.scale;
  addReceptacles((*attributes)->receptacles, item.receptacles,
                 {.world_from_parent = objectFromAsset(unscaled, unmoved.scale)});
  return {};
}

Result<void> SceneComposer::placeObject(const SceneItem& item) {
  const DatasetTemplate* entry = lookUp(TemplateKind::kObject, item);
  if (entry == nullptr) return {};
  const auto attributes = attributesOf(*entry, TemplateKind::kObject);
  if (!attributes) return tl::unexpected(attributes.error());
  ASSIGN_OR_RETURN(const auto mesh, meshOf(*entry, **attributes, TemplateKind::kObject));
  // What moves is no part of the scene: its mesh is read for a pack of its own.
  if (mesh.empty() || item.motion == MotionType::kDynamic) return {};
  RETURN_IF_ERROR(checkDistance(item, fmt::format("object '{}'", entry->name)));
  if (!(*attributes)->collidable) {
    warnOnce(
        fmt::format("object '{}' collides with nothing in Habitat; here it does", entry->name));
  }
  const auto asset = load(mesh);
  if (!asset) return tl::unexpected(asset.error());
  const Affine world_from_mesh = placement(item, **attributes, **asset);
  const std::string name = nextName(entry->name);
  addMesh(mesh, **asset, world_from_mesh, name);
  addReceptacles((*attributes)->receptacles, item.receptacles,
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
        const std::string file = asset.files.empty() ? asset.name : asset.files.front().name;
        // Its points are turned otherwise than those of the same file as an object.
        const std::string key = "URDF " + (urdf.parent_path() / file).lexically_normal().string();
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

Result<void> SceneComposer::placeArticulated(const SceneItem& item) {
  constexpr TemplateKind kKind = TemplateKind::kArticulated;
  const DatasetTemplate* entry = lookUp(kKind, item);
  if (entry == nullptr) return {};
  const auto attributes = attributesOf(*entry, kKind);
  if (!attributes) return tl::unexpected(attributes.error());
  const fs::path urdf = urdfOf(*entry, **attributes);
  if (auto near = index_.checkReach(urdf, placeOf(*entry)); !near) return near;
  if (!isFile(urdf)) {
    noteMissing(fmt::format("{} '{}': its URDF '{}' is missing", namesOf(kKind).noun, entry->name,
                            relative(urdf)));
    noteAbsent(urdf);
    return {};
  }
  RETURN_IF_ERROR(checkDistance(item, fmt::format("{} '{}'", namesOf(kKind).noun, entry->name)));
  const auto furniture = meshes_.loadFurniture(urdf);
  if (!furniture) return tl::unexpected(furniture.error());
  const fs::path folder = urdf.parent_path();
  for (const SourceFile& file : (*furniture)->files) merger_.noteFile(folder / file.name, file);
  for (const std::string& file : (*furniture)->absent_files) noteAbsent(folder / file);
  if (!(*furniture)->is_settled) result_.is_settled = false;
  noteLooks(urdf, (*furniture)->unreadable);
  for (const SourceAsset& mesh : (*furniture)->meshes) {
    noteLooks(folder / mesh.files.front().name, mesh.missing);
  }
  noteWarnings(urdf, (*furniture)->warnings);
  for (const std::string& reference : (*furniture)->missing) {
    noteMissing(fmt::format("{} '{}': its mesh '{}' is missing", namesOf(kKind).noun, entry->name,
                            reference));
  }
  // Neither the center of mass nor a frame: Habitat takes a URDF's root as it is.
  Affine root_from_urdf = kIdentityAffine;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    root_from_urdf[5 * axis] = (*attributes)->scale[axis] * item.scale[axis];
  }
  const Affine world_from_root = compose(worldFromObject(item), root_from_urdf);
  const std::vector<Affine> root_from_link = restPose(**furniture, item.joint_positions);
  ReceptacleParent placed{.kind = ReceptacleParent::Kind::kFurniture,
                          .name = nextName(entry->name)};
  placed.links.reserve(root_from_link.size());
  for (std::size_t n = 0; n < root_from_link.size(); ++n) {
    placed.links.push_back(
        {(*furniture)->links[n].name, compose(world_from_root, root_from_link[n])});
  }
  placeLinks(placed, **furniture, urdf);
  addReceptacles((*attributes)->receptacles, item.receptacles, placed);
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

Result<ComposedScene> SceneComposer::run(const std::string& name, const SceneInstance& instance,
                                         const std::vector<fs::path>& read) {
  SourceAsset& scene = result_.scene;
  scene.name = name;
  scene.format = "Habitat scene dataset";
  scene.convention = "Y up, meters (Habitat)";
  for (const fs::path& file : read) {
    RETURN_IF_ERROR(merger_.noteFile(file));
  }
  default_origin_ = instance.origin;
  if (instance.stage) {
    RETURN_IF_ERROR(placeStage(*instance.stage));
  } else {
    result_.has_stage = false;
    warnOnce("the scene says that it has no stage");
  }
  for (const SceneItem& item : instance.objects) {
    RETURN_IF_ERROR(placeObject(item));
  }
  for (const SceneItem& item : instance.articulated) {
    RETURN_IF_ERROR(placeArticulated(item));
  }
  addReceptacles(instance.receptacles, {}, {.world_from_parent = kIdentityAffine});
  merger_.finish();
  result_.absent_files.assign(absent_.begin(), absent_.end());
  for (std::string& sentence : result_.missing) {
    const unsigned times = missing_.at(sentence);
    if (times > 1) sentence += fmt::format(" ({} times)", times);
  }
  return std::move(result_);
}

}  // namespace galactic::bake
