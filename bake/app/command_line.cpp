#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <set>
#include <string_view>
#include <thread>

#include "command.h"
#include "galactic/bake/habitat_names.h"
#include "galactic/bake/option_field.h"
#include "galactic/bake/robot_recipe.h"
#include "galactic/error.h"
#include "support/console/standard_streams.h"
#include "support/text/help_lines.h"
#include "support/text/nearest_name.h"
#include "support/text/number_text.h"
#include "support/text/printable.h"
#include "support/try.h"
#include "terminal.h"

namespace galactic::bake {
namespace {

constexpr std::string_view kRecipeSuffix = ".toml";

constexpr const char* kFooter =
    "Examples:\n"
    "  galactic-bake scene.glb --radii 0.015,0.05,0.12\n"
    "  galactic-bake objects/ --as object -o objects.pack\n"
    "  galactic-bake fetch.urdf --as robot --recipe fetch.toml\n"
    "  galactic-bake scene.pack objects.pack fetch.pack --as episodes -o episodes.pack\n"
    "  galactic-bake rearrange.json.gz scene.pack objects.pack fetch.pack -o episodes.pack\n"
    "  galactic-bake scene.pack objects.pack fetch.pack episodes.pack --as world -o world.pack\n"
    "  galactic-bake replicaCAD.scene_dataset_config.json -o replica.pack\n"
    "  galactic-bake world.toml -o world.pack";

enum class AssetKind { kScene, kObject, kRobot, kEpisodes, kWorld, kDataset };
constexpr std::array<Named<AssetKind>, 6> kKindNames{{{"scene", AssetKind::kScene},
                                                      {"object", AssetKind::kObject},
                                                      {"robot", AssetKind::kRobot},
                                                      {"episodes", AssetKind::kEpisodes},
                                                      {"dataset", AssetKind::kDataset},
                                                      {"world", AssetKind::kWorld}}};

/// Options that do not control how to bake. Their help is defined below.
constexpr std::array<std::string_view, 4> kNotInFiles{"config", "help", "print-recipe", "version"};

using Target = std::variant<Job, DatasetCommand, RecipeCommand>;

/// One target of each kind.
std::vector<Target> allTargets() {
  return {Job(SceneJob{}),
          Job(ObjectJob{}),
          Job(RobotJob{}),
          Job(EpisodeImportJob{}),
          Job(EpisodeGenerationJob{}),
          Job(WorldJob{}),
          DatasetCommand{},
          RecipeCommand{}};
}

void visitTarget(Target& target, OptionVisitor& visitor) {
  std::visit([&](auto& one) { visitOptions(one, visitor); }, target);
}

/// Shows all options of the tool to `visitor`, each at least once.
void visitAll(OptionVisitor& visitor) {
  ToolOptions run;
  visitOptions(run, visitor);
  for (Target& target : allTargets()) visitTarget(target, visitor);
  ManyPacksOptions many;
  visitOptions(many, visitor);
}

std::string dashed(std::string_view name) { return "--" + std::string(name); }

/// Registers each visited option with the parser.
class Registrar final : public OptionVisitor {
 public:
  explicit Registrar(CLI::App& app) : app_(app) {}

  using OptionVisitor::option;
  void group(std::string_view heading) override { heading_ = heading; }
  void option(const OptionInfo& info, OptionField& field) override {
    if (!names_.emplace(info.name).second) return;
    const bool is_switch = field.kind() == OptionKind::kSwitch;
    const std::string help = withFlags(info.help);
    CLI::Option* option =
        is_switch ? app_.add_flag(typed(info.name), help) : app_.add_option(typed(info.name), help);
    option->group(heading_);
    if (is_switch) return;
    const std::vector<std::string> values = field.texts();
    const bool shows_default = values.size() == 1 && values.front().size() < kLongDefault &&
                               info.help.find("(default") == std::string_view::npos;
    option->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
        ->allow_extra_args(false)
        ->option_text(fmt::format("{}{}", info.form,
                                  shows_default ? fmt::format(" [{}]", values.front()) : ""));
  }

 private:
  static constexpr std::size_t kLongDefault = 24;

  static std::string typed(std::string_view name) {
    if (name == "threads") return "-j,--threads";
    for (const std::string_view with_letter : {"out", "verbose", "quiet"}) {
      if (name == with_letter) return fmt::format("-{},{}", name.front(), dashed(name));
    }
    return dashed(name);
  }

  CLI::App& app_;
  std::string heading_;
  std::set<std::string, std::less<>> names_;
};

class NameSet final : public OptionVisitor {
 public:
  using OptionVisitor::option;
  void option(const OptionInfo& info, OptionField& /*field*/) override { names.emplace(info.name); }
  std::set<std::string, std::less<>> names;
};

/// How messages describe the target.
std::string describe(const Target& target) {
  if (std::holds_alternative<DatasetCommand>(target)) return "--as dataset";
  if (std::holds_alternative<RecipeCommand>(target)) return "a world's recipe";
  const Job& job = std::get<Job>(target);
  std::string text = fmt::format("--as {}", kindOf(job));
  if (std::holds_alternative<EpisodeImportJob>(job)) text += " of published episodes";
  if (std::holds_alternative<EpisodeGenerationJob>(job)) text += " of packs";
  if (std::holds_alternative<WorldJob>(job)) text += " of packs";
  return text;
}

/// The parser and its results.
class CommandLine {
 public:
  CommandLine() {
    app_.footer(std::string(kFooter) + "\n\n" + kExitCodesHelp);
    app_.formatter(std::make_shared<HelpLines<CLI::Formatter, CLI::Option>>());
    app_.get_formatter()->column_width(34);
    app_.add_option("INPUT", inputs_,
                    "Meshes (GLB, glTF, OBJ, PLY, STL, DAE, ...), folders of objects, robots "
                    "(URDF, MJCF), published episodes (episode sets, Habitat's), a scene dataset, "
                    "a folder of scans, a world's recipe, or packs")
        ->type_name("");
    app_.add_option("--as", as_,
                    "What to make (default: robot of .urdf, .xml and .mjcf, episodes of "
                    ".episode_set.json and .json.gz, dataset of .scene_dataset_config.json, world "
                    "of .toml, else scene)")
        ->option_text("scene|object|robot|episodes|dataset|world");
    app_.add_option("--config", config_, "Read options from a TOML file")->option_text("FILE");
    app_.add_flag(
            "--print-recipe", prints_recipe_,
            "Print a robot recipe: with every key explained, or a draft for the robot that is "
            "given")
        ->check(switchCheck());
    app_.set_version_flag("--version", "galactic-bake " GALACTIC_VERSION);
    Registrar registrar(app_);
    visitAll(registrar);
  }

  void parse(int argc, const char* const* argv) { app_.parse(argc, argv); }
  /// Prints help or the version, and returns the exit code.
  int answer(const CLI::Success& asked) { return app_.exit(asked); }
  [[nodiscard]] std::string explain(const CLI::ParseError& error) const {
    return withSuggestions(error.what(), longNames());
  }
  /// Whether to explain every key of a robot recipe.
  [[nodiscard]] bool explainsRecipe() const { return prints_recipe_ && inputs_.empty(); }

  Result<BakeCommand> understand() {
    collectTyped();
    RETURN_IF_ERROR(readConfig());
    if (inputs_.empty()) {
      return fail(ErrorCode::kInvalidInput, "command line", "input is required; see --help");
    }
    BakeCommand command;
    command.inputs = std::move(inputs_);
    command.config = config_;
    command.prints_recipe = prints_recipe_;
    ASSIGN_OR_RETURN(auto target, chooseTarget(command.inputs));
    command.what = std::move(target);
    RETURN_IF_ERROR(readOptions(command));
    if (command.run.threads == 0) {
      command.run.threads = std::max(1U, std::thread::hardware_concurrency());
    }
    return command;
  }

 private:
  [[nodiscard]] std::vector<std::string> longNames() const {
    std::vector<std::string> names;
    for (const CLI::Option* option : app_.get_options()) {
      if (option->get_name().starts_with("--")) names.push_back(option->get_name());
    }
    return names;
  }

  /// Collects the typed options, except those that this class reads itself.
  void collectTyped() {
    for (const CLI::Option* option : app_.get_options()) {
      const std::string name = option->get_name();
      if (!name.starts_with("--") || option->count() == 0) continue;
      GivenOption given{.name = name.substr(2), .values = {}, .place = name};
      for (const std::string& text : option->results()) {
        given.values.push_back({.name = {}, .words = {text}});
      }
      if (std::ranges::find(kNotInFiles, given.name) == kNotInFiles.end()) {
        given_.push_back(std::move(given));
      }
    }
  }

  /// Adds the options of the file that were not typed.
  Result<void> readConfig() {
    if (app_.count("--config") == 0) return {};
    if (config_.empty()) {
      return fail(ErrorCode::kInvalidInput, "--config",
                  "has an empty value; give one, or leave the option out");
    }
    ASSIGN_OR_RETURN(auto options, readOptionFile(config_));
    for (GivenOption& option : options) {
      if (std::ranges::find(kNotInFiles, option.name) != kNotInFiles.end()) {
        return fail(ErrorCode::kInvalidInput, option.place,
                    "belongs on the command line; leave it out");
      }
      if (std::ranges::find(given_, option.name, &GivenOption::name) == given_.end()) {
        given_.push_back(std::move(option));
      }
    }
    return {};
  }

  static bool endsWithOneOf(const std::filesystem::path& path,
                            std::initializer_list<std::string_view> endings) {
    const std::string file = path.filename().string();
    return std::any_of(endings.begin(), endings.end(),
                       [&file](std::string_view ending) { return file.ends_with(ending); });
  }

  static bool isPack(const std::filesystem::path& path) { return endsWithOneOf(path, {".pack"}); }

  /// Whether all inputs have one of the endings, ignoring packs, but not all are packs.
  static bool allButPacksEndWithOneOf(const std::vector<std::filesystem::path>& inputs,
                                      std::initializer_list<std::string_view> endings) {
    return !std::ranges::all_of(inputs, isPack) &&
           std::ranges::all_of(inputs, [endings](const std::filesystem::path& path) {
             return isPack(path) || endsWithOneOf(path, endings);
           });
  }

  /// Whether all inputs have one of the endings.
  static bool allEndWithOneOf(const std::vector<std::filesystem::path>& inputs,
                              std::initializer_list<std::string_view> endings) {
    return std::ranges::all_of(inputs, [endings](const std::filesystem::path& path) {
      return endsWithOneOf(path, endings);
    });
  }

  /// The kind that --as names, or else the kind that the inputs' names suggest.
  Result<AssetKind> chooseKind(const std::vector<std::filesystem::path>& inputs) {
    AssetKind kind = AssetKind::kScene;
    if (allEndWithOneOf(inputs, {".urdf", ".xml", ".mjcf"})) kind = AssetKind::kRobot;
    // Only episodes come compressed.
    if (allButPacksEndWithOneOf(inputs, {kEpisodeSetSuffix, ".json.gz"})) {
      kind = AssetKind::kEpisodes;
    }
    if (allEndWithOneOf(inputs, {kDatasetSuffix})) kind = AssetKind::kDataset;
    if (allEndWithOneOf(inputs, {kRecipeSuffix})) kind = AssetKind::kWorld;
    const auto as = std::ranges::find(given_, "as", &GivenOption::name);
    if (as == given_.end()) return kind;
    if (as->values.size() > 1) {
      return fail(ErrorCode::kInvalidInput, as->place, "is given twice; give it once");
    }
    std::string fault = choice(kind, kKindNames)->read(as->values);
    if (!fault.empty()) return fail(ErrorCode::kInvalidInput, as->place, std::move(fault));
    given_.erase(as);
    return kind;
  }

  Result<Target> chooseTarget(const std::vector<std::filesystem::path>& inputs) {
    ASSIGN_OR_RETURN(const auto kind, chooseKind(inputs));
    switch (kind) {
      case AssetKind::kScene:
        return Job(SceneJob{});
      case AssetKind::kObject:
        return Job(ObjectJob{});
      case AssetKind::kRobot:
        return Job(RobotJob{});
      case AssetKind::kDataset:
        return DatasetCommand{};
      case AssetKind::kEpisodes:
        if (allButPacksEndWithOneOf(inputs, {".json", ".json.gz"})) return Job(EpisodeImportJob{});
        return Job(EpisodeGenerationJob{});
      case AssetKind::kWorld:
        break;
    }
    const bool is_recipe = inputs.size() == 1 && allEndWithOneOf(inputs, {kRecipeSuffix});
    return is_recipe ? Target(RecipeCommand{}) : Target(Job(WorldJob{}));
  }

  Result<void> readOptions(BakeCommand& command) const {
    OptionReader reader(given_);
    visitOptions(command.run, reader);
    visitTarget(command.what, reader);
    if (command.makesWorld()) visitOptions(command.many, reader);
    NameSet known;
    visitAll(known);
    const std::vector<std::string> names(known.names.begin(), known.names.end());
    if (auto finished = reader.finish(describe(command.what), names); !finished) return finished;
    if (const auto* job = std::get_if<Job>(&command.what)) {
      if (auto checked = checkTogether(*job, reader); !checked) return checked;
    }
    if (const auto* dataset = std::get_if<DatasetCommand>(&command.what)) {
      if (auto checked = checkTogether(dataset->jobs, reader); !checked) return checked;
    }
    return checkRun(command, reader);
  }

  static Result<void> checkRun(const BakeCommand& command, const OptionReader& given) {
    if (command.many.no_cache && given.isGiven("cache")) {
      return given.refuse("no-cache", "does not go with `cache`; give one");
    }
    if (given.isGiven("verbose") && given.isGiven("quiet")) {
      return given.refuse("verbose", "does not go with `quiet`; leave one of them out");
    }
    const Job* job = std::get_if<Job>(&command.what);
    const bool is_import = job != nullptr && std::holds_alternative<EpisodeImportJob>(*job);
    if (is_import && given.isGiven("seed") && std::ranges::none_of(command.inputs, isPack)) {
      return given.refuse("seed",
                          "is for starts that are drawn in packs; give those of the scenes, the "
                          "objects and the robot, too, or leave it out");
    }
    return command.prints_recipe ? checkDraft(command, given) : Result<void>{};
  }

  /// A draft of a recipe is for one robot, and is printed.
  static Result<void> checkDraft(const BakeCommand& command, const OptionReader& given) {
    const Job* job = std::get_if<Job>(&command.what);
    const bool is_robot = job != nullptr && std::holds_alternative<RobotJob>(*job);
    if (!is_robot || command.inputs.size() != 1) {
      return fail(ErrorCode::kInvalidInput, "--print-recipe",
                  "drafts a recipe of one robot; give its file, or no input to see every key");
    }
    for (const char* ignored : {"out", "recipe", "spheres", "report"}) {
      if (!given.isGiven(ignored)) continue;
      return given.refuse(ignored,
                          "does not go with `print-recipe`, which prints a recipe and bakes "
                          "nothing; leave it out");
    }
    return {};
  }

  CLI::App app_{"Bakes scenes, objects, robots and episodes into packs for galactic-run.",
                "galactic-bake"};
  std::vector<std::filesystem::path> inputs_;
  std::string as_;
  std::string config_;
  bool prints_recipe_ = false;
  std::vector<GivenOption> given_;
};

}  // namespace

bool isOfCommandLine(std::string_view name) {
  static const std::set<std::string, std::less<>> names = [] {
    NameSet set;
    ToolOptions run;
    ManyPacksOptions many;
    RecipeCommand recipe;
    visitOptions(run, set);
    visitOptions(many, set);
    visitOptions(recipe, set);
    set.names.insert({"as", "list"});
    // Recipes accept these, too.
    NameSet shared;
    visitOptions(recipe.episodes, shared);
    for (const std::string& option : shared.names) set.names.erase(option);
    set.names.insert(kNotInFiles.begin(), kNotInFiles.end());
    return set.names;
  }();
  return names.contains(name);
}

ParsedCommand parseCommandLine(int argc, const char* const* argv) {
  CommandLine line;
  try {
    line.parse(argc, argv);
  } catch (const CLI::Success& asked) {
    return line.answer(asked);
  } catch (const CLI::ParseError& error) {
    printToStderr(fmt::format("galactic-bake: command line: {}; see --help\n",
                              printable(line.explain(error))));
    return kExitUsage;
  }
  if (line.explainsRecipe()) {
    fmt::print("{}", describeRobotRecipe());
    return kExitOk;
  }
  auto command = line.understand();
  if (command) return std::move(*command);
  printError(command.error());
  return command.error().code == ErrorCode::kIo ? static_cast<int>(ErrorCode::kIo) : kExitUsage;
}

Result<BakeCommand> commandFrom(const std::vector<std::string>& arguments) {
  CommandLine line;
  std::vector<const char*> argv{"galactic-bake"};
  argv.reserve(arguments.size() + 1);
  for (const std::string& argument : arguments) argv.push_back(argument.c_str());
  try {
    line.parse(static_cast<int>(argv.size()), argv.data());
  } catch (const CLI::ParseError& error) {
    return fail(ErrorCode::kInvalidInput, "command line", line.explain(error));
  }
  return line.understand();
}

}  // namespace galactic::bake
