#include "dynamics/episodes/robot_driver.h"

#include <algorithm>
#include <cmath>

namespace galactic::dynamics {
namespace {

float clamped(float action) { return std::isnan(action) ? 0.0F : std::clamp(action, -1.0F, 1.0F); }

/// The motion of the base that the actions ask for.
BaseMotion baseMotionOf(const Robot& robot, std::span<const float> actions) {
  const RobotBase& base = *robot.base();
  const ActionLayout layout = ActionLayout::of(robot);
  BaseMotion motion{.forward = base.forward_step * clamped(actions[layout.forward()]),
                    .turn = base.turn_step * clamped(actions[layout.turn()])};
  if (layout.drives_sideways) {
    motion.left = base.sideways_step * clamped(actions[layout.sideways()]);
  }
  return motion;
}

/// Turns, then drives along the new heading.
void moveBase(const BaseMotion& motion, Pose& world_from_root) {
  world_from_root.rotation = rotationOfYaw(-motion.turn) * world_from_root.rotation;
  world_from_root.translation = world_from_root.translation +
                                rotate(world_from_root.rotation, {motion.forward, 0, -motion.left});
}

/// The motion along the ground that ends a contact; its length is the depth of the contact. Zero if
/// the way out is not along the ground.
Vec3 pushOut(const DynamicsWorld::BaseContact& contact) {
  const float length = std::hypot(contact.away.x, contact.away.z);
  constexpr float kNoDirection = 1e-6F;
  return length > kNoDirection ? contact.away * (contact.depth / length) : Vec3{};
}

}  // namespace

Pose gripOf(const Robot& robot, const Pose& world_from_root, std::span<const float> positions) {
  std::vector<Pose> world_from_link(robot.links().size());
  forwardKinematics(robot.links(), world_from_root, positions, world_from_link);
  const EndEffector& hand = *robot.endEffector();
  return world_from_link[hand.link] * Pose{hand.grasp_point, {}};
}

void moveJoints(const Robot& robot, std::span<const float> actions, std::span<float> positions) {
  const std::span<const ControlledJoint> joints = robot.controlledJoints();
  for (std::size_t n = 0; n < joints.size(); ++n) {
    float& position = positions[joints[n].position];
    position = std::clamp(position + joints[n].step * clamped(actions[n]), joints[n].lower,
                          joints[n].upper);
  }
}

void applyActions(const Robot& robot, std::span<const float> actions, Pose& world_from_root,
                  std::span<float> positions) {
  moveJoints(robot, actions, positions);
  moveBase(baseMotionOf(robot, actions), world_from_root);
}

RobotDriver::RobotDriver(const Robot& robot, DynamicsWorld& world, const SimulationOptions& options)
    : robot_(robot), world_(world), options_(options), targets_(world.positions()) {}

DrivenStep RobotDriver::step(std::span<const float> actions) {
  moveJoints(robot_, actions, targets_);
  const std::optional<Pose> root = clearOf(driveBase(actions));
  if (!root) speed_ = {};
  world_.drive(root.value_or(world_.worldFromRoot()), targets_);
  world_.step();
  DrivenStep step{.base_refused = !root, .grasped = {}, .released = {}};
  useHand(clamped(actions[ActionLayout::of(robot_).hand()]), step);
  return step;
}

Pose RobotDriver::worldFromGrip() const {
  return gripOf(robot_, world_.worldFromRoot(), world_.positions());
}

Pose RobotDriver::driveBase(std::span<const float> actions) {
  const BaseMotion asked = baseMotionOf(robot_, actions);
  Pose root = world_.worldFromRoot();
  const WorldOptions& options = world_.options();
  if (options.base == BaseDrive::kKinematic) {
    moveBase(asked, root);
    return root;
  }
  const auto substep = static_cast<float>(options.substep);
  const auto gain = static_cast<float>(options.base_gain);
  const float seconds = substep * static_cast<float>(options.substeps);
  for (std::uint32_t n = 0; n < options.substeps; ++n) {
    const auto follow = [&](float& speed, float motion) {
      speed += gain * (motion / seconds - speed);
    };
    follow(speed_.forward, asked.forward);
    follow(speed_.turn, asked.turn);
    follow(speed_.left, asked.left);
    moveBase({speed_.forward * substep, speed_.turn * substep, speed_.left * substep}, root);
  }
  return root;
}

std::optional<Pose> RobotDriver::clearOf(Pose root) const {
  for (std::uint32_t attempt = 0; attempt <= options_.slide.attempts; ++attempt) {
    const std::optional<Pose> standing = onFloor(root);
    if (!standing) return std::nullopt;
    const DynamicsWorld::BaseContact contact =
        world_.baseContact(*standing, standing->translation.y - robot_.base()->root_height +
                                          options_.ground.most_rise);
    if (contact.depth <= kTolerance) return standing;
    const Vec3 push = pushOut(contact);
    if (push == Vec3{}) return std::nullopt;
    root.translation = root.translation + push;
  }
  return std::nullopt;
}

std::optional<Pose> RobotDriver::onFloor(const Pose& world_from_root) const {
  const GroundOptions& ground = options_.ground;
  const float height = robot_.base()->root_height;
  Pose standing = world_from_root;
  const float now = world_.worldFromRoot().translation.y - height;
  const Vec3 above{standing.translation.x, now + ground.most_rise, standing.translation.z};
  const std::optional<float> floor = world_.floorBelow(above, ground.most_rise + ground.most_drop);
  if (!floor) return std::nullopt;
  standing.translation.y = *floor + height;
  return standing;
}

void RobotDriver::useHand(float value, DrivenStep& step) {
  const EndEffector& hand = *robot_.endEffector();
  if (!world_.held() && value >= options_.action.grasp) {
    step.grasped = world_.objectWithin(worldFromGrip().translation, hand.grasp_radius);
    if (step.grasped) world_.grasp(*step.grasped, hand.link);
  } else if (world_.held() && value < options_.action.release) {
    step.released = world_.held();
    world_.release();
  }
}

}  // namespace galactic::dynamics
