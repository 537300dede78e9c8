#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "galactic/error.h"
#include "galactic/pose.h"
#include "galactic/sensor_noise.h"
#include "galactic/simulation_options.h"
#include "galactic/world.h"

namespace galactic {

/// Which element of an env's row of actions is which. See BatchSimulator.
struct ActionLayout {
  /// Of the controlled joints, which come first, in the order of the robot's recipe.
  std::size_t joints = 0;
  /// Whether the base drives sideways, too, by an action after `turn`.
  bool drives_sideways = false;

  /// That of the robot's recipe; of a robot without one, no joints, and a base that does not drive
  /// sideways.
  [[nodiscard]] static ActionLayout of(const Robot& robot);

  /// Indices into the actions of an env, each of which goes from -1 to 1. 1 drives ahead.
  [[nodiscard]] constexpr std::size_t forward() const { return joints; }
  /// 1 turns clockwise, seen from above.
  [[nodiscard]] constexpr std::size_t turn() const { return joints + 1; }
  /// Only where the base drives sideways: 1 drives to the left.
  [[nodiscard]] constexpr std::size_t sideways() const { return joints + 2; }
  /// Grasps from ActionOptions::grasp on, and lets go below ActionOptions::release.
  [[nodiscard]] constexpr std::size_t hand() const { return movingCount(); }
  /// From ActionOptions::terminate on, the robot says that its task is done.
  [[nodiscard]] constexpr std::size_t terminate() const { return movingCount() + 1; }
  /// How many there are, and how many of them, the first ones, move the robot.
  [[nodiscard]] constexpr std::size_t count() const { return movingCount() + 2; }
  [[nodiscard]] constexpr std::size_t movingCount() const {
    return joints + (drives_sideways ? 3 : 2);
  }
};

/// One named part of an env's observation.
struct ObservationPart {
  std::string name;
  /// First element in the env's row, and number of elements.
  std::size_t first = 0;
  std::size_t size = 0;
};

/// The Error::name of BatchSimulator::create() where the robot can stand at the start of no
/// episode.
inline constexpr std::string_view kNoEpisodeStarts = "episodes/none-starts";

/// How an episode ended. Files keep the numbers (demonstrations, saved states): a new end gets the
/// next one, and none changes. If a step gives several reasons, the first of these counts:
/// kSuccess, kWrongTerminate, kWrongRelease, kWrongObject, kTimeOut.
enum class EpisodeEnd : std::uint8_t {
  kNone = 0,  ///< It has not ended.
  kSuccess,
  kWrongTerminate,  ///< The robot declared the task done when it was not.
  kWrongRelease,    ///< The hand let go of the target away from the goal.
  kWrongObject,     ///< The hand grasped another object.
  kTimeOut,         ///< TaskOptions::most_steps steps have passed.
};

/// As reports say it, and Python in upper case with '_' for ' '; empty for a number of none.
[[nodiscard]] constexpr std::string_view nameOf(EpisodeEnd end) {
  // No default: the compiler warns of an end without a name.
  switch (end) {
    case EpisodeEnd::kNone:
      return "none";
    case EpisodeEnd::kSuccess:
      return "success";
    case EpisodeEnd::kWrongTerminate:
      return "wrong terminate";
    case EpisodeEnd::kWrongRelease:
      return "wrong release";
    case EpisodeEnd::kWrongObject:
      return "wrong object";
    case EpisodeEnd::kTimeOut:
      return "time out";
  }
  return {};
}

/// How many there are: their numbers begin with 0 and leave none out.
inline constexpr std::size_t kEpisodeEnds = [] {
  std::uint8_t count = 0;
  while (!nameOf(EpisodeEnd{count}).empty()) ++count;
  return count;
}();

/// Whether the rules of the task ended the episode, for better or worse: a termination in the sense
/// of reinforcement learning, with no reward behind it.
[[nodiscard]] constexpr bool isTermination(EpisodeEnd end) {
  return end != EpisodeEnd::kNone && end != EpisodeEnd::kTimeOut;
}

/// Whether the clock ended the episode, which could have gone on: a truncation.
[[nodiscard]] constexpr bool isTruncation(EpisodeEnd end) { return end == EpisodeEnd::kTimeOut; }

/// Whether the episode ended by a mistake of the robot.
[[nodiscard]] constexpr bool isFailure(EpisodeEnd end) {
  return isTermination(end) && end != EpisodeEnd::kSuccess;
}

/// What happened in all envs, or in one, since the simulator was made or began anew (restart()), or
/// as a state that was restored has it.
struct SimulationStatistics {
  /// Steps of idle envs do not count.
  std::uint64_t steps = 0;
  /// Steps in which the robot kept its pose because the candidate penetrated something.
  std::uint64_t refused = 0;
  /// Steps whose candidate was free after being pushed.
  std::uint64_t slid = 0;
  std::uint64_t grasps = 0;
  /// Releases that found a place, and releases after which the object went back.
  std::uint64_t drops = 0;
  std::uint64_t restored = 0;
  std::uint64_t episodes = 0;
  std::uint64_t successes = 0;
  std::uint64_t failures = 0;
  /// Episodes that ended and in which the target had been in the hand.
  std::uint64_t picks = 0;
  /// Action values that were not a number and were taken as zero.
  std::uint64_t nan_actions = 0;
  /// Sum of the rewards of all steps.
  double reward = 0;
};

/// Calls `visit(name, member)` for each of them, in their order: the name that it has in Python,
/// and a pointer to the member.
template <class Visit>
constexpr void visitStatistics(Visit&& visit) {
  visit("steps", &SimulationStatistics::steps);
  visit("refused", &SimulationStatistics::refused);
  visit("slid", &SimulationStatistics::slid);
  visit("grasps", &SimulationStatistics::grasps);
  visit("drops", &SimulationStatistics::drops);
  visit("restored", &SimulationStatistics::restored);
  visit("episodes", &SimulationStatistics::episodes);
  visit("successes", &SimulationStatistics::successes);
  visit("failures", &SimulationStatistics::failures);
  visit("picks", &SimulationStatistics::picks);
  visit("nan_actions", &SimulationStatistics::nan_actions);
  visit("reward", &SimulationStatistics::reward);
}

// No member without a name.
static_assert([] {
  std::size_t bytes = 0;
  visitStatistics([&]<class T>(const char*, T SimulationStatistics::*) { bytes += sizeof(T); });
  return bytes;
}() == sizeof(SimulationStatistics));

/// The state of one env: for exports, pictures, planners; and to go on from, with
/// BatchSimulator::setStates(). A copy.
struct EnvState {
  /// Index into World::scenes(), and into the episode set's episodes.
  std::uint32_t scene = 0;
  std::uint32_t episode = 0;
  std::uint32_t step = 0;
  Pose world_from_root;
  /// The robot's whole vector of joint positions.
  std::vector<float> joint_positions;
  /// Origin at the grasp point, axes of the end effector's link.
  Pose world_from_grip;
  /// World poses of the episode's objects, in the order of its placements.
  std::vector<Pose> objects;
  /// Index into `objects`; -1 when nothing is held.
  std::int32_t held = -1;
  std::uint32_t target = 0;
  Pose goal;
  /// How many episodes the env has begun, this one included: what tells it from the same one begun
  /// again.
  std::uint64_t begun = 0;
};

/// Where the objects of an env are: a view of the simulator, valid until its next step.
struct EnvObjects {
  /// Index into World::scenes(), and into the episode set's episodes.
  std::uint32_t scene = 0;
  std::uint32_t episode = 0;
  /// Those that are there: without distractors the target alone.
  PresentObjects present;
  /// World poses, one for each that is there; of the held object, where it rested before it was
  /// grasped.
  std::span<const Pose> objects;
  /// Index into `objects`; -1 when nothing is held.
  std::int32_t held = -1;
  Pose world_from_held;
  /// Whether the target has been in the hand in this episode; see BatchSimulator::picks() for one
  /// that has ended.
  bool has_picked = false;
  /// Where the target is to be.
  Pose goal;
};

/// Where an env is after a step that was made elsewhere: by a physics engine, or by a real robot.
struct FollowedState {
  /// The root stays upright: only the yaw of its rotation counts.
  Pose world_from_root;
  /// One per position of the robot; positions that neither actions nor episodes move are ignored.
  std::span<const float> joint_positions;
  /// World poses, one per object of the env (EnvObjects::objects), also of the held one.
  std::span<const Pose> objects;
  /// Index into `objects`; -1 when nothing is held.
  std::int32_t held = -1;
  /// Whether something was in the way of the robot: what the bump sensor says.
  bool was_hindered = false;
};

/// Where a link sits on the body that carries it.
struct LinkOnBody {
  std::size_t body = 0;
  /// body_from_link.
  RigidTransform place;
};

/// Seconds that the threads spent in each phase of the sampled steps, added up.
struct PhaseTime {
  std::string_view name;
  double seconds = 0;
};

/// What the options say of noise, as an episode has drawn it: standard deviations, and steps of
/// delay. See RobotNoise and LaserOptions.
struct EpisodeNoise {
  float motion = 0;
  float motion_bias = 0;
  float localization = 0;
  std::uint32_t action_delay = 0;
  /// Meters; 0 without a laser.
  float laser = 0;
};

/// Who has chosen an episode that begins, and so whose RobotNoise it has.
enum class EpisodeChoice : std::uint8_t {
  /// Somebody who compares policies by it: the episode's own, the same in whatever env it is
  /// played.
  kNamed,
  /// Chance, as where its turn has come or a task draws it: the env's, another one each time.
  kDrawn,
};

/// N environments of one world, stepped together (paper, section 3.2 and appendices A, G and I).
/// What an env does depends on (world, options, seed, env number, actions) only: bit for bit the
/// same for any number of threads and of other envs. A step neither allocates, nor throws, nor
/// locks. Calls with arrays of other lengths than said, or with numbers of envs that there are not,
/// throw ErrorException with kInvalidInput and change nothing, as do those that have to wait for
/// endStep() where a step has begun: steps, states, statistics and times of phases. Not safe to
/// call from several threads at once.
///
/// Actions, for each env: one per controlled joint of the robot, in the order of its recipe (+-1:
/// the largest step); forward (+1: forward_step meters ahead); turn (+1: turn_step radians
/// clockwise, seen from above); where the robot's base drives sideways, sideways (+1:
/// sideways_step meters to the left); hand (1: grasp what the gripper touches, or keep it; 0:
/// release); terminate (1: the robot says that the task is done): see ActionLayout. Values are
/// clamped to
/// [-1, 1]; NaN is taken as 0 and counted.
class BatchSimulator {
 public:
  /// All envs stand at the start of their first episode. Fails with kInvalidInput on options out of
  /// their ranges (checkOptions), when no episode of the world can be started (the robot penetrates
  /// something in all of them; the error's name is kNoEpisodeStarts) or a laser sees nothing, and
  /// with kUnsupported when an action moves a planar or floating joint, or the link that carries
  /// the laser.
  [[nodiscard]] static Result<BatchSimulator> create(const World& world,
                                                     const SimulationOptions& options);
  ~BatchSimulator();
  BatchSimulator(BatchSimulator&&) noexcept;
  BatchSimulator& operator=(BatchSimulator&&) noexcept;

  [[nodiscard]] const World& world() const;
  /// As the simulator was created, with the seed of the last restart().
  [[nodiscard]] const SimulationOptions& options() const;
  [[nodiscard]] std::size_t envCount() const;
  [[nodiscard]] std::size_t actionCount() const;
  [[nodiscard]] ActionLayout actionLayout() const;
  [[nodiscard]] std::size_t observationSize() const;
  [[nodiscard]] std::size_t threadCount() const;
  /// The parts of an observation, in order:
  /// robot_target (3), grip_target (3), robot_grip (3), robot_goal (3), grip_goal (3): points in
  /// the frame of the base (on the floor under the root, turned by the yaw) or of the grip, meters;
  /// is_holding (1); joints (one per controlled joint, radians or meters); time (3): the share f of
  /// the steps that is left, as min(1, f), min(1, 5 f), min(1, 50 f). With SensorOptions also: bump
  /// (1): whether something was in the way of the last step; target_goal (3): from the target,
  /// where it is now, to the goal, along the axes of the base, meters; target_up (3): where that
  /// side of the target points that was up when the episode began, along these axes; near_objects
  /// (3 for each): from the grasp point to the nearest points of the nearest other objects, along
  /// these axes, meters, (0, 1, 0) in place of those further away than 1 m; laser (beams, for each
  /// of its planes): distances as shares of the range; geodesic (6): length, cosine and sine of the
  /// way along the floor to the target, and to the goal; last_actions (an action for each): what
  /// was asked for in the last steps, the latest first. See docs/simulation.md.
  [[nodiscard]] const std::vector<ObservationPart>& observationParts() const;

  /// One step of all envs. `actions`: envCount() * actionCount(), env after env.
  /// `resets`: empty, or for each env the index of an episode that begins instead of this step's
  /// end, kStays for none; the env's reward and done of this step are 0. Numbers that are no
  /// episode's, and those of skippedEpisodes(), begin none either: no episode becomes another.
  void step(std::span<const float> actions, std::span<const std::int32_t> resets = {});

  /// The same in two halves, so that the caller can work meanwhile. `actions` and `resets` must
  /// stay as they are until endStep() returns; what the simulator returns is valid after it. In
  /// between it takes no other step, no state is reset, saved, restored or copied, and neither
  /// statistics nor times of phases are read.
  void beginStep(std::span<const float> actions, std::span<const std::int32_t> resets = {});
  void endStep();
  /// Whether a step has begun and not ended.
  [[nodiscard]] bool isStepping() const;

  /// A step that was made elsewhere. The envs are in `states` (one per env) now, whatever the
  /// simulation would have made of `actions`; observations, rewards and ends of episodes follow as
  /// in step(), from where robot and objects are and from what is held now and was held before.
  /// Nothing asks whether a robot can be where it is said to be, but numbers that are not finite,
  /// rotations that are none and held objects that there are not are refused (ErrorException).
  void follow(std::span<const float> actions, std::span<const FollowedState> states);

  /// What reset() takes for an env instead of an episode: leave it as it is, or begin the episode
  /// whose turn it is.
  static constexpr std::int32_t kStays = -1;
  static constexpr std::int32_t kNextEpisode = -2;
  /// Begins episodes between two steps. `episodes`: for each env the index of an episode, kStays or
  /// kNextEpisode; where a number is neither, or of skippedEpisodes(), the env stays, too. What the
  /// last step returned stays, but for the observations of these envs; where that step ended an
  /// episode, the one before is their final observation.
  void reset(std::span<const std::int32_t> episodes, EpisodeChoice choice = EpisodeChoice::kNamed);
  /// All envs stand at the start of their first episode, as if the simulator had just been made
  /// with this seed; the statistics begin anew, too.
  void restart(std::uint64_t seed);

  /// Each of `envs` goes on from its state, which may be that of another env or simulator, a
  /// changed one, or one of your own: in EnvState::episode, whose scene, objects and target are
  /// there, after EnvState::step steps of it, with robot, objects and goal where the state says.
  /// The base goes to the floor, GroundOptions::most_rise above it or most_drop below it at most,
  /// and joints into their limits. What is held is in the hand as world_from_grip and its
  /// pose in `objects` say, and follows joints that you change; spheres of it that are in something
  /// do not count until they are free, as after a grasp. Objects that rest are taken as they are,
  /// also in the air, in furniture or in each other. `scene`, `begun` and the goal's rotation play
  /// no part, the root has its yaw alone, and positions that neither actions nor episodes move stay
  /// as they are. Where the target rests counts as where it began. What a state does not say begins
  /// anew: the last actions, whether something was in the way (bump), odometry. The luck of the env
  /// is its own or, with EpisodeChoice::kNamed, the episode's. What the last step returned stays,
  /// but for the observations of these envs.
  ///
  /// 1 where an env has its state now; 0 where it stays as it was: where no floor carries the base,
  /// where the robot would penetrate the scene or a resting object out of the hand's reach (one
  /// within counts as just let go of), or where the hand does not touch what it is to hold, whose
  /// box is then further than EndEffector::grasp_radius from the grasp point. Fails with
  /// kInvalidInput and changes nothing where an env is named twice, or where a state is of no
  /// episode that can be started, or has other counts of objects or positions, another target than
  /// its episode, numbers that are not finite, a root that is tilted by more than 0.1 rad or, where
  /// ways along the floor are observed or rewarded, another goal than its episode. Allocates.
  [[nodiscard]] Result<std::vector<std::uint8_t>> setStates(
      std::span<const std::uint32_t> envs, std::span<const EnvState> states,
      EpisodeChoice choice = EpisodeChoice::kDrawn);

  /// Fails as setStates() would because of a state, and does nothing else.
  [[nodiscard]] Result<void> checkStates(std::span<const EnvState> states) const;

  /// The state of all envs as bytes, or of `envs`, in that order (numbers below envCount(), an
  /// ErrorException otherwise): with what the last step returned, the statistics and the seed.
  [[nodiscard]] std::vector<std::byte> saveState() const;
  [[nodiscard]] std::vector<std::byte> saveState(std::span<const std::uint32_t> envs) const;
  /// What restoreState() takes for an env where a saved one is to become none.
  static constexpr std::uint32_t kNoEnv = ~std::uint32_t{0};
  /// Goes on from a state that a simulator of the same world and the same options saved (threads,
  /// auto_reset and body_transforms may differ and, with `envs`, the number of envs, rank and
  /// ranks): bit for bit as that one would have. The saved envs become all envs, or `envs`, in that
  /// order, and a single one becomes each of them; the random numbers and episodes to come are
  /// those of the env that a state is restored to. The bytes need not be trusted: fails with
  /// kInvalidInput or kUnsupported and changes nothing if they are not such a state, are of another
  /// number of envs or, with `envs`, of another seed, where one is named twice, or where one waits
  /// for its next episode and none does here.
  [[nodiscard]] Result<void> restoreState(std::span<const std::byte> state);
  [[nodiscard]] Result<void> restoreState(std::span<const std::byte> state,
                                          std::span<const std::uint32_t> envs);

  /// After the last step. Shape: envs * observationSize(). Where an episode ended, the first
  /// observation of the next one, or without SimulationOptions::auto_reset still its last.
  [[nodiscard]] std::span<const float> observations() const;
  /// Where an episode ended in the last step, its last observation; elsewhere undefined.
  [[nodiscard]] std::span<const float> finalObservations() const;
  /// Of the last step. Shape: envs.
  [[nodiscard]] std::span<const float> rewards() const;
  /// 1 where an episode ended in the last step. Shape: envs.
  [[nodiscard]] std::span<const std::uint8_t> dones() const;
  /// 1 where it ended in success. Shape: envs.
  [[nodiscard]] std::span<const std::uint8_t> successes() const;
  /// How it ended; kNone where it goes on or the caller reset it. Shape: envs.
  [[nodiscard]] std::span<const EpisodeEnd> endings() const;
  /// 1 where it ended and the target had been in the hand at any time of it, whatever the task.
  /// Shape: envs.
  [[nodiscard]] std::span<const std::uint8_t> picks() const;

  /// 1 where an env has played its share of the episodes (EpisodeOrder::kPartition), or waits where
  /// its episode ended (without SimulationOptions::auto_reset): from the step after on, it ignores
  /// actions, stays as it is with rewards of 0, ends nothing and is left out of all statistics,
  /// until the caller chooses an episode for it or, where it waits, asks for the next. Shape: envs.
  [[nodiscard]] std::span<const std::uint8_t> idle() const;

  [[nodiscard]] SimulationStatistics statistics() const;
  /// The statistics of one env.
  [[nodiscard]] SimulationStatistics statistics(std::size_t env) const;
  /// Episodes of the world that are skipped because the robot cannot start in them.
  [[nodiscard]] std::span<const std::uint32_t> skippedEpisodes() const;
  [[nodiscard]] EnvState envState(std::size_t env) const;
  /// The objects of one env, which is not checked, without copies: for rendering.
  [[nodiscard]] EnvObjects envObjects(std::size_t env) const noexcept;
  /// What the random numbers of the sensors of an env, which is not checked, follow from.
  [[nodiscard]] EnvMoment envMoment(std::size_t env) const noexcept;
  /// The noise of the episode that an env is in.
  [[nodiscard]] EpisodeNoise episodeNoise(std::size_t env) const;
  /// What an env was asked to do and has not done yet, as actions arrive late
  /// (RobotNoise::action_delay): an action for each step of its episode's delay, the one that is
  /// due in the next step first. Of steps before the episode, nothing moves and what the hand and
  /// terminate ask for is NaN. Shape: EpisodeNoise::action_delay * actionCount(). Allocates.
  [[nodiscard]] std::vector<float> actionsUnderWay(std::size_t env) const;
  /// A body is a group of links that no joint moves against each other in this run (joints that
  /// neither actions nor episodes move count as fixed). The root's is body 0.
  [[nodiscard]] std::size_t bodyCount() const;
  /// `link`: index into Robot::links().
  [[nodiscard]] LinkOnBody linkOnBody(std::size_t link) const;
  /// world_from_body of all bodies after the last step, for rendering. Shape: envs * bodyCount();
  /// empty without SimulationOptions::body_transforms.
  [[nodiscard]] std::span<const RigidTransform> bodyTransforms() const;

  /// From now on, measures the phases of one step in `every`; 0 switches this off.
  void samplePhases(std::uint32_t every);
  [[nodiscard]] std::vector<PhaseTime> phaseTimes() const;
  /// Memory of all envs together, bytes.
  [[nodiscard]] std::size_t memoryBytes() const;
  /// Memory of what all envs share beside the packs, bytes: how episodes begin, what is known of
  /// the floors of all homes, ways along them, and what lasers see.
  [[nodiscard]] std::size_t sharedBytes() const;

 private:
  class Impl;
  explicit BatchSimulator(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace galactic
