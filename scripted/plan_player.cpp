#include "scripted/plan_player.h"

#include <algorithm>
#include <cmath>

namespace galactic::scripted {
namespace {

constexpr float kTurn = 6.28318531F;
/// A base this far off the plan's line is astray, meters.
constexpr float kStray = 5e-3F;
/// So much of an action is nothing left to do.
constexpr float kNothing = 1e-3F;
/// Joints this far from where they were asked to be, in actions, have arrived; and so far while the
/// arm moves, they are waited for: it would cut the corners of its plan.
constexpr float kArrived = 0.02F;
constexpr float kFarBehind = 4;
/// Steps that joints are waited for, at most and without getting closer; what a load holds back
/// then does not come.
constexpr int kMostWaits = 60;
constexpr int kMostIdleWaits = 5;
/// Joints that are further behind then are held by something.
constexpr float kHeldBack = 1;

float planeDistance(const Vec3& a, const Vec3& b) {
  const float x = a.x - b.x;
  const float z = a.z - b.z;
  return std::sqrt(x * x + z * z);
}

/// Sets what a step that moves nothing decides. Whether it is one.
bool decides(PlanStep::Kind kind, const ActionRow& row) {
  switch (kind) {
    case PlanStep::Kind::kGrasp:
      row.grasp = 1;
      return true;
    case PlanStep::Kind::kRelease:
      row.grasp = -1;
      return true;
    case PlanStep::Kind::kTerminate:
      row.terminate = 1;
      return true;
    default:
      return false;
  }
}

}  // namespace

ActionRow rowOf(std::span<float> actions) {
  const std::size_t joints = actions.size() - 4;
  return {actions.first(joints), actions[joints], actions[joints + 1], actions[joints + 2],
          actions[joints + 3]};
}

PlanPlayer::Way PlanPlayer::moveBase(const RobotBase& robot_base, const BasePlace& at,
                                     const ActionRow& row) const {
  const BasePlace& to = plan_.steps[next_].base;
  const float turn = std::remainder(to.yaw - at.yaw, kTurn) / robot_base.turn_step;
  const Vec3 way = to.position - at.position;
  const Vec3 heading = headingOf(at.yaw);
  const float along = way.x * heading.x + way.z * heading.z;
  const float across = way.x * heading.z - way.z * heading.x;
  const float forward = along / robot_base.forward_step;
  const bool turns = std::fabs(turn) > kNothing;
  const bool drives = std::fabs(forward) > kNothing;
  // Positive turns are clockwise, positive yaw is not. Turns are spread over their actions evenly,
  // as the search looks at them.
  constexpr float kSlack = 1e-3F;
  if (turns) row.turn = -turn / std::max(std::ceil(std::fabs(turn) - kSlack), 1.0F);
  if (drives && !turns) row.forward = std::clamp(forward, -1.0F, 1.0F);
  Way result;
  result.remaining = (turns ? std::fabs(turn) : 0) + (drives ? std::fabs(forward) : 0);
  result.strays = std::fabs(across) > kStray || (turns && drives);
  return result;
}

PlanPlayer::Way PlanPlayer::moveArm(const Arm& arm, const BasePlace& at,
                                    std::span<const float> asked, const ActionRow& row) const {
  const PlanStep& step = plan_.steps[next_];
  const float actions = arm.actionsBetween(asked, step.joints);
  Way result;
  result.strays = planeDistance(at.position, step.base.position) > kStray;
  if (actions <= kNothing) return result;
  result.remaining = actions;
  // All joints arrive together, so that the arm stays on the planned line.
  const float share = 1 / std::max(actions, 1.0F);
  for (std::size_t joint = 0; joint < arm.joints().size(); ++joint) {
    const float step_size = arm.joints()[joint].step;
    if (!(step_size > 0)) continue;
    row.joints[joint] = share * arm.difference(joint, asked, step.joints) / step_size;
  }
  return result;
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
  const Quat& q = state.world_from_root.rotation;
  const BasePlace at{state.world_from_root.translation, 2 * std::atan2(q.y, q.w)};
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
    const Way way = is_arm_next ? moveArm(arm, at, asked, row) : moveBase(robot_base, at, row);
    if (way.strays) return Progress::kStuck;
    if (way.remaining == 0) continue;
    const bool moved = remaining_ < 0 || way.remaining < remaining_ - kNothing / 2;
    remaining_ = way.remaining;
    return moved ? Progress::kActs : Progress::kStuck;
  }
  return Progress::kDone;
}

void PlanPlayer::goOn() {
  ++next_;
  remaining_ = -1;
}

}  // namespace galactic::scripted
