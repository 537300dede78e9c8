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

/// A plan that is being made: what it is about, and how far it has come. It refers to what the call
/// that makes the plan has, and is gone with that call.
struct CurrentPlan {
  const EnvState& state;
  /// Of what the hand reaches with.
  const ReachView& view;
  /// Where plans have ended in vain: it ends at no such place.
  std::span<const Stance> failed;
  /// Of the next motion of the arm; each has its own.
  std::uint64_t seed = 0;
  /// Motions of the arm that were searched for in vain.
  int failed_motions = 0;
  /// The target is also reached for from other directions than those in which hands usually come.
  bool is_thorough = false;
  InverseKinematicsOptions hand_options = {};
};

/// Finds how the arm reaches for what a plan is about, and how it folds again. The scene has the
/// state of the plan; its joints are others afterwards.
class ReachSearch {
 public:
  /// `scene`, `arm` and `table`, which is the arm's, must outlive the search. `success_distance`:
  /// from the goal, meters.
  ReachSearch(PlanningScene& scene, Arm& arm, const ReachTable& table, float success_distance);

  /// The hand has a direction that even the base's turn cannot choose.
  [[nodiscard]] bool isStiff() const { return is_stiff_; }
  [[nodiscard]] Stance stanceAt(const BasePlace& base, const Joints& joints);

  /// From the joints `carried` to the grasp of the target, or to the release at the goal of what is
  /// held; none where neither is found. Turns the base where the arm lacks joints.
  [[nodiscard]] std::optional<ArmPath> reachTarget(CurrentPlan& plan, BasePlace& base,
                                                   const Joints& carried);
  [[nodiscard]] std::optional<ArmPath> reachGoal(CurrentPlan& plan, BasePlace& base,
                                                 const Joints& carried);

  /// From where the arm is to its pose for driving; empty when it is there.
  [[nodiscard]] std::optional<ArmPath> fold(CurrentPlan& plan, const BasePlace& base,
                                            const Joints& from, const Joints& carried);
  [[nodiscard]] std::optional<ArmPath> liftAndFold(CurrentPlan& plan, const BasePlace& base,
                                                   const Joints& from, const Joints& carried);

 private:
  /// What the arm has to do at a place where the robot may stand: as HandGoal has it, but with
  /// place and directions in the world.
  struct Reach {
    HandGoal goal;
    /// Direction in which the hand leaves again.
    Vec3 retreat;
    float retreat_length = 0.1F;
    /// The hand may come from anywhere, and leaves the way it points or upward.
    bool any_direction = false;
  };

  /// How the hand leaves from `there`, the best first; empty where it cannot.
  [[nodiscard]] ArmPath retreatFrom(const CurrentPlan& plan, const BasePlace& base,
                                    const Joints& there, const Reach& reach);
  /// The arm's move for this reach, to a free pose at which `isRight`, by way of the retreat.
  template <class IsRight>
  [[nodiscard]] std::optional<ArmPath> reach(CurrentPlan& plan, BasePlace& base,
                                             const Joints& carried, const Reach& reach,
                                             const IsRight& is_right);
  /// Whether the arm, once it has grasped the target at `positions`, can be folded.
  [[nodiscard]] bool comesAway(CurrentPlan& plan, const BasePlace& base, const Joints& positions,
                               const Joints& carried);
  [[nodiscard]] Pose gripAt(const Joints& joints) { return arm_.gripOf(arm_.placeLinks(joints)); }

  PlanningScene& scene_;
  Arm& arm_;
  const ReachTable& table_;
  ArmPlanner arm_planner_;
  /// Farthest that what is released may come to rest from the goal, meters.
  float landing_distance_ = 0;
  /// How far the base turns for a reach, radians.
  float most_turn_ = 0;
  bool is_stiff_ = false;
};

}  // namespace galactic::scripted
