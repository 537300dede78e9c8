#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "build/pack_list.h"
#include "recipe/world_recipe.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

/// The folders in which a recipe's files are looked for.
std::vector<fs::path> rootsOf(const RecipeSource& source) {
  const fs::path beside = source.recipe.parent_path();
  std::vector<fs::path> roots{beside.empty() ? fs::path(".") : beside};
  if (!source.data.empty()) roots.push_back(source.data);
  return roots;
}

tl::unexpected<Error> located(Error error, const std::string& place) {
  error.where = error.where.empty() ? place : place + ": " + error.where;
  return tl::unexpected<Error>(std::move(error));
}

/// Makes jobs from the tables of a recipe.
class RecipeJobs {
 public:
  RecipeJobs(const RecipeSource& source, const WorldRecipe& recipe, BakeLibraries& libraries,
             PackList& packs)
      : source_(source),
        recipe_(recipe),
        libraries_(libraries),
        packs_(packs),
        roots_(rootsOf(source)) {}

  Result<void> add() {
    for (const RecipeAssets& assets : recipe_.scenes) {
      if (auto added = addScenes(assets); !added) return added;
    }
    for (const RecipeAssets& assets : recipe_.objects) {
      if (auto added = addObjects(assets); !added) return added;
    }
    if (recipe_.robot) {
      if (auto added = addRobot(*recipe_.robot); !added) return added;
    }
    RETURN_IF_ERROR(checkOverrides());
    if (recipe_.episodes) RETURN_IF_ERROR(addEpisodes(*recipe_.episodes));
    return packs_.checkRadii();
  }

 private:
  Result<void> addScenes(const RecipeAssets& assets) {
    ASSIGN_OR_RETURN(const auto inputs, inputsOf(assets));
    DatasetJobs dataset;
    SceneJob scene;
    auto read = assets.is_dataset ? readOptions(assets, "a dataset", dataset)
                                  : readOptions(assets, "`as` scene", scene);
    if (!read) return read;
    for (const fs::path& input : inputs) {
      if (!assets.is_dataset) {
        scene.input = input;
        packs_.add("scenes/" + input.stem().string(), scene, input);
        continue;
      }
      dataset.input = input;
      auto added = addDataset(dataset, libraries_, packs_);
      if (!added && added.error().where == "scenes") return located(added.error(), assets.place);
      if (!added) return added;
    }
    return {};
  }

  Result<void> addObjects(const RecipeAssets& assets) {
    ASSIGN_OR_RETURN(const auto inputs, inputsOf(assets));
    ObjectJob job;
    if (auto read = readOptions(assets, "`as` object", job); !read) return read;
    ASSIGN_OR_RETURN(const auto found, findObjects(inputs));
    for (const std::string& warning : found.warnings) packs_.warn(warning);
    for (const ObjectInput& object : found.objects) {
      job.inputs = {object.path};
      job.name = object.name;
      packs_.add("objects/" + object.name, job, object.path);
    }
    return {};
  }

  Result<void> addRobot(const RecipeAssets& assets) {
    ASSIGN_OR_RETURN(const auto inputs, inputsOf(assets));
    RobotJob job;
    if (auto read = readOptions(assets, "`as` robot", job); !read) return read;
    if (inputs.size() != 1) {
      return fail(ErrorCode::kInvalidInput, assets.place,
                  fmt::format("[robot] names {} files, expected one URDF or MJCF", inputs.size()));
    }
    job.input = inputs.front();
    packs_.add("robot", job, job.input);
    return {};
  }

  /// Options on the command line apply to episodes that the recipe generates; the seed also applies
  /// to starts drawn for imported episodes.
  [[nodiscard]] Result<void> checkOverrides() const {
    const auto& [count, seed] = source_.episodes;
    if (!count && !seed) return {};
    if (recipe_.episodes && (recipe_.episodes->inputs.empty() || !count)) return {};
    return fail(
        ErrorCode::kInvalidInput, count ? "count" : "seed",
        fmt::format("is about episodes that are generated, and the recipe {}; leave it out, "
                    "or give the recipe a table [episodes] without `files`",
                    recipe_.episodes ? "imports its own" : "has none"));
  }

  Result<void> addEpisodes(const RecipeAssets& assets) {
    // Generated episodes have no inputs: the packs they are made in do not exist yet.
    if (assets.inputs.empty()) {
      EpisodeGenerationJob job;
      if (auto read = readOptions(assets, "generated episodes", job); !read) return read;
      if (source_.episodes.count) job.generate.episodes = *source_.episodes.count;
      if (source_.episodes.seed) job.generate.seed = *source_.episodes.seed;
      if (auto checked = packs_.checkForEpisodes(); !checked) {
        return located(checked.error(), assets.place);
      }
      packs_.setEpisodes(std::move(job));
      return {};
    }
    ASSIGN_OR_RETURN(const auto inputs, inputsOf(assets));
    EpisodeImportJob job;
    if (auto read = readOptions(assets, "imported episodes", job); !read) return read;
    if (inputs.size() != 1) {
      return fail(ErrorCode::kInvalidInput, assets.place,
                  fmt::format("[episodes] names {} files, expected one", inputs.size()));
    }
    job.input = inputs.front();
    if (source_.episodes.seed) job.seed = source_.episodes.seed;
    packs_.setEpisodes(std::move(job));
    return {};
  }

  [[nodiscard]] Result<std::vector<fs::path>> inputsOf(const RecipeAssets& assets) const {
    auto inputs = findInputs(assets.inputs, roots_);
    if (!inputs) return located(inputs.error(), assets.place);
    return inputs;
  }

  /// Reads the options for all tables, which do not apply to episodes, and then those of this
  /// table.
  template <class Target>
  Result<void> readOptions(const RecipeAssets& assets, std::string_view what, Target& target) {
    constexpr bool kIsEpisodes =
        std::is_same_v<Target, EpisodeGenerationJob> || std::is_same_v<Target, EpisodeImportJob>;
    std::vector<GivenOption> given;
    if (!kIsEpisodes) given = recipe_.common;
    given.insert(given.end(), assets.options.begin(), assets.options.end());
    for (const GivenOption& option : given) {
      if (!source_.is_of_command_line || !source_.is_of_command_line(option.name)) continue;
      return fail(ErrorCode::kInvalidInput, option.place,
                  "belongs on the command line, not into a recipe; leave it out");
    }
    OptionReader reader(given, [this](const fs::path& path) -> Result<fs::path> {
      ASSIGN_OR_RETURN(const auto found, findInputs({path.string()}, roots_));
      return found.front();
    });
    visitOptions(target, reader);
    std::vector<std::string> known = optionNames();
    known.insert(known.end(), {"files", "dataset", "scenes", "missing"});
    if (auto finished = reader.finish(what, known); !finished) return finished;
    return checkTogether(target, reader);
  }

  const RecipeSource& source_;
  const WorldRecipe& recipe_;
  BakeLibraries& libraries_;
  PackList& packs_;
  std::vector<fs::path> roots_;
};

}  // namespace

Result<WorldPlan> jobsOfRecipe(const RecipeSource& source, const fs::path& world,
                               BakeLibraries& libraries) {
  ASSIGN_OR_RETURN(const auto recipe, readWorldRecipe(source.recipe));
  PackList packs(world);
  packs.setTask(recipe.task);
  RETURN_IF_ERROR(RecipeJobs(source, recipe, libraries, packs).add());
  return packs.finish();
}

}  // namespace galactic::bake
