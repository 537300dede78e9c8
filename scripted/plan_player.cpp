#include "scripted/plan_player.h"

#include <algorithm>
#include <cmath>

namespace galactic::scripted {
namespace {

/// If the base is this far from its planned place while the arm moves, it is off, meters and
/// radians.
constexpr float kOff = 5e-3F;
constexpr float kOffYaw = 5e-3F;
/// If the base is this far from the line of a drive, it is astray, meters: the surroundings there
/// are unchecked.
constexpr float kStray = 0.15F;
/// How far ahead on its line the base steers, meters.
constexpr float kLookAhead = 0.3F;
/// If the base's heading misses that point by less than kStraight, it drives straight on; by more
/// than kAskew, it turns before it drives, radians.
constexpr float kStraight = 5e-3F;
constexpr float kAskew = 0.2F;
/// If less than this fraction of an action is left, nothing is.
constexpr float kNothing = 1e-3F;
/// What may be left after the action that should have been the last, in actions: rough where later
/// steps correct it, fine where the hand has to be in its place.
constexpr float kRoughRest = 0.25F;
constexpr float kFineRest = 0.02F;
/// If this many actions make no progress, the robot is stuck.
constexpr int kMostVain = 2;
/// Joints that are at most kArrived actions from where they were asked to be have arrived. While
/// the arm moves, the player waits for joints that are farther behind than kFarBehind: otherwise
/// the arm would cut the corners of its plan.
constexpr float kArrived = 0.02F;
constexpr float kFarBehind = 4;
/// Steps to wait for joints at most, in total and without progress; joints that a load still holds
/// back then will not arrive.
constexpr int kMostWaits = 60;
constexpr int kMostIdleWaits = 5;
/// After that wait, joints that lag by more than this many actions are held back by something.
constexpr float kHeldBack = 1;

/// The components on the ground.
Vec3 flat(const Vec3& v) { return {v.x, 0, v.z}; }

float planeDistance(const Vec3& a, const Vec3& b) {
  const Vec3 way = flat(a - b);
  return std::sqrt(dot(way, way));
}

/// Moves nothing.
void clear(const ActionRow& row) {
  std::ranges::fill(row.joints, 0.0F);
  row.forward = row.turn = 0;
}

}  // namespace

ActionRow rowOf(const ActionLayout& layout, std::span<float> actions) {
  return {actions.first(layout.joints), actions[layout.forward()], actions[layout.turn()],
          actions[layout.hand()], actions[layout.terminate()]};
}

bool PlanPlayer::decides(PlanStep::Kind kind, const ActionRow& row) const {
  switch (kind) {
    case PlanStep::Kind::kGrasp:
      row.grasp = decisions_.grasp;
      return true;
    case PlanStep::Kind::kRelease:
      row.grasp = decisions_.release;
      return true;
    case PlanStep::Kind::kTerminate:
      row.terminate = decisions_.terminate;
      return true;
    default:
      return false;
  }
}

bool PlanPlayer::isBeforeArm() const {
  const std::size_t after = next_ + 1;
  return after < plan_.steps.size() && plan_.steps[after].kind == PlanStep::Kind::kMoveArm;
}

PlanPlayer::Way PlanPlayer::turn(const RobotBase& robot_base, const BasePlace& at,
                                 const ActionRow& row) const {
  const BasePlace& to = plan_.steps[next_].base;
  const float left = wrappedAngle(to.yaw - at.yaw) / robot_base.turn_step;
  Way result;
  // The next drive corrects a turn that is not quite right.
  const float off = 0.9F * kOffYaw / robot_base.turn_step;
  result.rest = isBeforeArm() ? std::min(off, kRoughRest) : kRoughRest;
  result.remaining = std::fabs(left);
  // Positive turns are clockwise, positive yaw is counterclockwise. Turns are spread evenly over
  // their actions, as the search checks them.
  constexpr float kSlack = 1e-3F;
  row.turn = -left / std::max(std::ceil(result.remaining - kSlack), 1.0F);
  return result;
}

PlanPlayer::Way PlanPlayer::drive(const RobotBase& robot_base, const BasePlace& at,
                                  const ActionRow& row) const {
  const PlanStep& step = plan_.steps[next_];
  const Vec3 line = flat(step.base.position - step.from);
  const Vec3 way = line * (1 / std::sqrt(dot(line, line)));
  const float sign = dot(way, headingOf(step.base.yaw)) < 0 ? -1.0F : 1.0F;
  const Vec3 to_end = flat(step.base.position - at.position);
  const float left = dot(to_end, way);
  const Vec3 to_line = to_end - way * left;
  const Vec3 aim = (way * kLookAhead + to_line) * sign;
  const float askew = wrappedAngle(angleOf(-aim.z, aim.x) - at.yaw);
  Way result;
  result.rest = kRoughRest;
  result.strays = dot(to_line, to_line) > kStray * kStray;
  result.remaining = std::fabs(left) / robot_base.forward_step;
  if (std::fabs(askew) > kStraight) {
    result.steering = std::fabs(askew) / robot_base.turn_step;
    row.turn = std::clamp(-askew / robot_base.turn_step, -1.0F, 1.0F);
  }
  const bool looks_there = std::fabs(askew) <= kAskew + robot_base.turn_step;
  if (looks_there) row.forward = sign * std::clamp(left / robot_base.forward_step, -1.0F, 1.0F);
  return result;
}

PlanPlayer::Way PlanPlayer::moveArm(const Arm& arm, const BasePlace& at,
                                    std::span<const float> asked, const ActionRow& row) const {
  const PlanStep& step = plan_.steps[next_];
  Way result;
  result.rest = isBeforeArm() ? kRoughRest : kFineRest;
  result.remaining = arm.actionsBetween(asked, step.joints);
  result.strays = planeDistance(at.position, step.base.position) > kOff ||
                  std::fabs(wrappedAngle(at.yaw - step.base.yaw)) > kOffYaw;
  // All joints arrive together, so that the arm stays on the planned line.
  const float share = 1 / std::max(result.remaining, 1.0F);
  for (std::size_t joint = 0; joint < arm.joints().size(); ++joint) {
    const float step_size = arm.joints()[joint].step;
    if (!(step_size > 0)) continue;
    row.joints[joint] = share * arm.difference(joint, asked, step.joints) / step_size;
  }
  return result;
}

PlanPlayer::Way PlanPlayer::advance(const Arm& arm, const RobotBase& robot_base,
                                    const BasePlace& at, std::span<const float> asked,
                                    const ActionRow& row) const {
  switch (plan_.steps[next_].kind) {
    case PlanStep::Kind::kTurn:
      return turn(robot_base, at, row);
    case PlanStep::Kind::kDrive:
      return drive(robot_base, at, row);
    default:
      return moveArm(arm, at, asked, row);
  }
}

bool PlanPlayer::isOver(const Way& way) const {
  const bool was_last = remaining_ >= 0 && remaining_ <= 1;
  return way.remaining <= (was_last ? std::max(way.rest, kNothing) : kNothing);
}

bool PlanPlayer::getsOn(const Way& way) {
  const float left = way.remaining + way.steering;
  const bool is_less = remaining_ < 0 || left < least_left_ - kNothing / 2;
  if (is_less) least_left_ = left;
  vain_ = is_less ? 0 : vain_ + 1;
  remaining_ = way.remaining;
  return vain_ <= kMostVain;
}

bool PlanPlayer::waitsFor(float lag, bool is_arm_next) {
  const bool is_near = lag <= (is_arm_next ? kFarBehind : kArrived);
  if (is_near || waits_ >= kMostWaits || idle_waits_ >= kMostIdleWaits) return false;
  if (waits_ == 0 || lag < least_lag_ - kNothing) {
    least_lag_ = lag;
    idle_waits_ = 0;
  } else {
    ++idle_waits_;
  }
  ++waits_;
  return true;
}

bool PlanPlayer::isHeldBack(float lag, bool is_arm_next) const {
  return waits_ > 0 && lag > (is_arm_next ? kFarBehind : kHeldBack);
}

PlanPlayer::Progress PlanPlayer::play(const Arm& arm, const RobotBase& robot_base,
                                      const EnvState& state, std::span<const float> asked,
                                      const ActionRow& row) {
  const BasePlace at{state.world_from_root.translation, yawOf(state.world_from_root.rotation)};
  const float lag = arm.actionsBetween(state.joint_positions, asked);
  for (; next_ < plan_.steps.size(); goOn()) {
    const PlanStep& step = plan_.steps[next_];
    const bool is_arm_next = step.kind == PlanStep::Kind::kMoveArm;
    if (is_arm_next || !has_settled_) {
      if (waitsFor(lag, is_arm_next)) return Progress::kActs;
      if (isHeldBack(lag, is_arm_next)) return Progress::kStuck;
      waits_ = idle_waits_ = 0;
      has_settled_ = !is_arm_next;
    }
    if (decides(step.kind, row)) {
      goOn();
      return Progress::kActs;
    }
    const Way way = advance(arm, robot_base, at, asked, row);
    if (way.strays) return is_arm_next ? Progress::kOff : Progress::kAstray;
    if (!isOver(way)) return getsOn(way) ? Progress::kActs : Progress::kStuck;
    clear(row);
  }
  return Progress::kDone;
}

void PlanPlayer::goOn() {
  ++next_;
  remaining_ = -1;
  vain_ = 0;
}

}  // namespace galactic::scripted
