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

// What is asked of one pack: its inputs and its options, plain values that say all there is to say
// of it. What a bake works with besides is in BakeContext. Whatever is not an input, a name or an
// internal is in the kind's visitor below, and from there in the command line, in recipes, in the
// provenance and in the key of the cache.

/// What is drawn of a scene, an object or a robot.
struct DrawOptions {
  bool wanted = true;
  RenderBakeOptions meshes{};
  TextureBakeOptions textures{};
  /// Folder for texture packs that assets share; empty: each pack has its own.
  std::filesystem::path shared_textures{};

  friend bool operator==(const DrawOptions&, const DrawOptions&) = default;
};

/// How far a surface of what is handled may move, meters: it is seen from nearer than scenes are.
inline constexpr double kHandledRenderError = 0.002;

/// A scene instance of a dataset.
struct InstancedScene {
  std::string name;
  /// Changes with what the dataset has: the scene may then be of other parts with the same names.
  std::uint64_t dataset_fingerprint = 0;

  friend bool operator==(const InstancedScene&, const InstancedScene&) = default;
};

/// One scene.
struct SceneJob {
  /// The mesh; of an instance the configuration of its dataset.
  std::filesystem::path input{};
  std::optional<InstancedScene> instance{};
  /// Of the scene in its pack; empty: that of the file.
  std::string name{};
  MeshImportOptions import{};
  SceneBakeOptions grids{};
  DrawOptions draw{};

  friend bool operator==(const SceneJob&, const SceneJob&) = default;
};

/// A set of objects.
struct ObjectJob {
  /// Meshes, and folders that are searched for them.
  std::vector<std::filesystem::path> inputs{};
  /// Of the object in its pack, where there is only one; empty: that of its file.
  std::string name{};
  /// Published collection whose boxes and spheres the objects get; empty: none.
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
  /// Folders of ROS packages by name; next come those of ROS_PACKAGE_PATH.
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
  /// Scenes, objects (none: those of object_packs) and one robot, and worlds of them, in which the
  /// starts are drawn that the file does not give; empty: they are not.
  std::vector<std::filesystem::path> packs{};
  /// List of the episodes to keep; empty: all.
  std::filesystem::path only{};
  /// Packs of the objects, and worlds of them, for where their centers are; empty: none.
  std::vector<std::filesystem::path> object_packs{};
  EpisodeImportOptions import{};
  /// Of the starts that are drawn; not given: 1.
  std::optional<std::uint64_t> seed{};

  friend bool operator==(const EpisodeImportJob&, const EpisodeImportJob&) = default;
};

/// Episodes that are generated.
struct EpisodeGenerationJob {
  /// Scenes, objects and one robot.
  std::vector<std::filesystem::path> packs{};
  EpisodeGeneratorOptions generate{.shorten_way = true};
  /// How many of the episodes the scripted policy plays; 0: none.
  std::uint32_t solve = 16;
  /// The meshes that scenes were baked from, by the scenes' names.
  std::map<std::string, std::filesystem::path> geometry{};
  /// What scenes were baked from that are made in the same build, by the scenes' names.
  std::map<std::string, SceneJob> scenes{};

  friend bool operator==(const EpisodeGenerationJob&, const EpisodeGenerationJob&) = default;
};

/// A list of packs.
struct WorldJob {
  std::vector<std::filesystem::path> packs{};
  /// What the world says of its task: options of OptionScope::kTask.
  std::vector<OptionText> task{};

  friend bool operator==(const WorldJob&, const WorldJob&) = default;
};

using Job =
    std::variant<SceneJob, ObjectJob, RobotJob, EpisodeImportJob, EpisodeGenerationJob, WorldJob>;

/// "scene", "object", "robot", "episodes" or "world": what --as takes.
[[nodiscard]] std::string_view kindOf(const Job& job);

/// Names each option of a kind of job once, for all who need the list: command line, recipes,
/// provenance, cache and reports. A field that is added to one of the structs does not compile
/// until the visitor names it.
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

/// The options of a job that have a value, as they would be typed, files without their folders: for
/// the provenance of its pack. The kind comes first, of all but scenes.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> contentOptions(const Job& job);

/// Provenance of the job's pack.
[[nodiscard]] Provenance provenanceOf(const Job& job, std::vector<SourceFile> sources,
                                      std::vector<std::string> warnings);

/// Everything but the content of files that decides the bytes of the job's pack and what is
/// reported of it. Files are named relative to `folder`, so that a dataset that moves keeps its
/// key. Not the program that bakes.
[[nodiscard]] std::string keyOf(const Job& job, const std::filesystem::path& folder);

}  // namespace galactic::bake
