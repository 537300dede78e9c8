#include "recipe/world_recipe.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "recipe/recipe_task.h"
#include "support/try.h"
#include "toml/given_options.h"
#include "toml/recipe_table.h"
#include "toml/toml_table.h"

namespace galactic::bake {
namespace {

bool isText(const TomlValue& value) { return std::holds_alternative<std::string>(value.value); }

class WorldRecipeReader {
 public:
  explicit WorldRecipeReader(FirstError& errors) : errors_(errors) {}

  WorldRecipe read(const TomlTable& root) {
    WorldRecipe recipe;
    RecipeTable table(root, "", 0, errors_);
    if (const TomlTable* common = table.table("bake")) {
      recipe.common = options(*common);
    }
    readList(table.list("scenes"), "scenes", recipe.scenes);
    readList(table.list("objects"), "objects", recipe.objects);
    recipe.robot = readOne(table, "robot");
    recipe.episodes = readOne(table, "episodes");
    if (const TomlTable* task = table.table("task")) {
      recipe.task = readRecipeTask(*task, table.find("task")->line, errors_);
    }
    table.finish();
    if (recipe.scenes.empty()) {
      errors_.at(0, "names no scenes; begin a table [[scenes]] with files or a dataset");
    }
    return recipe;
  }

 private:
  void readList(const TomlArray* list, std::string_view name, std::vector<RecipeAssets>& assets) {
    if (list == nullptr) return;
    for (const TomlValue& entry : *list) {
      const auto* table = std::get_if<TomlTable>(&entry.value);
      if (table == nullptr) {
        return errors_.at(entry.line,
                          fmt::format("{0}: expected an array of tables, [[{0}]]", name));
      }
      assets.push_back(readAssets(*table, entry.line));
      if (assets.back().inputs.empty()) {
        errors_.at(entry.line, fmt::format("[[{}]] names no files{}", name,
                                           name == "scenes" ? " and no dataset" : ""));
      }
    }
  }

  std::optional<RecipeAssets> readOne(RecipeTable& root, std::string_view name) {
    const TomlTable* table = root.table(name);
    if (table == nullptr) return std::nullopt;
    return readAssets(*table, root.find(name)->line);
  }

  RecipeAssets readAssets(const TomlTable& table, std::uint32_t line) {
    RecipeAssets assets;
    assets.place = errors_.place(line);
    for (const TomlEntry& entry : table) {
      if (!namesInputs(entry.key)) continue;
      if (!assets.inputs.empty()) {
        errors_.at(entry.value.line, "both files and dataset are given; keep one of them");
      }
      assets.is_dataset = entry.key == "dataset";
      assets.inputs = texts(entry);
      if (std::ranges::find(assets.inputs, "") != assets.inputs.end()) {
        errors_.at(entry.value.line,
                   fmt::format("{}: a name is empty; name a file or a folder", entry.key));
      }
    }
    assets.options = options(table);
    return assets;
  }

  /// Reads a text, or a list of texts.
  std::vector<std::string> texts(const TomlEntry& entry) {
    if (isText(entry.value)) return {std::get<std::string>(entry.value.value)};
    std::vector<std::string> found;
    const auto* list = std::get_if<TomlArray>(&entry.value.value);
    if (list != nullptr && std::all_of(list->begin(), list->end(), isText)) {
      found.reserve(list->size());
      for (const TomlValue& value : *list) found.push_back(std::get<std::string>(value.value));
    } else {
      errors_.at(entry.value.line,
                 fmt::format("{}: expected a string or a list of strings", entry.key));
    }
    return found;
  }

  static bool namesInputs(std::string_view key) { return key == "files" || key == "dataset"; }

  std::vector<GivenOption> options(const TomlTable& table) {
    auto given = givenIn(table, errors_.place(0), namesInputs);
    if (given) return std::move(*given);
    errors_.take(given.error());
    return {};
  }

  FirstError& errors_;
};

}  // namespace

Result<WorldRecipe> readWorldRecipe(const std::filesystem::path& path) {
  ASSIGN_OR_RETURN(const auto table, readToml(path));
  FirstError errors(path.string());
  WorldRecipe recipe = WorldRecipeReader(errors).read(table);
  if (errors.error()) return tl::unexpected(*errors.error());
  return recipe;
}

}  // namespace galactic::bake
