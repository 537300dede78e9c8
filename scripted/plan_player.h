#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "galactic/batch_simulator.h"
#include "scripted/decisions.h"
#include "scripted/plan.h"

namespace galactic::scripted {

/// Where the values of an env's actions go, as BatchSimulator has them. No plan drives sideways.
struct ActionRow {
  std::span<float> joints;
  float& forward;
  float& turn;
  float& grasp;
  float& terminate;
};
[[nodiscard]] ActionRow rowOf(const ActionLayout& layout, std::span<float> actions);

/// Turns a plan into actions, one step after the other. A base that is off the line of a drive
/// turns towards a point on that line, somewhat ahead, as where motions are not quite what was
/// asked for.
class PlanPlayer {
 public:
  enum class Progress : std::uint8_t {
    /// The row is set.
    kActs,
    /// Nothing is left to do.
    kDone,
    /// The arm is to move, but the base is not quite where the plan has it then.
    kOff,
    /// The base is far from the line of its drive.
    kAstray,
    /// The robot does not move as it should.
    kStuck,
  };

  PlanPlayer() = default;
  explicit PlanPlayer(Plan plan, const Decisions& decisions = {})
      : plan_(std::move(plan)), decisions_(decisions) {}

  /// The next action from where the robot is and where its joints were `asked` to be, which is
  /// where they are, or where motors bring them: then it waits, with zeros, where they lag far
  /// behind and before anything but the arm is to move. Sets `row` but for its grasp and terminate
  /// actions, unless a step decides these.
  Progress play(const Arm& arm, const RobotBase& robot_base, const EnvState& state,
                std::span<const float> asked, const ActionRow& row);

 private:
  /// What is left of a step, in actions.
  struct Way {
    float remaining = 0;
    /// What may be left after the action that should have been the last one.
    float rest = 0;
    bool strays = false;
    /// Actions that bring the base back to its line; none of those that remain.
    float steering = 0;
  };
  /// Sets what a step that moves nothing decides. Whether it is one.
  [[nodiscard]] bool decides(PlanStep::Kind kind, const ActionRow& row) const;
  /// Whether the arm moves in the next step of the plan.
  [[nodiscard]] bool isBeforeArm() const;
  [[nodiscard]] Way turn(const RobotBase& robot_base, const BasePlace& at,
                         const ActionRow& row) const;
  [[nodiscard]] Way drive(const RobotBase& robot_base, const BasePlace& at,
                          const ActionRow& row) const;
  [[nodiscard]] Way moveArm(const Arm& arm, const BasePlace& at, std::span<const float> asked,
                            const ActionRow& row) const;
  [[nodiscard]] Way advance(const Arm& arm, const RobotBase& robot_base, const BasePlace& at,
                            std::span<const float> asked, const ActionRow& row) const;
  /// Whether nothing that counts is left of the current step.
  [[nodiscard]] bool isOver(const Way& way) const;
  /// Whether the current step gets on.
  [[nodiscard]] bool getsOn(const Way& way);
  /// Whether to wait for joints that are `lag` actions from where they were asked to be.
  [[nodiscard]] bool waitsFor(float lag, bool is_arm_next);
  /// Whether something holds the joints back, after all this waiting.
  [[nodiscard]] bool isHeldBack(float lag, bool is_arm_next) const;
  /// To the next step.
  void goOn();

  Plan plan_;
  Decisions decisions_;
  std::size_t next_ = 0;
  /// Actions left of the current step when it was last played; negative: not played yet.
  float remaining_ = -1;
  /// The least that was left of it, steering included, and the actions since.
  float least_left_ = 0;
  int vain_ = 0;
  /// Steps that the joints were waited for, the least lag in that time, and the steps since.
  int waits_ = 0;
  float least_lag_ = 0;
  int idle_waits_ = 0;
  /// Nothing is to be waited for until the arm moves again.
  bool has_settled_ = false;
};

}  // namespace galactic::scripted
