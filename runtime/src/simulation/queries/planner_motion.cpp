#include "simulation/queries/planner_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "galactic/kinematics.h"
#include "galactic/robot.h"
#include "simulation/collision/collision.h"
#include "simulation/motion/motion_model.h"

namespace galactic::simulation {
namespace {

/// The most that base and joints together may turn from one place of a motion to the next, radians,
/// so that the arcs of spheres are hardly longer than straight lines.
constexpr double kMostTurn = 0.5;
/// The next place is aimed to be this far away, in radii: a bit less than allowed, because ways are
/// curved.
constexpr double kAimedMove = 0.9;
/// Places of a motion nearer to each other than this share of the way are the same up to rounding.
constexpr double kLeastShare = 1e-9;
/// Floors whose heights differ by less than this are the same, meters.
constexpr float kSameFloor = 1e-3F;

/// For each joint position, whether it moves the shorter way round.
std::vector<bool> wrapsOf(const Robot& robot) {
  constexpr float kUnlimited = std::numeric_limits<float>::max();
  std::vector<PositionLimits> limits(robot.limits().begin(), robot.limits().end());
  for (const ControlledJoint& joint : robot.controlledJoints()) {
    limits[joint.position] = {joint.lower, joint.upper};
  }
  std::vector<bool> wraps(limits.size());
  for (std::uint32_t n = 0; n < limits.size(); ++n) {
    const bool is_limited = limits[n].lower > -kUnlimited || limits[n].upper < kUnlimited;
    wraps[n] = !is_limited && isPeriodic(robot, n);
  }
  return wraps;
}

}  // namespace

PlannerMotion::PlannerMotion(const Robot& robot)
    : wraps_(wrapsOf(robot)), joints_(robot.positionCount()) {}

bool PlannerMotion::isFree(PlannerEnv& env, const RobotPose& from, const RobotPose& to) {
  env_ = &env;
  from_ = from;
  to_ = to;
  turn_ = wrappedAngle(to.base.yaw - from.base.yaw);
  most_share_ = std::min(1.0, kMostTurn / std::max(kMostTurn, wholeTurn()));
  robot_before_ = env.robot_;
  held_before_ = env.held_spheres_;
  ignored_ = env.ignored_;
  left_ = env.left_;
  const bool is_free = walk();
  env.ignored_ = ignored_;
  env.left_ = left_;
  if (env.has_joints_) env.assemble(env.joints_);
  return is_free;
}

bool PlannerMotion::walk() {
  const std::optional<float> first = env_->floorAt(from_.base.position);
  const std::optional<float> last = env_->floorAt(to_.base.position);
  if (!first || !last) return false;
  // Check the end first, because it is the most likely to be blocked.
  putTo(1);
  base_.position.y = *last;
  if (!env_->isFree(base_)) return false;
  putTo(0);
  base_.position.y = *first;
  climbed_from_ = base_.position;
  if (!arrives()) return false;
  share_ = 0;
  next_ = most_share_;
  while (share_ < 1) {
    const Vec3 before = base_.position;
    if (!goTo(std::min(1.0, share_ + next_))) return false;
    if (!followFloor(before) || !arrives()) return false;
  }
  return std::fabs(base_.position.y - *last) < kSameFloor;
}

double PlannerMotion::wholeTurn() const {
  double sum = std::fabs(static_cast<double>(turn_));
  for (const LinkFrame& link : env_->world().robot().links()) {
    const bool turns = link.type != JointType::kFixed && link.type != JointType::kPrismatic;
    if (!turns || link.position < 0) continue;
    const auto first = static_cast<std::size_t>(link.position);
    for (std::size_t n = first; n < first + positionCount(link.type); ++n) {
      sum += std::fabs(static_cast<double>(link.multiplier * wayOf(n)));
    }
  }
  return sum;
}

float PlannerMotion::wayOf(std::size_t position) const {
  const float way = to_.joints[position] - from_.joints[position];
  return wraps_[position] ? wrappedAngle(way) : way;
}

void PlannerMotion::putTo(double share) {
  const auto part = static_cast<float>(share);
  for (std::size_t n = 0; n < joints_.size(); ++n) joints_[n] = from_.joints[n] + part * wayOf(n);
  env_->assemble(joints_);
  const Vec3 way = to_.base.position - from_.base.position;
  base_.position.x = from_.base.position.x + part * way.x;
  base_.position.z = from_.base.position.z + part * way.z;
  base_.yaw = from_.base.yaw + part * turn_;
}

bool PlannerMotion::goTo(double share) {
  const SphereBatch robot = env_->robotAt(base_);
  std::swap(env_->robot_, robot_before_);
  SphereBatch held;
  if (env_->isHolding()) {
    held = env_->heldAt(base_);
    std::swap(env_->held_spheres_, held_before_);
  }
  for (;;) {
    putTo(share);
    float move = farthestMove(robot, env_->robotAt(base_));
    if (env_->isHolding()) move = std::max(move, farthestMove(held, env_->heldAt(base_)));
    const double longer = kAimedMove / std::max(static_cast<double>(move), kAimedMove / 2);
    next_ = std::min(most_share_, (share - share_) * longer);
    if (move <= 1) break;
    if (next_ < kLeastShare) return false;
    share = share_ + next_;
  }
  share_ = share;
  return true;
}

bool PlannerMotion::followFloor(const Vec3& before) {
  if (base_.position.x == before.x && base_.position.z == before.z) return true;
  // The limits of rise and drop apply to each whole step of the simulation.
  const Vec3 gone = before - climbed_from_;
  const float step = env_->world().robot().base()->forward_step;
  if (gone.x * gone.x + gone.z * gone.z >= step * step) climbed_from_ = before;
  const std::optional<float> height = env_->floorAt(base_.position);
  if (!height) return false;
  base_.position.y = *height;
  const float rise = *height - climbed_from_.y;
  const GroundOptions& ground = env_->options().ground;
  return rise <= ground.most_rise && -rise <= ground.most_drop;
}

bool PlannerMotion::arrives() {
  if (!env_->isFree(base_)) return false;
  env_->countFree(base_);
  return true;
}

}  // namespace galactic::simulation
