#pragma once
#include <cstdint>
#include <optional>
#include <span>

#include "galactic/batch_simulator.h"
#include "galactic/planning_scene.h"
#include "scripted/arm_planner.h"
#include "scripted/inverse_kinematics.h"
#include "scripted/plan.h"
#include "scripted/reach_table.h"

namespace galactic::scripted {

/// A plan in the making: what it is about, and how far it has come. Refers to data of the call that
/// makes the plan, and must not outlive that call.
struct CurrentPlan {
  const EnvState& state;
  /// The point and direction with which the hand reaches.
  const ReachView& view;
  /// Where earlier plans failed: this plan must end at none of these places.
  std::span<const Stance> failed;
  /// Seed of the arm's next motion; each motion has its own.
  std::uint64_t seed = 0;
  /// Motions of the arm that were searched for without success.
  int failed_motions = 0;
  /// Also reach for the target from directions in which hands do not usually come.
  bool is_thorough = false;
  InverseKinematicsOptions hand_options = {};
};

/// Finds how the arm reaches for the target or goal of a plan, and how it folds again. The scene
/// must be in the state of the plan; the search leaves other joints in it.
class ReachSearch {
 public:
  /// `scene`, `arm` and `table`, which belongs to the arm, must outlive the search.
  /// `success_distance` from the goal, meters.
  ReachSearch(PlanningScene& scene, Arm& arm, const ReachTable& table, float success_distance);

  /// Whether the hand has a direction that not even a turn of the base can choose.
  [[nodiscard]] bool isStiff() const { return is_stiff_; }
  [[nodiscard]] Stance stanceAt(const BasePlace& base, const Joints& joints);

  /// From the joints `carried` to the grasp of the target, or to the release of the held object at
  /// the goal; none if there is no path. Turns the base if the arm lacks joints.
  [[nodiscard]] std::optional<ArmPath> reachTarget(CurrentPlan& plan, BasePlace& base,
                                                   const Joints& carried);
  [[nodiscard]] std::optional<ArmPath> reachGoal(CurrentPlan& plan, BasePlace& base,
                                                 const Joints& carried);

  /// From where the arm is to its pose for driving; empty if it is there already.
  [[nodiscard]] std::optional<ArmPath> fold(CurrentPlan& plan, const BasePlace& base,
                                            const Joints& from, const Joints& carried);
  [[nodiscard]] std::optional<ArmPath> liftAndFold(CurrentPlan& plan, const BasePlace& base,
                                                   const Joints& from, const Joints& carried);

 private:
  /// What the arm has to do at a place where the robot may stand: as in HandGoal, but with place
  /// and directions in the world frame.
  struct Reach {
    HandGoal goal;
    /// Direction in which the hand leaves again.
    Vec3 retreat;
    float retreat_length = 0.1F;
    /// The hand may come from anywhere, and retreats the way it came or upward.
    bool any_direction = false;
  };

  /// How the hand leaves from `there`, on the first way that is free; empty if it cannot.
  [[nodiscard]] ArmPath retreatFrom(const CurrentPlan& plan, const BasePlace& base,
                                    const Joints& there, const Reach& reach);
  /// Moves the arm for this reach to a free pose that passes `is_right`; the last part goes along
  /// the retreat in reverse.
  template <class IsRight>
  [[nodiscard]] std::optional<ArmPath> reach(CurrentPlan& plan, BasePlace& base,
                                             const Joints& carried, const Reach& reach,
                                             const IsRight& is_right);
  /// Whether the arm can be folded after it has grasped the target at `positions`.
  [[nodiscard]] bool comesAway(CurrentPlan& plan, const BasePlace& base, const Joints& positions,
                               const Joints& carried);
  [[nodiscard]] Pose gripAt(const Joints& joints) { return arm_.gripOf(arm_.placeLinks(joints)); }

  PlanningScene& scene_;
  Arm& arm_;
  const ReachTable& table_;
  ArmPlanner arm_planner_;
  /// How far from the goal a released object may come to rest, meters.
  float landing_distance_ = 0;
  /// How far the base may turn for a reach, radians.
  float most_turn_ = 0;
  bool is_stiff_ = false;
};

}  // namespace galactic::scripted
