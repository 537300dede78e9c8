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

/// What to do with a scene of a dataset if some of its files are missing. A scene without its stage
/// is never baked.
enum class MissingPolicy {
  kFail,     ///< An error.
  kSkip,     ///< The scene is left out and listed.
  kWithout,  ///< The scene is baked without the missing files, which are listed.
};

/// The scenes and movable objects of a dataset.
struct DatasetJobs {
  /// A dataset's configuration, or a folder of scans.
  std::filesystem::path input{};
  /// Patterns (*, ?) for the scenes' names; none: all scenes.
  std::vector<std::string> scenes{};
  MissingPolicy missing = MissingPolicy::kWithout;
  /// Options of all scenes; objects have the same radii and render meshes.
  SceneJob scene{};
};

void visitOptions(DatasetJobs& dataset, OptionVisitor& visitor);

/// The names of the scenes that are wanted, ascending. Fails with the errors of
/// SceneDataset::read() and findSceneFiles(), and with kInvalidInput if a pattern matches no scene,
/// or if a folder belongs to a dataset whose scenes are composed of meshes.
[[nodiscard]] Result<std::vector<std::string>> sceneNames(const DatasetJobs& dataset);

/// Everything that is baked for datasets, with a world at `world` that lists it. The other packs
/// are put into a folder beside it that has the world's name. Reads the datasets' lists, but no
/// meshes. Fails with kInvalidInput if two packs would have the same name, or if something is
/// missing and MissingPolicy::kFail applies.
[[nodiscard]] Result<WorldPlan> jobsOfDatasets(const std::vector<DatasetJobs>& datasets,
                                               const std::filesystem::path& world,
                                               BakeLibraries& libraries);

/// Values that replace those of a recipe's episodes, so that one recipe can make several worlds
/// that differ in their episodes.
struct EpisodeOverrides {
  std::optional<std::uint32_t> count{};
  std::optional<std::uint64_t> seed{};
};

/// A recipe and its context.
struct RecipeSource {
  std::filesystem::path recipe;
  /// Where to look for files of the recipe that are not beside it; empty: nowhere else.
  std::filesystem::path data{};
  EpisodeOverrides episodes{};
  /// Whether a name is an option that only a command line may have.
  std::function<bool(std::string_view)> is_of_command_line{};
};

/// Everything that is baked for a recipe. Fails as jobsOfDatasets() does, and with kIo or
/// kInvalidInput, naming the recipe's line, if something cannot be read or found.
[[nodiscard]] Result<WorldPlan> jobsOfRecipe(const RecipeSource& source,
                                             const std::filesystem::path& world,
                                             BakeLibraries& libraries);

/// Checks for options that contradict each other, or that have no effect without others, as far as
/// a job or the given options show this. Fails with kInvalidInput.
[[nodiscard]] Result<void> checkTogether(const Job& job, const OptionReader& given);
[[nodiscard]] Result<void> checkTogether(const DatasetJobs& dataset, const OptionReader& given);

}  // namespace galactic::bake
