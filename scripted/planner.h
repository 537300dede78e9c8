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

/// Makes plans, for one env at a time.
class Planner {
 public:
  /// The robot of `world` must have a base and an end effector.
  Planner(const World& world, const SimulationOptions& options);

  /// Plans from anywhere, with an empty hand, to the grasp of the target. Repeats a stance like one
  /// that failed only if there is no other.
  [[nodiscard]] Plan planPick(const EnvState& state, const Attempt& attempt);
  /// Plans from anywhere, with the target in the hand, to its release at the goal.
  [[nodiscard]] Plan planPlace(const EnvState& state, const Attempt& attempt);
  /// The same from where the base stands: the base only turns, and the plan ends at no stance like
  /// one that failed. `reach` counts these plans within the attempt.
  [[nodiscard]] Plan planPickFromHere(const EnvState& state, const Attempt& attempt,
                                      std::uint32_t reach);
  [[nodiscard]] Plan planPlaceFromHere(const EnvState& state, const Attempt& attempt,
                                       std::uint32_t reach);

 private:
  /// planOf(), with the stance in which the plan ends.
  [[nodiscard]] Plan planTo(const BasePlace& start, const BaseRoute& route, const ArmPath& path,
                            PlanStep::Kind last);
  /// The hand's view of a goal for what it holds.
  [[nodiscard]] ReachView placeView(const Pose& goal) const;
  /// Poses of the arm for driving, best first: controlled joints from `carries_`, the others from
  /// the env.
  [[nodiscard]] std::vector<Joints> carriesOf(const EnvState& state) const;
  /// Tries these folds in order: moves to each with `fold`, and returns the first plan that `make`
  /// finds from one.
  template <class Fold, class MakePlan>
  [[nodiscard]] Plan folded(CurrentPlan& plan, std::span<const Joints> carries, const Fold& fold,
                            const MakePlan& make);
  /// Where the base may stand to reach this point of the world.
  [[nodiscard]] FloorSearch::Target standsFor(const Vec3& point) const;
  [[nodiscard]] Plan pick(CurrentPlan& plan);
  [[nodiscard]] Plan pickWith(CurrentPlan& plan, const BasePlace& start, const Joints& carried);
  [[nodiscard]] Plan place(CurrentPlan& plan);
  [[nodiscard]] Plan placeWith(CurrentPlan& plan, const BasePlace& start, const Joints& carried);
  [[nodiscard]] Plan pickFromHere(CurrentPlan& plan);
  /// Turns the base to `turned`, from where the arm follows the path `reaching`, to grasp or to
  /// release. If there is no path, the plan is troubled.
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
