#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "galactic/bake/episode_generator.h"
#include "galactic/bake/jobs.h"
#include "galactic/bake/libraries.h"
#include "galactic/bake/robot_import.h"
#include "galactic/bake/source_asset.h"
#include "galactic/bake/world_pack.h"
#include "galactic/error.h"

namespace galactic::bake {

// Whole packs from files: import, bake, render meshes, textures and provenance, written in one
// step. With these functions, a program can do what galactic-bake does.

/// A file that a bake read.
struct ReadFile {
  std::filesystem::path path;
  /// What it held, if the reader recorded that.
  std::optional<SourceFile> content;
};

/// The files that bakes read, and those that they looked for.
class ReadLog {
 public:
  void noteRead(const std::filesystem::path& file) { read_.push_back({file, std::nullopt}); }
  /// Notes files by their names below `folder`.
  void note(const std::filesystem::path& folder, const ReadFiles& read);
  /// Remembers a file that was looked for and is not there.
  void noteAbsent(const std::filesystem::path& file) { absent_.push_back(file); }

  [[nodiscard]] const std::vector<ReadFile>& files() const { return read_; }
  [[nodiscard]] const std::vector<std::filesystem::path>& absent() const { return absent_; }
  /// Whether the same files always give the same asset.
  [[nodiscard]] bool isSettled() const { return is_settled_; }

  /// Refuses to write `output` over a file that was read.
  [[nodiscard]] Result<void> checkNotRead(const std::filesystem::path& output) const;

 private:
  std::vector<ReadFile> read_;
  std::vector<std::filesystem::path> absent_;
  bool is_settled_ = true;
};

/// A function that is called with the item that is being worked on, the current stage, and how far
/// it is (0 to 1).
using BakeProgress =
    std::function<void(std::string_view item, std::string_view stage, double fraction)>;

/// What a bake needs besides its job: where the pack is written, and what the bakes of a run share.
struct BakeContext {
  /// The path of the pack; with `dry_run` nothing is written.
  std::filesystem::path output{};
  ReadLog& log;
  BakeLibraries& libraries;
  /// The pack does not depend on the number of threads.
  unsigned threads = 1;
  BakeProgress show = [](std::string_view, std::string_view, double) {};
  /// Called now and then, from several threads: whether a long bake should end early, with
  /// kInterrupted.
  std::function<bool()> stops = [] { return false; };
  bool dry_run = false;
  /// Whether a pack of several objects is written with those that succeeded if others fail.
  bool keep_going = false;
  /// The memory that scenes may use that are prepared for episodes at the same time; null: no
  /// limit.
  MemoryBudget* memory = nullptr;
};

/// The result of baking one scene.
struct SceneOutcome {
  std::filesystem::path input;
  /// How axes and unit were interpreted.
  std::string convention;
  BakedScene scene;
  StageTimes times;
};

/// One input that could not be baked.
struct BakeFailure {
  std::filesystem::path input;
  Error error;
};

/// The result of baking a set of objects.
struct ObjectSetOutcome {
  /// Where an object came from.
  struct Origin {
    std::filesystem::path input;
    double import_seconds = 0;
  };
  std::vector<float> radii;
  std::vector<BakedObject> objects;
  /// One for each object.
  std::vector<Origin> origins;
  /// Warnings about the collection, and about meshes that are not objects.
  std::vector<std::string> warnings;
  /// Objects that could not be baked. If there are any, no pack is written unless
  /// BakeContext::keep_going is set.
  std::vector<BakeFailure> failures;
  double seconds = 0;
};

/// The result of baking one robot.
struct RobotOutcome {
  std::filesystem::path input;
  BakedRobot robot;
  /// Where each mesh was found.
  std::vector<std::string> resolutions;
  double import_seconds = 0;
  double write_seconds = 0;
  double seconds = 0;
};

/// How episodes were generated.
struct EpisodeGeneration {
  RejectionCounts rejections;
  std::vector<GeneratedScene> scenes;
  std::vector<UnusableScene> left_out;
  SolvedSample sample;
  std::uint32_t skipped = 0;
  std::uint32_t with_fewer_objects = 0;
};

/// The result of making one set of episodes.
struct EpisodeOutcome {
  /// What it was made from, as text for people.
  std::string input;
  SourceEpisodes episodes;
  /// Only for generated episodes.
  std::optional<EpisodeGeneration> generation{};
  double seconds = 0;
};

/// The result of linking a world.
struct WorldOutcome {
  std::vector<LinkedPack> packs;
  double seconds = 0;
};

/// A pack that was made, and everything that is known about it.
struct BakedPack {
  std::variant<SceneOutcome, ObjectSetOutcome, RobotOutcome, EpisodeOutcome, WorldOutcome> outcome;
  std::filesystem::path output;
  /// Size of the pack; 0 for a dry run.
  std::uint64_t pack_bytes = 0;
};

/// Bakes one scene, with its render meshes and textures, into its pack. Parts that are missing for
/// an instance of a dataset are left out, with a warning. Fails with the errors of importer, bakers
/// and writer, and with kInvalidInput if the output is a file that was read; `where` names the
/// file.
[[nodiscard]] Result<BakedPack> bakeSceneFile(const SceneJob& job, BakeContext& context);

/// The name of a scene in its pack.
[[nodiscard]] std::string nameOf(const SceneJob& job);

/// Reads the meshes of a scene as bakeSceneFile does.
[[nodiscard]] Result<SourceAsset> readSceneFile(const SceneJob& job, BakeLibraries& libraries);

/// Bakes all objects of a job into one pack. Objects that fail are in the outcome's failures. If no
/// object is left, or if no pack is written for another reason, the failure is the result's error.
[[nodiscard]] Result<BakedPack> bakeObjectFiles(const ObjectJob& job, BakeContext& context);

/// Bakes one robot (URDF or MJCF), with its recipe and meshes, into its pack.
[[nodiscard]] Result<BakedPack> bakeRobotFile(const RobotJob& job, BakeContext& context);

/// The options with which a job's robot file is read.
[[nodiscard]] RobotImportOptions robotOptionsOf(const RobotJob& job);

/// Reads a robot's file as bakeRobotFile does.
[[nodiscard]] Result<SourceRobot> readRobotFile(const RobotJob& job);

/// Imports a published set of episodes into a pack.
[[nodiscard]] Result<BakedPack> bakeEpisodes(const EpisodeImportJob& job, BakeContext& context);

/// Generates episodes in packs and lets the scripted policy play a sample of them. Until the pack
/// is written, finished episodes are kept in OUTPUT.partial, from which a bake that was interrupted
/// or killed continues.
[[nodiscard]] Result<BakedPack> bakeEpisodes(const EpisodeGenerationJob& job, BakeContext& context);

/// Lists packs in a world pack, after checking that together they make a world.
[[nodiscard]] Result<BakedPack> linkWorld(const WorldJob& job, BakeContext& context);

/// Runs a job of any kind. Records the files that the job names as read.
[[nodiscard]] Result<BakedPack> bake(const Job& job, BakeContext& context);

/// One mesh file that becomes an object.
struct ObjectInput {
  std::filesystem::path path;
  /// Name of the object in the pack.
  std::string name;
};

/// The objects that were found.
struct FoundObjects {
  /// By ascending name.
  std::vector<ObjectInput> objects;
  /// Warnings about meshes that are not objects. Names are relative to the inputs.
  std::vector<std::string> warnings;
};

/// The objects that `inputs` name: mesh files, and folders that are searched. Each file is an
/// object, named by its stem. A file whose stem is "textured" or "model" takes the name of its
/// folder, or of the folder above if its own folder's name says how the file was made
/// ("google_16k"): this is the layout of YCB and Google Scanned Objects. In a folder below an
/// input, such a file stands for the whole folder; in an input itself, it does so only if no other
/// object lies beside it. If NAME_visual and NAME_collision lie side by side (Gazebo's layout), the
/// first is the object NAME. Hidden files and folders are skipped, and links to folders are
/// followed. Fails with kIo if a folder cannot be read or a link with a mesh's name leads to
/// nothing, and with kInvalidInput if an input holds no mesh or two objects have the same name.
[[nodiscard]] Result<FoundObjects> findObjects(const std::vector<std::filesystem::path>& inputs);

}  // namespace galactic::bake
