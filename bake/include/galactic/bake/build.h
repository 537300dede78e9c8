#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "galactic/bake/figures.h"
#include "galactic/bake/jobs.h"
#include "galactic/bake/libraries.h"
#include "galactic/error.h"

namespace galactic::bake {

// A build makes single packs, or all packs of a world, from datasets or a recipe. In the build of a
// world, packs that were made before come from a cache. The bytes of the packs depend on neither
// threads nor shards nor the cache.

/// One pack that is to be made.
struct PackJob {
  /// A name for people, by which lists are sorted: "scenes/kitchen.pack".
  std::string name;
  Job job;
  std::filesystem::path output;
  /// For a pack of a world: the folder to which the names of the files that it depends on are
  /// relative.
  std::filesystem::path folder{};
  /// For a pack of a world: the size of its main input and of the files that the input names, as
  /// far as this can be found quickly. Large packs are baked first.
  std::uint64_t source_bytes = 0;
};

/// A scene that is not baked, and why; or a pack, and what is missing for it.
struct LeftOut {
  std::string name;
  std::vector<std::string> reasons;
};

/// A scene of a dataset with files that cannot be understood.
struct BrokenScene {
  /// The name of its pack.
  std::string name;
  BakeFailure failure;
};

/// Everything that has to be made for one world.
struct WorldPlan {
  /// The pack that lists all others: a WorldJob, whose packs follow from what is made.
  PackJob world{.name = {}, .job = WorldJob{}, .output = {}};
  /// Where the other packs are written.
  std::filesystem::path folder;
  /// Packs that do not depend on each other.
  std::vector<PackJob> assets;
  /// Scenes for which no job can be made.
  std::vector<BrokenScene> broken;
  /// Generated in the assets' packs, or imported.
  std::optional<PackJob> episodes;
  std::vector<LeftOut> left_out;
  /// How many of the assets are movable objects of datasets' scenes: they are part of no scene.
  std::size_t movable_objects = 0;
  /// One sentence each.
  std::vector<std::string> warnings;
};

/// One part of a build that is split: the packs whose number modulo `count` is `index`.
struct Shard {
  std::size_t index = 0;
  std::size_t count = 1;
};

struct BuildOptions {
  unsigned threads = 1;
  /// Whether to begin the next pack after an error.
  bool keep_going = false;
  /// Whether everything is baked and nothing written.
  bool dry_run = false;
};

struct WorldBuildOptions {
  /// Threads of all bakes together.
  unsigned threads = 1;
  /// Whether to begin the next pack after an error, and to link the world without those that fail.
  bool keep_going = false;
  /// Folder that caches earlier bakes; none: nothing is cached.
  std::optional<std::filesystem::path> cache{};
  /// With several shards, neither the episodes nor the world are made.
  Shard shard{};
  /// Bytes of memory that bakes, and scenes in which episodes are drawn, may use at the same time,
  /// as far as this can be foreseen.
  std::uint64_t memory = std::numeric_limits<std::uint64_t>::max();
};

enum class PackState {
  kPlanned,    ///< Not made: this is only a plan, or the build was stopped.
  kBaked,      ///< Made now.
  kUnchanged,  ///< Made before.
  kElsewhere,  ///< It belongs to another shard.
  kFailed,
};

struct PackOutcome {
  std::string name;
  PackState state = PackState::kPlanned;
  /// Figures of a pack that was made, now or before: the cache keeps them.
  std::optional<PackFigures> figures{};
  /// In a build that keeps going, a set of objects may be made and still have failures.
  std::vector<BakeFailure> failures{};
  /// Warnings of this run; those of the pack are in its figures.
  std::vector<std::string> warnings{};
  /// What was read now.
  ReadLog log{};
  double seconds = 0;

  [[nodiscard]] bool isThere() const {
    return state == PackState::kBaked || state == PackState::kUnchanged;
  }
};

struct BuildOutcome {
  /// The packs in order. For a world: the assets, then broken scenes, then the episodes, unless
  /// they are left to another run.
  std::vector<PackOutcome> packs;
  /// The world's pack, if it was linked or could not be linked.
  std::optional<PackOutcome> world;
  /// The packs that the world lists.
  std::vector<LinkedPack> linked;
  bool stopped = false;
  double seconds = 0;

  [[nodiscard]] std::size_t count(PackState state) const;
  /// The first error in the order of the packs; null where there is none.
  [[nodiscard]] const Error* firstError() const;
};

/// Follows a build. Its functions are called from several threads at the same time.
class BuildObserver {
 public:
  BuildObserver() = default;
  virtual ~BuildObserver() = default;
  BuildObserver(const BuildObserver&) = delete;
  BuildObserver& operator=(const BuildObserver&) = delete;

  /// Called when work on a pack begins; `pack`: its name (PackJob::name).
  virtual void begin(std::string_view /*pack*/) {}
  /// Called with the progress of a pack: what is being worked on (`item`: usually one of its
  /// inputs), at which stage, and which fraction of that stage or item is done, from 0 to 1.
  virtual void show(std::string_view /*item*/, std::string_view /*stage*/, double /*fraction*/) {}
  /// Called when a pack is finished; also for broken scenes, for which begin() was never called.
  virtual void end(const PackOutcome& /*pack*/) {}
  /// Whether the build should begin nothing more.
  [[nodiscard]] virtual bool stops() { return false; }
};

/// Makes the packs, one after the other. Removes files that killed builds of them have left.
/// `libraries`: those with which the jobs were planned, if any, so that nothing is read twice.
[[nodiscard]] BuildOutcome build(std::span<const PackJob> packs, const BuildOptions& options,
                                 BuildObserver& observer, BakeLibraries& libraries);

/// Makes the packs of a world, several at a time, and then the world itself, which is not reported
/// to the observer. Removes files that killed builds of it have left.
[[nodiscard]] BuildOutcome build(const WorldPlan& plan, const WorldBuildOptions& options,
                                 BuildObserver& observer, BakeLibraries& libraries);

/// The outcome with which a build of a world begins: packs that are planned, packs that belong to
/// another shard, and broken scenes.
[[nodiscard]] BuildOutcome plannedOutcome(const WorldPlan& plan, const Shard& shard);

/// The files that the packs of a world name and that are missing: inputs, meshes that a scene of a
/// dataset places, textures, meshes of robots. Reads the meshes, on `threads` threads, and bakes
/// nothing. In the order of the plan; packs that miss nothing are left out.
[[nodiscard]] std::vector<LeftOut> findMissing(const WorldPlan& plan, unsigned threads,
                                               BakeLibraries& libraries);

}  // namespace galactic::bake
