#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "galactic/drawn_number.h"
#include "galactic/pose.h"

namespace galactic {

/// How a robot that would penetrate something is moved clear (paper, appendix I.1).
enum class SlideDirection : std::uint8_t {
  /// Along what blocks it: the shortest move of the base that frees all spheres.
  kGlide = 0,
  /// Published code: from the first sphere found in contact towards the base.
  kTowardsBase = 1,
};

struct SlideOptions {
  /// Moves of the base per step; 0 switches sliding off.
  std::uint32_t attempts = 3;
  SlideDirection direction = SlideDirection::kGlide;
  /// Length of one move in meters: the longest with kGlide, the only one with kTowardsBase.
  float step = 0.15F;
};

/// How a released object finds its place (paper, appendix I.2).
struct PlacementOptions {
  /// Candidate poses: the one of the release, and jittered ones.
  std::uint32_t attempts = 6;
  /// A candidate that would have to be lifted further than this to be free is given up, meters.
  float most_lift = 0.05F;
  /// Left between the object and what it rests on, meters.
  float clearance = 0.001F;
  /// Half the range of random directions about the direction away from the object that was hit,
  /// radians; with none to go away from, all directions are equally likely.
  float direction_spread = 1.0471976F;
  /// Length of a jitter, in diagonals of the object's box.
  float jitter = 1.0F;
};

/// How the base follows the floor.
struct GroundOptions {
  /// Highest rise and deepest drop of the floor under the base within one step, meters. A higher
  /// step is a wall; a deeper drop is refused. Under what is too low for a rise above the default,
  /// the base rises by the default at most.
  float most_rise = 0.05F;
  float most_drop = 0.05F;
};

/// What the hand has to touch of a resting object in order to grasp it.
enum class GraspShape : std::uint8_t {
  /// Its oriented box, and all planes around its convex hull that its pack knows.
  kHull = 0,
  /// Published code: its oriented box.
  kBox = 1,
};

/// Thresholds of the actions that switch something, and what a grasp is about.
struct ActionOptions {
  /// A hand that is empty grasps from this value on.
  float grasp = 0.5F;
  /// A hand that holds something releases it below this value. The paper's action is 0 or 1; the
  /// published code releases below -0.5, so that a policy can do neither.
  float release = 0.5F;
  float terminate = 0.5F;
  GraspShape grasp_shape = GraspShape::kHull;
};

/// What the robot has to do.
enum class TaskKind : std::uint8_t {
  /// Bring the target to the goal, release it there, and say so (paper, appendix A).
  kRearrange = 0,
  /// Pick up the target.
  kMobilePick = 1,
  /// Nothing: no reward, no success, no failure; episodes end when their time is up.
  kNone = 2,
};

/// The task, its reward (paper, equation 1) and its end. The defaults are the paper's.
struct TaskOptions {
  TaskKind kind = TaskKind::kRearrange;
  float success_reward = 10.0F;
  float pick_reward = 5.0F;
  float reach_weight = 1.0F;
  float transport_weight = 1.0F;
  float action_weight = 0.001F;
  /// Per meter of the shortest way along the floor to the target or, once it is held, to the goal.
  /// The paper has no such term.
  float geodesic_weight = 0;
  /// Subtracted in each step, and when an episode fails.
  float slack_penalty = 0.0F;
  float failure_penalty = 0.0F;
  /// Subtracted in each step in which an obstacle kept the robot where it was.
  float bump_penalty = 0.0F;
  /// Subtracted in each step in which the first thing in the robot's way is an object at rest, also
  /// where it slides past it: a real one would be knocked over.
  float knock_penalty = 0.0F;
  /// Subtracted in each step in which something is overlooked that fails unless `drop_fails` is
  /// off: the hand would have released the target away from the goal, or holds another object.
  float drop_penalty = 0.0F;
  /// Subtracted in each step in which the hand holds the target on its side; of a target that is
  /// tilted by an angle a, 1 - cos(a) of it.
  float tilt_penalty = 0.0F;
  /// Distance of target and goal that counts as success, meters.
  float success_distance = 0.1F;
  /// Steps after which an episode ends without success or failure; 0 for never.
  std::uint32_t most_steps = 500;
  /// Success needs the terminate action, and terminating elsewhere is a failure. Off: success is
  /// judged at each release, and the action is ignored ("no terminate action").
  bool needs_terminate = true;
  /// In so many first steps of an episode the terminate action does nothing.
  std::uint32_t terminate_after = 0;
  /// Releases away from the goal and grasps of another object end the episode as a failure. Off:
  /// they do nothing ("safe drop": a release away from the goal is not carried out).
  bool drop_fails = true;
  /// Whether objects other than the target are there.
  bool distractors = true;
  /// Whether observations follow the target; otherwise they give it where it was at the start, as
  /// the published code does.
  bool observes_current_target = false;
};

/// Stands for the value in the robot's recipe or, if the recipe has none, for the default of the
/// value.
inline constexpr float kOfRobot = -1;

/// The most scans of one laser.
inline constexpr std::size_t kMostLaserHeights = 16;

/// Planar laser scans as a part of the observation: distances around the robot. kOfRobot in place
/// of a number: that of the robot's recipe.
struct LaserOptions {
  /// Of one scan; 0: no laser.
  std::uint32_t beams = 0;
  /// Degrees, the middle straight ahead of the laser; by default 360.
  float fov_degrees = kOfRobot;
  /// Above the floor, meters, one for each scan, kMostLaserHeights at most: a single height, or a
  /// range of heights, in which a beam ends at whatever is nearest at any of them, as where the
  /// points of a depth camera are made a scan. Empty: that of the robot's recipe; by default 0.25.
  std::vector<Span> heights = {};
  /// Farthest distance, meters; by default 10.
  float range = kOfRobot;
  /// Nearest distance, meters: what is nearer is measured as this. By default 0.
  float least_range = kOfRobot;
  /// Standard deviation of a distance, meters; by default 0.
  DrawnNumber noise = kOfRobot;
};

/// The most objects near the hand that an observation can tell of.
inline constexpr std::uint32_t kMostNearObjects = 16;

/// The most steps of which an observation can tell what was asked for.
inline constexpr std::uint32_t kMostLastActions = 100;

/// What the robot senses beside its own state; all off by default.
struct SensorOptions {
  /// Whether an obstacle kept the robot where it was in the last step.
  bool bump = false;
  /// The way from the target, where it is now, to the goal.
  bool target_goal = false;
  /// How the target is tilted against how it stood when the episode began.
  bool target_up = false;
  /// Objects nearest to the hand that are observed beside the target; 0 for none, kMostNearObjects
  /// at most.
  std::uint32_t near_objects = 0;
  LaserOptions laser;
  /// Whether the ways along the floor to target and goal are observed.
  bool geodesic = false;
  /// Most memory that these ways may take, megabytes; also for TaskOptions::geodesic_weight.
  std::uint32_t geodesic_megabytes = 1024;
  /// Steps of whose actions observations tell: the last ones of the episode; 0 for none,
  /// kMostLastActions at most. For robots that do late what they are asked to.
  std::uint32_t last_actions = 0;
};

/// The most steps by which actions may be late.
inline constexpr std::uint32_t kMostActionDelay = 100;

/// How far real robots are from doing what they are asked to, and from knowing where they are: for
/// policies that are to work on them. All off by default; see docs/simulation.md. But for the
/// delay, numbers are standard deviations, as shares of the motion, so that a robot that is asked
/// to stand still stands still. Each may be a range from which episodes draw.
struct RobotNoise {
  /// Of each motion in each step: base and joints. Driving a whole step also turns the base by such
  /// a share of a whole turn.
  DrawnNumber motion = 0;
  /// The same of what stays for an episode: gains that are off.
  DrawnNumber motion_bias = 0;
  /// Of what odometry adds up to where the robot takes itself to be.
  DrawnNumber localization = 0;
  /// Steps that go by until the robot does what it was asked to, kMostActionDelay at most. It holds
  /// still until the first action of an episode arrives.
  DrawnCount action_delay = 0;

  [[nodiscard]] constexpr bool changesMotion() const {
    return motion.most > 0 || motion_bias.most > 0;
  }
  [[nodiscard]] constexpr bool delaysActions() const { return action_delay.most > 0; }
};

/// In which order an env takes the episodes of a world.
enum class EpisodeOrder : std::uint8_t {
  /// A new permutation of all its episodes each time round.
  kShuffled = 0,
  /// As they are stored: env b begins with episode b.
  kLinear = 1,
  /// Env b of all N envs (of all ranks) takes episodes b, b + N, ..., then none: together, each
  /// episode once. For evaluations. The only order in which an env's episodes depend on the number
  /// of envs.
  kPartition = 2,
};

/// No batch of simulations, images or policies takes more threads, however many it is told.
inline constexpr std::uint32_t kMostThreads = 4096;

struct SimulationOptions {
  std::uint32_t envs = 128;
  /// 0: one per processor.
  std::uint32_t threads = 0;
  std::uint64_t seed = 1;
  EpisodeOrder order = EpisodeOrder::kShuffled;
  /// Env b of this batch is env rank * envs + b of ranks * envs: what each env takes and draws
  /// depends on that number only.
  std::uint32_t rank = 0;
  std::uint32_t ranks = 1;
  /// Whether steps give the pose of every body of the robot, for rendering.
  bool body_transforms = false;
  /// Whether a step that ends an episode begins the next. Else the env stays where its episode
  /// ended, idle (BatchSimulator::idle()), until BatchSimulator::reset, so that this can be drawn;
  /// the episodes are the same.
  bool auto_reset = true;
  /// Whether moves are looked at on their way: in parts so short that no sphere moves further than
  /// its radius. Each part slides on its own; the first that cannot ends the move where it got to.
  /// Else only the end of a move is looked at (as in the published code), and the robot may pass
  /// through what is thinner than its way in one step.
  bool continuous_collision = false;
  ActionOptions action;
  SlideOptions slide;
  PlacementOptions placement;
  GroundOptions ground;
  RobotNoise noise;
  SensorOptions sensors;
  TaskOptions task;
};

}  // namespace galactic
