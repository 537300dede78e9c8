#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string_view>
#include <tuple>
#include <vector>

#include "dynamics/episodes/episode_lane.h"
#include "dynamics/episodes/trace.h"
#include "dynamics/sources/sources.h"
#include "dynamics/world.h"
#include "galactic/error.h"
#include "galactic/simulation_options.h"
#include "galactic/world.h"

namespace galactic::dynamics {

/// What a link penetrated.
enum class Thing : std::uint8_t { kScene, kObject };
inline constexpr std::array<std::string_view, 2> kThingNames{"scene", "object"};

/// Why the simulation did not see a contact.
enum class MissCause : std::uint8_t {
  /// The link protrudes from its spheres there.
  kSphereGap,
  /// A sphere is there, but it is free by the nearest column.
  kColumnCell,
  /// The spheres there are still ignored, as the hand has just released the object.
  kLeaving,
  /// Neither the pose before nor the one after the step is in contact, but the one between them is.
  kTunneled,
};
inline constexpr std::array<std::string_view, 4> kMissCauseNames{
    "sphere gap", "column cell", "object being left", "between steps"};

/// What obstructed the robot in the simulation where nothing really is.
enum class InventedCause : std::uint8_t {
  /// The columns under the base have no floor to carry it.
  kFloor,
  /// A sphere that protrudes from its link, or the column next to it.
  kScene,
  /// A sphere that protrudes from its link, or a box that is larger than its object.
  kObject,
};
inline constexpr std::array<std::string_view, 3> kInventedCauseNames{"floor", "scene", "object"};

/// A kind of contact: link of the robot, what it penetrates, why the simulation misses it.
using MissKey = std::tuple<std::uint32_t, Thing, MissCause>;

/// How an object moved within two seconds from where the simulation put it.
struct Rest {
  /// How far the object's origin moved, meters.
  float displacement = 0;
  /// How far its up axis tilted, radians.
  float lean = 0;
  /// How far it fell, meters.
  float drop = 0;
  /// Number of the step in which it was released.
  std::uint32_t step = 0;
  /// Its pose after two seconds.
  Pose world_from_object = {};
};

/// A contact that the simulation misses.
struct DeepContact {
  std::uint32_t step = 0;
  /// Meters.
  float depth = 0;
  MissKey key;
};

/// One episode in both worlds, the simulation and the dynamics.
struct EpisodeComparison {
  std::uint32_t env = 0;
  std::uint32_t episode = 0;
  /// The end in the simulation.
  EpisodeEnd end = EpisodeEnd::kNone;
  std::uint32_t steps = 0;
  /// The end in the dynamics, by the simulation's rules; kNone if the recorded actions ran out.
  EpisodeEnd end_in_dynamics = EpisodeEnd::kNone;
  /// Steps after which all poses were finite: the engine may lose bodies that are pressed into
  /// others, even in the first step, and then the episode ends without success.
  std::uint32_t steps_in_dynamics = 0;
  /// Whether the episode succeeds in the dynamics, and still does two seconds later.
  bool success_settled = false;
  /// Whether the hand held the target at some time.
  bool picked_in_dynamics = false;
  /// The first step after which the hands hold different things.
  std::optional<std::uint32_t> parted;
  /// For each step that both worlds made: the distance of the roots on the ground, and of the
  /// grips; meters.
  std::vector<float> base_gap;
  std::vector<float> grip_gap;
  /// Sum and maximum of the difference between position and target, over all steps of the dynamics
  /// and all controlled joints, radians or meters.
  double tracking_sum = 0;
  double tracking_worst = 0;
  /// Steps in which a link of the robot, in its pose in the simulation, is deeper than kTolerance
  /// in the triangles of the scene or in the hull of a resting object.
  std::map<MissKey, std::uint32_t> missed;
  /// Steps with any such contact, and the deepest contact.
  std::uint32_t missed_steps = 0;
  std::optional<DeepContact> deepest;
  /// Steps with an empty hand in which the simulation refused the motion or pushed the robot clear;
  /// and those of them in which the requested pose touches nothing.
  std::uint32_t hindered = 0;
  std::map<InventedCause, std::uint32_t> invented;
  /// Objects that the hand never held in the dynamics, but that moved by more than kDisturbed.
  std::uint32_t disturbed = 0;
  std::vector<Rest> rests;

  [[nodiscard]] bool succeedsInSimulation() const { return end == EpisodeEnd::kSuccess; }
  [[nodiscard]] bool succeedsInDynamics() const { return end_in_dynamics == EpisodeEnd::kSuccess; }
  [[nodiscard]] std::uint32_t inventedSteps() const;
};

/// Meters.
inline constexpr float kDisturbed = 0.02F;

/// Whose actions the dynamics carry out.
enum class ComparisonMode : std::uint8_t {
  kReplay,      ///< Those of a recording, regardless of their effect.
  kClosedLoop,  ///< Those of a policy that observes the dynamics.
};
inline constexpr std::array<std::string_view, 2> kComparisonModeNames{"replay", "closed loop"};

/// Returns the actions of a step (from 0, in order), valid until the next call; empty after the
/// last step. Fails as the policy does.
using ActionSource = std::function<Result<std::span<const float>>(std::size_t step)>;

/// The actions of the trace, which must outlive the result.
[[nodiscard]] ActionSource recordedActions(const EpisodeTrace& trace);

/// The actions of the lane's policy; the lane must outlive the result. They stop after 10,000
/// steps, in case the task never ends the episode.
[[nodiscard]] ActionSource policyActions(EpisodeLane& lane);

/// What comparisons need besides an episode. All of it must outlive the comparisons.
struct ComparisonWorlds {
  const World& world;
  const SimulationOptions& simulation;
  const Sources& sources;
  const WorldOptions& options;
};

/// Called after the start of an episode in the dynamics, without actions, and after each of its
/// steps. `follower`: the simulator of the lane that follows the dynamics.
using StepWatcher =
    std::function<void(const BatchSimulator& follower, std::span<const float> actions)>;

/// Carries out actions in a dynamics world that starts like the episode in the simulation, until
/// the task ends it or the actions run out. `lane` follows that world, so that its policy observes
/// it. Deterministic. Fails if `actions` fails.
[[nodiscard]] Result<EpisodeComparison> compareEpisode(const EpisodeTrace& trace, EpisodeLane& lane,
                                                       const ComparisonWorlds& worlds,
                                                       const ActionSource& actions,
                                                       const StepWatcher& watch = {});

/// Plays an episode with the lane's policy in the simulation alone. Fails as the policy does.
[[nodiscard]] Result<EpisodeTrace> traceOf(std::uint32_t episode, EpisodeLane& lane);

}  // namespace galactic::dynamics
