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

// A build makes single packs, or all of a world: of datasets or of a recipe. Of a world, packs that
// were made before come from a cache; the bytes of all of them depend on neither threads nor shards
// nor the cache.

/// One pack that is to be made.
struct PackJob {
  /// For people, and by which lists are sorted: "scenes/kitchen.pack".
  std::string name;
  Job job;
  std::filesystem::path output;
  /// Of a world's pack: names of files that it depends on begin here.
  std::filesystem::path folder{};
  /// Of a world's pack: size of its main input and of the files that this one names, as far as that
  /// is told quickly: the large ones are baked first.
  std::uint64_t source_bytes = 0;
};

/// A scene that is not baked and why, or a pack and what is missing for it.
struct LeftOut {
  std::string name;
  std::vector<std::string> reasons;
};

/// A scene of a dataset whose files cannot be understood.
struct BrokenScene {
  /// That of its pack.
  std::string name;
  BakeFailure failure;
};

/// Everything that is made for one world.
struct WorldPlan {
  /// Lists all others: a WorldJob, whose packs follow from what is made.
  PackJob world{.name = {}, .job = WorldJob{}, .output = {}};
  /// Where the others go.
  std::filesystem::path folder;
  /// None of them needs another.
  std::vector<PackJob> assets;
  /// Those of which no job can be made.
  std::vector<BrokenScene> broken;
  /// Made in the assets' packs, or imported.
  std::optional<PackJob> episodes;
  std::vector<LeftOut> left_out;
  /// How many of the assets are objects that scenes of datasets move: they are in no scene.
  std::size_t movable_objects = 0;
  /// One sentence each.
  std::vector<std::string> warnings;
};

/// One part of work that is split: the packs whose number, modulo `count`, is `index`.
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
  /// Of all bakes together.
  unsigned threads = 1;
  /// Whether to begin the next pack after an error, and to link the world without those that fail.
  bool keep_going = false;
  /// Folder of bakes that were done before; none: nothing is remembered.
  std::optional<std::filesystem::path> cache{};
  /// Without the episodes and the world where there are several shards.
  Shard shard{};
  /// Bytes that bakes, and scenes in which episodes are drawn, may take at the same time, as far as
  /// that can be foreseen.
  std::uint64_t memory = std::numeric_limits<std::uint64_t>::max();
};

enum class PackState {
  kPlanned,    ///< Nothing became of it: a plan, or the build was stopped.
  kBaked,      ///< Made now.
  kUnchanged,  ///< Made before.
  kElsewhere,  ///< It belongs to another shard.
  kFailed,
};

struct PackOutcome {
  std::string name;
  PackState state = PackState::kPlanned;
  /// Of a pack that was made, now or before: the cache keeps them.
  std::optional<PackFigures> figures{};
  /// Where a build keeps going, a set of objects may be made and have failures.
  std::vector<BakeFailure> failures{};
  /// Of this run; those of the pack are in its figures.
  std::vector<std::string> warnings{};
  /// What was read now.
  ReadLog log{};
  double seconds = 0;

  [[nodiscard]] bool isThere() const {
    return state == PackState::kBaked || state == PackState::kUnchanged;
  }
};

struct BuildOutcome {
  /// In their order; of a world the assets, then what is broken, then the episodes, unless they are
  /// left to another run.
  std::vector<PackOutcome> packs;
  /// Where a world was linked, or could not be.
  std::optional<PackOutcome> world;
  /// What the world lists.
  std::vector<LinkedPack> linked;
  bool stopped = false;
  double seconds = 0;

  [[nodiscard]] std::size_t count(PackState state) const;
  /// The first error in the order of the packs; null where there is none.
  [[nodiscard]] const Error* firstError() const;
};

/// Follows a build. Its functions are called from several threads, at the same time.
class BuildObserver {
 public:
  BuildObserver() = default;
  virtual ~BuildObserver() = default;
  BuildObserver(const BuildObserver&) = delete;
  BuildObserver& operator=(const BuildObserver&) = delete;

  /// A pack is being made; `pack`: its name (PackJob::name).
  virtual void begin(std::string_view /*pack*/) {}
  /// How far a pack is: what it is at (`item`: one of its inputs, as a rule), with what, and which
  /// fraction of that stage or item is done, from 0 to 1.
  virtual void show(std::string_view /*item*/, std::string_view /*stage*/, double /*fraction*/) {}
  /// Also of what is broken, which never began.
  virtual void end(const PackOutcome& /*pack*/) {}
  /// Whether to begin nothing more.
  [[nodiscard]] virtual bool stops() { return false; }
};

/// Makes the packs, one after the other. Clears away what killed builds of them have left.
/// `libraries`: those with which the jobs were planned, if any, so that nothing is read twice.
[[nodiscard]] BuildOutcome build(std::span<const PackJob> packs, const BuildOptions& options,
                                 BuildObserver& observer, BakeLibraries& libraries);

/// Makes the packs of a world, several at a time, and then the world, of which the observer is not
/// told. Clears away what killed builds of it have left.
[[nodiscard]] BuildOutcome build(const WorldPlan& plan, const WorldBuildOptions& options,
                                 BuildObserver& observer, BakeLibraries& libraries);

/// What a build of a world begins with: what is planned, what belongs to another shard, and what is
/// broken.
[[nodiscard]] BuildOutcome plannedOutcome(const WorldPlan& plan, const Shard& shard);

/// What the packs of a world name and what is not there: inputs, meshes that a scene of a dataset
/// places, textures, meshes of robots. Reads the meshes, on `threads` threads, and bakes nothing.
/// In the order of the plan; packs that miss nothing are left out.
[[nodiscard]] std::vector<LeftOut> findMissing(const WorldPlan& plan, unsigned threads,
                                               BakeLibraries& libraries);

}  // namespace galactic::bake
