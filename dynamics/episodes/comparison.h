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

/// What a link was in.
enum class Thing : std::uint8_t { kScene, kObject };
inline constexpr std::array<std::string_view, 2> kThingNames{"scene", "object"};

/// Why the simulation did not see a contact.
enum class MissCause : std::uint8_t {
  /// The link sticks out of its spheres there.
  kSphereGap,
  /// A sphere is there, and the nearest column says that it is free.
  kColumnCell,
  /// The spheres there do not count yet: the hand has let go of the object.
  kLeaving,
  /// Neither the pose before nor the one after the step is in it, but the one between them.
  kTunneled,
};
inline constexpr std::array<std::string_view, 4> kMissCauseNames{
    "sphere gap", "column cell", "object being left", "between steps"};

/// What the simulation had in the way where nothing is.
enum class InventedCause : std::uint8_t {
  /// The columns under the base have no floor that carries it.
  kFloor,
  /// A sphere that sticks out of its link, or the column next to it.
  kScene,
  /// A sphere that sticks out of its link, or a box that is larger than its object.
  kObject,
};
inline constexpr std::array<std::string_view, 3> kInventedCauseNames{"floor", "scene", "object"};

/// Contacts of the same kind: link of the robot, what it is in, why the simulation does not see it.
using MissKey = std::tuple<std::uint32_t, Thing, MissCause>;

/// What became of an object where the simulation put it, two seconds later.
struct Rest {
  /// Of the object's origin, meters.
  float displacement = 0;
  /// How far its up axis turned away, radians.
  float lean = 0;
  /// How far it went down, meters.
  float drop = 0;
  /// Number of the step in which it was let go.
  std::uint32_t step = 0;
  /// Where it is then.
  Pose world_from_object = {};
};

/// A contact that the simulation does not see.
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
  /// Of the simulation.
  EpisodeEnd end = EpisodeEnd::kNone;
  std::uint32_t steps = 0;
  /// Of the dynamics, by the simulation's rules; kNone where the recorded actions ran out.
  EpisodeEnd end_in_dynamics = EpisodeEnd::kNone;
  /// Those after which the engine knew where everything was: it may lose what is pressed into other
  /// things, even in the first one, and then the episode ends without a success.
  std::uint32_t steps_in_dynamics = 0;
  /// Success in the dynamics that is still one two seconds later.
  bool success_settled = false;
  /// Whether the hand held the target at some time.
  bool picked_in_dynamics = false;
  /// The first step after which the hands do not hold the same.
  std::optional<std::uint32_t> parted;
  /// After each step that both made: how far the roots are apart on the ground, and the grips;
  /// meters.
  std::vector<float> base_gap;
  std::vector<float> grip_gap;
  /// Over all steps of the dynamics and controlled joints: position against its target, radians or
  /// meters.
  double tracking_sum = 0;
  double tracking_worst = 0;
  /// Steps in which a link of the robot, where the simulation has it, is deeper than kTolerance in
  /// the triangles of the scene or in the hull of a resting object.
  std::map<MissKey, std::uint32_t> missed;
  /// Steps with any of them, and the deepest.
  std::uint32_t missed_steps = 0;
  std::optional<DeepContact> deepest;
  /// Steps in which the simulation refused the motion or pushed the robot clear, with empty hand;
  /// and those of them in which the pose that the action asked for touches nothing.
  std::uint32_t hindered = 0;
  std::map<InventedCause, std::uint32_t> invented;
  /// Objects that the hand never held in the dynamics and that are more than kDisturbed from their
  /// place.
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
  kReplay,      ///< Those of a recording, whatever becomes of them.
  kClosedLoop,  ///< Those of a policy that observes the dynamics.
};
inline constexpr std::array<std::string_view, 2> kComparisonModeNames{"replay", "closed loop"};

/// The actions of a step (from 0, in order), valid until the next call; empty after the last step.
/// Fails as its policy does.
using ActionSource = std::function<Result<std::span<const float>>(std::size_t step)>;

/// Those of the trace, which must outlive them.
[[nodiscard]] ActionSource recordedActions(const EpisodeTrace& trace);

/// Those of the policy of the lane, which must outlive them; of 10,000 steps, so that an episode
/// ends that the task does not end.
[[nodiscard]] ActionSource policyActions(EpisodeLane& lane);

/// What comparisons need besides an episode. All of it must outlive them.
struct ComparisonWorlds {
  const World& world;
  const SimulationOptions& simulation;
  const Sources& sources;
  const WorldOptions& options;
};

/// Told after the start of an episode in the dynamics, without actions, and after each of its
/// steps. `follower`: of the lane that follows them.
using StepWatcher =
    std::function<void(const BatchSimulator& follower, std::span<const float> actions)>;

/// Carries out actions in a dynamics world that starts as the episode did in the simulation, until
/// the task or they end it. `lane` follows that world, so that its policy observes it.
/// Deterministic. Fails as `actions` do.
[[nodiscard]] Result<EpisodeComparison> compareEpisode(const EpisodeTrace& trace, EpisodeLane& lane,
                                                       const ComparisonWorlds& worlds,
                                                       const ActionSource& actions,
                                                       const StepWatcher& watch = {});

/// Plays an episode with the lane's policy in the simulation alone. Fails as the policy does.
[[nodiscard]] Result<EpisodeTrace> traceOf(std::uint32_t episode, EpisodeLane& lane);

}  // namespace galactic::dynamics
