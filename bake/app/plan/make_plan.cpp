#include "plan/make_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <system_error>
#include <utility>

#include "galactic/bake/world_recipe.h"
#include "object_inputs.h"
#include "plan/dataset_plan.h"
#include "plan/pack_list.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

/// Where files of a recipe are looked for.
std::vector<fs::path> rootsOf(const BakeCommand& command) {
  const fs::path beside = command.inputs.front().parent_path();
  std::vector<fs::path> roots{beside.empty() ? fs::path(".") : beside};
  if (!command.plan.data.empty()) roots.push_back(command.plan.data);
  return roots;
}

/// Options whose values are files, which a recipe names as it names its inputs.
bool namesFile(std::string_view option) {
  constexpr std::array<std::string_view, 5> kFiles{"recipe", "spheres", "collection", "only",
                                                   "object-pack"};
  return std::find(kFiles.begin(), kFiles.end(), option) != kFiles.end();
}

/// Options whose values are NAME=FILE.
bool namesFileOfName(std::string_view option) {
  return option == "package" || option == "geometry";
}

/// Turns the tables of a recipe into commands, and these into packs.
class RecipePlanner {
 public:
  RecipePlanner(const BakeCommand& command, PackList& packs)
      : packs_(packs), roots_(rootsOf(command)) {}

  Result<void> plan(const WorldRecipe& recipe) {
    common_ = &recipe.common;
    for (const RecipeAssets& assets : recipe.scenes) {
      if (auto planned = planScenes(assets); !planned) return planned;
    }
    for (const RecipeAssets& assets : recipe.objects) {
      if (auto planned = planObjects(assets); !planned) return planned;
    }
    if (recipe.robot) {
      if (auto planned = planRobot(*recipe.robot); !planned) return planned;
    }
    return recipe.episodes ? planEpisodes(*recipe.episodes) : Result<void>{};
  }

 private:
  Result<void> planScenes(const RecipeAssets& assets) {
    const auto command = commandOf(assets, assets.is_dataset ? "dataset" : "scene", true);
    if (!command) return tl::unexpected(command.error());
    for (const fs::path& input : command->inputs) {
      BakeCommand one = *command;
      one.inputs = {input};
      if (assets.is_dataset) {
        if (auto added = addDataset(one, packs_); !added) return added;
      } else {
        packs_.add("scenes/" + input.stem().string(), std::move(one), input);
      }
    }
    return {};
  }

  Result<void> planObjects(const RecipeAssets& assets) {
    const auto command = commandOf(assets, "object", true);
    if (!command) return tl::unexpected(command.error());
    const auto objects = findObjects(command->inputs);
    if (!objects) return tl::unexpected(objects.error());
    for (const ObjectInput& object : *objects) {
      BakeCommand one = *command;
      one.inputs = {object.path};
      one.asset_name = object.name;
      packs_.add("objects/" + object.name, std::move(one), object.path);
    }
    return {};
  }

  Result<void> planRobot(const RecipeAssets& assets) {
    auto command = commandOf(assets, "robot", true);
    if (!command) return tl::unexpected(command.error());
    if (command->inputs.size() != 1) {
      return fail(
          ErrorCode::kInvalidInput, assets.place,
          fmt::format("[robot] names {} files, one URDF is wanted", command->inputs.size()));
    }
    const fs::path input = command->inputs.front();
    packs_.add("robot", std::move(*command), input);
    return {};
  }

  Result<void> planEpisodes(const RecipeAssets& assets) {
    auto command = commandOf(assets, "episodes", false);
    if (!command) return tl::unexpected(command.error());
    packs_.setEpisodes(std::move(*command));
    return {};
  }

  /// What somebody would have typed for a table of the recipe.
  Result<BakeCommand> commandOf(const RecipeAssets& assets, const char* kind, bool with_common) {
    std::vector<std::string> arguments{"--as", kind};
    if (with_common) {
      if (auto added = addOptions(*common_, arguments); !added) {
        return tl::unexpected(added.error());
      }
    }
    if (auto added = addOptions(assets.options, arguments); !added) {
      return tl::unexpected(added.error());
    }
    auto inputs = findInputs(assets.inputs, roots_);
    if (!inputs) return located(inputs.error(), assets);
    // Episodes that are generated are made of packs that do not exist yet.
    arguments.emplace_back("--");
    if (inputs->empty()) arguments.emplace_back("packs");
    for (const fs::path& input : *inputs) arguments.push_back(input.string());
    auto command = commandFrom(arguments);
    if (!command) return located(command.error(), assets);
    if (inputs->empty()) command->inputs.clear();
    return command;
  }

  static tl::unexpected<Error> located(Error error, const RecipeAssets& assets) {
    error.where = error.where.empty() ? assets.place : assets.place + ": " + error.where;
    return tl::unexpected<Error>(std::move(error));
  }

  Result<void> addOptions(const std::vector<RecipeOption>& options,
                          std::vector<std::string>& arguments) const {
    for (const RecipeOption& option : options) {
      if (option.values.empty()) arguments.push_back("--" + option.name);
      for (const std::string& value : option.values) {
        auto text = textOf(option, value);
        if (!text) return tl::unexpected(text.error());
        arguments.push_back(fmt::format("--{}={}", option.name, *text));
      }
    }
    return {};
  }

  /// The value as it is typed from the current folder.
  [[nodiscard]] Result<std::string> textOf(const RecipeOption& option,
                                           const std::string& value) const {
    const bool has_name = namesFileOfName(option.name);
    if (!has_name && !namesFile(option.name)) return value;
    const std::size_t begin = has_name ? value.find('=') + 1 : 0;
    const auto found = findInputs({value.substr(begin)}, roots_);
    if (!found) {
      return galactic::fail(found.error().code, option.place + ": " + option.name,
                            found.error().where + " " + found.error().message);
    }
    return value.substr(0, begin) + found->front().string();
  }

  PackList& packs_;
  std::vector<fs::path> roots_;
  const std::vector<RecipeOption>* common_ = nullptr;
};

/// "home" of home.scene_dataset_config.json, of home.toml and of the folder home.
std::string worldName(const fs::path& input) {
  constexpr std::string_view kDatasetSuffix = ".scene_dataset_config.json";
  std::error_code unknown;
  // "scans/" has no file name, and "." is none.
  const fs::path whole = fs::absolute(input, unknown).lexically_normal();
  std::string name = (whole.has_filename() ? whole : whole.parent_path()).filename().string();
  if (fs::is_directory(input, unknown)) return name;
  if (!name.ends_with(kDatasetSuffix)) return whole.stem().string();
  return name.substr(0, name.size() - kDatasetSuffix.size());
}

/// NAME.pack, in the folder or under the name that the command gives.
Result<fs::path> worldPackOf(const BakeCommand& command) {
  const std::string name = worldName(command.inputs.front());
  std::error_code unknown;
  const fs::path& out = command.output;
  const bool is_folder = !out.has_filename() || fs::is_directory(out, unknown);
  if (is_folder) return out / (name + ".pack");
  if (out.has_extension()) return out;
  // The other packs go into a folder of this name.
  return fail(
      ErrorCode::kInvalidInput, "--out",
      fmt::format("is \"{}\", NAME.pack or a folder that is there is wanted", out.string()));
}

}  // namespace

Result<std::vector<std::string>> namesOfScenes(const BakeCommand& command) {
  std::error_code unknown;
  if (fs::is_directory(command.inputs.front(), unknown)) {
    const auto files = findSceneFiles(command.inputs.front());
    if (!files) return tl::unexpected(files.error());
    return wantedScenes(namesOf(*files), command.dataset);
  }
  const auto dataset =
      SceneDataset::read(command.inputs.front(), {.allow_outside = command.allow_outside});
  if (!dataset) return tl::unexpected(dataset.error());
  return wantedScenes(dataset->scenes(), command.dataset);
}

Result<WorldPlan> makePlan(const BakeCommand& command) {
  auto world = worldPackOf(command);
  if (!world) return tl::unexpected(world.error());
  PackList packs(std::move(*world));
  if (command.kind == AssetKind::kDataset) {
    for (const fs::path& input : command.inputs) {
      BakeCommand one = command;
      one.inputs = {input};
      if (auto added = addDataset(one, packs); !added) return tl::unexpected(added.error());
    }
    return packs.finish();
  }
  const auto recipe = readWorldRecipe(command.inputs.front());
  if (!recipe) return tl::unexpected(recipe.error());
  if (auto planned = RecipePlanner(command, packs).plan(*recipe); !planned) {
    return tl::unexpected(planned.error());
  }
  packs.setTask(recipe->task);
  return packs.finish();
}

}  // namespace galactic::bake
