#include "dynamics/episodes/comparison.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "dynamics/episodes/inspection.h"
#include "dynamics/episodes/robot_driver.h"
#include "support/try.h"

namespace galactic::dynamics {
namespace {

/// The number of control steps in two seconds.
constexpr int kRestSteps = 60;
/// The length of an episode that the task does not end.
constexpr std::size_t kMostPolicySteps = 10'000;

float lengthOf(const Vec3& v) { return std::sqrt(dot(v, v)); }

/// The objects of an episode at these poses.
std::vector<PlacedObject> placed(const EpisodeTrace& trace, const ComparisonWorlds& worlds,
                                 const std::vector<Pose>& poses) {
  const EpisodeSet& set = worlds.world.episodes();
  const Episode& episode = set.episodes()[trace.episode];
  const auto placements = set.presentOf(episode, poses.size()).placements;
  std::vector<PlacedObject> objects;
  for (std::size_t n = 0; n < poses.size(); ++n) {
    const auto shape = worlds.sources.objects.find(worlds.world.objectOf(placements[n]).name);
    objects.push_back({shape->second, poses[n]});
  }
  return objects;
}

/// Whether a pose is finite: the engine may lose bodies that are pressed into others.
bool isKnown(const Pose& pose) {
  const auto& [x, y, z] = pose.translation;
  const auto& [i, j, k, w] = pose.rotation;
  return std::isfinite(x + y + z + i + j + k + w);
}

/// Whether all poses are finite.
bool isAllKnown(const FollowedState& state) {
  const auto is_known = [](const Pose& pose) { return isKnown(pose); };
  return isKnown(state.world_from_root) && std::ranges::all_of(state.objects, is_known) &&
         std::ranges::all_of(state.joint_positions, [](float p) { return std::isfinite(p); });
}

/// One episode in both worlds.
class Comparison {
 public:
  Comparison(const EpisodeTrace& trace, EpisodeLane& lane, const ComparisonWorlds& worlds)
      : trace_(trace),
        lane_(lane),
        worlds_(worlds),
        scene_(worlds.sources.scenes.find(worlds.world.scenes()[trace.scene].name())->second),
        objects_(placed(trace, worlds, trace.start_objects)),
        bodies_(bodiesOf(worlds.sources.robot, worlds.world.robot(), trace.start_positions)),
        was_held_(objects_.size()) {
    result_.env = trace.env;
    result_.episode = trace.episode;
    result_.end = trace.end;
    result_.steps = static_cast<std::uint32_t>(trace.steps.size());
  }

  Result<EpisodeComparison> run(const ActionSource& actions_of, const StepWatcher& watch) {
    Inspection(trace_, worlds_.world, worlds_.simulation, scene_, objects_, setup()).run(result_);
    RETURN_IF_ERROR(playDynamics(actions_of, watch));
    restAll();
    return std::move(result_);
  }

 private:
  [[nodiscard]] RobotSetup setup() const {
    return {.robot = worlds_.world.robot(),
            .shape = worlds_.sources.robot_shape,
            .bodies = bodies_,
            .world_from_root = trace_.start_root,
            .positions = trace_.start_positions};
  }

  Result<void> playDynamics(const ActionSource& actions_of, const StepWatcher& watch) {
    DynamicsWorld dynamics(scene_, objects_, worlds_.options);
    dynamics.addRobot(setup());
    RobotDriver driver(worlds_.world.robot(), dynamics, worlds_.simulation);
    WorldReading reading;
    lane_.begin(trace_.episode, worlds_.options.arm);
    if (watch) watch(lane_.simulator(), {});
    for (std::size_t n = 0; !lane_.isDone(); ++n) {
      ASSIGN_OR_RETURN(const auto actions, actions_of(n));
      if (actions.empty()) break;
      const DrivenStep driven = driver.step(actions);
      if (driven.grasped) was_held_[*driven.grasped] = true;
      const FollowedState now = reading.read(dynamics, driven, objects_.size());
      // The simulation cannot follow such a state: the episode ends without success.
      if (!isAllKnown(now)) break;
      lane_.follow(actions, now);
      if (watch) watch(lane_.simulator(), actions);
      compare(n, dynamics, driver);
    }
    finish(dynamics);
    return {};
  }

  void compare(std::size_t n, const DynamicsWorld& dynamics, const RobotDriver& driver) {
    ++result_.steps_in_dynamics;
    const std::vector<float> positions = dynamics.positions();
    const Robot& robot = worlds_.world.robot();
    for (const ControlledJoint& joint : robot.controlledJoints()) {
      const auto miss = static_cast<double>(
          std::abs(positions[joint.position] - driver.targets()[joint.position]));
      result_.tracking_sum += miss;
      result_.tracking_worst = std::max(result_.tracking_worst, miss);
    }
    if (n >= trace_.steps.size()) return;
    const TracedStep& simulated = trace_.steps[n];
    const Vec3 base = dynamics.worldFromRoot().translation - simulated.world_from_root.translation;
    result_.base_gap.push_back(std::hypot(base.x, base.z));
    const Pose grip = gripOf(robot, simulated.world_from_root, simulated.positions);
    result_.grip_gap.push_back(lengthOf(driver.worldFromGrip().translation - grip.translation));
    if (!result_.parted && simulated.held != dynamics.held()) {
      result_.parted = static_cast<std::uint32_t>(n);
    }
  }

  /// Records how the episode ended, and the state two seconds later.
  void finish(DynamicsWorld& dynamics) {
    result_.end_in_dynamics = lane_.end();
    result_.picked_in_dynamics = was_held_[trace_.target];
    for (int n = 0; n < kRestSteps; ++n) dynamics.step();
    result_.success_settled = result_.succeedsInDynamics() && stillSucceeds(dynamics);
    for (std::size_t n = 0; n < objects_.size(); ++n) {
      const Vec3 way =
          dynamics.objectPose(n).translation - objects_[n].world_from_object.translation;
      // Written so that it is also true for NaN, if the engine lost the object.
      if (!was_held_[n] && !(lengthOf(way) <= kDisturbed)) ++result_.disturbed;
    }
  }

  [[nodiscard]] bool stillSucceeds(const DynamicsWorld& dynamics) const {
    const TaskOptions& task = worlds_.simulation.task;
    const bool holds = dynamics.held() == trace_.target;
    if (task.kind == TaskKind::kMobilePick) return holds;
    const Vec3 away = dynamics.objectPose(trace_.target).translation - trace_.goal.translation;
    return !holds && lengthOf(away) < task.success_distance;
  }

  /// Releases each object where the simulation put it, among the others and without the robot, and
  /// waits. An object that the engine loses keeps its last known pose.
  void restAll() {
    std::vector<PlacedObject> objects = objects_;
    for (const TracedRelease& release : trace_.releases) {
      objects[release.object].world_from_object = release.world_from_object;
      DynamicsWorld dynamics(scene_, objects, worlds_.options);
      for (std::size_t n = 0; n < objects.size(); ++n) {
        if (n != release.object) dynamics.sleep(n);
      }
      const Pose& put = release.world_from_object;
      Pose now = put;
      for (int n = 0; n < kRestSteps; ++n) {
        dynamics.step();
        const Pose next = dynamics.objectPose(release.object);
        if (!isKnown(next)) break;
        now = next;
      }
      const Vec3 up = rotate(now.rotation * conjugate(put.rotation), {0, 1, 0});
      result_.rests.push_back({.displacement = lengthOf(now.translation - put.translation),
                               .lean = std::acos(std::clamp(up.y, -1.0F, 1.0F)),
                               .drop = put.translation.y - now.translation.y,
                               .step = static_cast<std::uint32_t>(release.step),
                               .world_from_object = now});
    }
  }

  const EpisodeTrace& trace_;
  EpisodeLane& lane_;
  const ComparisonWorlds& worlds_;
  std::shared_ptr<const SceneShape> scene_;
  std::vector<PlacedObject> objects_;
  std::vector<RobotBody> bodies_;
  std::vector<bool> was_held_;
  EpisodeComparison result_;
};

}  // namespace

std::uint32_t EpisodeComparison::inventedSteps() const {
  std::uint32_t sum = 0;
  for (const auto& [cause, count] : invented) sum += count;
  return sum;
}

ActionSource recordedActions(const EpisodeTrace& trace) {
  return [&trace](std::size_t step) -> Result<std::span<const float>> {
    if (step >= trace.steps.size()) return std::span<const float>();
    return std::span<const float>(trace.steps[step].actions);
  };
}

ActionSource policyActions(EpisodeLane& lane) {
  return [&lane](std::size_t step) -> Result<std::span<const float>> {
    if (step >= kMostPolicySteps) return std::span<const float>();
    return lane.act();
  };
}

Result<EpisodeComparison> compareEpisode(const EpisodeTrace& trace, EpisodeLane& lane,
                                         const ComparisonWorlds& worlds,
                                         const ActionSource& actions, const StepWatcher& watch) {
  return Comparison(trace, lane, worlds).run(actions, watch);
}

Result<EpisodeTrace> traceOf(std::uint32_t episode, EpisodeLane& lane) {
  lane.begin(episode, ArmDrive::kKinematic);
  const BatchSimulator& simulator = lane.simulator();
  EpisodeTrace trace = beginTrace(0, simulator.envState(0));
  const ActionSource actions_of = policyActions(lane);
  while (!lane.isDone()) {
    const SimulationStatistics before = simulator.statistics(0);
    ASSIGN_OR_RETURN(const auto actions, actions_of(trace.steps.size()));
    if (actions.empty()) break;
    lane.step(actions);
    extendTrace(trace, actions, simulator.envState(0), before, simulator.statistics(0));
  }
  trace.end = lane.end();
  return trace;
}

}  // namespace galactic::dynamics
