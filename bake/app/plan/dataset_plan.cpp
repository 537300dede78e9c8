#include "plan/dataset_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <system_error>
#include <utility>

#include "galactic/bake/world_recipe.h"

namespace galactic::bake {
namespace {

/// A command for one of the assets of a dataset: its options go with scenes and with objects.
BakeCommand assetCommand(const BakeCommand& dataset, AssetKind kind) {
  BakeCommand command = dataset;
  command.kind = kind;
  command.import = datasetMeshOptions();
  command.import.allow_outside = dataset.allow_outside;
  return command;
}

void addObjects(const SceneSurvey& survey, const BakeCommand& dataset, PackList& packs) {
  for (const DatasetObject& object : survey.movable) {
    const std::string name = "objects/" + object.name;
    if (packs.has(name)) continue;
    BakeCommand command = assetCommand(dataset, AssetKind::kObject);
    command.inputs = {object.mesh};
    command.asset_name = object.name;
    command.import.transform = object.object_from_mesh;
    packs.add(name, std::move(command), object.mesh);
  }
}

Result<void> addScans(const BakeCommand& command, PackList& packs) {
  const auto files = findSceneFiles(command.inputs.front());
  if (!files) return tl::unexpected(files.error());
  const auto names = wantedScenes(namesOf(*files), command.dataset);
  if (!names) return tl::unexpected(names.error());
  for (const SceneFile& file : *files) {
    if (!std::ranges::binary_search(*names, file.name)) continue;
    BakeCommand one = command;
    one.kind = AssetKind::kScene;
    one.inputs = {file.path};
    one.asset_name = file.name;
    if (!one.import.up) one.import.up = file.up;
    packs.add("scenes/" + file.name, std::move(one), file.path);
  }
  return {};
}

}  // namespace

std::vector<std::string> namesOf(const std::vector<SceneFile>& files) {
  std::vector<std::string> names;
  names.reserve(files.size());
  for (const SceneFile& file : files) names.push_back(file.name);
  std::ranges::sort(names);
  return names;
}

Result<std::vector<std::string>> wantedScenes(const std::vector<std::string>& scenes,
                                              const DatasetOptions& options) {
  if (options.scenes.empty()) return scenes;
  std::vector<bool> wanted(scenes.size(), false);
  for (const std::string& pattern : options.scenes) {
    bool fits_any = false;
    for (std::size_t n = 0; n < wanted.size(); ++n) {
      if (!fitsPattern(scenes[n], pattern)) continue;
      wanted[n] = true;
      fits_any = true;
    }
    if (fits_any) continue;
    return fail(ErrorCode::kInvalidInput, "--scenes",
                fmt::format("\"{}\" fits none of the dataset's {} scenes; --list prints them",
                            pattern, wanted.size()));
  }
  std::vector<std::string> names;
  for (std::size_t n = 0; n < wanted.size(); ++n) {
    if (wanted[n]) names.push_back(scenes[n]);
  }
  return names;
}

Result<void> addDataset(const BakeCommand& command, PackList& packs) {
  std::error_code unknown;
  if (std::filesystem::is_directory(command.inputs.front(), unknown)) {
    return addScans(command, packs);
  }
  if (command.import.up || command.import.scale || command.import.transform) {
    return fail(ErrorCode::kInvalidInput, command.inputs.front().string(),
                "says itself how its meshes stand; leave out --up, --scale and --transform");
  }
  auto read = SceneDataset::read(command.inputs.front(), {.allow_outside = command.allow_outside});
  if (!read) return tl::unexpected(read.error());
  const auto dataset = std::make_shared<const SceneDataset>(std::move(*read));
  const auto names = wantedScenes(dataset->scenes(), command.dataset);
  if (!names) return tl::unexpected(names.error());
  MeshImportOptions mesh_options = datasetMeshOptions();
  mesh_options.allow_outside = command.allow_outside;
  const auto meshes = std::make_shared<MeshLibrary>(mesh_options);
  const auto textures = std::make_shared<TextureLibrary>();
  for (const std::string& warning : dataset->warnings()) packs.warn(warning);
  for (const std::string& name : *names) {
    auto survey = dataset->survey(name);
    if (!survey) return tl::unexpected(survey.error());
    const bool lacks = !survey->missing.empty();
    if (lacks && command.dataset.missing == MissingPolicy::kFail) {
      return fail(
          ErrorCode::kInvalidInput, fmt::format("{}: {}", command.inputs.front().string(), name),
          survey->missing.front() + "; add it, or bake with --missing skip or --missing without");
    }
    // Without its stage nothing else matters; the stage is looked for first.
    if (!survey->has_stage && lacks) survey->missing.resize(1);
    if (!survey->has_stage || (lacks && command.dataset.missing == MissingPolicy::kSkip)) {
      packs.leaveOut({name, std::move(survey->missing)});
      continue;
    }
    BakeCommand one = assetCommand(command, AssetKind::kScene);
    one.asset_name = name;
    one.render.textures.library = textures;
    one.render.shared_textures = packs.folder() / "textures";
    PlannedPack& pack = packs.add("scenes/" + name, std::move(one), command.inputs.front());
    pack.scene = InstancedScene{dataset, meshes, name};
    pack.source_bytes = survey->bytes;
    addObjects(*survey, command, packs);
  }
  return {};
}

}  // namespace galactic::bake
