#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "galactic/bake/build.h"
#include "galactic/bake/jobs.h"
#include "galactic/bake/libraries.h"
#include "galactic/bake/option_field.h"
#include "galactic/error.h"

namespace galactic::bake {

/// How the name of a scene dataset's configuration ends.
inline constexpr std::string_view kDatasetSuffix = ".scene_dataset_config.json";

/// What to do with a scene of a dataset of which something is missing. A scene without its stage is
/// never baked.
enum class MissingPolicy {
  kFail,     ///< An error.
  kSkip,     ///< The scene is left out, and listed.
  kWithout,  ///< It is baked without what is missing, which is listed.
};

/// The scenes and movable objects of a dataset.
struct DatasetJobs {
  /// A dataset's configuration, or a folder of scans.
  std::filesystem::path input{};
  /// Patterns (*, ?) of the scenes' names; none: all.
  std::vector<std::string> scenes{};
  MissingPolicy missing = MissingPolicy::kWithout;
  /// Options of all scenes; objects have the same radii and render meshes.
  SceneJob scene{};
};

void visitOptions(DatasetJobs& dataset, OptionVisitor& visitor);

/// The names of the scenes that are wanted, ascending. Fails with the errors of SceneDataset::read
/// and findSceneFiles, and with kInvalidInput where a pattern fits none, or where a folder is that
/// of a dataset whose scenes are composed of meshes.
[[nodiscard]] Result<std::vector<std::string>> sceneNames(const DatasetJobs& dataset);

/// Everything that is baked for datasets, with a world at `world` that lists it; the other packs go
/// into a folder beside it, with its name. Reads the datasets' lists, no mesh. Fails with
/// kInvalidInput where two packs would have one name, or something is missing and that is to be an
/// error.
[[nodiscard]] Result<WorldPlan> jobsOfDatasets(const std::vector<DatasetJobs>& datasets,
                                               const std::filesystem::path& world,
                                               BakeLibraries& libraries);

/// What may be said of the episodes of a recipe instead of what the recipe says, so that it makes
/// several worlds that differ in their episodes.
struct EpisodeOverrides {
  std::optional<std::uint32_t> count{};
  std::optional<std::uint64_t> seed{};
};

/// A recipe, and what is around it.
struct RecipeSource {
  std::filesystem::path recipe;
  /// Where its files are looked for that are not beside it; empty: nowhere else.
  std::filesystem::path data{};
  EpisodeOverrides episodes{};
  /// Names that would be options, but of a command line only.
  std::function<bool(std::string_view)> is_of_command_line{};
};

/// Everything that is baked for a recipe. Fails as jobsOfDatasets does, and with kIo and
/// kInvalidInput, naming the recipe's line, on what cannot be read or found.
[[nodiscard]] Result<WorldPlan> jobsOfRecipe(const RecipeSource& source,
                                             const std::filesystem::path& world,
                                             BakeLibraries& libraries);

/// Options that contradict each other, or say nothing without others, as far as a job or the given
/// options show it. Fails with kInvalidInput.
[[nodiscard]] Result<void> checkTogether(const Job& job, const OptionReader& given);
[[nodiscard]] Result<void> checkTogether(const DatasetJobs& dataset, const OptionReader& given);

}  // namespace galactic::bake
