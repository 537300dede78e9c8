#include "replay.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "robot_driver.h"

namespace galactic::dynamics {
namespace {

/// Control steps of two seconds.
constexpr int kRestSteps = 60;
/// A contact of less says nothing about what hindered a motion, meters.
constexpr float kTouch = 0.001F;

float lengthOf(const Vec3& v) { return std::sqrt(dot(v, v)); }

/// The objects of an episode at these poses.
std::vector<PlacedObject> placed(const EpisodeTrace& trace, const World& world,
                                 const Sources& sources, const std::vector<Pose>& poses) {
  const EpisodeSet& set = world.episodes();
  const auto placements = set.placements(set.episodes()[trace.episode]);
  std::vector<PlacedObject> objects;
  for (std::size_t n = 0; n < poses.size(); ++n) {
    // Without distractors the target alone is there.
    const Placement& placement = poses.size() == placements.size()
                                     ? placements[n]
                                     : placements[set.episodes()[trace.episode].target];
    const auto shape = sources.objects.find(world.objectOf(placement).name);
    objects.push_back({shape->second, poses[n]});
  }
  return objects;
}

/// What one replay is made of.
class Replay {
 public:
  Replay(const EpisodeTrace& trace, const World& world, const SimulationOptions& simulation,
         const Sources& sources, const WorldOptions& options)
      : trace_(trace),
        world_(world),
        simulation_(simulation),
        sources_(sources),
        options_(options),
        scene_(sources.scenes.find(world.scenes()[trace.scene].name())->second),
        objects_(placed(trace, world, sources, trace.start_objects)),
        bodies_(bodiesOf(sources.robot, world.robot(), trace.start_positions)),
        probe_(scene_, objects_, setup()) {
    result_.env = trace.env;
    result_.episode = trace.episode;
    result_.end = trace.end;
  }

  EpisodeReplay play() {
    DynamicsWorld there(scene_, objects_, options_);
    there.addRobot(setup());
    RobotDriver driver(world_.robot(), there, simulation_);
    was_held_.assign(objects_.size(), false);
    for (std::size_t n = 0; n < trace_.steps.size(); ++n) {
      const DrivenStep driven = driver.step(trace_.steps[n].actions);
      if (driven.grasped) was_held_[*driven.grasped] = true;
      compare(trace_.steps[n], there, driver);
      inspect(n);
    }
    result_.picked_there = was_held_[trace_.target];
    result_.success_there = succeeds(there);
    for (int n = 0; n < kRestSteps; ++n) there.step();
    result_.success_settled = result_.success_there && succeeds(there);
    countDisturbed(there);
    restAll();
    return std::move(result_);
  }

 private:
  [[nodiscard]] RobotSetup setup() const {
    return {.robot = world_.robot(),
            .shape = sources_.robot_shape,
            .bodies = bodies_,
            .world_from_root = trace_.start_root,
            .positions = trace_.start_positions};
  }

  void compare(const TracedStep& here, const DynamicsWorld& there, const RobotDriver& driver) {
    const Vec3 base = there.worldFromRoot().translation - here.world_from_root.translation;
    result_.base_gap.push_back(std::hypot(base.x, base.z));
    const Pose grip = gripOf(world_.robot(), here.world_from_root, here.positions);
    result_.grip_gap.push_back(lengthOf(driver.worldFromGrip().translation - grip.translation));
    const std::vector<float> positions = there.positions();
    for (const ControlledJoint& joint : world_.robot().controlledJoints()) {
      const auto miss = static_cast<double>(
          std::abs(positions[joint.position] - driver.targets()[joint.position]));
      result_.tracking_sum += miss;
      result_.tracking_worst = std::max(result_.tracking_worst, miss);
    }
  }

  /// What the simulation says of step `n`, against triangles and hulls.
  void inspect(std::size_t n) {
    const TracedStep& step = trace_.steps[n];
    if ((step.was_refused || step.has_slid) && !heldBefore(n)) {
      ++result_.hindered;
      const auto touched = wanted(n);
      const float ground = groundUnder(step.world_from_root);
      const auto touches = [&](const RobotContact& c) { return counts(c, kTouch, ground); };
      result_.invented += std::ranges::none_of(touched, touches) ? 1U : 0U;
    }
    takeReleases(n);
    bool leaves = false;
    bool misses = false;
    for (const RobotContact& contact :
         probe_.contacts(step.world_from_root, step.positions, step.held)) {
      leaves = leaves || (leaving_ && contact.object == static_cast<int>(*leaving_));
      if (!counts(contact, kTolerance, groundUnder(step.world_from_root))) continue;
      misses = true;
      ++result_.missed[{contact.link, contact.object < 0 ? Thing::kScene : Thing::kObject}];
    }
    if (misses) ++result_.missed_steps;
    if (!leaves) leaving_.reset();
  }

  [[nodiscard]] bool heldBefore(std::size_t n) const {
    return n > 0 && trace_.steps[n - 1].held.has_value();
  }
  /// Up to which height the scene is ground for a base that stands there.
  [[nodiscard]] float groundUnder(const Pose& world_from_root) const {
    return world_from_root.translation.y - world_.robot().base()->root_height +
           simulation_.ground.most_rise;
  }
  [[nodiscard]] bool counts(const RobotContact& contact, float depth, float ground) const {
    const bool is_left = leaving_ && contact.object == static_cast<int>(*leaving_);
    if (contact.object < 0 && isGround(contact.point, contact.away, ground)) return false;
    return contact.depth > depth && !is_left;
  }

  /// The contacts of the pose that the action of step `n` asked for.
  [[nodiscard]] std::vector<RobotContact> wanted(std::size_t n) const {
    const Robot& robot = world_.robot();
    Pose root = n == 0 ? trace_.start_root : trace_.steps[n - 1].world_from_root;
    std::vector<float> positions = n == 0 ? trace_.start_positions : trace_.steps[n - 1].positions;
    applyActions(robot, trace_.steps[n].actions, root, positions);
    return probe_.contacts(root, positions, {});
  }

  void takeReleases(std::size_t n) {
    for (const TracedRelease& release : trace_.releases) {
      if (release.step != n) continue;
      probe_.moveObject(release.object, release.world_from_object);
      leaving_ = release.object;
    }
  }

  /// By the simulation's rules, of what is there now.
  [[nodiscard]] bool succeeds(const DynamicsWorld& there) const {
    const TaskOptions& task = simulation_.task;
    const bool holds = there.held() == trace_.target;
    if (task.kind == TaskKind::kMobilePick) return holds;
    const std::size_t terminate = world_.robot().controlledJoints().size() + 3;
    const bool has_ended = !task.needs_terminate ||
                           trace_.steps.back().actions[terminate] >= simulation_.action.terminate;
    const Vec3 away = there.objectPose(trace_.target).translation - trace_.goal.translation;
    return task.kind == TaskKind::kRearrange && has_ended && !holds && result_.picked_there &&
           lengthOf(away) < task.success_distance;
  }

  void countDisturbed(const DynamicsWorld& there) {
    for (std::size_t n = 0; n < objects_.size(); ++n) {
      const Vec3 way = there.objectPose(n).translation - objects_[n].world_from_object.translation;
      if (!was_held_[n] && lengthOf(way) > kDisturbed) ++result_.disturbed;
    }
  }

  /// Lets each released object go where the simulation put it, among the others and without the
  /// robot.
  void restAll() {
    std::vector<PlacedObject> objects = objects_;
    for (const TracedRelease& release : trace_.releases) {
      objects[release.object].world_from_object = release.world_from_object;
      DynamicsWorld there(scene_, objects, options_);
      for (int n = 0; n < kRestSteps; ++n) there.step();
      const Pose& put = release.world_from_object;
      const Pose now = there.objectPose(release.object);
      const Vec3 up = rotate(now.rotation * conjugate(put.rotation), {0, 1, 0});
      result_.rests.push_back({.displacement = lengthOf(now.translation - put.translation),
                               .lean = std::acos(std::clamp(up.y, -1.0F, 1.0F)),
                               .drop = put.translation.y - now.translation.y});
    }
  }

  const EpisodeTrace& trace_;
  const World& world_;
  const SimulationOptions& simulation_;
  const Sources& sources_;
  const WorldOptions& options_;
  std::shared_ptr<const SceneShape> scene_;
  std::vector<PlacedObject> objects_;
  std::vector<RobotBody> bodies_;
  ContactProbe probe_;
  std::vector<bool> was_held_;
  /// An object that the hand let go of and has not left.
  std::optional<std::size_t> leaving_;
  EpisodeReplay result_;
};

}  // namespace

EpisodeReplay replay(const EpisodeTrace& trace, const World& world,
                     const SimulationOptions& simulation, const Sources& sources,
                     const WorldOptions& options) {
  return Replay(trace, world, simulation, sources, options).play();
}

}  // namespace galactic::dynamics
