#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "galactic/planning_scene.h"
#include "galactic/world.h"
#include "scripted/arm_planner.h"
#include "scripted/floor_search.h"
#include "scripted/plan.h"
#include "scripted/reach_table.h"

namespace galactic::scripted {

/// Makes the plans of one env after the other.
class Planner {
 public:
  /// `world`: its robot has base and end effector.
  Planner(const World& world, const SimulationOptions& options);

  /// From anywhere with an empty hand, to the grasp of the target; to a stance that is like one
  /// that failed only where there is no other.
  [[nodiscard]] Plan planPick(const EnvState& state, const Attempt& attempt);
  /// From anywhere with the target in the hand, to its release at the goal.
  [[nodiscard]] Plan planPlace(const EnvState& state, const Attempt& attempt);
  /// The same from where the base stands: it turns at most, and does not come to a stance that is
  /// like one that failed. `reach` counts these plans of the attempt.
  [[nodiscard]] Plan planPickFromHere(const EnvState& state, const Attempt& attempt,
                                      std::uint32_t reach);
  [[nodiscard]] Plan planPlaceFromHere(const EnvState& state, const Attempt& attempt,
                                       std::uint32_t reach);

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

  /// `draw` tells plans of one attempt apart.
  void takeOver(const EnvState& state, const Attempt& attempt, std::uint32_t draw);
  [[nodiscard]] Stance stanceAt(const BasePlace& base, const Joints& joints);
  /// Whether a plan that ended here, or nearly so, failed.
  [[nodiscard]] bool hasFailed(const Stance& stance) const;
  /// What `plan` finds; without regard to what failed where that is nothing.
  template <class MakePlan>
  [[nodiscard]] Plan anew(const MakePlan& plan);
  /// As planOf, with its stance.
  [[nodiscard]] Plan planTo(const BasePlace& start, const BaseRoute& route, const ArmPath& path,
                            PlanStep::Kind last);
  void intendToPick();
  /// What reaches the goal with what is held.
  [[nodiscard]] ReachView placeView() const;
  /// Poses of the arm for driving, the best first: controlled joints from `carries_`, the others
  /// from the env.
  [[nodiscard]] std::vector<Joints> carriesOf(const EnvState& state) const;
  /// How the hand leaves from `there`, the best first; empty where it cannot.
  [[nodiscard]] ArmPath retreatFrom(const BasePlace& base, const Joints& there, const Reach& reach);
  /// The arm's move for this reach, to a free pose at which `isRight`, by way of the retreat. Turns
  /// the base where the arm lacks joints.
  template <class IsRight>
  [[nodiscard]] std::optional<ArmPath> reach(BasePlace& base, const Joints& carried,
                                             const Reach& reach, const IsRight& is_right);
  [[nodiscard]] std::optional<ArmPath> reachTarget(BasePlace& base, const Joints& carried);
  [[nodiscard]] std::optional<ArmPath> reachGoal(BasePlace& base, const Joints& carried);
  /// Whether the arm, once it has grasped the target at `positions`, can be folded.
  [[nodiscard]] bool comesAway(const BasePlace& base, const Joints& positions,
                               const Joints& carried);
  /// With the first of these folds from which `plan` finds something, after a `fold` to it.
  template <class Fold, class MakePlan>
  [[nodiscard]] Plan folded(std::span<const Joints> carries, const Fold& fold,
                            const MakePlan& plan);
  [[nodiscard]] Plan pickWith(const BasePlace& start, const Joints& carried);
  /// Whether a search of the floor ends, or goes on, after a reach.
  [[nodiscard]] FloorSearch::Verdict verdictOn(const std::optional<ArmPath>& reaching) const;
  /// Where the base may stand for a reach to this point of the world.
  [[nodiscard]] FloorSearch::Target standsFor(const Vec3& point) const;
  /// What `plan` finds with what is held upright, or else as upright as it finds something.
  template <class MakePlan>
  [[nodiscard]] Plan leaning(const MakePlan& plan);
  [[nodiscard]] Plan pick();
  [[nodiscard]] Plan place();
  [[nodiscard]] Plan pickFromHere();
  /// `turned`: the base as the arm reaches from it by the path `reaching`; nothing reaches where
  /// there is none.
  [[nodiscard]] Plan planFromHere(const std::optional<ArmPath>& reaching, const BasePlace& turned,
                                  PlanStep::Kind last, ScriptedTrouble not_reached);
  [[nodiscard]] Plan placeWith(const BasePlace& start, const Joints& carried);
  /// From where the arm is to its pose for driving; empty when it is there.
  [[nodiscard]] std::optional<ArmPath> fold(const BasePlace& base, const Joints& from,
                                            const Joints& carried);
  [[nodiscard]] std::optional<ArmPath> liftAndFold(const BasePlace& base, const Joints& from,
                                                   const Joints& carried);
  [[nodiscard]] Pose gripAt(const Joints& joints) { return arm_.gripOf(arm_.placeLinks(joints)); }
  [[nodiscard]] std::uint64_t nextSeed();

  World world_;
  SimulationOptions options_;
  PlanningScene scene_;
  Arm arm_;
  ArmPlanner arm_planner_;
  FloorSearch floor_search_;
  ReachTable reach_table_;
  ReachView pick_view_;
  /// How far the base turns for a reach, radians.
  float most_turn_ = 0;
  /// The hand has a direction that even the base's turn cannot choose.
  bool is_stiff_ = false;
  std::vector<Joints> carries_;
  // Of the current plan:
  const EnvState* state_ = nullptr;
  const ReachView* view_ = nullptr;
  std::span<const Stance> failed_;
  std::uint64_t seed_ = 0;
  int failed_motions_ = 0;
  /// The target is also reached for from other directions than those in which hands usually come.
  bool is_thorough_ = false;
  InverseKinematicsOptions hand_options_;
};

}  // namespace galactic::scripted
