#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

#include "build/pack_list.h"
#include "dataset/config/dataset_index.h"
#include "dataset/dataset_library.h"
#include "dataset/scene_files.h"
#include "galactic/bake/habitat_names.h"
#include "json/json_reader.h"
#include "recipe/world_recipe.h"
#include "support/files/output_files.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

constexpr std::array<Named<MissingPolicy>, 3> kMissingNames{{{"fail", MissingPolicy::kFail},
                                                             {"skip", MissingPolicy::kSkip},
                                                             {"without", MissingPolicy::kWithout}}};

/// The first configuration by name, in a folder, of a dataset that composes scenes. A configuration
/// that only describes how to read scans has no scenes of its own.
std::optional<std::filesystem::path> composingDataset(const std::filesystem::path& folder) {
  std::set<std::filesystem::path> configurations;
  std::error_code error;
  std::filesystem::directory_iterator entry(folder, error);
  for (; !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (name.ends_with(kDatasetSuffix)) configurations.insert(entry->path());
  }
  for (const std::filesystem::path& path : configurations) {
    const auto index = readDatasetIndex(path, /*allow_outside=*/true);
    if (index && !index->block(TemplateKind::kScene).templates.all().empty()) return path;
  }
  return std::nullopt;
}

/// The scans in a folder. Fails if the folder belongs to a dataset with composed scenes.
Result<std::vector<SceneFile>> scansIn(const std::filesystem::path& folder) {
  if (const auto dataset = composingDataset(folder)) {
    return fail(
        ErrorCode::kInvalidInput, folder.string(),
        fmt::format("found the folder of a dataset whose scenes are composed of its meshes, "
                    "wanted one of scans; give {}",
                    dataset->string()));
  }
  return findSceneFiles(folder);
}

/// The names of the files, ascending.
std::vector<std::string> namesOf(const std::vector<SceneFile>& files) {
  std::vector<std::string> names;
  names.reserve(files.size());
  for (const SceneFile& file : files) names.push_back(file.name);
  std::ranges::sort(names);
  return names;
}

/// The names among `scenes` that match any of the patterns; all without patterns.
Result<std::vector<std::string>> wantedScenes(const std::vector<std::string>& scenes,
                                              const std::vector<std::string>& patterns) {
  if (patterns.empty()) return scenes;
  std::vector<std::string> names;
  for (const std::string& pattern : patterns) {
    const std::size_t before = names.size();
    std::ranges::copy_if(scenes, std::back_inserter(names),
                         [&](const std::string& name) { return fitsPattern(name, pattern); });
    if (names.size() > before) continue;
    return fail(
        ErrorCode::kInvalidInput, "scenes",
        fmt::format(
            "\"{}\" fits none of the dataset's {} scenes; galactic-bake DATASET `list` prints them",
            pattern, scenes.size()));
  }
  std::ranges::sort(names);
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

MeshImportOptions meshOptionsOf(const DatasetJobs& dataset) {
  MeshImportOptions options = datasetMeshOptions();
  options.allow_outside = dataset.scene.import.allow_outside;
  return options;
}

/// Whether `pack`, which has the object's name, is for this object and not for another template or
/// scale.
bool isSameObject(const PackJob& pack, const DatasetObject& object) {
  const auto* known = std::get_if<ObjectJob>(&pack.job);
  return known != nullptr && known->inputs.front() == object.mesh &&
         known->import.transform == object.object_from_mesh;
}

void addObjects(const SceneSurvey& survey, const DatasetJobs& dataset, PackList& packs) {
  for (const DatasetObject& object : survey.movable) {
    const std::string name = "objects/" + object.name;
    if (const PackJob* known = packs.find(name)) {
      if (!isSameObject(*known, object)) {
        packs.warn(
            fmt::format("object \"{}\": scenes place several of this name, of other templates "
                        "or of other scales; its pack holds the first of them",
                        object.name));
      }
      continue;
    }
    ObjectJob job{.inputs = {object.mesh}, .name = object.name};
    job.import = meshOptionsOf(dataset);
    job.import.transform = object.object_from_mesh;
    job.shape.spheres.radii = dataset.scene.grids.radii;
    job.draw = dataset.scene.draw;
    packs.addMovable(name, std::move(job));
  }
}

/// The up axis of a scan, from its attributes if it has any.
Result<std::optional<UpAxis>> upOf(const SceneFile& scan) {
  if (scan.attributes.empty()) return scan.up;
  ASSIGN_OR_RETURN(const Json json,
                   readJsonFile(scan.attributes, {.what = "a stage's attributes",
                                                  .suffix = kStageSuffix,
                                                  .max_bytes = std::size_t{1} << 24U}));
  const auto up = json.is_object() ? json.find("up") : json.end();
  if (!json.is_object() || up == json.end()) return scan.up;
  if (*up == Json({0, 1, 0})) return UpAxis::kY;
  if (*up == Json({0, 0, 1})) return UpAxis::kZ;
  return fail(ErrorCode::kInvalidInput, scan.attributes.string() + ": up",
              "is neither [0, 1, 0] nor [0, 0, 1]; give `up`");
}

Result<void> addScans(const DatasetJobs& dataset, PackList& packs) {
  ASSIGN_OR_RETURN(const auto files, scansIn(dataset.input));
  ASSIGN_OR_RETURN(const auto names, wantedScenes(namesOf(files), dataset.scenes));
  packs.keepOutOf(dataset.input);
  for (const SceneFile& file : files) {
    if (!std::ranges::binary_search(names, file.name)) continue;
    SceneJob job = dataset.scene;
    job.input = file.path;
    job.name = file.name;
    if (!job.import.up) {
      auto up = upOf(file);
      if (!up) {
        packs.addBroken({"scenes/" + file.name + ".pack", {file.path, std::move(up.error())}});
        continue;
      }
      job.import.up = *up;
    }
    packs.add("scenes/" + file.name, std::move(job), file.path);
  }
  return {};
}

Result<void> addInstance(const std::string& name, const DatasetJobs& dataset,
                         const SceneDataset& read, PackList& packs) {
  auto survey = read.survey(name);
  if (!survey) return tl::unexpected(survey.error());
  const bool lacks = !survey->missing.empty();
  if (lacks && dataset.missing == MissingPolicy::kFail) {
    return fail(
        ErrorCode::kInvalidInput, fmt::format("{}: {}", dataset.input.string(), name),
        survey->missing.front() + "; add it, or bake with `missing` skip or `missing` without");
  }
  // Without the stage, nothing else matters. The stage is the first entry because it is looked for
  // first.
  if (!survey->has_stage && lacks) survey->missing.resize(1);
  if (!survey->has_stage || (lacks && dataset.missing == MissingPolicy::kSkip)) {
    packs.leaveOut({name, std::move(survey->missing)});
    return {};
  }
  SceneJob job = dataset.scene;
  job.input = dataset.input;
  job.instance = InstancedScene{name, read.fingerprint()};
  job.name = name;
  job.draw.shared_textures = packs.folder() / "textures";
  packs.add("scenes/" + name, std::move(job), dataset.input).source_bytes = survey->bytes;
  addObjects(*survey, dataset, packs);
  return {};
}

}  // namespace

void visitOptions(DatasetJobs& dataset, OptionVisitor& v) {
  auto& [input, scenes, missing, scene] = dataset;
  visitOptions(scene, v);
  v.group("Datasets");
  v.option(
      {"scenes", "PATTERN", "Only scenes whose names fit a pattern with * and ? (may be repeated)"},
      texts(scenes));
  v.option({"missing", "fail|skip|without",
            "A scene of which something is missing: an error, left out, or baked without it"},
           choice(missing, kMissingNames));
  v.internals(input);
}

Result<std::vector<std::string>> sceneNames(const DatasetJobs& dataset) {
  if (isFolder(dataset.input)) {
    ASSIGN_OR_RETURN(const auto files, scansIn(dataset.input));
    return wantedScenes(namesOf(files), dataset.scenes);
  }
  ASSIGN_OR_RETURN(
      const auto read,
      SceneDataset::read(dataset.input, {.allow_outside = dataset.scene.import.allow_outside}));
  return wantedScenes(read.scenes(), dataset.scenes);
}

Result<void> addDataset(const DatasetJobs& dataset, BakeLibraries& libraries, PackList& packs) {
  if (isFolder(dataset.input)) return addScans(dataset, packs);
  const MeshImportOptions& import = dataset.scene.import;
  if (import.up || import.scale || import.transform) {
    return fail(
        ErrorCode::kInvalidInput, dataset.input.string(),
        "says itself how its meshes stand; leave out `up`, `scale` and `transform`, or correct "
        "up, front and scale in the attributes of its stages and objects");
  }
  ASSIGN_OR_RETURN(const OpenDataset* const open,
                   libraries.datasets().open(dataset.input, {import.allow_outside}));
  const SceneDataset& read = open->scenes;
  ASSIGN_OR_RETURN(const auto names, wantedScenes(read.scenes(), dataset.scenes));
  for (const std::string& warning : read.warnings()) packs.warn(warning);
  for (const std::string& name : names) {
    auto added = addInstance(name, dataset, read, packs);
    if (!added) {
      packs.addBroken({"scenes/" + name + ".pack", {dataset.input, std::move(added.error())}});
    }
  }
  return {};
}

Result<WorldPlan> jobsOfDatasets(const std::vector<DatasetJobs>& datasets,
                                 const std::filesystem::path& world, BakeLibraries& libraries) {
  PackList packs(world);
  for (const DatasetJobs& dataset : datasets) {
    RETURN_IF_ERROR(addDataset(dataset, libraries, packs));
  }
  return packs.finish();
}

}  // namespace galactic::bake
