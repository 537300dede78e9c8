#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "galactic/bake/episode_set_import.h"
#include "galactic/bake/triangle_mesh.h"
#include "galactic/error.h"
#include "galactic/pack.h"

namespace galactic {
class Journal;
}  // namespace galactic

namespace galactic::bake {

class MemoryBudget;

/// Why something that was drawn for an episode was not taken. In the order of the tests.
enum class EpisodeRejection : std::uint8_t {
  kDistance,           ///< The goal is nearer to the target or farther from it than asked.
  kOtherPart,          ///< The goal or the start is where the robot cannot drive from the target.
  kSameSupport,        ///< The goal is on the target's surface, another was asked for.
  kNoRoom,             ///< The columns are not flat and free under and over the object.
  kUneven,             ///< Rays at the triangles found a gap, a slope or an edge under the object.
  kOutsideReceptacle,  ///< The object's middle is in no receptacle.
  kOverlap,            ///< Too near to another object or in the way of the robot's reach.
  kMoved,              ///< Settling moved the object, or it did not come to rest.
  kTipped,             ///< Settling tipped the object.
  kPlacement,          ///< A run would find no place for the object there if it were released.
  kNotReached,         ///< No position of base and arm reaches the object.
  kStartDistance,      ///< The start is nearer to the target or farther from it than asked.
  kStartBlocked,       ///< The robot would touch something at the start.
  kReplayBlocked,      ///< The runtime does not start the episode: the robot penetrates something.
  kReplayMoved,        ///< In the first step of a run something moved that should not.
};
inline constexpr std::size_t kRejectionCount = 15;

/// A short name, as in reports: "no_room".
[[nodiscard]] std::string_view rejectionName(EpisodeRejection reason);

/// How often each reason was met.
class RejectionCounts {
 public:
  void add(EpisodeRejection reason) { ++counts_[static_cast<std::size_t>(reason)]; }
  void add(const RejectionCounts& other) {
    for (std::size_t n = 0; n < kRejectionCount; ++n) counts_[n] += other.counts_[n];
  }
  [[nodiscard]] std::uint64_t& operator[](EpisodeRejection reason) {
    return counts_[static_cast<std::size_t>(reason)];
  }
  [[nodiscard]] std::uint64_t operator[](EpisodeRejection reason) const {
    return counts_[static_cast<std::size_t>(reason)];
  }

 private:
  std::array<std::uint64_t, kRejectionCount> counts_{};
};

/// For people: "no_room 812, not_reached 14"; "nothing" where all are 0.
[[nodiscard]] std::string textOf(const RejectionCounts& counts);

/// What is known of a scene besides its pack.
struct SceneDetails {
  /// The triangles that the scene was baked from, world frame; empty: unknown.
  TriangleMesh mesh;
  std::vector<SupportRegion> receptacles;
};

/// Gives the details of a scene by its name. Called once for each scene, when its turn comes, and
/// from several threads.
using SceneDetailSource = std::function<Result<SceneDetails>(std::string_view scene)>;

/// Told how many episodes are done; called from several threads, one at a time.
using EpisodeProgress = std::function<void(std::size_t done)>;

/// On which surfaces objects and goals are put.
enum class SupportChoice : std::uint8_t {
  kFound,        ///< All that the column grids show.
  kReceptacles,  ///< Those in the scene's receptacles only.
  kBoth,         ///< All, but half of the draws go to receptacles where the scene has some.
};

/// In which of their stable poses objects stand.
enum class PoseChoice : std::uint8_t {
  kDropped,  ///< Each as often as drops end in it: bottles mostly lie.
  kUpright,  ///< Those of an object in which its up axis leans least.
};

/// A part of the scenes.
enum class SplitSide : std::uint8_t { kAll, kTrain, kValidation };

/// Which scenes are used. Whether one is held out for validation depends on its name and these
/// numbers only, not on the other scenes.
struct SceneSplit {
  SplitSide side = SplitSide::kAll;
  /// Expected share of the scenes that is held out, 0 to 1.
  float held_out = 0.2F;
  std::uint64_t seed = 1;

  friend bool operator==(const SceneSplit&, const SceneSplit&) = default;
};

/// Whether the scene of this name is for validation.
[[nodiscard]] bool isHeldOut(std::string_view scene, const SceneSplit& split);

/// Both ends included.
struct CountRange {
  std::uint32_t least = 0;
  std::uint32_t most = 0;

  friend bool operator==(const CountRange&, const CountRange&) = default;
};

/// Meters, both ends included.
struct DistanceRange {
  float least = 0;
  float most = std::numeric_limits<float>::infinity();

  friend bool operator==(const DistanceRange&, const DistanceRange&) = default;
};

inline constexpr float kMostFlatness = 0.02F;

struct EpisodeGeneratorOptions {
  std::uint32_t episodes = 100;
  /// Objects per episode, the target among them.
  CountRange objects{10, 10};
  std::uint64_t seed = 1;
  /// Heights above the floor between which objects and goals are placed.
  DistanceRange heights{0.3F, 1.2F};
  /// Heights of the surface under an object may differ by this much either way, meters, up to
  /// kMostFlatness. Scans are bumpy: they need more, and geometry to settle objects on.
  float flatness = 0.002F;
  /// Distance of the target's origin at its start and at its goal.
  DistanceRange target_to_goal{.least = 1.0F};
  /// Whether a scene too small for the least of these distances gets half of what it has, with a
  /// warning, instead of being left out.
  bool shorten_way = false;
  /// Horizontal distance of the robot's base and the target's origin.
  DistanceRange start_to_target{};
  /// Whether the goal lies on another surface than the target: one that no flat way connects.
  bool goal_on_other_support = false;
  /// Share of the episodes that may find no place: they are skipped. More are an error. 0 to 1.
  float most_skipped = 0.1F;
  SupportChoice supports = SupportChoice::kBoth;
  PoseChoice poses = PoseChoice::kDropped;
  SceneSplit split{};

  friend bool operator==(const EpisodeGeneratorOptions&, const EpisodeGeneratorOptions&) = default;
};

/// In what episodes are generated.
struct EpisodeInputs {
  /// Scenes, one or more sets of objects, one robot, in any order, baked for the same radii.
  std::vector<const PackFile*> packs{};
  /// Empty: nothing is known but the packs.
  SceneDetailSource details{};
  /// The result does not depend on them. Each has one scene prepared at a time, as far as `memory`
  /// goes.
  unsigned threads = 1;
  /// Keeps what is done, and may hold what was done before, of the same packs, options, seed and
  /// program: that is not done again. Null: nothing is kept.
  Journal* journal = nullptr;
  /// Asked now and then, from several threads, whether to end early; empty: never.
  std::function<bool()> stops{};
  /// What scenes may take that are prepared at the same time, with their details, as far as that
  /// can be foreseen from the sizes of the files that their packs were made of. Null: as much as
  /// it is. One scene at a time is prepared in any case.
  MemoryBudget* memory = nullptr;
};

/// Scanned surfaces bend by that, meters.
inline constexpr float kScanFlatness = 0.01F;

/// What was found in a scene.
struct GeneratedScene {
  std::string name;
  std::uint32_t episodes = 0;
  /// Episodes that found no place in it.
  std::uint32_t skipped = 0;
  /// Columns with a floor on which the robot stands and drives.
  std::size_t floor_places = 0;
  /// Parts of the floor, such as storeys: it drives in one of them in each episode.
  std::size_t floor_parts = 0;
  /// Columns over a flat surface within reach, and how many surfaces they make.
  std::size_t support_places = 0;
  std::size_t surfaces = 0;
  /// How many columns there would be with kScanFlatness; 0 where that was not asked, as in scenes
  /// with many or with surfaces that may be as bumpy.
  std::size_t bumpy_places = 0;
  std::size_t receptacles = 0;
  /// Whether the scene's triangles were there to settle objects on.
  bool has_mesh = false;
  /// The least distance of target and goal, where it is not the one of the options.
  std::optional<float> shortened_way;
};

/// A scene in which there can be no episodes.
struct UnusableScene {
  std::string name;
  /// One sentence.
  std::string reason;
};

struct GeneratedEpisodes {
  SourceEpisodes episodes;
  RejectionCounts rejections;
  /// By name; those of the split only.
  std::vector<GeneratedScene> scenes;
  /// By name; scenes of the split in which the robot stands nowhere or nothing is within its reach.
  /// There is a warning in `episodes` for each. With fewer episodes than scenes not all of them are
  /// looked at.
  std::vector<UnusableScene> left_out;
  /// Episodes that found no place. They have no number: those after them follow at once.
  std::uint32_t skipped = 0;
  /// Episodes with fewer objects than the options ask for, where no more found a place.
  std::uint32_t with_fewer_objects = 0;
};

/// Generates rearrangement episodes: objects in stable poses on what the column grids show to be
/// flat and free, the robot on the floor where neither it nor its start pose penetrates anything,
/// target and goal within reach of a place that the robot's base can drive to. Where the scene's
/// triangles are known, rays see that the surface has no gap, and every object is settled with
/// Bullet and taken only if it stays. Each episode is replayed for one step in the runtime.
/// Deterministic: episode k depends on the inputs, the seed and k; not on the order of the packs
/// nor on the threads. Scene k % scenes, counted by name, is that of episode k; scenes without a
/// floor or without anything within reach are left out and do not count. An episode for which no
/// place is found is drawn longer, near places that have proven to hold objects, then with fewer
/// objects, and skipped at last; what becomes of it depends on no other episode.
/// Fails with kInvalidInput, saying what was tried, on unusable options, packs that do not go
/// together, when all scenes are left out and when more than the options' share of the episodes is
/// skipped, or all; with the errors of `inputs.details` and of the journal; and with kInterrupted
/// once `inputs.stops` has said so.
[[nodiscard]] Result<GeneratedEpisodes> generateEpisodes(const EpisodeInputs& inputs,
                                                         const EpisodeGeneratorOptions& options,
                                                         const EpisodeProgress& progress = {});

/// Draws the starts that published episodes lack (SourceEpisodes::without_start) as those of
/// generated episodes are drawn: on the largest part of the floor, where neither the robot nor its
/// start pose penetrates anything, replayed for one step in the runtime. They are for the robot of
/// `inputs`, of which the packs, the threads and `stops` are used; none of the set's episodes may
/// give positions of joints. Deterministic: a start depends on the packs, the seed, its episode and
/// the episode's number in the set. Where nothing is found the episode is left out, with a warning.
/// Fails with kInvalidInput on packs that do not go together, on a scene or an object that none of
/// them holds, and where all episodes would be left out; with the errors of replaying; and with
/// kInterrupted once `inputs.stops` has said so: then the set is of no use.
[[nodiscard]] Result<void> drawStarts(const EpisodeInputs& inputs, std::uint64_t seed,
                                      SourceEpisodes& episodes);

/// How a sample of episodes went.
struct SolvedSample {
  std::uint32_t episodes = 0;
  std::uint32_t solved = 0;
  /// How many of the others ended how: ScriptedTrouble's names, "out of time", "does not start".
  std::map<std::string, std::uint32_t> unsolved;
};

struct EpisodeSolvingOptions {
  /// How many episodes at most; they are evenly chosen.
  std::uint32_t most_episodes = 16;
  /// After this many steps an episode counts as unsolved.
  std::uint32_t most_steps = 1000;
};

/// Lets the ScriptedPolicy of the runtime play Rearrange in a sample of the episodes: what it does
/// not solve may be solvable nevertheless, but a low share says that something is wrong. `packs`:
/// scenes, objects and the robot of the episodes. Fails with the errors of World::from and
/// BatchSimulator::create. The result does not depend on `threads`.
[[nodiscard]] Result<SolvedSample> solveSample(std::span<const PackFile* const> packs,
                                               const SourceEpisodes& episodes,
                                               const EpisodeSolvingOptions& options,
                                               unsigned threads = 1);

}  // namespace galactic::bake
