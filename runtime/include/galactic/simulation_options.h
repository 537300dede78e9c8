#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "galactic/drawn_number.h"
#include "galactic/pose.h"

namespace galactic {

/// In which direction a robot that would penetrate something is moved clear (paper, appendix I.1).
enum class SlideDirection : std::uint8_t {
  /// Along what blocks it: the shortest move of the base that frees all spheres.
  kGlide = 0,
  /// As in the published code: from the first sphere found in contact towards the base.
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
  /// Number of candidate poses: the pose of the release, and jittered ones.
  std::uint32_t attempts = 6;
  /// A candidate that would have to be lifted further than this to be free is discarded, meters.
  float most_lift = 0.05F;
  /// Gap left between the object and what it rests on, meters.
  float clearance = 0.001F;
  /// Half the range of random directions about the direction away from the object that was hit,
  /// radians. If no object was hit, all directions are equally likely.
  float direction_spread = 1.0471976F;
  /// Length of a jitter, in multiples of the diagonal of the object's box.
  float jitter = 1.0F;
};

/// How the base follows the floor.
struct GroundOptions {
  /// Highest rise and deepest drop of the floor under the base within one step, meters. A higher
  /// rise is a wall; a deeper drop is refused. Where something overhead leaves no room for a rise
  /// above the default, the base rises by at most the default.
  float most_rise = 0.05F;
  float most_drop = 0.05F;
};

/// The shape of a resting object that the hand has to touch to grasp it.
enum class GraspShape : std::uint8_t {
  /// Its oriented box, cut by all planes around its convex hull that its pack contains.
  kHull = 0,
  /// As in the published code: its oriented box.
  kBox = 1,
};

/// Thresholds of the actions that switch something, and the shape that a grasp has to touch.
struct ActionOptions {
  /// An empty hand grasps at this value and above.
  float grasp = 0.5F;
  /// A hand that holds something releases it below this value. The paper's action is 0 or 1. The
  /// published code releases below -0.5, so that a policy can also do neither.
  float release = 0.5F;
  float terminate = 0.5F;
  GraspShape grasp_shape = GraspShape::kHull;
};

/// What the robot has to do.
enum class TaskKind : std::uint8_t {
  /// Bring the target to the goal, release it there, and terminate (paper, appendix A).
  kRearrange = 0,
  /// Pick up the target.
  kMobilePick = 1,
  /// Nothing: no reward, no success, no failure; episodes end when their time is up.
  kNone = 2,
};

/// The task, its reward (paper, equation 1) and how it ends. The defaults are the paper's.
struct TaskOptions {
  TaskKind kind = TaskKind::kRearrange;
  float success_reward = 10.0F;
  float pick_reward = 5.0F;
  float reach_weight = 1.0F;
  float transport_weight = 1.0F;
  float action_weight = 0.001F;
  /// Reward per meter by which the shortest path along the floor to the target gets shorter or,
  /// while the target is held, the path to the goal. The paper has no such term.
  float geodesic_weight = 0;
  /// `slack_penalty` is subtracted in each step, `failure_penalty` when an episode fails.
  float slack_penalty = 0.0F;
  float failure_penalty = 0.0F;
  /// Subtracted in each step in which an obstacle kept the robot from moving.
  float bump_penalty = 0.0F;
  /// Subtracted in each step in which the first thing in the robot's way is a resting object, even
  /// if the robot slides past it: a real object would be knocked over.
  float knock_penalty = 0.0F;
  /// Subtracted in each step with a mistake that only goes unpunished because `drop_fails` is off:
  /// the hand would have released the target away from the goal, or holds another object.
  float drop_penalty = 0.0F;
  /// Subtracted in each step in which the hand holds the target on its side. If the target is
  /// tilted by an angle a, 1 - cos(a) times this is subtracted.
  float tilt_penalty = 0.0F;
  /// Distance between target and goal within which the task is solved, meters.
  float success_distance = 0.1F;
  /// Steps after which an episode ends without success or failure; 0: never.
  std::uint32_t most_steps = 500;
  /// Whether success needs the terminate action, and terminating elsewhere is a failure. Off:
  /// success is judged at each release, and the action is ignored ("no terminate action").
  bool needs_terminate = true;
  /// Number of steps at the start of an episode in which the terminate action does nothing.
  std::uint32_t terminate_after = 0;
  /// Whether releases away from the goal and grasps of another object end the episode as a failure.
  /// Off: they do not ("safe drop"), and a release away from the goal is not carried out.
  bool drop_fails = true;
  /// Whether objects other than the target are present.
  bool distractors = true;
  /// Whether observations give the target's current place; otherwise they give its place at the
  /// start, as in the published code.
  bool observes_current_target = false;
};

/// Stands for the value in the robot's recipe or, if the recipe has none, for the default.
inline constexpr float kOfRobot = -1;

/// The largest number of scans of one laser.
inline constexpr std::size_t kMostLaserHeights = 16;

/// Planar laser scans as a part of the observation: distances around the robot. kOfRobot in place
/// of a number stands for the value in the robot's recipe.
struct LaserOptions {
  /// Beams of one scan; 0: no laser.
  std::uint32_t beams = 0;
  /// Field of view, degrees, centered on the direction straight ahead of the laser; by default 360.
  float fov_degrees = kOfRobot;
  /// Heights above the floor, meters, one for each scan, at most kMostLaserHeights: a single
  /// height, or a range of heights. In a range, a beam ends at whatever is nearest at any height in
  /// it, as in a scan made from the points of a depth camera. Empty: the height in the robot's
  /// recipe; by default 0.25.
  std::vector<Span> heights = {};
  /// Farthest distance, meters; by default 10.
  float range = kOfRobot;
  /// Nearest distance, meters: anything nearer is measured as this. By default 0.
  float least_range = kOfRobot;
  /// Standard deviation of a distance, meters; by default 0.
  DrawnNumber noise = kOfRobot;
};

/// The largest number of objects near the hand in an observation.
inline constexpr std::uint32_t kMostNearObjects = 16;

/// The largest number of steps whose actions can be part of an observation.
inline constexpr std::uint32_t kMostLastActions = 100;

/// What the robot senses besides its own state; all off by default.
struct SensorOptions {
  /// Whether an obstacle kept the robot from moving in the last step.
  bool bump = false;
  /// The vector from the target's current position to the goal.
  bool target_goal = false;
  /// How the target is tilted compared with how it stood when the episode began.
  bool target_up = false;
  /// How many of the objects nearest to the hand are observed besides the target; 0 for none, at
  /// most kMostNearObjects.
  std::uint32_t near_objects = 0;
  LaserOptions laser;
  /// Whether the shortest paths along the floor to target and goal are observed.
  bool geodesic = false;
  /// The most memory that these paths may use, megabytes; also for TaskOptions::geodesic_weight.
  std::uint32_t geodesic_megabytes = 1024;
  /// How many of the episode's last steps have their actions in the observation; 0 for none, at
  /// most kMostLastActions. For robots whose actions take effect late.
  std::uint32_t last_actions = 0;
};

/// The largest delay of actions, in steps.
inline constexpr std::uint32_t kMostActionDelay = 100;

/// How imprecisely robots move and how imprecisely they know where they are: for policies that have
/// to work on real robots. All off by default; see docs/simulation.md. Except for the delay, the
/// numbers are standard deviations as fractions of the motion, so that a robot that is told to
/// stand still stands still. Each may be a range from which episodes draw.
struct RobotNoise {
  /// Noise of each motion of base and joints in each step. Driving RobotBase::forward_step also
  /// turns the base, by this fraction of RobotBase::turn_step.
  DrawnNumber motion = 0;
  /// The same, but constant for an episode: gains that are wrong.
  DrawnNumber motion_bias = 0;
  /// Noise of the odometry, which adds up in the place where the robot believes it is.
  DrawnNumber localization = 0;
  /// Steps that pass before an action takes effect, at most kMostActionDelay. The robot holds still
  /// until the first action of an episode arrives.
  DrawnCount action_delay = 0;

  [[nodiscard]] constexpr bool changesMotion() const {
    return motion.most > 0 || motion_bias.most > 0;
  }
  [[nodiscard]] constexpr bool delaysActions() const { return action_delay.most > 0; }
};

/// In which order an env plays the episodes of a world.
enum class EpisodeOrder : std::uint8_t {
  /// A new permutation of all episodes each time around.
  kShuffled = 0,
  /// In the order in which they are stored: env b begins with episode b.
  kLinear = 1,
  /// Env b of all N envs (of all ranks) plays episodes b, b + N, ..., then none, so that together
  /// they play each episode once. For evaluations. The only order in which an env's episodes depend
  /// on the number of envs.
  kPartition = 2,
};

/// No batch of simulations, images or policies uses more threads than this, however many are asked
/// for.
inline constexpr std::uint32_t kMostThreads = 4096;

struct SimulationOptions {
  std::uint32_t envs = 128;
  /// 0: one per processor.
  std::uint32_t threads = 0;
  std::uint64_t seed = 1;
  EpisodeOrder order = EpisodeOrder::kShuffled;
  /// Env b of this batch is env rank * envs + b of ranks * envs. The episodes that an env plays and
  /// its random numbers depend on that number only.
  std::uint32_t rank = 0;
  std::uint32_t ranks = 1;
  /// Whether steps compute the pose of every body of the robot, for rendering.
  bool body_transforms = false;
  /// Whether a step that ends an episode begins the next one. Otherwise the env stays where its
  /// episode ended, idle (BatchSimulator::idle()), until BatchSimulator::reset(), so that this
  /// state can be drawn. The episodes are the same.
  bool auto_reset = true;
  /// Whether moves are checked along their whole path, in parts so short that no sphere moves
  /// further than its radius. Each part slides on its own, and the first part that cannot be made
  /// free ends the move there. Otherwise only the end of a move is checked (as in the published
  /// code), and the robot may pass through anything thinner than the distance it moves in one step.
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
