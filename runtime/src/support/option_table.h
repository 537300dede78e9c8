#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "galactic/simulation_options.h"

namespace galactic {

/// A named value of an option.
template <class T>
struct Named {
  std::string_view name;
  T value;
};

/// The values that an option may have, both ends included.
template <class T>
struct Within {
  T least;
  T most;
};

inline constexpr std::array<Named<TaskKind>, 3> kTaskNames{{{"rearrange", TaskKind::kRearrange},
                                                            {"pick", TaskKind::kMobilePick},
                                                            {"none", TaskKind::kNone}}};
inline constexpr std::array<Named<EpisodeOrder>, 3> kOrderNames{
    {{"shuffled", EpisodeOrder::kShuffled},
     {"linear", EpisodeOrder::kLinear},
     {"partition", EpisodeOrder::kPartition}}};
inline constexpr std::array<Named<SlideDirection>, 2> kSlideNames{
    {{"glide", SlideDirection::kGlide}, {"towards-base", SlideDirection::kTowardsBase}}};
inline constexpr std::array<Named<GraspShape>, 2> kGraspShapeNames{
    {{"hull", GraspShape::kHull}, {"box", GraspShape::kBox}}};

/// The names, as errors list them: "a, b or c".
template <class T>
[[nodiscard]] std::string namesOf(std::span<const Named<T>> names) {
  std::string text;
  for (std::size_t n = 0; n < names.size(); ++n) {
    if (n > 0) text += n + 1 < names.size() ? ", " : " or ";
    text += names[n].name;
  }
  return text;
}

/// A name for a set of values of several options, which may also be given alone and then take
/// precedence. A preset is not an option of its own: recordings, reports and packs store its parts.
template <class T>
struct Preset {
  std::span<const Named<T>> names;
  /// The options that it sets.
  std::span<const std::string_view> parts;
};

inline constexpr std::array<Named<SlideOptions>, 3> kSlidePresets{
    {{"glide", {}},
     {"published", {.attempts = 5, .direction = SlideDirection::kTowardsBase, .step = 0.05F}},
     {"off", {.attempts = 0}}}};
inline constexpr std::array<std::string_view, 3> kSlideParts{"slide-direction", "slide-attempts",
                                                             "slide-step"};

/// A switch: a field, and the value that typing the switch gives it.
struct Switch {
  bool& field;
  bool when_typed;
};

/// Visits each option that determines what a simulation does. This is the one list for all who need
/// it: the command line of galactic-run, recordings, reports, world packs and the recipes of
/// worlds. Calls on `v`
///   group(heading), whole(name, field, Within, help), real(name, field, Within, help),
///   drawn(name, field, within, help), where `within` of a whole number is its maximum,
///   heights(name, field, within, help), choice(name, field, names, help), flag(name, Switch,
///   help), seed(name, field, help), preset(name, field, Preset, help) before its parts.
template <class Visitor>
void visitBatchOptions(SimulationOptions& o, Visitor& v) {
  v.group("Simulation");
  v.whole("envs", o.envs, Within<std::uint32_t>{1, 1U << 20U}, "Environments that step together");
  v.seed("seed", o.seed, "Seed of episodes, placements and policy, and of --bench");
  v.choice("order", o.order, kOrderNames, "Order in which an env takes the episodes");
  v.whole("rank", o.rank, Within<std::uint32_t>{0, 65535},
          "Number of this batch among those that share the episodes");
  v.whole("ranks", o.ranks, Within<std::uint32_t>{1, 65536}, "How many batches share the episodes");
}

/// The heading of the reward options, which do nothing without a task.
inline constexpr const char* kRewardGroup = "Reward";

/// The same for the task and its reward.
template <class Visitor>
void visitTaskOptions(TaskOptions& t, Visitor& v) {
  constexpr Within<float> kReward{-1e6F, 1e6F};
  v.group("Task");
  v.choice("task", t.kind, kTaskNames, "What the robot has to do");
  v.whole("episode-steps", t.most_steps, Within<std::uint32_t>{0, 1U << 30U},
          "Steps after which an episode ends; 0: never");
  v.real("success-distance", t.success_distance, Within<float>{0, 1000},
         "Largest distance between target and goal that is a success, meters");
  v.flag("no-terminate", Switch{t.needs_terminate, false},
         "Judge success at each release; the terminate action does nothing");
  v.whole("terminate-after", t.terminate_after, Within<std::uint32_t>{0, 1U << 30U},
          "First steps of an episode in which the terminate action does nothing");
  v.flag("safe-drop", Switch{t.drop_fails, false},
         "Ignore releases away from the goal, instead of counting them as failures");
  v.flag("no-distractors", Switch{t.distractors, false}, "Leave out all objects except the target");
  v.flag("observe-current", Switch{t.observes_current_target, true},
         "Observe the target where it is, not where it was at the start");
  v.group(kRewardGroup);
  v.real("success-reward", t.success_reward, kReward, "Reward for success");
  v.real("pick-reward", t.pick_reward, kReward, "Reward for the first grasp of the target");
  v.real("reach-weight", t.reach_weight, kReward,
         "Reward per meter that the hand gets closer to the target");
  v.real("transport-weight", t.transport_weight, kReward,
         "Reward per meter that the target gets closer to the goal");
  v.real("geodesic-weight", t.geodesic_weight, kReward,
         "Reward per meter by which the path along the floor to target, then goal, gets shorter");
  v.real("action-weight", t.action_weight, kReward, "Penalty on squared changes of joint actions");
  v.real("slack-penalty", t.slack_penalty, kReward, "Penalty for each step");
  v.real("failure-penalty", t.failure_penalty, kReward, "Penalty for a failure");
  v.real("bump-penalty", t.bump_penalty, kReward, "Penalty for each step that something blocked");
  v.real("knock-penalty", t.knock_penalty, kReward,
         "Penalty for each step in which an object was in the robot's way");
  v.real(
      "drop-penalty", t.drop_penalty, kReward,
      "Penalty for each step in which safe-drop ignores a release, or another object in the hand");
  v.real("tilt-penalty", t.tilt_penalty, kReward,
         "Penalty for each step in which the hand holds the target on its side");
}

/// The same for what the robot does and encounters.
template <class Visitor>
void visitMotionOptions(SimulationOptions& o, Visitor& v) {
  constexpr Within<float> kThreshold{-2, 2};
  constexpr Within<float> kMeters{0, 1000};
  // Not 0: rounding errors make no place of a floor exactly as high as the one before it.
  constexpr Within<float> kStep{0.001F, 1000};
  constexpr Within<std::uint32_t> kAttempts{0, 1000};
  v.group("Actions");
  v.real("grasp-from", o.action.grasp, kThreshold,
         "An empty hand grasps if its action is at least this");
  v.real("release-below", o.action.release, kThreshold,
         "A full hand lets go if its action is below this");
  v.real("terminate-from", o.action.terminate, kThreshold,
         "The robot terminates if its action is at least this");
  v.choice("grasp-shape", o.action.grasp_shape, kGraspShapeNames,
           "What of an object the hand has to touch: its convex hull, or its box");
  v.group("Sliding and floor");
  v.preset("slide", o.slide, Preset<SlideOptions>{kSlidePresets, kSlideParts},
           "How a robot that would hit something is pushed clear");
  v.choice("slide-direction", o.slide.direction, kSlideNames,
           "Direction in which the base is pushed");
  v.whole("slide-attempts", o.slide.attempts, kAttempts, "Moves per step; 0: no sliding");
  v.real("slide-step", o.slide.step, kMeters,
         "Longest move of glide, length of each of towards-base, meters");
  v.real("floor-rise", o.ground.most_rise, kStep, "Highest step up, meters");
  v.real("floor-drop", o.ground.most_drop, kStep, "Deepest step down, meters");
  v.flag("continuous-collision", Switch{o.continuous_collision, true},
         "Look at moves on their way, too, and pass through nothing");
  v.group("Placing released objects");
  v.whole("place-attempts", o.placement.attempts, kAttempts, "Poses to try for a released object");
  v.real("place-lift", o.placement.most_lift, kMeters, "Highest lift out of a collision, meters");
  v.real("place-clearance", o.placement.clearance, kMeters, "Gap left below the object, meters");
  v.real("place-spread", o.placement.direction_spread, Within<float>{0, 4},
         "Half the range of random directions, radians");
  v.real("place-jitter", o.placement.jitter, kMeters, "Length of a jitter, in box diagonals");
}

/// The same for the robot's imperfections.
template <class Visitor>
void visitNoiseOptions(RobotNoise& n, Visitor& v) {
  constexpr Span kShare{0, 1};
  v.group("Noise of motion and localization (standard deviations, as shares of motions), delay");
  v.drawn("motion-noise", n.motion, kShare, "Of what the robot does in a step");
  v.drawn("motion-bias", n.motion_bias, kShare, "Of what it does in all steps of an episode");
  v.drawn("localization-noise", n.localization, kShare, "Of odometry, which tells it where it is");
  v.drawn("action-delay", n.action_delay, kMostActionDelay,
          "Steps until the robot does what it was asked to");
}

/// The same for what the robot senses.
template <class Visitor>
void visitSensorOptions(SensorOptions& s, Visitor& v) {
  LaserOptions& laser = s.laser;
  v.group("Sensors (below 0: as the robot's recipe says)");
  v.flag("bump", Switch{s.bump, true}, "Observe whether something blocked the last step");
  v.flag("target-goal", Switch{s.target_goal, true},
         "Observe the way from the target, where it is now, to the goal");
  v.flag("target-up", Switch{s.target_up, true},
         "Observe where that side of the target points that was up when the episode began");
  v.whole("near-objects", s.near_objects, Within<std::uint32_t>{0, kMostNearObjects},
          "Objects nearest to the hand to observe beside the target; 0: none");
  v.whole("laser-beams", laser.beams, Within<std::uint32_t>{0, 1024},
          "Beams of a planar laser scan; 0: none");
  v.real("laser-fov", laser.fov_degrees, Within<float>{kOfRobot, 360},
         "Field of view of the scan, degrees");
  v.heights("laser-heights", laser.heights, Span{0, 100},
            "Heights of the scans above the floor, or ranges of them, meters");
  v.real("laser-range", laser.range, Within<float>{kOfRobot, 1000}, "Farthest distance, meters");
  v.real("laser-min-range", laser.least_range, Within<float>{kOfRobot, 1000},
         "Nearest distance, meters");
  v.drawn("laser-noise", laser.noise, Span{kOfRobot, 10},
          "Standard deviation of a distance, meters");
  v.flag("geodesic", Switch{s.geodesic, true},
         "Observe the paths along the floor to target and goal");
  v.whole("geodesic-megabytes", s.geodesic_megabytes, Within<std::uint32_t>{1, 1U << 20U},
          "Most memory for these paths, MB");
  v.whole("last-actions", s.last_actions, Within<std::uint32_t>{0, kMostLastActions},
          "Steps whose actions to observe, the last ones; 0: none");
}

/// What a world may set about its task, its reward and what the robot does and senses: all options
/// but those of the batch.
template <class Visitor>
void visitWorldTask(SimulationOptions& options, Visitor& visitor) {
  visitTaskOptions(options.task, visitor);
  visitMotionOptions(options, visitor);
  visitNoiseOptions(options.noise, visitor);
  visitSensorOptions(options.sensors, visitor);
}

/// All options, in the order of recordings and reports.
template <class Visitor>
void visitOptions(SimulationOptions& options, Visitor& visitor) {
  visitBatchOptions(options, visitor);
  visitWorldTask(options, visitor);
}

}  // namespace galactic
