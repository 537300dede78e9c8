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

/// The meaning of each element in an env's row of actions. See BatchSimulator.
struct ActionLayout {
  /// Number of controlled joints. Their actions come first, in the order of the robot's recipe.
  std::size_t joints = 0;
  /// Whether the base also drives sideways, with an action that follows `turn`.
  bool drives_sideways = false;

  /// The layout that the robot's recipe gives. Without a recipe, there are no joints, and the base
  /// does not drive sideways.
  [[nodiscard]] static ActionLayout of(const Robot& robot);

  /// The functions below return indices into the actions of an env, each of which ranges from -1 to
  /// 1. 1 drives forward.
  [[nodiscard]] constexpr std::size_t forward() const { return joints; }
  /// 1 turns clockwise, seen from above.
  [[nodiscard]] constexpr std::size_t turn() const { return joints + 1; }
  /// Only if the base drives sideways: 1 drives to the left.
  [[nodiscard]] constexpr std::size_t sideways() const { return joints + 2; }
  /// The hand grasps at ActionOptions::grasp and above, and releases below ActionOptions::release.
  [[nodiscard]] constexpr std::size_t hand() const { return movingCount(); }
  /// At ActionOptions::terminate and above, the robot declares its task done.
  [[nodiscard]] constexpr std::size_t terminate() const { return movingCount() + 1; }
  /// The number of actions. The first movingCount() of them move the robot.
  [[nodiscard]] constexpr std::size_t count() const { return movingCount() + 2; }
  [[nodiscard]] constexpr std::size_t movingCount() const {
    return joints + (drives_sideways ? 3 : 2);
  }
};

/// One named part of an env's observation.
struct ObservationPart {
  std::string name;
  /// Index of the first element in the env's row, and number of elements.
  std::size_t first = 0;
  std::size_t size = 0;
};

/// The Error::name of BatchSimulator::create() when there is no episode at whose start the robot
/// can stand.
inline constexpr std::string_view kNoEpisodeStarts = "episodes/none-starts";

/// How an episode ended. Files store the numbers (demonstrations, saved states): a new way to end
/// gets the next number, and no number ever changes. If a step ends an episode for several reasons,
/// the first of these counts: kSuccess, kWrongTerminate, kWrongRelease, kWrongObject, kTimeOut.
enum class EpisodeEnd : std::uint8_t {
  kNone = 0,  ///< It has not ended.
  kSuccess,
  kWrongTerminate,  ///< The robot declared the task done when it was not.
  kWrongRelease,    ///< The hand let go of the target away from the goal.
  kWrongObject,     ///< The hand grasped another object.
  kTimeOut,         ///< TaskOptions::most_steps steps have passed.
};

/// The name that reports use. Python has it in upper case, with '_' in place of ' '. Empty for a
/// number that stands for no end.
[[nodiscard]] constexpr std::string_view nameOf(EpisodeEnd end) {
  // There is no default, so that the compiler warns of an end without a name.
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

/// The number of values of EpisodeEnd, which are numbered from 0 without gaps.
inline constexpr std::size_t kEpisodeEnds = [] {
  std::uint8_t count = 0;
  while (!nameOf(EpisodeEnd{count}).empty()) ++count;
  return count;
}();

/// Whether the rules of the task ended the episode, for better or worse: a termination in the sense
/// of reinforcement learning, after which no reward follows.
[[nodiscard]] constexpr bool isTermination(EpisodeEnd end) {
  return end != EpisodeEnd::kNone && end != EpisodeEnd::kTimeOut;
}

/// Whether the step limit ended the episode, which could have gone on: a truncation.
[[nodiscard]] constexpr bool isTruncation(EpisodeEnd end) { return end == EpisodeEnd::kTimeOut; }

/// Whether a mistake of the robot ended the episode.
[[nodiscard]] constexpr bool isFailure(EpisodeEnd end) {
  return isTermination(end) && end != EpisodeEnd::kSuccess;
}

/// What happened in all envs, or in one, since the simulator was created or restarted (restart()).
/// Restoring a state replaces the statistics with those that were saved.
struct SimulationStatistics {
  /// The steps of idle envs are not counted.
  std::uint64_t steps = 0;
  /// Steps in which the robot kept its pose because the candidate penetrated something.
  std::uint64_t refused = 0;
  /// Steps whose candidate was free after being pushed.
  std::uint64_t slid = 0;
  std::uint64_t grasps = 0;
  /// Releases for which a place was found, and releases after which the object went back to where
  /// it had rested.
  std::uint64_t drops = 0;
  std::uint64_t restored = 0;
  std::uint64_t episodes = 0;
  std::uint64_t successes = 0;
  std::uint64_t failures = 0;
  /// Episodes that have ended and in which the hand held the target at some time.
  std::uint64_t picks = 0;
  /// Action values that were NaN and were treated as zero.
  std::uint64_t nan_actions = 0;
  /// Sum of the rewards of all steps.
  double reward = 0;
};

/// Calls `visit(name, member)` for each statistic, in order, with its name in Python and a pointer
/// to the member.
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

// Checks that every member has a name.
static_assert([] {
  std::size_t bytes = 0;
  visitStatistics([&]<class T>(const char*, T SimulationStatistics::*) { bytes += sizeof(T); });
  return bytes;
}() == sizeof(SimulationStatistics));

/// A copy of the state of one env: for exports, pictures and planners, and to continue from with
/// BatchSimulator::setStates().
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
  /// How many episodes the env has begun, including this one. It tells this episode from the same
  /// one begun again.
  std::uint64_t begun = 0;
};

/// Where the objects of an env are: a view of the simulator, valid until its next step.
struct EnvObjects {
  /// Index into World::scenes(), and into the episode set's episodes.
  std::uint32_t scene = 0;
  std::uint32_t episode = 0;
  /// The objects that are present: without distractors, the target alone.
  PresentObjects present;
  /// World poses, one for each object that is present. The pose of the held object is the one in
  /// which it rested before it was grasped.
  std::span<const Pose> objects;
  /// Index into `objects`; -1 when nothing is held.
  std::int32_t held = -1;
  Pose world_from_held;
  /// Whether the hand has held the target in this episode. For an episode that has ended, see
  /// BatchSimulator::picks().
  bool has_picked = false;
  /// The pose to which the target has to be brought.
  Pose goal;
};

/// The state of an env after a step that something else made, such as a physics engine or a real
/// robot.
struct FollowedState {
  /// The root stays upright: only the yaw of its rotation is used.
  Pose world_from_root;
  /// One per position of the robot; positions that neither actions nor episodes move are ignored.
  std::span<const float> joint_positions;
  /// World poses, one per object of the env (EnvObjects::objects), including the held one.
  std::span<const Pose> objects;
  /// Index into `objects`; -1 when nothing is held.
  std::int32_t held = -1;
  /// Whether something was in the robot's way: the value of the bump sensor.
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

/// The noise that an episode has drawn from the ranges in the options: standard deviations, and a
/// delay in steps. See RobotNoise and LaserOptions.
struct EpisodeNoise {
  float motion = 0;
  float motion_bias = 0;
  float localization = 0;
  std::uint32_t action_delay = 0;
  /// Meters; 0 without a laser.
  float laser = 0;
};

/// Who has chosen the episode that begins. This decides which random numbers its RobotNoise uses.
enum class EpisodeChoice : std::uint8_t {
  /// The caller named it, for example to compare policies. The random numbers are the episode's
  /// own: the same in whichever env it is played.
  kNamed,
  /// Its turn came, or a task drew it. The random numbers are the env's, and differ each time.
  kDrawn,
};

/// N environments of one world, stepped together (paper, section 3.2 and appendices A, G and I).
/// What an env does depends only on (world, options, seed, env number, actions). It is the same,
/// bit for bit, for any number of threads and of other envs. A step neither allocates, nor throws,
/// nor locks. A call with an array of the wrong length or an env number out of range throws
/// ErrorException with kInvalidInput and changes nothing. So does a call that has to wait for
/// endStep() while a step is under way: steps, states, statistics and times of phases. Not safe to
/// call from several threads at once.
///
/// Actions, for each env: one per controlled joint of the robot, in the order of its recipe (+-1:
/// the largest step); forward (+1: forward_step meters ahead); turn (+1: turn_step radians
/// clockwise, seen from above); if the robot's base drives sideways, sideways (+1: sideways_step
/// meters to the left); hand (1: grasp what the gripper touches, or keep it; 0: release); terminate
/// (1: the robot declares the task done). See ActionLayout. Values are clamped to [-1, 1]; NaN is
/// treated as 0 and counted.
class BatchSimulator {
 public:
  /// Creates a simulator whose envs all stand at the start of their first episode. Fails with
  /// kInvalidInput when an option is out of range (checkOptions), when no episode of the world can
  /// be started because the robot penetrates something in all of them (the error's name is
  /// kNoEpisodeStarts), or when a laser sees nothing. Fails with kUnsupported when an action moves
  /// a planar or floating joint, or the link that carries the laser.
  [[nodiscard]] static Result<BatchSimulator> create(const World& world,
                                                     const SimulationOptions& options);
  ~BatchSimulator();
  BatchSimulator(BatchSimulator&&) noexcept;
  BatchSimulator& operator=(BatchSimulator&&) noexcept;

  [[nodiscard]] const World& world() const;
  /// The options that the simulator was created with, and the seed of the last restart().
  [[nodiscard]] const SimulationOptions& options() const;
  [[nodiscard]] std::size_t envCount() const;
  [[nodiscard]] std::size_t actionCount() const;
  [[nodiscard]] ActionLayout actionLayout() const;
  [[nodiscard]] std::size_t observationSize() const;
  [[nodiscard]] std::size_t threadCount() const;
  /// The parts of an observation, in order:
  /// robot_target (3), grip_target (3), robot_grip (3), robot_goal (3), grip_goal (3): points in
  /// the frame of the base (on the floor under the root, turned by the yaw) or of the grip, meters;
  /// is_holding (1); joints (one per controlled joint, radians or meters); time (3): the fraction f
  /// of the steps that is left, as min(1, f), min(1, 5 f), min(1, 50 f). SensorOptions add: bump
  /// (1): whether something was in the way in the last step; target_goal (3): the vector from the
  /// target's current position to the goal, along the axes of the base, meters; target_up (3): the
  /// direction, along these axes, of the side of the target that was up when the episode began;
  /// near_objects (3 for each): vectors from the grasp point to the nearest points of the nearest
  /// other objects, along these axes, meters, with (0, 1, 0) in place of objects more than 1 m
  /// away; laser (beams, for each of its planes): distances as fractions of the range; geodesic
  /// (6): length, cosine and sine of the path along the floor to the target, and to the goal;
  /// last_actions (a row of actions for each step): the actions of the last steps, latest first.
  /// See docs/simulation.md.
  [[nodiscard]] const std::vector<ObservationPart>& observationParts() const;

  /// Steps all envs once. `actions`: envCount() * actionCount(), env after env.
  /// `resets`: empty, or for each env the index of an episode that begins in place of this step's
  /// outcome, or kStays for none. The reward and done of an env that is reset are 0 in this step.
  /// An index that is out of range or among skippedEpisodes() begins no episode: no other episode
  /// takes its place.
  void step(std::span<const float> actions, std::span<const std::int32_t> resets = {});

  /// step() in two halves, so that the caller can work in the meantime. `actions` and `resets` must
  /// not change until endStep() returns, and what the simulator returns is valid only after that.
  /// Between the two calls, no other step may begin, no state may be reset, saved, restored or
  /// copied, and neither statistics nor times of phases may be read.
  void beginStep(std::span<const float> actions, std::span<const std::int32_t> resets = {});
  void endStep();
  /// Whether a step has begun and has not ended yet.
  [[nodiscard]] bool isStepping() const;

  /// Follows a step that something else made. The envs are now in `states` (one per env), whatever
  /// the simulation would have made of `actions`. Observations, rewards and ends of episodes follow
  /// as in step(), from where robot and objects are, what is held now and what was held before.
  /// Whether the robot can be where `states` puts it is not checked. Numbers that are not finite,
  /// invalid rotations and indices of held objects that do not exist are refused (ErrorException).
  void follow(std::span<const float> actions, std::span<const FollowedState> states);

  /// Values that reset() takes for an env in place of an episode's index: leave the env as it is,
  /// or begin the episode whose turn it is.
  static constexpr std::int32_t kStays = -1;
  static constexpr std::int32_t kNextEpisode = -2;
  /// Begins episodes between two steps. `episodes`: for each env the index of an episode, kStays or
  /// kNextEpisode. An env whose number is none of these, or is among skippedEpisodes(), stays as it
  /// is, too. The results of the last step stay, except for the observations of these envs. If that
  /// step ended an episode, the env's previous observation becomes its final observation.
  void reset(std::span<const std::int32_t> episodes, EpisodeChoice choice = EpisodeChoice::kNamed);
  /// Puts all envs at the start of their first episode, as if the simulator had just been created
  /// with this seed. The statistics start again from zero.
  void restart(std::uint64_t seed);

  /// Makes each of `envs` continue from its state, which may be that of another env or simulator, a
  /// modified one, or one that you made. The env is then in EnvState::episode, with its scene,
  /// objects and target, after EnvState::step steps, and robot, objects and goal are where the
  /// state puts them. The base is put on the floor, which is at most GroundOptions::most_rise above
  /// it or most_drop below it, and joints are clamped to their limits. A held object is placed in
  /// the hand as world_from_grip and its pose in `objects` say, and moves with joints that you
  /// change. Those of its spheres that penetrate something are ignored until they are free, as
  /// after a grasp. Resting objects stay where the state puts them, even in the air, in furniture
  /// or in each other. `scene`, `begun` and the goal's rotation are ignored; only the yaw of the
  /// root is used; and positions that neither actions nor episodes move stay as they are. The place
  /// where the target rests counts as the place where it began. What a state does not contain
  /// starts afresh: the last actions, whether something was in the way (bump), and odometry. The
  /// random numbers are the env's own or, with EpisodeChoice::kNamed, the episode's. The results of
  /// the last step stay, except for the observations of these envs.
  ///
  /// Returns 1 for each env that has its state now, and 0 for each that stays as it was. An env
  /// stays as it was if no floor carries the base, if the robot would penetrate the scene or a
  /// resting object that is out of the hand's reach (an object within reach counts as just
  /// released), or if the hand does not touch the object that it should hold: its box is then
  /// further than EndEffector::grasp_radius from the grasp point. Fails with kInvalidInput and
  /// changes nothing if an env is named twice, or if the episode of a state cannot be started. The
  /// same happens if a state has the wrong number of objects or positions, another target than its
  /// episode, numbers that are not finite, a root that is tilted by more than 0.1 rad or, when
  /// paths along the floor are observed or rewarded, another goal than its episode. Allocates.
  [[nodiscard]] Result<std::vector<std::uint8_t>> setStates(
      std::span<const std::uint32_t> envs, std::span<const EnvState> states,
      EpisodeChoice choice = EpisodeChoice::kDrawn);

  /// Checks states only: fails as setStates() would because of one of them.
  [[nodiscard]] Result<void> checkStates(std::span<const EnvState> states) const;

  /// The state of all envs, or of `envs` in that order, as bytes, with the results of the last
  /// step, the statistics and the seed. Numbers in `envs` must be below envCount() (ErrorException
  /// otherwise).
  [[nodiscard]] std::vector<std::byte> saveState() const;
  [[nodiscard]] std::vector<std::byte> saveState(std::span<const std::uint32_t> envs) const;
  /// What restoreState() takes in place of an env's number for a saved env that is not to be
  /// restored.
  static constexpr std::uint32_t kNoEnv = ~std::uint32_t{0};
  /// Continues from a state that a simulator of the same world and the same options saved, bit for
  /// bit as that simulator would have. Threads, auto_reset and body_transforms may differ and, with
  /// `envs`, the number of envs, rank and ranks. The saved envs become all envs, or `envs` in that
  /// order; a single saved env becomes each of them. Future random numbers and episodes are those
  /// of the env to which a state is restored. The bytes need not be trusted. Fails with
  /// kInvalidInput or kUnsupported and changes nothing if they are not such a state, have another
  /// number of envs or, with `envs`, another seed; if an env is named twice; or if a saved env
  /// waits for its next episode, which no env of this simulator does.
  [[nodiscard]] Result<void> restoreState(std::span<const std::byte> state);
  [[nodiscard]] Result<void> restoreState(std::span<const std::byte> state,
                                          std::span<const std::uint32_t> envs);

  /// The observations after the last step. Shape: envs * observationSize(). For an env whose
  /// episode ended, it is the first observation of the next episode, or the last one of the ended
  /// episode without SimulationOptions::auto_reset.
  [[nodiscard]] std::span<const float> observations() const;
  /// The last observation of each episode that ended in the last step; undefined for other envs.
  [[nodiscard]] std::span<const float> finalObservations() const;
  /// The rewards of the last step. Shape: envs.
  [[nodiscard]] std::span<const float> rewards() const;
  /// 1 where an episode ended in the last step. Shape: envs.
  [[nodiscard]] std::span<const std::uint8_t> dones() const;
  /// 1 where the episode ended in success. Shape: envs.
  [[nodiscard]] std::span<const std::uint8_t> successes() const;
  /// How the episode ended; kNone where it goes on or the caller reset it. Shape: envs.
  [[nodiscard]] std::span<const EpisodeEnd> endings() const;
  /// 1 where the episode ended and the hand had held the target at any time in it, whatever the
  /// task. Shape: envs.
  [[nodiscard]] std::span<const std::uint8_t> picks() const;

  /// 1 where an env has played its share of the episodes (EpisodeOrder::kPartition), or waits after
  /// the end of its episode (without SimulationOptions::auto_reset). From the next step on, an idle
  /// env ignores actions, stays as it is with rewards of 0, ends no episode and is left out of all
  /// statistics, until the caller chooses an episode for it or, if it waits, asks for the next one.
  /// Shape: envs.
  [[nodiscard]] std::span<const std::uint8_t> idle() const;

  [[nodiscard]] SimulationStatistics statistics() const;
  /// The statistics of one env.
  [[nodiscard]] SimulationStatistics statistics(std::size_t env) const;
  /// Indices of the world's episodes that are skipped because the robot cannot start in them.
  [[nodiscard]] std::span<const std::uint32_t> skippedEpisodes() const;
  [[nodiscard]] EnvState envState(std::size_t env) const;
  /// The objects of one env, without copies: for rendering. `env` is not checked.
  [[nodiscard]] EnvObjects envObjects(std::size_t env) const noexcept;
  /// What the random numbers of an env's sensors are derived from. `env` is not checked.
  [[nodiscard]] EnvMoment envMoment(std::size_t env) const noexcept;
  /// The noise of the episode that an env is in.
  [[nodiscard]] EpisodeNoise episodeNoise(std::size_t env) const;
  /// The actions of an env that have not taken effect yet, because actions arrive late
  /// (RobotNoise::action_delay): one row for each step of its episode's delay, beginning with the
  /// row that is due in the next step. In rows that stand for steps before the episode, motions are
  /// 0 and the hand and terminate actions are NaN. Shape: EpisodeNoise::action_delay *
  /// actionCount(). Allocates.
  [[nodiscard]] std::vector<float> actionsUnderWay(std::size_t env) const;
  /// The number of bodies. A body is a group of links that no joint moves relative to each other in
  /// this run (joints that neither actions nor episodes move count as fixed). The root belongs to
  /// body 0.
  [[nodiscard]] std::size_t bodyCount() const;
  /// `link`: index into Robot::links().
  [[nodiscard]] LinkOnBody linkOnBody(std::size_t link) const;
  /// world_from_body of all bodies after the last step, for rendering. Shape: envs * bodyCount();
  /// empty without SimulationOptions::body_transforms.
  [[nodiscard]] std::span<const RigidTransform> bodyTransforms() const;

  /// Measures the phases of one in `every` steps from now on; 0 switches this off.
  void samplePhases(std::uint32_t every);
  [[nodiscard]] std::vector<PhaseTime> phaseTimes() const;
  /// Memory used by all envs together, bytes.
  [[nodiscard]] std::size_t memoryBytes() const;
  /// Memory used by what all envs share besides the packs, bytes: how episodes begin, the floors of
  /// all homes, paths along them, and what lasers see.
  [[nodiscard]] std::size_t sharedBytes() const;

 private:
  class Impl;
  explicit BatchSimulator(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace galactic
