#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "galactic/bake/option_field.h"
#include "galactic/error.h"
#include "galactic/option_text.h"

namespace galactic::bake {

/// One table of a recipe: what is baked, and how.
struct RecipeAssets {
  /// File and line.
  std::string place;
  /// Files, folders and patterns (* and ? in any part of the path), as they are written.
  std::vector<std::string> inputs;
  /// Whether the inputs are scene datasets, not scenes.
  bool is_dataset = false;
  std::vector<GivenOption> options;
};

/// What a world is made of (TOML); docs/worlds.md tells its form.
struct WorldRecipe {
  /// For all scenes, objects and the robot.
  std::vector<GivenOption> common;
  /// At least one.
  std::vector<RecipeAssets> scenes;
  std::vector<RecipeAssets> objects;
  std::optional<RecipeAssets> robot;
  /// With inputs they are imported, without they are generated.
  std::optional<RecipeAssets> episodes;
  /// What the world says of its task: options of OptionScope::kTask in the order of the option
  /// table, with their values as listOptions() writes them. Empty where the recipe says nothing.
  std::vector<OptionText> task;
};

/// Reads a recipe. Keys that are not its own are options of jobs, by their names; they are read
/// where it is known of which kind of job. Those of [task] are options of galactic-run, and checked
/// here. Fails with kIo, or with kInvalidInput naming file and line.
[[nodiscard]] Result<WorldRecipe> readWorldRecipe(const std::filesystem::path& path);

/// The files and folders that `patterns` name, ascending, each once. A pattern is looked for from
/// each of `roots` in turn, and the first root where it fits anything counts; absolute ones need
/// none. Fails with kIo, naming the pattern, where it fits nothing.
[[nodiscard]] Result<std::vector<std::filesystem::path>> findInputs(
    const std::vector<std::string>& patterns, const std::vector<std::filesystem::path>& roots);

/// Whether `text` is `pattern`, in which * stands for any characters and ? for one.
[[nodiscard]] bool fitsPattern(std::string_view text, std::string_view pattern);

}  // namespace galactic::bake
