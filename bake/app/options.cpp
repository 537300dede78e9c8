#include "options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>
#include <functional>
#include <map>
#include <memory>
#include <string_view>
#include <thread>

#include "config_file.h"
#include "galactic/bake/robot_recipe.h"
#include "galactic/error.h"
#include "galactic/nearest_name.h"
#include "galactic/number_text.h"
#include "galactic/printable.h"
#include "option_groups.h"
#include "option_values.h"

namespace galactic::bake {
namespace {

constexpr std::string_view kDatasetSuffix = ".scene_dataset_config.json";
constexpr std::string_view kRecipeSuffix = ".toml";

constexpr const char* kFooter =
    "Examples:\n"
    "  galactic-bake scene.glb --radii 0.015,0.05,0.12\n"
    "  galactic-bake objects/ --as object -o objects.pack\n"
    "  galactic-bake fetch.urdf --as robot --recipe fetch.toml\n"
    "  galactic-bake scene.pack objects.pack fetch.pack --as episodes -o episodes.pack\n"
    "  galactic-bake scene.pack objects.pack fetch.pack episodes.pack --as world -o world.pack\n"
    "  galactic-bake replicaCAD.scene_dataset_config.json -o replica.pack\n"
    "  galactic-bake world.toml -o world.pack";

const std::map<std::string, AssetKind>& kindNames() {
  static const std::map<std::string, AssetKind> names{
      {"scene", AssetKind::kScene},     {"object", AssetKind::kObject},
      {"robot", AssetKind::kRobot},     {"episodes", AssetKind::kEpisodes},
      {"dataset", AssetKind::kDataset}, {"world", AssetKind::kWorld}};
  return names;
}

/// The headings of --help, and which kinds of asset each is for.
struct Group {
  const char* heading;
  bool (*is_for)(AssetKind);
};

bool isObject(AssetKind kind) { return kind == AssetKind::kObject; }
bool isDataset(AssetKind kind) { return kind == AssetKind::kDataset; }
bool isScene(AssetKind kind) { return kind == AssetKind::kScene || isDataset(kind); }
bool isRobot(AssetKind kind) { return kind == AssetKind::kRobot; }
bool isEpisodes(AssetKind kind) { return kind == AssetKind::kEpisodes; }
bool isMesh(AssetKind kind) { return isScene(kind) || isObject(kind); }
bool isShape(AssetKind kind) { return isRobot(kind) || isObject(kind); }
bool hasRadii(AssetKind kind) { return isScene(kind) || isObject(kind) || isRobot(kind); }
bool hasPlan(AssetKind kind) { return isDataset(kind) || kind == AssetKind::kWorld; }
bool hasSeed(AssetKind kind) { return isScene(kind) || isEpisodes(kind); }

constexpr Group kRadiiGroup{"Spheres (scenes, objects, robots)", hasRadii};
constexpr Group kFileGroup{"Files (scenes, objects, robots)", hasRadii};
constexpr Group kMeshGroup{"Meshes (scenes, objects)", isMesh};
constexpr Group kSceneGroup{"Scenes", isScene};
constexpr Group kShapeGroup{"Spheres and boxes (objects, robots)", isShape};
constexpr Group kObjectGroup{"Objects", isObject};
constexpr Group kRobotGroup{"Robots", isRobot};
constexpr Group kEpisodeGroup{"Episodes", isEpisodes};
constexpr Group kRenderGroup{"Render meshes (scenes, objects, robots)", hasRadii};
constexpr Group kSeedGroup{"Scenes, generated episodes", hasSeed};
constexpr Group kDatasetGroup{"Datasets", isDataset};
constexpr Group kPlanGroup{"Datasets, worlds from recipes", hasPlan};
constexpr std::array kGroups{kRadiiGroup, kFileGroup,    kSceneGroup,   kMeshGroup,
                             kShapeGroup, kObjectGroup,  kRobotGroup,   kRenderGroup,
                             kSeedGroup,  kEpisodeGroup, kDatasetGroup, kPlanGroup};

/// Whether the option's values are files, which count by their content.
bool namesFiles(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  return type.ends_with("FILE") || type.ends_with("PACK") || type.ends_with("DIR");
}

/// Which packs are made, where and when; not what is in them.
bool decidesContent(const Group& group) {
  return group.is_for != kDatasetGroup.is_for && group.is_for != kPlanGroup.is_for;
}

/// Options that were typed although their group is for other kinds of asset.
Result<void> checkGroup(const CLI::App& app, const Group& group, AssetKind kind) {
  if (group.is_for(kind)) return {};
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_group() != group.heading || option->count() == 0) continue;
    return fail(ErrorCode::kInvalidInput, option->get_name(),
                fmt::format("does not go with --as {}; leave it out", nameOf(kindNames(), kind)));
  }
  return {};
}

/// The parser would wait for what comes through a pipe.
std::string refusePipe(const std::string& path) {
  std::error_code missing;
  const auto type = std::filesystem::status(path, missing).type();
  using Type = std::filesystem::file_type;
  if (type != Type::fifo && type != Type::character && type != Type::socket) return {};
  throw CLI::FileError(path + " is not a regular file; give the path of a file");
}

void addRunOptions(CLI::App& app, BakeCommand& command) {
  app.add_option("input", command.inputs,
                 "Meshes (GLB, glTF, OBJ, PLY, STL, DAE, ...), folders of objects, URDF robots, "
                 "published episodes (episode sets, Habitat's), a scene dataset, a world's recipe, "
                 "or packs")
      ->required()
      ->option_text("INPUT...");
  app.add_option("--as", command.kind,
                 "What to make (default: robot of .urdf, episodes of .episode_set.json and "
                 ".json.gz, dataset of .scene_dataset_config.json, world of .toml, else scene)")
      ->transform(CLI::CheckedTransformer(kindNames()))
      ->option_text("scene|object|robot|episodes|dataset|world");
  app.add_option("-o,--out", command.output,
                 "Pack to write, or a folder for several packs (default: NAME.pack)")
      ->type_name("OUT");
  app.add_option("-j,--jobs", command.jobs, "Threads; the result does not depend on it")
      ->check(wholeCheck(1, 4096))
      ->capture_default_str();
  app.add_option("--report", command.report, "Write what was done as JSON")->type_name("FILE.json");
  app.add_option("--check", command.golden_report,
                 "Compare what was done with a report of an earlier bake; exit code 7 when it "
                 "differs")
      ->type_name("FILE.json");
  app.add_option("--tolerance", command.tolerance,
                 "Share by which numbers may differ for --check (default: whole ones not at all)")
      ->check(numberCheck(0, 1e6))
      ->type_name("SHARE");
  app.set_config("--config", "", "Read options from a TOML file")
      ->type_name("FILE")
      ->check(CLI::Validator(refusePipe, ""));
  app.config_formatter(std::make_shared<ConfigFile>(app));
  app.add_flag("--dry-run", command.dry_run, "Read and check the inputs, write no pack");
  app.add_flag("--keep-going", command.keep_going, "Go on with the next input after an error");
  app.add_flag_callback(
      "-v,--verbose", [&command] { command.verbosity = Verbosity::kVerbose; }, "Say more");
  app.add_flag_callback(
      "-q,--quiet", [&command] { command.verbosity = Verbosity::kQuiet; }, "Only errors");
  app.add_flag_callback(
      "--print-recipe",
      [&command] {
        // The inputs, which stand first among the options, have been read.
        command.robot.print_recipe = !command.inputs.empty();
        if (command.robot.print_recipe) return;
        fmt::print("{}", describeRobotRecipe());
        throw CLI::Success();
      },
      "Print a robot recipe: with every key explained, or a draft for the URDF that is given");
  app.set_version_flag("--version", "galactic-bake " GALACTIC_VERSION);
}

Result<void> understandRadii(const std::vector<std::string>& texts, BakeCommand& command) {
  const auto radii = parseNumbers(joined(texts), "--radii");
  if (!radii) return tl::unexpected(radii.error());
  command.scene.radii.clear();
  for (const double radius : *radii) command.scene.radii.push_back(static_cast<float>(radius));
  command.object.spheres.radii = command.scene.radii;
  return {};
}

/// All groups of options and the texts that they hold between parsing and understanding.
class CommandLine {
 public:
  explicit CommandLine(BakeCommand& command) : command_(command) {
    app_.footer(std::string(kFooter) + "\n\n" + kExitCodesHelp);
    app_.get_formatter()->column_width(34);
    addRunOptions(app_, command);
    addGroup(kRadiiGroup, [&] { addRadii(); });
    addGroup(kSeedGroup, [&] { addSeed(); });
    addGroup(kSceneGroup, [&] { scene_.addTo(app_, command); });
    addGroup(kFileGroup, [&] { addReach(); });
    addGroup(kMeshGroup, [&] { import_.addTo(app_); });
    addGroup(kShapeGroup, [&] { shape_.addTo(app_, command); });
    addGroup(kObjectGroup, [&] { addCollection(); });
    addGroup(kRobotGroup, [&] { robot_.addTo(app_, command); });
    addGroup(kRenderGroup, [&] { render_.addTo(app_, command); });
    addGroup(kEpisodeGroup, [&] { episodes_.addTo(app_, command); });
    addGroup(kDatasetGroup, [&] { plan_.addDatasetTo(app_, command); });
    addGroup(kPlanGroup, [&] { plan_.addTo(app_, command); });
  }

  void parse(int argc, const char* const* argv) { app_.parse(argc, argv); }
  /// Help and version.
  int answer(const CLI::Success& asked) { return app_.exit(asked); }
  [[nodiscard]] std::string explain(const CLI::ParseError& error) const {
    return withSuggestions(error.what(), longNamesOf(app_));
  }

  Result<void> understand() {
    if (auto filled = checkFilled(); !filled) return filled;
    chooseKind();
    for (const Group& group : kGroups) {
      if (auto fits = checkGroup(app_, group, command_.kind); !fits) return fits;
    }
    for (const auto& step : {understandRadii(radii_, command_), import_.understand(command_),
                             scene_.understand(command_, seeds_), shape_.understand(command_),
                             robot_.understand(command_), render_.understand(command_),
                             episodes_.understand(command_, seeds_), checkCollection(),
                             plan_.understand(command_), checkDraft(), checkPairs()}) {
      if (!step) return step;
    }
    // Movable objects may be small.
    if (command_.kind == AssetKind::kObject) command_.import.smallest_size = 0;
    command_.import.allow_outside = command_.allow_outside;
    command_.setJobs(command_.jobs);
    command_.config = app_.get_config_ptr()->as<std::string>();
    remember();
    keepTyped();
    return {};
  }

 private:
  void addGroup(const Group& group, const std::function<void()>& add) {
    app_.option_defaults()->group(group.heading);
    add();
    app_.option_defaults()->group("Options");
  }

  void addRadii() {
    app_.add_option("--radii", radii_, "Sphere radii, metres, ascending")
        ->type_name("R,R,...")
        ->allow_extra_args(false)
        ->default_str("0.015,0.05,0.12");
  }

  /// An empty value is a mistake of a script, not the default.
  [[nodiscard]] Result<void> checkFilled() const {
    for (const CLI::Option* option : app_.get_options()) {
      for (const std::string& value : option->results()) {
        if (!value.empty()) continue;
        return fail(ErrorCode::kInvalidInput, option->get_name(),
                    "has an empty value; give one, or leave the option out");
      }
    }
    return {};
  }

  void addReach() {
    app_.add_flag("--allow-outside", command_.allow_outside,
                  "Read what meshes, robots and datasets name wherever it points, not only below "
                  "their folders and in packages");
  }

  void addCollection() {
    app_.add_option("--collection", command_.collection,
                    "Published *.collection.json: the objects in it get its boxes and spheres")
        ->type_name("FILE");
  }

  /// A collection's boxes stand in the frame of the mesh files.
  [[nodiscard]] Result<void> checkCollection() const {
    if (command_.collection.empty()) return {};
    if (command_.import.up && !command_.import.transform) return {};
    return fail(ErrorCode::kInvalidInput, "--collection",
                "needs the up axis of the meshes, in whose frame its boxes stand: give --up, and "
                "no --transform");
  }

  [[nodiscard]] bool isTyped(const char* option) const { return app_.count(option) > 0; }

  /// A draft is of one robot, and printed.
  [[nodiscard]] Result<void> checkDraft() const {
    if (!command_.robot.print_recipe) return {};
    if (!isRobot(command_.kind) || command_.inputs.size() != 1) {
      return fail(ErrorCode::kInvalidInput, "--print-recipe",
                  "drafts a recipe of one URDF; give one, or no input to see every key");
    }
    for (const char* ignored : {"--out", "--recipe", "--spheres", "--report", "--check"}) {
      if (!isTyped(ignored)) continue;
      return fail(ErrorCode::kInvalidInput, ignored,
                  "does not go with --print-recipe, which prints a recipe and bakes nothing; leave "
                  "it out");
    }
    return {};
  }

  /// Options that would be ignored beside others, or without them.
  [[nodiscard]] Result<void> checkPairs() const {
    const auto refuse = [](const char* option, const char* message) {
      return fail(ErrorCode::kInvalidInput, option, message);
    };
    if (isTyped("--tolerance") && !isTyped("--check")) {
      return refuse("--tolerance", "is about --check; add it, or leave this out");
    }
    for (const char* drawn :
         {"--render-error", "--texture-size", "--texture-format", "--lighting"}) {
      if (isTyped(drawn) && isTyped("--no-render-meshes")) {
        return refuse(drawn, "does not go with --no-render-meshes; leave one of them out");
      }
    }
    for (const char* shape : {"--obb", "--no-support"}) {
      if (isTyped(shape) && !isObject(command_.kind)) {
        return refuse(shape, "is about objects; leave it out");
      }
    }
    for (const char* planned : {"--data", "--cache", "--no-cache", "--shard", "--memory"}) {
      if (isTyped(planned) && !command_.hasPlan()) {
        return refuse(planned, "goes with a dataset or a recipe, not with packs; leave it out");
      }
    }
    if (isTyped("--seed") && isDataset(command_.kind)) {
      return refuse("--seed", "is a point of one scene, and a dataset has many; leave it out");
    }
    if (isTyped("--data") && isDataset(command_.kind)) {
      return refuse("--data", "goes with a recipe, not with a dataset; leave it out");
    }
    return {};
  }

  void addSeed() {
    app_.add_option("--seed", seeds_,
                    "Scenes: a point of the room (may be repeated), x,y,z in metres, y up; "
                    "episodes: the number from which the random ones are drawn")
        ->type_name("X,Y,Z|N")
        ->allow_extra_args(false);
  }

  /// Whether each input ends in one of them.
  [[nodiscard]] bool allEndWithOneOf(std::initializer_list<std::string_view> endings) const {
    return std::all_of(command_.inputs.begin(), command_.inputs.end(),
                       [endings](const std::filesystem::path& path) {
                         const std::string file = path.filename().string();
                         return std::any_of(
                             endings.begin(), endings.end(),
                             [&file](std::string_view ending) { return file.ends_with(ending); });
                       });
  }

  void chooseKind() {
    command_.episodes.generated = !allEndWithOneOf({".json", ".json.gz"});
    if (app_.get_option("--as")->count() > 0) return;
    command_.kind = AssetKind::kScene;
    if (allEndWithOneOf({".urdf"})) command_.kind = AssetKind::kRobot;
    // Nothing but episodes comes compressed.
    if (allEndWithOneOf({kEpisodeSetSuffix, ".json.gz"})) command_.kind = AssetKind::kEpisodes;
    if (allEndWithOneOf({kDatasetSuffix})) command_.kind = AssetKind::kDataset;
    if (allEndWithOneOf({kRecipeSuffix})) command_.kind = AssetKind::kWorld;
  }

  /// In this order in every pack; only what decides the content.
  void remember() {
    if (!isScene(command_.kind)) {
      command_.remember("as", nameOf(kindNames(), command_.kind));
    }
    if (hasRadii(command_.kind)) command_.remember("radii", joined(radii_));
    if (command_.allow_outside) command_.remember("allow-outside", "yes");
    if (isScene(command_.kind)) scene_.remember(command_);
    if (isShape(command_.kind)) shape_.remember(command_);
    command_.remember("collection", command_.collection.filename().string());
    if (isRobot(command_.kind)) robot_.remember(command_);
    if (isMesh(command_.kind)) import_.remember(command_);
    if (hasRadii(command_.kind)) render_.remember(command_);
    if (isEpisodes(command_.kind)) episodes_.remember(command_);
  }

  /// From the parser itself, so that no option can be forgotten.
  void keepTyped() {
    for (const Group& group : kGroups) {
      if (!decidesContent(group)) continue;
      for (const CLI::Option* option : app_.get_options()) {
        if (option->get_group() != group.heading || option->count() == 0) continue;
        if (namesFiles(*option)) continue;
        command_.typed_options.emplace_back(option->get_name(),
                                            fmt::format("{}", fmt::join(option->results(), "\n")));
      }
    }
  }

  BakeCommand& command_;
  CLI::App app_{"Bakes scenes, objects, robots and episodes into packs for galactic-run.",
                "galactic-bake"};
  std::vector<std::string> radii_{"0.015", "0.05", "0.12"};
  ImportOptions import_;
  SceneOptions scene_;
  ShapeOptions shape_;
  RobotFileOptions robot_;
  RenderMeshOptions render_;
  EpisodeSetOptions episodes_;
  PlannedOptions plan_;
  std::vector<std::string> seeds_;
};

}  // namespace

ParsedCommand parseCommandLine(int argc, const char* const* argv) {
  BakeCommand command;
  command.jobs = std::max(1U, std::thread::hardware_concurrency());
  CommandLine line(command);
  try {
    line.parse(argc, argv);
  } catch (const CLI::Success& asked) {
    return line.answer(asked);
  } catch (const CLI::FileError& error) {
    fmt::print(stderr, "galactic-bake: --config: {}\n", printable(error.what()));
    return static_cast<int>(ErrorCode::kIo);
  } catch (const CLI::ConfigError& error) {
    fmt::print(stderr, "galactic-bake: {}\n", printable(error.what()));
    return kExitUsage;
  } catch (const CLI::ParseError& error) {
    fmt::print(stderr, "galactic-bake: command line: {}; see --help\n",
               printable(line.explain(error)));
    return kExitUsage;
  }
  if (const auto understood = line.understand(); !understood) {
    fmt::print(stderr, "galactic-bake: {}: {}\n", printable(understood.error().where),
               printable(understood.error().message));
    return kExitUsage;
  }
  return command;
}

Result<BakeCommand> commandFrom(const std::vector<std::string>& arguments) {
  BakeCommand command;
  CommandLine line(command);
  std::vector<const char*> argv{"galactic-bake"};
  argv.reserve(arguments.size() + 1);
  for (const std::string& argument : arguments) argv.push_back(argument.c_str());
  try {
    line.parse(static_cast<int>(argv.size()), argv.data());
  } catch (const CLI::ParseError& error) {
    return fail(ErrorCode::kInvalidInput, "", line.explain(error));
  }
  if (auto understood = line.understand(); !understood) return tl::unexpected(understood.error());
  return command;
}

bool BakeCommand::hasPlan() const {
  return kind == AssetKind::kDataset || (kind == AssetKind::kWorld && inputs.size() == 1 &&
                                         inputs.front().string().ends_with(kRecipeSuffix));
}

std::vector<std::filesystem::path> BakeCommand::namedFiles() const {
  std::vector<std::filesystem::path> files = inputs;
  for (const std::filesystem::path& file : {config, robot.recipe, robot.spheres, episodes.only,
                                            episodes.object_pack, collection, golden_report}) {
    if (!file.empty()) files.push_back(file);
  }
  return files;
}

}  // namespace galactic::bake
