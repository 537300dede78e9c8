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

/// Why something that was drawn for an episode was rejected. In the order of the tests.
enum class EpisodeRejection : std::uint8_t {
  kDistance,           ///< The goal is nearer to the target, or farther from it, than asked for.
  kOtherPart,          ///< The goal or the start is where the robot cannot drive from the target.
  kSameSupport,        ///< The goal is on the target's surface, but another one was asked for.
  kNoRoom,             ///< The columns are not flat and free under and over the object.
  kUneven,             ///< Rays at the triangles found a gap, a slope or an edge under the object.
  kOutsideReceptacle,  ///< The object's middle is in no receptacle.
  kOverlap,            ///< Too near to another object, or in the way of the robot's reach.
  kMoved,              ///< Settling moved the object, or it did not come to rest.
  kTipped,             ///< Settling tipped the object.
  kPlacement,          ///< A run would find no place for the object if it were released there.
  kNotReached,         ///< No position of base and arm reaches the object.
  kStartDistance,      ///< The start is nearer to the target, or farther from it, than asked for.
  kStartBlocked,       ///< The robot would touch something at the start.
  kReplayBlocked,      ///< The runtime does not start the episode: the robot penetrates something.
  kReplayMoved,        ///< In the first step of a run, something moved that should not move.
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

/// What is known about a scene besides its pack.
struct SceneDetails {
  /// The triangles that the scene was baked from, world frame; empty: unknown.
  TriangleMesh mesh;
  std::vector<SupportRegion> receptacles;
};

/// Returns the details of a scene, given its name. Called once for each scene, when its turn comes,
/// from several threads.
using SceneDetailSource = std::function<Result<SceneDetails>(std::string_view scene)>;

/// A function that is called with the number of finished episodes, from several threads, one at a
/// time.
using EpisodeProgress = std::function<void(std::size_t done)>;

/// On which surfaces objects and goals are put.
enum class SupportChoice : std::uint8_t {
  kFound,        ///< All that the column grids show.
  kReceptacles,  ///< Only those in the scene's receptacles.
  kBoth,         ///< All, but half of the draws go to receptacles where the scene has some.
};

/// In which of their stable poses objects stand.
enum class PoseChoice : std::uint8_t {
  kDropped,  ///< Each pose as often as drops end in it: most bottles lie on their sides.
  kUpright,  ///< The poses of an object in which its up axis leans least.
};

/// A part of the scenes.
enum class SplitSide : std::uint8_t { kAll, kTrain, kValidation };

/// Which scenes are used. Whether a scene is held out for validation depends only on its name and
/// these numbers, not on the other scenes.
struct SceneSplit {
  SplitSide side = SplitSide::kAll;
  /// Expected fraction of scenes that are held out, 0 to 1.
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
  /// kMostFlatness. Scans are bumpy: they need a larger value, and geometry to settle objects on.
  float flatness = 0.002F;
  /// Distance between the target's origin at its start and at its goal.
  DistanceRange target_to_goal{.least = 1.0F};
  /// Whether a scene that is too small for the least of these distances gets half of its largest
  /// distance instead, with a warning, rather than being left out.
  bool shorten_way = false;
  /// Horizontal distance between the robot's base and the target's origin.
  DistanceRange start_to_target{};
  /// Whether the goal must lie on another surface than the target: one to which no flat path leads.
  bool goal_on_other_support = false;
  /// Largest fraction of episodes that may be skipped because no place is found for them, 0 to 1.
  /// More are an error.
  float most_skipped = 0.1F;
  SupportChoice supports = SupportChoice::kBoth;
  PoseChoice poses = PoseChoice::kDropped;
  SceneSplit split{};

  friend bool operator==(const EpisodeGeneratorOptions&, const EpisodeGeneratorOptions&) = default;
};

/// What episodes are generated from.
struct EpisodeInputs {
  /// Scenes, one or more sets of objects, one robot, in any order, baked for the same radii.
  std::vector<const PackFile*> packs{};
  /// Empty: only the packs are known.
  SceneDetailSource details{};
  /// The result does not depend on the number of threads. Each thread prepares one scene at a time,
  /// as far as `memory` allows.
  unsigned threads = 1;
  /// Stores finished work, and may hold work that was done before with the same packs, options,
  /// seed and program, which is then not repeated. Null: nothing is stored.
  Journal* journal = nullptr;
  /// Called now and then, from several threads: whether to end early; empty: never.
  std::function<bool()> stops{};
  /// The memory that scenes may use that are prepared at the same time, with their details, as far
  /// as this can be foreseen from the sizes of the files that their packs were made from. Null: no
  /// limit. One scene at a time is always prepared.
  MemoryBudget* memory = nullptr;
};

/// How far scanned surfaces typically deviate from a plane, meters.
inline constexpr float kScanFlatness = 0.01F;

/// What was found in a scene.
struct GeneratedScene {
  std::string name;
  std::uint32_t episodes = 0;
  /// Episodes for which no place was found in it.
  std::uint32_t skipped = 0;
  /// Columns with a floor on which the robot can stand and drive.
  std::size_t floor_places = 0;
  /// Parts of the floor, such as storeys: in each episode, the robot drives in one of them.
  std::size_t floor_parts = 0;
  /// Columns over a flat surface within reach, and how many surfaces they make.
  std::size_t support_places = 0;
  std::size_t surfaces = 0;
  /// How many such columns there would be with kScanFlatness. 0 if this was not examined, because
  /// the scene has many columns or because the options already allow surfaces as bumpy as this.
  std::size_t bumpy_places = 0;
  std::size_t receptacles = 0;
  /// Whether the scene's triangles were available to settle objects on.
  bool has_mesh = false;
  /// The least distance between target and goal, if it is not the one in the options.
  std::optional<float> shortened_way;
};

/// A scene in which no episodes are possible.
struct UnusableScene {
  std::string name;
  /// One sentence.
  std::string reason;
};

struct GeneratedEpisodes {
  SourceEpisodes episodes;
  RejectionCounts rejections;
  /// By name; only scenes of the split.
  std::vector<GeneratedScene> scenes;
  /// By name; scenes of the split in which the robot can stand nowhere or nothing is within its
  /// reach. There is a warning in `episodes` for each. If there are fewer episodes than scenes, not
  /// all scenes are examined.
  std::vector<UnusableScene> left_out;
  /// Episodes for which no place was found. They have no index: the next episode takes it.
  std::uint32_t skipped = 0;
  /// Episodes with fewer objects than the options ask for, because no place was found for more.
  std::uint32_t with_fewer_objects = 0;
};

/// Generates rearrangement episodes: objects in stable poses on surfaces that the column grids show
/// to be flat and free; the robot on the floor, where its start pose penetrates nothing; target and
/// goal within reach of a place that the robot's base can drive to. If the scene's triangles are
/// known, rays check that the surface has no gap, and every object is settled with Bullet and used
/// only if it stays in place. Each episode is replayed for one step in the runtime. Deterministic:
/// episode k depends on the inputs, the seed and k, but not on the order of the packs nor on the
/// threads. Episode k is in scene k % scenes, in order of name; scenes without a floor or without
/// anything within reach are left out and not counted. If no place is found for an episode, more
/// places are drawn near those that have held objects, then with fewer objects, and at last the
/// episode is skipped. What becomes of an episode does not depend on other episodes. Fails with
/// kInvalidInput, describing what was tried, if options are unusable, if packs do not go together,
/// if all scenes are left out, or if all episodes or more than the fraction in the options are
/// skipped. Also fails with the errors of `inputs.details` and of the journal, and with
/// kInterrupted once `inputs.stops` returns true.
[[nodiscard]] Result<GeneratedEpisodes> generateEpisodes(const EpisodeInputs& inputs,
                                                         const EpisodeGeneratorOptions& options,
                                                         const EpisodeProgress& progress = {});

/// Draws the starts that published episodes lack (SourceEpisodes::without_start), in the same way
/// as for generated episodes: on the largest part of the floor, where the robot's start pose
/// penetrates nothing, replayed for one step in the runtime. The starts are for the robot of
/// `inputs`, of which only the packs, the threads and `stops` are used. None of the set's episodes
/// may give joint positions. Deterministic: a start depends on the packs, the seed, its episode and
/// the episode's index in the set. An episode for which no start is found is left out, with a
/// warning. Fails with kInvalidInput if packs do not go together, if none of them holds a scene or
/// an object of the set, or if all episodes would be left out. Also fails with the errors of
/// replaying, and with kInterrupted once `inputs.stops` returns true; the set is then unusable.
[[nodiscard]] Result<void> drawStarts(const EpisodeInputs& inputs, std::uint64_t seed,
                                      SourceEpisodes& episodes);

/// How many episodes of a sample were solved.
struct SolvedSample {
  std::uint32_t episodes = 0;
  std::uint32_t solved = 0;
  /// How the others ended, and how many each way: ScriptedTrouble's names, "out of time", "does not
  /// start".
  std::map<std::string, std::uint32_t> unsolved;
};

struct EpisodeSolvingOptions {
  /// Largest number of episodes, which are chosen evenly.
  std::uint32_t most_episodes = 16;
  /// After this many steps an episode counts as unsolved.
  std::uint32_t most_steps = 1000;
};

/// Lets the ScriptedPolicy play Rearrange in a sample of the episodes. Episodes that it does not
/// solve may still be solvable, but if it solves few, something is wrong. `packs`: scenes, objects
/// and the robot of the episodes. Fails with the errors of World::from() and
/// BatchSimulator::create(). The result does not depend on `threads`.
[[nodiscard]] Result<SolvedSample> solveSample(std::span<const PackFile* const> packs,
                                               const SourceEpisodes& episodes,
                                               const EpisodeSolvingOptions& options,
                                               unsigned threads = 1);

}  // namespace galactic::bake
