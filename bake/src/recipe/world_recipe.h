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

/// One table of a recipe: what to bake, and how.
struct RecipeAssets {
  /// File and line, for messages.
  std::string place;
  /// Files, folders and patterns (* and ? in any part of the path), as written in the recipe.
  std::vector<std::string> inputs;
  /// Whether the inputs are scene datasets rather than scenes.
  bool is_dataset = false;
  std::vector<GivenOption> options;
};

/// The contents of a world (TOML); docs/worlds.md describes the format.
struct WorldRecipe {
  /// Options for all scenes, objects and the robot.
  std::vector<GivenOption> common;
  /// At least one.
  std::vector<RecipeAssets> scenes;
  std::vector<RecipeAssets> objects;
  std::optional<RecipeAssets> robot;
  /// Episodes are imported if there are inputs, and generated if there are none.
  std::optional<RecipeAssets> episodes;
  /// The world's own settings for its task: options of OptionScope::kTask in the order of the
  /// option table, with their values as listOptions() writes them. Empty if the recipe has none.
  std::vector<OptionText> task;
};

/// Reads a recipe. Keys that do not belong to the recipe itself are options of jobs; they are
/// interpreted later, when the kind of job is known. Those of [task] are options of galactic-run,
/// and are checked here. Fails with kIo, or with kInvalidInput and the file and line.
[[nodiscard]] Result<WorldRecipe> readWorldRecipe(const std::filesystem::path& path);

/// The files and folders that match `patterns`, ascending, without repetitions. Tries each of
/// `roots` in turn for a pattern, and takes the first one where anything matches; absolute patterns
/// need no root. Fails with kIo, naming the pattern, if nothing matches.
[[nodiscard]] Result<std::vector<std::filesystem::path>> findInputs(
    const std::vector<std::string>& patterns, const std::vector<std::filesystem::path>& roots);

/// Whether `text` matches `pattern`, in which * stands for any characters and ? for one.
[[nodiscard]] bool fitsPattern(std::string_view text, std::string_view pattern);

}  // namespace galactic::bake
