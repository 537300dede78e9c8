#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "galactic/bake/episode_generator.h"
#include "galactic/bake/episode_set_import.h"
#include "galactic/bake/mesh_import.h"
#include "galactic/bake/object_baker.h"
#include "galactic/bake/option_field.h"
#include "galactic/bake/render_baker.h"
#include "galactic/bake/robot_baker.h"
#include "galactic/bake/scene_baker.h"
#include "galactic/bake/source_asset.h"
#include "galactic/option_text.h"

namespace galactic::bake {

// Jobs describe the packs to be made: each has the inputs and options of one pack, as plain values
// that describe it completely. Everything else that a bake works with is in BakeContext. Every
// field that is not an input, a name or an internal is named in the visitor of its kind below, and
// so appears on the command line, in recipes, in the provenance and in the key of the cache.

/// How a scene, an object or a robot is prepared for drawing.
struct DrawOptions {
  bool wanted = true;
  RenderBakeOptions meshes{};
  TextureBakeOptions textures{};
  /// Folder for texture packs that assets share; empty: each pack has its own textures.
  std::filesystem::path shared_textures{};

  friend bool operator==(const DrawOptions&, const DrawOptions&) = default;
};

/// How far simplification may move surfaces of objects and robots, meters: they are seen from
/// nearer than scenes.
inline constexpr double kHandledRenderError = 0.002;

/// A scene instance of a dataset.
struct InstancedScene {
  std::string name;
  /// Changes when the dataset's files change: the scene may then have other parts with the same
  /// names.
  std::uint64_t dataset_fingerprint = 0;

  friend bool operator==(const InstancedScene&, const InstancedScene&) = default;
};

/// One scene.
struct SceneJob {
  /// The mesh; for an instance, the configuration of its dataset.
  std::filesystem::path input{};
  std::optional<InstancedScene> instance{};
  /// Name of the scene in its pack; empty: that of the file.
  std::string name{};
  MeshImportOptions import{};
  SceneBakeOptions grids{};
  DrawOptions draw{};

  friend bool operator==(const SceneJob&, const SceneJob&) = default;
};

/// A set of objects.
struct ObjectJob {
  /// Meshes, and folders that are searched for meshes.
  std::vector<std::filesystem::path> inputs{};
  /// Name of the object in its pack, if there is only one; empty: that of its file.
  std::string name{};
  /// Published collection from which the objects take their boxes and spheres; empty: none.
  std::filesystem::path collection{};
  /// Movable objects may be small.
  MeshImportOptions import{.smallest_size = 0};
  ObjectBakeOptions shape{};
  DrawOptions draw{.meshes = {.error = kHandledRenderError}};

  friend bool operator==(const ObjectJob&, const ObjectJob&) = default;
};

/// One robot.
struct RobotJob {
  /// A URDF or an MJCF.
  std::filesystem::path input{};
  /// Folders of ROS packages, by name; those in ROS_PACKAGE_PATH are searched next.
  std::map<std::string, std::filesystem::path> packages{};
  /// Robot recipe (TOML) or published collection (JSON); empty: none.
  std::filesystem::path recipe{};
  /// Hand-made spheres (spherized URDF or MJCF, SRDF); empty: none.
  std::filesystem::path spheres{};
  bool allow_missing = false;
  bool allow_outside = false;
  RobotBakeOptions shape{};
  DrawOptions draw{.meshes = {.error = kHandledRenderError}};

  friend bool operator==(const RobotJob&, const RobotJob&) = default;
};

/// A published set of episodes.
struct EpisodeImportJob {
  std::filesystem::path input{};
  /// Packs in which the starts that the file does not give are drawn: scenes, objects (none: those
  /// of object_packs), one robot, or worlds of them. Empty: no starts are drawn.
  std::vector<std::filesystem::path> packs{};
  /// List of the episodes to keep; empty: all.
  std::filesystem::path only{};
  /// Packs of the objects, or worlds with them, from which the objects' centers are taken; empty:
  /// none.
  std::vector<std::filesystem::path> object_packs{};
  EpisodeImportOptions import{};
  /// Seed of the starts that are drawn; not given: 1.
  std::optional<std::uint64_t> seed{};

  friend bool operator==(const EpisodeImportJob&, const EpisodeImportJob&) = default;
};

/// Episodes that are generated.
struct EpisodeGenerationJob {
  /// Scenes, objects and one robot.
  std::vector<std::filesystem::path> packs{};
  EpisodeGeneratorOptions generate{.shorten_way = true};
  /// How many episodes the scripted policy plays; 0: none.
  std::uint32_t solve = 16;
  /// The meshes that scenes were baked from, by the scenes' names.
  std::map<std::string, std::filesystem::path> geometry{};
  /// Jobs of scenes that are baked in the same build, by the scenes' names.
  std::map<std::string, SceneJob> scenes{};

  friend bool operator==(const EpisodeGenerationJob&, const EpisodeGenerationJob&) = default;
};

/// A list of packs.
struct WorldJob {
  std::vector<std::filesystem::path> packs{};
  /// The world's task: options of OptionScope::kTask.
  std::vector<OptionText> task{};

  friend bool operator==(const WorldJob&, const WorldJob&) = default;
};

using Job =
    std::variant<SceneJob, ObjectJob, RobotJob, EpisodeImportJob, EpisodeGenerationJob, WorldJob>;

/// The value of --as: "scene", "object", "robot", "episodes" or "world".
[[nodiscard]] std::string_view kindOf(const Job& job);

/// Names each option of a kind of job once, for everything that needs the list: command line,
/// recipes, provenance, cache and reports. If you add a field to one of the structs, it does not
/// compile until the visitor names it.
void visitOptions(SceneJob& job, OptionVisitor& visitor);
void visitOptions(ObjectJob& job, OptionVisitor& visitor);
void visitOptions(RobotJob& job, OptionVisitor& visitor);
void visitOptions(EpisodeImportJob& job, OptionVisitor& visitor);
void visitOptions(EpisodeGenerationJob& job, OptionVisitor& visitor);
void visitOptions(WorldJob& job, OptionVisitor& visitor);
void visitOptions(Job& job, OptionVisitor& visitor);

/// The names of all options of all jobs, each once.
[[nodiscard]] std::vector<std::string> optionNames();

/// The files and folders that the job names, inputs first.
[[nodiscard]] std::vector<std::filesystem::path> filesOf(const Job& job);

/// The options of a job that have a value, as they would be typed, with files without their
/// folders: for the provenance of its pack. The kind comes first, except for scenes.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> contentOptions(const Job& job);

/// Provenance of the job's pack.
[[nodiscard]] Provenance provenanceOf(const Job& job, std::vector<SourceFile> sources,
                                      std::vector<std::string> warnings);

/// Everything, except the content of files and the baking program, that decides the bytes of the
/// job's pack and what is reported about it. Files are named relative to `folder`, so that a
/// dataset keeps its key when it is moved.
[[nodiscard]] std::string keyOf(const Job& job, const std::filesystem::path& folder);

}  // namespace galactic::bake
