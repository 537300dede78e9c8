#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <functional>
#include <iterator>
#include <system_error>

#include "command.h"
#include "galactic/bake/habitat_names.h"
#include "support/files/output_files.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

/// The path without dots and without a trailing slash.
fs::path wholePath(const fs::path& path) {
  std::error_code unknown;
  const fs::path whole = fs::absolute(path, unknown).lexically_normal();
  return whole.has_filename() ? whole : whole.parent_path();
}

/// Whether `path` is a folder or names one that is to be made.
bool namesFolder(const fs::path& path) { return !path.has_filename() || isFolder(path); }

/// The name, without extension, of the pack made from `input`.
fs::path packName(const Job& job, const fs::path& input) {
  if (std::holds_alternative<WorldJob>(job)) return "world";
  if (std::holds_alternative<EpisodeGenerationJob>(job)) return "episodes";
  if (std::holds_alternative<EpisodeImportJob>(job)) return episodeSetName(input);
  if (!isFolder(input)) return input.stem();
  // In a folder's name, a dot does not begin an extension.
  const fs::path folder = wholePath(input);
  return folder.has_filename() ? folder.filename() : "objects";
}

bool isPack(const fs::path& input) { return input.extension() == ".pack"; }

/// Sets the inputs of a job: a single one, or all that go into one pack.
void setInputs(Job& job, const std::vector<fs::path>& inputs) {
  struct Set {
    const std::vector<fs::path>& inputs;
    void operator()(ObjectJob& one) const { one.inputs = inputs; }
    void operator()(EpisodeGenerationJob& one) const { one.packs = inputs; }
    void operator()(WorldJob& one) const { one.packs = inputs; }
    void operator()(SceneJob& one) const { one.input = inputs.front(); }
    void operator()(RobotJob& one) const { one.input = inputs.front(); }
    void operator()(EpisodeImportJob& one) const {
      one.input = inputs.front();
      one.packs.assign(std::next(inputs.begin()), inputs.end());
    }
  };
  std::visit(Set{inputs}, job);
}

bool makesOnePack(const Job& job) {
  return std::holds_alternative<ObjectJob>(job) || std::holds_alternative<WorldJob>(job) ||
         std::holds_alternative<EpisodeGenerationJob>(job);
}

/// Explains what a JSON file given as a mesh is, and what to give instead.
std::string whatJsonIs(std::string_view file) {
  if (file.ends_with(kSceneSuffix)) {
    return fmt::format("is a scene of a dataset; give the dataset's NAME{}, with `scenes` {}",
                       kDatasetSuffix, habitatName(file));
  }
  if (file.ends_with(kStageSuffix)) {
    return fmt::format(
        "is about a stage of a dataset; give the mesh that it names as its render_asset, with the "
        "axis that it gives as `up`, or the dataset's NAME{} for scenes with their furniture",
        kDatasetSuffix);
  }
  if (file.ends_with(kObjectSuffix)) {
    return fmt::format(
        "is about an object of a dataset; give the mesh that it names as its render_asset, with "
        "`as` object and the axis that it gives as `up`, or the dataset's NAME{} for all objects "
        "that its scenes move",
        kDatasetSuffix);
  }
  return "is no mesh but JSON; add `as` episodes if it holds published episodes";
}

/// Refuses an input that does not fit the job and suggests what the user may have meant. Other
/// faults are left to the input's reader, which knows best what is wrong.
Result<void> checkInput(const fs::path& input, const Job& job) {
  const std::string file = input.filename().string();
  if (isFolder(input)) {
    if (!std::holds_alternative<SceneJob>(job)) return {};
    return fail(ErrorCode::kIo, input.string(),
                "is a folder; give a mesh in it, or add `as` object to bake the meshes in it as "
                "objects, or `as` dataset to bake them as scans");
  }
  if (isPack(input)) {
    // The starts of published episodes are drawn in packs.
    if (std::holds_alternative<EpisodeImportJob>(job)) return {};
    return fail(ErrorCode::kInvalidInput, input.string(),
                "is a pack already; add `as` episodes to generate episodes in packs, or `as` world "
                "to link them");
  }
  const bool is_of_meshes =
      std::holds_alternative<SceneJob>(job) || std::holds_alternative<ObjectJob>(job);
  if (!is_of_meshes || !file.ends_with(".json") || !isThere(input)) return {};
  return fail(ErrorCode::kUnsupported, input.string(), whatJsonIs(file));
}

/// Only episodes and worlds have packs as inputs.
Result<void> checkInputs(const BakeCommand& command, const Job& job) {
  if (std::holds_alternative<WorldJob>(job) || std::holds_alternative<EpisodeGenerationJob>(job)) {
    return {};
  }
  for (const fs::path& input : command.inputs) RETURN_IF_ERROR(checkInput(input, job));
  return {};
}

std::vector<PackJob> packsOfFiles(const BakeCommand& command, const Job& job) {
  std::vector<PackJob> packs;
  const fs::path& out = command.run.out;
  std::vector<fs::path> inputs = command.inputs;
  // Packs given with files of published episodes apply to all of these files.
  std::vector<fs::path> shared;
  if (std::holds_alternative<EpisodeImportJob>(job)) {
    const auto first = std::stable_partition(inputs.begin(), inputs.end(), std::not_fn(isPack));
    shared.assign(first, inputs.end());
    inputs.erase(first, inputs.end());
  }
  const bool is_one = makesOnePack(job) || inputs.size() == 1;
  const auto add = [&](std::vector<fs::path> of_one) {
    fs::path name = packName(job, of_one.front());
    name += ".pack";
    const bool is_folder = !is_one || namesFolder(out);
    PackJob pack{.name = name.string(), .job = job, .output = name};
    if (!out.empty()) pack.output = is_folder ? out / name : out;
    of_one.insert(of_one.end(), shared.begin(), shared.end());
    setInputs(pack.job, of_one);
    packs.push_back(std::move(pack));
  };
  if (makesOnePack(job)) {
    add(inputs);
  } else {
    for (const fs::path& input : inputs) add({input});
  }
  return packs;
}

/// For example "home" for home.scene_dataset_config.json, home.toml and the folder home.
std::string worldName(const fs::path& input) {
  const fs::path whole = wholePath(input);
  std::string name = whole.filename().string();
  if (isFolder(input)) return name;
  if (!name.ends_with(kDatasetSuffix)) return whole.stem().string();
  return name.substr(0, name.size() - kDatasetSuffix.size());
}

/// NAME.pack in the folder, or the file name, that the command gives.
fs::path worldPack(const BakeCommand& command) {
  const fs::path& out = command.run.out;
  return namesFolder(out) ? out / (worldName(command.inputs.front()) + ".pack") : out;
}

}  // namespace

Result<std::vector<PackJob>> packsOf(const BakeCommand& command) {
  const Job& job = std::get<Job>(command.what);
  RETURN_IF_ERROR(checkInputs(command, job));
  return packsOfFiles(command, job);
}

Result<WorldPlan> planOf(const BakeCommand& command, BakeLibraries& libraries) {
  const fs::path world = worldPack(command);
  if (const auto* recipe = std::get_if<RecipeCommand>(&command.what)) {
    return jobsOfRecipe({.recipe = command.inputs.front(),
                         .data = recipe->data,
                         .episodes = recipe->episodes,
                         .is_of_command_line = isOfCommandLine},
                        world, libraries);
  }
  std::vector<DatasetJobs> datasets(command.inputs.size(),
                                    std::get<DatasetCommand>(command.what).jobs);
  for (std::size_t n = 0; n < datasets.size(); ++n) datasets[n].input = command.inputs[n];
  return jobsOfDatasets(datasets, world, libraries);
}

}  // namespace galactic::bake
