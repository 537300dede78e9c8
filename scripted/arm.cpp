#include "scripted/arm.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace galactic::scripted {
namespace {

constexpr float kPi = 3.14159265F;

/// Whether positions that differ by a full turn are the same to the simulation: a continuous joint
/// without limits, and no joint that follows it slides or turns by a fraction of its turn.
bool isPeriodic(const Robot& robot, const ControlledJoint& joint) {
  constexpr float kUnlimited = std::numeric_limits<float>::max();
  if (joint.lower > -kUnlimited || joint.upper < kUnlimited) return false;
  bool is_continuous = false;
  for (const LinkFrame& link : robot.links()) {
    if (link.position != static_cast<std::int32_t>(joint.position)) continue;
    const bool turns = link.type == JointType::kContinuous || link.type == JointType::kRevolute;
    if (!turns || link.multiplier != std::round(link.multiplier)) return false;
    is_continuous = is_continuous || link.type == JointType::kContinuous;
  }
  return is_continuous;
}

}  // namespace

Arm::Arm(const Robot& robot)
    : robot_(&robot), self_collision_(robot), links_(robot.links().size()) {
  joints_.reserve(robot.controlledJoints().size());
  for (const ControlledJoint& joint : robot.controlledJoints()) {
    joints_.push_back(
        {joint.position, joint.step, joint.lower, joint.upper, isPeriodic(robot, joint)});
  }
  const std::span<const LinkFrame> links = robot.links();
  for (auto link = static_cast<std::int32_t>(robot.endEffector()->link); link >= 0;
       link = links[static_cast<std::size_t>(link)].parent) {
    const auto index = static_cast<std::size_t>(link);
    for (std::size_t joint = 0; joint < joints_.size(); ++joint) {
      const bool moves =
          links[index].type != JointType::kFixed &&
          links[index].position == static_cast<std::int32_t>(joints_[joint].position);
      if (moves) movers_.push_back({index, joint});
    }
  }
  joinTelescopes();
}

void Arm::joinTelescopes() {
  for (std::uint32_t joint = 0; joint < joints_.size(); ++joint) joints_[joint].leader = joint;
  // Cosine of the largest angle between two slides that count as parallel: URDFs round their
  // rotations.
  constexpr float kParallel = 0.9999F;
  const std::span<const Pose> links = placeLinks(robot_->startPositions());
  const auto slide_of = [&](const Mover& mover) {
    const LinkFrame& link = robot_->links()[mover.link];
    return rotate(links[mover.link].rotation, link.axis) * link.multiplier;
  };
  // From the hand to the root.
  const Mover* last = nullptr;
  for (const Mover& mover : movers_) {
    const bool slides = robot_->links()[mover.link].type == JointType::kPrismatic;
    const bool goes_on = slides && last != nullptr && last->joint != mover.joint &&
                         dot(slide_of(*last), slide_of(mover)) > kParallel;
    if (goes_on) {
      const std::uint32_t old = joints_[last->joint].leader;
      const auto leader = std::min(old, static_cast<std::uint32_t>(mover.joint));
      for (ArmJoint& joint : joints_) {
        if (joint.leader == old || joint.leader == mover.joint) joint.leader = leader;
      }
    }
    last = slides ? &mover : nullptr;
  }
}

void Arm::draw(RandomStream& random, Joints& positions) const {
  for (std::size_t n = 0; n < joints_.size(); ++n) {
    const ArmJoint& joint = joints_[n];
    const ArmJoint& leader = joints_[joint.leader];
    float share = 0;
    if (joint.leader == n) {
      share = random.unit();
    } else if (leader.upper > leader.lower) {
      share = (positions[leader.position] - leader.lower) / (leader.upper - leader.lower);
    }
    const bool winds = joint.wraps || joint.upper - joint.lower > 2 * kFullTurn;
    const float lower = winds ? std::max(joint.lower, -kPi) : joint.lower;
    const float upper = winds ? std::min(joint.upper, kPi) : joint.upper;
    positions[joint.position] = lower + share * (upper - lower);
  }
}

std::span<const Pose> Arm::placeLinks(std::span<const float> positions) {
  forwardKinematics(robot_->links(), {}, positions, links_);
  return links_;
}

Pose Arm::gripOf(std::span<const Pose> links) const {
  const EndEffector& hand = *robot_->endEffector();
  return links[hand.link] * Pose{hand.grasp_point, {}};
}

void Arm::columns(std::span<const Pose> links, std::span<Column> out) const {
  std::ranges::fill(out, Column{});
  for (const Mover& mover : movers_) {
    const LinkFrame& link = robot_->links()[mover.link];
    const Pose& pose = links[mover.link];
    const Vec3 axis = rotate(pose.rotation, link.axis) * link.multiplier;
    Column& column = out[mover.joint];
    if (link.type == JointType::kPrismatic) {
      column.slide = column.slide + axis;
    } else {
      column.turn = column.turn + axis;
      column.origin = pose.translation;
    }
  }
}

float Arm::difference(std::size_t joint, std::span<const float> from,
                      std::span<const float> to) const {
  const ArmJoint& arm_joint = joints_[joint];
  const float way = to[arm_joint.position] - from[arm_joint.position];
  return arm_joint.wraps ? wrappedAngle(way) : way;
}

float Arm::distance(std::span<const float> from, std::span<const float> to) const {
  float most = 0;
  for (std::size_t joint = 0; joint < joints_.size(); ++joint) {
    most = std::max(most, std::fabs(difference(joint, from, to)));
  }
  return most;
}

float Arm::actionsBetween(std::span<const float> from, std::span<const float> to) const {
  float most = 0;
  for (std::size_t joint = 0; joint < joints_.size(); ++joint) {
    const float way = std::fabs(difference(joint, from, to));
    if (way > 0 && joints_[joint].step > 0) most = std::max(most, way / joints_[joint].step);
  }
  return most;
}

void Arm::interpolate(std::span<const float> from, std::span<const float> to, float share,
                      Joints& out) const {
  out.assign(from.begin(), from.end());
  for (std::size_t joint = 0; joint < joints_.size(); ++joint) {
    out[joints_[joint].position] += share * difference(joint, from, to);
  }
}

void Arm::move(std::size_t joint, float by, Joints& positions) const {
  const ArmJoint& arm_joint = joints_[joint];
  float& position = positions[arm_joint.position];
  position = arm_joint.wraps ? wrappedAngle(position + by)
                             : std::clamp(position + by, arm_joint.lower, arm_joint.upper);
}

}  // namespace galactic::scripted
