#include "dynamics/sources/sources.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <string_view>
#include <utility>
#include <variant>

#include "dynamics/sources/hull_points.h"
#include "dynamics/sources/object_config.h"
#include "dynamics/sources/pack_sources.h"
#include "galactic/bake/assets.h"
#include "galactic/bake/job_lists.h"
#include "galactic/bake/robot_import.h"
#include "galactic/bake/triangle_mesh.h"
#include "support/try.h"

namespace galactic::dynamics {
namespace {

using Names = std::set<std::string, std::less<>>;

Result<void> noteContent(const std::filesystem::path& file, bake::ReadLog& log) {
  ASSIGN_OR_RETURN(auto content, bake::describeFile(file));
  log.note(file.parent_path(), {.files = {std::move(content)}});
  return {};
}

/// The mesh, and those of the files from which its object was baked that exist.
Result<std::vector<bake::SourceFile>> filesOfMesh(const std::filesystem::path& mesh,
                                                  const std::vector<bake::SourceFile>& baked) {
  ASSIGN_OR_RETURN(auto main, bake::describeFile(mesh));
  std::vector<bake::SourceFile> files{std::move(main)};
  for (const bake::SourceFile& one : baked) {
    if (one.name == files.front().name) continue;
    auto file = bake::describeFile(mesh.parent_path() / one.name);
    if (!file) continue;
    file->name = one.name;
    files.push_back(std::move(*file));
  }
  return files;
}

/// Reads those parts of a recipe's jobs that a world needs.
class SourceReader {
 public:
  SourceReader(const World& world, bake::BakeLibraries& libraries, Sources& sources)
      : world_(world), libraries_(libraries), sources_(sources), packs_(world) {
    const EpisodeSet& set = world.episodes();
    for (const Episode& episode : set.episodes()) {
      scenes_.emplace(world.sceneOf(episode).name());
      for (const Placement& placement : set.placements(episode)) {
        objects_.emplace(world.objectOf(placement).name);
      }
    }
  }

  Result<void> operator()(const bake::SceneJob& job) {
    const std::string name = bake::nameOf(job);
    if (!scenes_.contains(name)) return {};
    ASSIGN_OR_RETURN(const auto asset, bake::readSceneFile(job, libraries_));
    sources_.log.note(job.input.parent_path(), asset.read);
    RETURN_IF_ERROR(compare({.kind = PackKind::kScene, .name = name, .files = asset.read.files}));
    ASSIGN_OR_RETURN(const auto clean, bake::placeAndClean(asset));
    sources_.scenes.emplace(name, makeSceneShape(clean.mesh));
    return {};
  }
  Result<void> operator()(const bake::ObjectJob& job) {
    ASSIGN_OR_RETURN(const auto found, bake::findObjects(job.inputs));
    for (const bake::ObjectInput& input : found.objects) {
      sources_.log.noteRead(input.path);
      const std::string& name = job.name.empty() ? input.name : job.name;
      if (!objects_.contains(name)) continue;
      ASSIGN_OR_RETURN(const auto object, readObject(input.path, name, job));
      sources_.objects.emplace(name, makeObjectShape(object));
    }
    return {};
  }
  Result<void> operator()(const bake::RobotJob& job) {
    ASSIGN_OR_RETURN(auto robot, bake::readRobotFile(job));
    sources_.log.note(job.input.parent_path(), robot.read);
    RETURN_IF_ERROR(compare({.kind = PackKind::kRobot,
                             .name = world_.robot().name(),
                             .files = robot.read.files,
                             .named = {job.recipe, job.spheres}}));
    ASSIGN_OR_RETURN(auto inertials, bake::readInertials(job.input, bake::robotOptionsOf(job)));
    ASSIGN_OR_RETURN(sources_.robot, robotParts({job.input.filename().string(), std::move(robot),
                                                 std::move(inertials)},
                                                world_.robot()));
    sources_.robot_shape = makeRobotShape(sources_.robot);
    for (const std::string& warning : sources_.robot.warnings) {
      sources_.warnings.push_back(warning);
    }
    return {};
  }
  /// Episodes and worlds are packs, not sources.
  Result<void> operator()(const auto& /*job*/) { return {}; }

  /// Fails if something that the world needs was not in the recipe.
  [[nodiscard]] Result<void> finish(const std::filesystem::path& recipe) const {
    for (const std::string& name : scenes_) {
      if (!sources_.scenes.contains(name)) return absent(recipe, "scene", name);
    }
    for (const std::string& name : objects_) {
      if (!sources_.objects.contains(name)) return absent(recipe, "object", name);
    }
    if (!sources_.robot_shape) return absent(recipe, "robot", world_.robot().name());
    return {};
  }

  /// Warns of how many objects the masses are unknown.
  void warnOfDefaults() {
    if (without_mass_ == 0) return;
    sources_.warnings.push_back(fmt::format(
        "{} of {} objects have no mass in an object configuration: each of them weighs {} kg",
        without_mass_, objects_.size(), kObjectMass));
  }

 private:
  Result<ObjectSource> readObject(const std::filesystem::path& mesh, std::string_view name,
                                  const bake::ObjectJob& job) {
    ObjectConfig config;
    if (const auto file = findObjectConfig(mesh, name)) {
      RETURN_IF_ERROR(noteContent(*file, sources_.log));
      ASSIGN_OR_RETURN(config, readObjectConfig(*file));
    }
    for (const std::string& warning : config.warnings) {
      sources_.warnings.push_back(fmt::format("object '{}' {}", name, warning));
    }
    if (!config.mass) ++without_mass_;
    ObjectSource object{
        .hulls = {}, .mass = config.mass.value_or(kObjectMass), .friction = config.friction};
    if (!config.collision_asset.empty()) {
      ASSIGN_OR_RETURN(const auto asset, readMesh(config.collision_asset, job));
      object.hulls = piecesOf(asset, config.joins_meshes);
      if (!object.hulls.empty()) {
        RETURN_IF_ERROR(checkExtents(object.hulls, config.collision_asset.string()));
        // The mesh is not read, but it may have changed since the bake.
        ASSIGN_OR_RETURN(auto files, filesOfMesh(mesh, packs_.listed(PackKind::kObjects, name)));
        RETURN_IF_ERROR(compareObject(name, std::move(files), job));
        return object;
      }
      sources_.warnings.push_back(
          fmt::format("object '{}' has the collision asset '{}', no part of which has four "
                      "corners; the hull of its mesh counts",
                      name, config.collision_asset.filename().string()));
    }
    ASSIGN_OR_RETURN(const auto asset, readMesh(mesh, job));
    RETURN_IF_ERROR(compareObject(name, asset.read.files, job));
    object.hulls = {cornersOf(asset)};
    RETURN_IF_ERROR(checkExtents(object.hulls, mesh.string()));
    return object;
  }
  Result<bake::SourceAsset> readMesh(const std::filesystem::path& mesh,
                                     const bake::ObjectJob& job) {
    ASSIGN_OR_RETURN(auto asset, bake::importMesh(mesh, job.import));
    sources_.log.note(mesh.parent_path(), asset.read);
    return asset;
  }

  /// Warns if the packs were baked from different files.
  Result<void> compare(const AssetSources& now) {
    ASSIGN_OR_RETURN(auto differences, packs_.differences(now));
    std::ranges::move(differences, std::back_inserter(sources_.warnings));
    return {};
  }
  Result<void> compareObject(std::string_view name, std::vector<bake::SourceFile> files,
                             const bake::ObjectJob& job) {
    return compare({.kind = PackKind::kObjects,
                    .name = name,
                    .files = std::move(files),
                    .named = {job.collection}});
  }

  static tl::unexpected<Error> absent(const std::filesystem::path& recipe, std::string_view kind,
                                      std::string_view name) {
    return fail(ErrorCode::kInvalidInput, recipe.string(),
                fmt::format("makes no {} '{}', which the world has; give the recipe that the world "
                            "was baked from",
                            kind, name));
  }

  const World& world_;
  bake::BakeLibraries& libraries_;
  Sources& sources_;
  PackSources packs_;
  Names scenes_;
  Names objects_;
  std::size_t without_mass_ = 0;
};

}  // namespace

Result<Sources> readSources(const bake::RecipeSource& source, const World& world) {
  // Nothing is written to this path; the list needs a name for the world.
  bake::BakeLibraries libraries;
  ASSIGN_OR_RETURN(const auto list, bake::jobsOfRecipe(source, "world.pack", libraries));
  Sources sources;
  SourceReader reader(world, libraries, sources);
  RETURN_IF_ERROR(noteContent(source.recipe, sources.log));
  for (const bake::PackJob& pack : list.assets) {
    for (const std::filesystem::path& file : bake::filesOf(pack.job)) sources.log.noteRead(file);
    RETURN_IF_ERROR(std::visit(reader, pack.job));
  }
  RETURN_IF_ERROR(reader.finish(source.recipe));
  reader.warnOfDefaults();
  return sources;
}

}  // namespace galactic::dynamics
