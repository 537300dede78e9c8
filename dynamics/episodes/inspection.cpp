#include "dynamics/episodes/inspection.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "dynamics/episodes/robot_driver.h"

namespace galactic::dynamics {
namespace {

/// Shallower contacts do not explain what hindered a motion, meters.
constexpr float kTouch = 0.001F;
/// A robot that moves less than this cannot pass through anything on the way, meters.
constexpr float kPasses = 2 * kTolerance;

float distanceOf(const Vec3& a, const Vec3& b) {
  const Vec3 way = a - b;
  return std::sqrt(dot(way, way));
}

/// The distance of `point` from the nearest sphere of the robot, meters; negative inside.
float outsideSpheres(const Robot& robot, std::span<const Pose> world_from_link, const Vec3& point) {
  float least = std::numeric_limits<float>::max();
  for (const SphereGroup& group : robot.groups()) {
    const Pose& world_from_group = world_from_link[group.link];
    for (const SetSphere& sphere : group.spheres) {
      const Vec3 center = world_from_group * sphere.center;
      least = std::min(least, distanceOf(center, point) - robot.radii()[sphere.radius_index]);
    }
  }
  return least;
}

/// Positions halfway between two others. The simulation keeps the angle of a continuous joint
/// within one turn, so such a joint goes the shorter way around.
std::vector<float> halfWay(const Robot& robot, std::span<const float> from,
                           std::span<const float> to) {
  std::vector<float> ways(from.size());
  for (std::size_t n = 0; n < ways.size(); ++n) ways[n] = to[n] - from[n];
  for (const LinkFrame& link : robot.links()) {
    if (link.type != JointType::kContinuous) continue;
    float& way = ways[static_cast<std::size_t>(link.position)];
    way = wrappedAngle(way);
  }
  std::vector<float> middle(from.begin(), from.end());
  for (std::size_t n = 0; n < middle.size(); ++n) middle[n] += 0.5F * ways[n];
  return middle;
}

}  // namespace

Inspection::Inspection(const EpisodeTrace& trace, const World& world,
                       const SimulationOptions& simulation, std::shared_ptr<const SceneShape> scene,
                       std::span<const PlacedObject> objects, const RobotSetup& setup)
    : trace_(trace),
      world_(world),
      simulation_(simulation),
      probe_(std::move(scene), objects, setup),
      planning_(world, simulation),
      world_from_link_(world.robot().links().size()) {}

void Inspection::run(EpisodeComparison& result) {
  for (std::size_t step = 0; step < trace_.steps.size(); ++step) inspect(step, result);
}

void Inspection::inspect(std::size_t step, EpisodeComparison& result) {
  const TracedStep& now = trace_.steps[step];
  const bool was_held = step > 0 && trace_.steps[step - 1].held.has_value();
  if ((now.was_refused || now.has_slid) && !was_held) judgeHindered(step, result);
  takeReleases(step);
  judgeMissed(step, result);
}

Inspection::RobotPose Inspection::before(std::size_t step) const {
  if (step == 0) return {trace_.start_root, trace_.start_positions};
  return {trace_.steps[step - 1].world_from_root, trace_.steps[step - 1].positions};
}

float Inspection::groundUnder(const Pose& world_from_root) const {
  return world_from_root.translation.y - world_.robot().base()->root_height +
         simulation_.ground.most_rise;
}

bool Inspection::counts(const RobotContact& contact, float depth, float ground) const {
  const bool is_left = leaving_ && contact.object == static_cast<int>(*leaving_);
  if (contact.object < 0 && isGround(contact.point, contact.away, ground)) return false;
  return contact.depth > depth && !is_left;
}

void Inspection::judgeHindered(std::size_t step, EpisodeComparison& result) {
  ++result.hindered;
  RobotPose wanted = before(step);
  applyActions(world_.robot(), trace_.steps[step].actions, wanted.world_from_root,
               wanted.positions);
  const auto touched = probe_.contacts(wanted.world_from_root, wanted.positions, {});
  const float ground = groundUnder(trace_.steps[step].world_from_root);
  const auto touches = [&](const RobotContact& c) { return counts(c, kTouch, ground); };
  if (std::ranges::none_of(touched, touches)) ++result.invented[inventedCauseOf(step, wanted)];
}

InventedCause Inspection::inventedCauseOf(std::size_t step, const RobotPose& wanted) {
  EnvState state;
  state.scene = trace_.scene;
  state.episode = trace_.episode;
  state.world_from_root = wanted.world_from_root;
  state.joint_positions = wanted.positions;
  state.objects = step == 0 ? trace_.start_objects : objectsAfter(trace_, step - 1);
  state.target = static_cast<std::uint32_t>(trace_.target);
  state.goal = trace_.goal;
  planning_.update(state);
  planning_.setJoints(wanted.positions);
  BasePlace base = planning_.baseOf(state);
  const auto floor = planning_.floorAt(base.position.x, base.position.z, base.position.y);
  if (!floor) return InventedCause::kFloor;
  base.position.y = *floor;
  return planning_.isRobotFreeOfScene(base) ? InventedCause::kObject : InventedCause::kScene;
}

void Inspection::takeReleases(std::size_t step) {
  for (const TracedRelease& release : trace_.releases) {
    if (release.step != step) continue;
    probe_.moveObject(release.object, release.world_from_object);
    leaving_ = release.object;
  }
}

void Inspection::judgeMissed(std::size_t step, EpisodeComparison& result) {
  const TracedStep& now = trace_.steps[step];
  const RobotPose pose{now.world_from_root, now.positions};
  const float ground = groundUnder(now.world_from_root);
  bool leaves = false;
  std::set<MissKey> missed;
  for (const RobotContact& contact :
       probe_.contacts(now.world_from_root, now.positions, now.held)) {
    leaves = leaves || (leaving_ && contact.object == static_cast<int>(*leaving_));
    if (!counts(contact, kTolerance, ground)) continue;
    const MissKey key{contact.link, contact.object < 0 ? Thing::kScene : Thing::kObject,
                      causeOf(contact, pose)};
    missed.insert(key);
    if (result.deepest && contact.depth <= result.deepest->depth) continue;
    result.deepest = {static_cast<std::uint32_t>(step), contact.depth, key};
  }
  for (const MissKey& key : missed) ++result.missed[key];
  if (!missed.empty()) ++result.missed_steps;
  if (!leaves) leaving_.reset();
  if (missed.empty() && !touched_before_) judgeBetween(step, result);
  touched_before_ = !missed.empty();
}

/// Checks the pose halfway between those before and after the step.
void Inspection::judgeBetween(std::size_t step, EpisodeComparison& result) {
  const Robot& robot = world_.robot();
  const TracedStep& now = trace_.steps[step];
  RobotPose pose = before(step);
  const Vec3 grip = gripOf(robot, pose.world_from_root, pose.positions).translation;
  const Vec3 next_grip = gripOf(robot, now.world_from_root, now.positions).translation;
  const Vec3& root = pose.world_from_root.translation;
  if (distanceOf(grip, next_grip) < kPasses &&
      distanceOf(root, now.world_from_root.translation) < kPasses) {
    return;
  }
  pose.world_from_root = between(pose.world_from_root, now.world_from_root, 0.5F);
  pose.positions = halfWay(robot, pose.positions, now.positions);
  const float ground = groundUnder(pose.world_from_root);
  std::set<MissKey> missed;
  for (const RobotContact& contact :
       probe_.contacts(pose.world_from_root, pose.positions, now.held)) {
    if (!counts(contact, kTolerance, ground)) continue;
    missed.insert(
        {contact.link, contact.object < 0 ? Thing::kScene : Thing::kObject, MissCause::kTunneled});
  }
  for (const MissKey& key : missed) ++result.missed[key];
  if (!missed.empty()) ++result.missed_steps;
}

/// The cause is a sphere gap if the contact vanishes without the part of the link that protrudes
/// from its spheres.
MissCause Inspection::causeOf(const RobotContact& contact, const RobotPose& pose) {
  forwardKinematics(world_.robot().links(), pose.world_from_root, pose.positions, world_from_link_);
  const float out = outsideSpheres(world_.robot(), world_from_link_, contact.on_robot);
  if (out > 0 && contact.depth - out <= kTolerance) return MissCause::kSphereGap;
  // An object's box encloses all of it, so a sphere inside must have been ignored.
  return contact.object < 0 ? MissCause::kColumnCell : MissCause::kLeaving;
}

}  // namespace galactic::dynamics
