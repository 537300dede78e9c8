#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "galactic/bake/episode_generator.h"
#include "galactic/bake/episode_set_import.h"
#include "galactic/bake/mesh_import.h"
#include "galactic/bake/object_baker.h"
#include "galactic/bake/render_baker.h"
#include "galactic/bake/scene_baker.h"
#include "galactic/error.h"

namespace galactic::bake {

/// How much to print.
enum class Verbosity {
  kSilent,  ///< Nothing: the caller tells errors.
  kQuiet,   ///< Errors.
  kNormal,
  kVerbose
};

/// What the inputs are.
enum class AssetKind { kScene, kObject, kRobot, kEpisodes, kWorld, kDataset };

/// How a robot is read and which recipe goes with it.
struct RobotOptions {
  /// --package NAME=DIR.
  std::map<std::string, std::filesystem::path> packages;
  /// Robot recipe (TOML) or published collection (JSON); empty: none.
  std::filesystem::path recipe;
  /// Hand-made spheres (spherized URDF, SRDF); empty: none.
  std::filesystem::path spheres;
  bool allow_missing = false;
  /// Print a draft of a recipe for the robot, and bake nothing.
  bool print_recipe = false;
};

/// Where episodes come from.
struct EpisodeOptions {
  /// Whether the inputs are packs, in which episodes are generated; else they are episode sets,
  /// which are imported.
  bool generated = false;
  EpisodeImportOptions import;
  /// List of the episodes to keep; empty: all.
  std::filesystem::path only;
  /// Pack of the objects, for where their centres are; empty: none.
  std::filesystem::path object_pack;
  EpisodeGeneratorOptions generate;
  /// How many of the generated episodes the scripted policy plays; 0: none.
  std::uint32_t solve = 16;
  /// The meshes that scenes were baked from, by the scenes' names.
  std::map<std::string, std::filesystem::path> geometry;
  /// What is known of the scenes where a plan made them; empty: nothing but `geometry`.
  SceneDetailSource details;
};

/// What is drawn.
struct RenderOptions {
  bool wanted = true;
  RenderBakeOptions meshes;
  TextureBakeOptions textures;
  /// Folder for texture packs that assets share; empty: each pack has its own.
  std::filesystem::path shared_textures{};
};

/// What to do with a scene of a dataset of which something lacks. A scene without its stage is
/// never baked.
enum class MissingPolicy {
  kFail,     ///< An error.
  kSkip,     ///< The scene is left out, and listed.
  kWithout,  ///< It is baked without what lacks, which is listed.
};

/// Which scenes of a dataset.
struct DatasetOptions {
  /// Patterns (*, ?) of names; none: all.
  std::vector<std::string> scenes;
  MissingPolicy missing = MissingPolicy::kWithout;
  /// Only print the names.
  bool list = false;
};

/// One part of work that is split: the packs whose number, modulo `count`, is `index`.
struct Shard {
  std::size_t index = 0;
  std::size_t count = 1;
};

/// How the many packs of a dataset or world are baked.
struct PlanOptions {
  /// Where a recipe's files are looked for that are not beside it; empty: nowhere else.
  std::filesystem::path data;
  /// Empty: beside the packs.
  std::filesystem::path cache;
  bool no_cache = false;
  Shard shard;
  /// Bytes that bakes at the same time may take together, as far as that can be foreseen.
  std::uint64_t memory = 0;
};

/// What the user typed, understood.
struct BakeCommand {
  AssetKind kind = AssetKind::kScene;
  std::vector<std::filesystem::path> inputs;
  /// A file for one pack, a folder for several; empty: NAME.pack in the current folder.
  std::filesystem::path output;
  std::filesystem::path report;
  /// Golden report to compare with; empty: none. See compareReports.
  std::filesystem::path golden_report;
  /// Share by which the numbers of the reports may differ.
  std::optional<double> tolerance;
  /// The file of options that was read, if any: like the inputs, nothing may replace it.
  std::filesystem::path config;
  MeshImportOptions import;
  SceneBakeOptions scene;
  ObjectBakeOptions object;
  /// Published collection whose boxes and spheres objects get; empty: none.
  std::filesystem::path collection;
  RobotOptions robot;
  RenderOptions render;
  EpisodeOptions episodes;
  /// Whether what assets name is read wherever it points; robot meshes, too.
  bool allow_outside = false;
  DatasetOptions dataset;
  PlanOptions plan;
  /// Name of the asset in its pack; empty: that of its file.
  std::string asset_name;
  /// Most spheres of an object or robot, where the user said so; 0: no limit.
  std::optional<std::uint32_t> max_spheres;
  /// Whether eps and tau of object.spheres come from the user: then they override a recipe's.
  bool tolerances_given = false;
  unsigned jobs = 1;
  bool dry_run = false;
  bool keep_going = false;
  Verbosity verbosity = Verbosity::kNormal;
  /// The options that decide the pack's content, as text, for its provenance.
  std::vector<std::pair<std::string, std::string>> content_options;
  /// Every option that was typed and may decide the content or the report, with its texts as typed:
  /// for the cache's key. Not those that name files: see namedFiles.
  std::vector<std::pair<std::string, std::string>> typed_options;

  /// Bakes on `count` threads, which the result does not depend on.
  void setJobs(unsigned count) {
    jobs = count;
    scene.jobs = count;
    object.spheres.jobs = count;
    episodes.generate.jobs = count;
  }

  /// Whether to print what was done.
  [[nodiscard]] bool saysMore() const { return verbosity >= Verbosity::kNormal; }

  /// Whether all inputs go into one pack.
  [[nodiscard]] bool makesOnePack() const {
    return kind == AssetKind::kObject || kind == AssetKind::kWorld ||
           (kind == AssetKind::kEpisodes && episodes.generated);
  }

  /// Whether it is a recipe or a dataset, of which many packs are made.
  [[nodiscard]] bool hasPlan() const;

  /// The files that it names: they are read whatever else is.
  [[nodiscard]] std::vector<std::filesystem::path> namedFiles() const;

  /// Adds an option to content_options unless its text is empty.
  void remember(const char* name, const std::string& value) {
    if (!value.empty()) content_options.emplace_back(name, value);
  }
};

/// The command, or the exit code of a command line that needs no work: help, version, or a mistake,
/// which has been explained on stderr.
using ParsedCommand = std::variant<BakeCommand, int>;

[[nodiscard]] ParsedCommand parseCommandLine(int argc, const char* const* argv);

/// The command that somebody would have typed with these arguments, the program's name not among
/// them. Fails with kInvalidInput where they are none; `where` is the option, or empty.
[[nodiscard]] Result<BakeCommand> commandFrom(const std::vector<std::string>& arguments);

}  // namespace galactic::bake
