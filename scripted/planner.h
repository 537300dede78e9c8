#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "galactic/planning_scene.h"
#include "galactic/world.h"
#include "scripted/floor_search.h"
#include "scripted/plan.h"
#include "scripted/reach_search.h"
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
  /// As planOf, with its stance.
  [[nodiscard]] Plan planTo(const BasePlace& start, const BaseRoute& route, const ArmPath& path,
                            PlanStep::Kind last);
  /// What reaches this goal with what is held.
  [[nodiscard]] ReachView placeView(const Pose& goal) const;
  /// Poses of the arm for driving, the best first: controlled joints from `carries_`, the others
  /// from the env.
  [[nodiscard]] std::vector<Joints> carriesOf(const EnvState& state) const;
  /// With the first of these folds from which `make` finds something, after a `fold` to it.
  template <class Fold, class MakePlan>
  [[nodiscard]] Plan folded(CurrentPlan& plan, std::span<const Joints> carries, const Fold& fold,
                            const MakePlan& make);
  /// Where the base may stand for a reach to this point of the world.
  [[nodiscard]] FloorSearch::Target standsFor(const Vec3& point) const;
  [[nodiscard]] Plan pick(CurrentPlan& plan);
  [[nodiscard]] Plan pickWith(CurrentPlan& plan, const BasePlace& start, const Joints& carried);
  [[nodiscard]] Plan place(CurrentPlan& plan);
  [[nodiscard]] Plan placeWith(CurrentPlan& plan, const BasePlace& start, const Joints& carried);
  [[nodiscard]] Plan pickFromHere(CurrentPlan& plan);
  /// `turned`: the base as the arm reaches from it by the path `reaching`, to grasp or to release;
  /// nothing reaches where there is none.
  [[nodiscard]] Plan planFromHere(const EnvState& state, const std::optional<ArmPath>& reaching,
                                  const BasePlace& turned, PlanStep::Kind last);

  World world_;
  PlanningScene scene_;
  Arm arm_;
  FloorSearch floor_search_;
  ReachTable reach_table_;
  ReachView pick_view_;
  ReachSearch reach_search_;
  std::vector<Joints> carries_;
};

}  // namespace galactic::scripted
