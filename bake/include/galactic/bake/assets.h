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
// step. What galactic-bake does, a program does with these.

/// A file that a bake read.
struct ReadFile {
  std::filesystem::path path;
  /// What it held, where the reader said so.
  std::optional<SourceFile> content;
};

/// What bakes read and looked for.
class ReadLog {
 public:
  void noteRead(const std::filesystem::path& file) { read_.push_back({file, std::nullopt}); }
  /// By their names below `folder`.
  void note(const std::filesystem::path& folder, const ReadFiles& read);
  /// Remembers a file that was looked for and is not there.
  void noteAbsent(const std::filesystem::path& file) { absent_.push_back(file); }

  [[nodiscard]] const std::vector<ReadFile>& files() const { return read_; }
  [[nodiscard]] const std::vector<std::filesystem::path>& absent() const { return absent_; }
  /// Whether the same files make the same asset again.
  [[nodiscard]] bool isSettled() const { return is_settled_; }

  /// Refuses to write `output` over a file that was read.
  [[nodiscard]] Result<void> checkNotRead(const std::filesystem::path& output) const;

 private:
  std::vector<ReadFile> read_;
  std::vector<std::filesystem::path> absent_;
  bool is_settled_ = true;
};

/// Told what is worked on, what is being done with it, and how far it is (0 to 1).
using BakeProgress =
    std::function<void(std::string_view item, std::string_view stage, double fraction)>;

/// What a bake is given besides its job: where the pack goes, and what the bakes of a run share.
struct BakeContext {
  /// The pack; with `dry_run` nothing is written.
  std::filesystem::path output{};
  ReadLog& log;
  BakeLibraries& libraries;
  /// The pack does not depend on them.
  unsigned threads = 1;
  BakeProgress show = [](std::string_view, std::string_view, double) {};
  /// Asked now and then, from several threads, whether a long bake ends early, with kInterrupted.
  std::function<bool()> stops = [] { return false; };
  bool dry_run = false;
  /// Whether a pack of several objects holds those that succeeded when others fail.
  bool keep_going = false;
  /// What scenes may take that are prepared for episodes at the same time; null: as much as it is.
  MemoryBudget* memory = nullptr;
};

/// What became of one scene.
struct SceneOutcome {
  std::filesystem::path input;
  /// How axes and unit were read.
  std::string convention;
  BakedScene scene;
  StageTimes times;
};

/// One input that could not be baked.
struct BakeFailure {
  std::filesystem::path input;
  Error error;
};

/// What became of a set of objects.
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
  /// Of the collection, and of meshes that are no objects.
  std::vector<std::string> warnings;
  /// Objects that could not be baked. Without BakeContext::keep_going there is then no pack.
  std::vector<BakeFailure> failures;
  double seconds = 0;
};

/// What became of one robot.
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

/// What became of one set of episodes.
struct EpisodeOutcome {
  /// What it was made from, for people.
  std::string input;
  SourceEpisodes episodes;
  /// Of generated ones.
  std::optional<EpisodeGeneration> generation{};
  double seconds = 0;
};

/// What became of a world.
struct WorldOutcome {
  std::vector<LinkedPack> packs;
  double seconds = 0;
};

/// A pack that was made, and everything that is known of it.
struct BakedPack {
  std::variant<SceneOutcome, ObjectSetOutcome, RobotOutcome, EpisodeOutcome, WorldOutcome> outcome;
  std::filesystem::path output;
  /// Size of the pack; 0 for a dry run.
  std::uint64_t pack_bytes = 0;
};

/// Bakes one scene, its render meshes and textures into its pack. What an instance of a dataset
/// lacks is left out, with a warning. Fails with the errors of importer, bakers and writer, and
/// with kInvalidInput where the output is a file that was read; `where` names the file.
[[nodiscard]] Result<BakedPack> bakeSceneFile(const SceneJob& job, BakeContext& context);

/// The name of a scene in its pack.
[[nodiscard]] std::string nameOf(const SceneJob& job);

/// Reads the meshes of a scene as bakeSceneFile does.
[[nodiscard]] Result<SourceAsset> readSceneFile(const SceneJob& job, BakeLibraries& libraries);

/// Bakes all objects of a job into one pack. An object that fails is in the outcome's failures; it
/// is the result's error where no object is left, or where there is no pack for another reason.
[[nodiscard]] Result<BakedPack> bakeObjectFiles(const ObjectJob& job, BakeContext& context);

/// Bakes one robot (URDF or MJCF) with its recipe and meshes into its pack.
[[nodiscard]] Result<BakedPack> bakeRobotFile(const RobotJob& job, BakeContext& context);

/// How the robot's file of a job is read.
[[nodiscard]] RobotImportOptions robotOptionsOf(const RobotJob& job);

/// Reads a robot's file as bakeRobotFile does.
[[nodiscard]] Result<SourceRobot> readRobotFile(const RobotJob& job);

/// Imports a published set of episodes into a pack.
[[nodiscard]] Result<BakedPack> bakeEpisodes(const EpisodeImportJob& job, BakeContext& context);

/// Generates episodes in packs and lets the scripted policy play a sample of them. What is drawn
/// stands in OUTPUT.partial until the pack is written: a bake that was interrupted or killed goes
/// on from there.
[[nodiscard]] Result<BakedPack> bakeEpisodes(const EpisodeGenerationJob& job, BakeContext& context);

/// Lists packs in a world pack, after seeing that together they make a world.
[[nodiscard]] Result<BakedPack> linkWorld(const WorldJob& job, BakeContext& context);

/// Whichever the job is. Notes the files that the job names as read.
[[nodiscard]] Result<BakedPack> bake(const Job& job, BakeContext& context);

/// One mesh file that becomes an object.
struct ObjectInput {
  std::filesystem::path path;
  /// Name of the object in the pack.
  std::string name;
};

/// Which objects there are.
struct FoundObjects {
  /// By ascending name.
  std::vector<ObjectInput> objects;
  /// Of meshes that are no objects. Names are relative to the inputs.
  std::vector<std::string> warnings;
};

/// The objects that `inputs` (mesh files, and folders that are searched) name. A file is an object
/// named by its stem. A file whose stem is "textured" or "model" takes the name of its folder, or
/// of the one above where that says how it was made ("google_16k"): so are YCB and Google Scanned
/// Objects laid out. In a folder below an input it stands for all of that folder; in an input
/// itself where no other object lies beside it. Of NAME_visual and NAME_collision side by side,
/// Gazebo's layout, the first is the object NAME. Hidden files and folders are passed over, links
/// to folders followed. Fails with kIo where a folder cannot be read or a link with a mesh's name
/// leads to nothing, and with kInvalidInput where an input holds no mesh or two objects have one
/// name.
[[nodiscard]] Result<FoundObjects> findObjects(const std::vector<std::filesystem::path>& inputs);

}  // namespace galactic::bake
