#include "galactic/bake/world_recipe.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "galactic/bake/toml_table.h"
#include "recipe/recipe_table.h"
#include "recipe/recipe_task.h"

namespace galactic::bake {
namespace {

/// Options that say how a command runs, not what is made: they belong to the command line.
constexpr std::array<std::string_view, 20> kCommandLineOnly{
    "as",      "out",   "jobs",    "report", "config",   "dry-run",      "keep-going",
    "verbose", "quiet", "version", "cache",  "memory",   "print-recipe", "shard",
    "check",   "help",  "data",    "list",   "no-cache", "tolerance"};

/// A single value as it would be typed.
std::optional<std::string> textOf(const TomlValue& value) {
  if (const auto* text = std::get_if<std::string>(&value.value)) return *text;
  if (const auto* whole = std::get_if<std::int64_t>(&value.value)) return fmt::format("{}", *whole);
  // The shortest text that reads back as the same number.
  if (const auto* real = std::get_if<double>(&value.value)) return fmt::format("{}", *real);
  return std::nullopt;
}

bool isText(const TomlValue& value) { return std::holds_alternative<std::string>(value.value); }

class WorldRecipeReader {
 public:
  explicit WorldRecipeReader(FirstError& errors) : errors_(errors) {}

  WorldRecipe read(const TomlTable& root) {
    WorldRecipe recipe;
    RecipeTable table(root, "", 0, errors_);
    if (const TomlTable* common = table.table("bake")) {
      for (const TomlEntry& entry : *common) addOption(entry, recipe.common);
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
                          fmt::format("{0} has to be an array of tables, [[{0}]]", name));
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
      if (entry.key == "files" || entry.key == "dataset") {
        if (!assets.inputs.empty()) {
          errors_.at(entry.value.line, "both files and dataset are given; keep one of them");
        }
        assets.is_dataset = entry.key == "dataset";
        assets.inputs = texts(entry);
      } else {
        addOption(entry, assets.options);
      }
    }
    return assets;
  }

  /// A text, or a list of texts.
  std::vector<std::string> texts(const TomlEntry& entry) {
    if (isText(entry.value)) return {std::get<std::string>(entry.value.value)};
    std::vector<std::string> found;
    const auto* list = std::get_if<TomlArray>(&entry.value.value);
    if (list != nullptr && std::all_of(list->begin(), list->end(), isText)) {
      found.reserve(list->size());
      for (const TomlValue& value : *list) found.push_back(std::get<std::string>(value.value));
    } else {
      errors_.at(entry.value.line,
                 fmt::format("{} has to be a string or a list of strings", entry.key));
    }
    return found;
  }

  void addOption(const TomlEntry& entry, std::vector<RecipeOption>& options) {
    if (std::find(kCommandLineOnly.begin(), kCommandLineOnly.end(), entry.key) !=
        kCommandLineOnly.end()) {
      return errors_.at(entry.value.line,
                        fmt::format("{} belongs on the command line, not into a recipe; leave it "
                                    "out",
                                    entry.key));
    }
    const auto* flag = std::get_if<bool>(&entry.value.value);
    if (flag != nullptr && !*flag) return;
    options.push_back({entry.key, {}, errors_.place(entry.value.line)});
    if (flag == nullptr) options.back().values = valuesOf(entry);
  }

  /// A list of numbers is one value, a list of texts are several; a table is NAME=VALUE each.
  std::vector<std::string> valuesOf(const TomlEntry& entry) {
    if (auto text = textOf(entry.value)) return {std::move(*text)};
    if (const auto* list = std::get_if<TomlArray>(&entry.value.value)) {
      return valuesOf(*list, entry);
    }
    std::vector<std::string> values;
    for (const TomlEntry& pair : std::get<TomlTable>(entry.value.value)) {
      const auto text = textOf(pair.value);
      if (!text) errors_.at(pair.value.line, fmt::format("{} has to be a string", pair.key));
      values.push_back(pair.key + "=" + text.value_or(""));
    }
    return values;
  }

  std::vector<std::string> valuesOf(const TomlArray& list, const TomlEntry& entry) {
    const bool are_texts = std::all_of(list.begin(), list.end(), isText);
    std::vector<std::string> values;
    for (const TomlValue& value : list) {
      const auto text = textOf(value);
      if (!text) {
        errors_.at(value.line, fmt::format("{} has to be a list of numbers or strings", entry.key));
        return {};
      }
      if (are_texts || values.empty()) {
        values.push_back(*text);
      } else {
        values.back() += "," + *text;
      }
    }
    return values;
  }

  FirstError& errors_;
};

}  // namespace

Result<WorldRecipe> readWorldRecipe(const std::filesystem::path& path) {
  const auto table = readToml(path);
  if (!table) return tl::unexpected(table.error());
  FirstError errors(path.string());
  WorldRecipe recipe = WorldRecipeReader(errors).read(*table);
  if (errors.error()) return tl::unexpected(*errors.error());
  return recipe;
}

}  // namespace galactic::bake
