#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "galactic/batch_simulator.h"
#include "scripted/decisions.h"
#include "scripted/plan.h"

namespace galactic::scripted {

/// The places of an env's action values, as BatchSimulator has them. No plan drives sideways.
struct ActionRow {
  std::span<float> joints;
  float& forward;
  float& turn;
  float& grasp;
  float& terminate;
};
[[nodiscard]] ActionRow rowOf(const ActionLayout& layout, std::span<float> actions);

/// Turns a plan into actions, step by step. A base that is off the line of a drive steers towards a
/// point somewhat ahead on that line, because motions may deviate from what was asked for.
class PlanPlayer {
 public:
  enum class Progress : std::uint8_t {
    /// `row` is set.
    kActs,
    /// Nothing is left to do.
    kDone,
    /// The arm should move, but the base is not quite where the plan expects it.
    kOff,
    /// The base is far from the line of its drive.
    kAstray,
    /// The robot does not move as it should.
    kStuck,
  };

  PlanPlayer() = default;
  explicit PlanPlayer(Plan plan, const Decisions& decisions = {})
      : plan_(std::move(plan)), decisions_(decisions) {}

  /// Chooses the next action, given where the robot is and where its joints were `asked` to be. If
  /// motors move the joints, these may lag: the player then waits, with zero actions, when joints
  /// lag far behind, and until they have arrived before it does anything but move the arm. Sets
  /// `row` except for its grasp and terminate actions, which are set only by steps that decide
  /// them.
  Progress play(const Arm& arm, const RobotBase& robot_base, const EnvState& state,
                std::span<const float> asked, const ActionRow& row);

 private:
  /// What is left of a step, in actions.
  struct Way {
    float remaining = 0;
    /// What may be left after the action that should have been the last.
    float rest = 0;
    bool strays = false;
    /// Actions that bring the base back to its line; not part of `remaining`.
    float steering = 0;
  };
  /// If the step only decides something, sets the decision in `row`. Returns whether it is such a
  /// step.
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
  /// Whether nothing that matters is left of the current step.
  [[nodiscard]] bool isOver(const Way& way) const;
  /// Whether the current step makes progress.
  [[nodiscard]] bool getsOn(const Way& way);
  /// Whether to wait for joints that are `lag` actions behind where they were asked to be.
  [[nodiscard]] bool waitsFor(float lag, bool is_arm_next);
  /// Whether something still holds the joints back after waiting.
  [[nodiscard]] bool isHeldBack(float lag, bool is_arm_next) const;
  /// Goes on to the next step.
  void goOn();

  Plan plan_;
  Decisions decisions_;
  std::size_t next_ = 0;
  /// Actions that were left of the current step when it was last played; negative: not played yet.
  float remaining_ = -1;
  /// The least that was left of the step, steering included, and the actions since then.
  float least_left_ = 0;
  int vain_ = 0;
  /// Steps spent waiting for the joints, the smallest lag in that time, and the steps since then.
  int waits_ = 0;
  float least_lag_ = 0;
  int idle_waits_ = 0;
  /// Whether nothing has to be waited for until the arm moves again.
  bool has_settled_ = false;
};

}  // namespace galactic::scripted
