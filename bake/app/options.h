#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "galactic/bake/episode_sampler.h"
#include "galactic/bake/episode_set_import.h"
#include "galactic/bake/mesh_import.h"
#include "galactic/bake/object_baker.h"
#include "galactic/bake/render_baker.h"
#include "galactic/bake/scene_baker.h"
#include "galactic/error.h"

namespace galactic::bake {

/// How much to print.
enum class Verbosity { kQuiet, kNormal, kVerbose };

/// What the inputs are.
enum class AssetKind { kScene, kObject, kRobot, kEpisodes, kWorld };

/// How a robot is read and which recipe goes with it.
struct RobotOptions {
  /// --package NAME=DIR.
  std::map<std::string, std::filesystem::path> packages;
  /// Robot recipe (TOML) or published collection (JSON); empty: none.
  std::filesystem::path recipe;
  /// Hand-made spheres (spherized URDF, SRDF); empty: none.
  std::filesystem::path spheres;
  bool allow_missing = false;
};

/// Where episodes come from.
struct EpisodeOptions {
  /// Whether the inputs are packs, in which episodes are sampled; else they are episode sets, which
  /// are imported.
  bool sampled = false;
  EpisodeImportOptions import;
  /// List of the episodes to keep; empty: all.
  std::filesystem::path only;
  /// Pack of the objects, for where their centres are; empty: none.
  std::filesystem::path object_pack;
  EpisodeSamplerOptions sample;
};

/// What is drawn.
struct RenderOptions {
  bool wanted = true;
  RenderBakeOptions meshes;
  TextureBakeOptions textures;
  bool ambient_occlusion = false;
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

  /// Whether all inputs go into one pack.
  [[nodiscard]] bool makesOnePack() const {
    return kind == AssetKind::kObject || kind == AssetKind::kWorld ||
           (kind == AssetKind::kEpisodes && episodes.sampled);
  }

  /// Adds an option to content_options unless its text is empty.
  void remember(const char* name, const std::string& value) {
    if (!value.empty()) content_options.emplace_back(name, value);
  }
};

/// The command, or the exit code of a command line that needs no work: help, version, or a mistake,
/// which has been explained on stderr.
using ParsedCommand = std::variant<BakeCommand, int>;

[[nodiscard]] ParsedCommand parseCommandLine(int argc, const char* const* argv);

}  // namespace galactic::bake
