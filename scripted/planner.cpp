#include "scripted/planner.h"

#include <algorithm>
#include <utility>

#include "scripted/carries.h"

namespace galactic::scripted {
namespace {

constexpr std::uint32_t kReachSamples = 20000;
/// A plan is given up after this many unsuccessful searches for a motion of the arm.
constexpr int kMostFailedMotions = 12;

/// Keeps the random numbers of the plans of one attempt apart.
constexpr std::uint32_t kPickDraw = 0;
constexpr std::uint32_t kPickFromHereDraw = 250;
constexpr std::uint32_t kPlaceDraw = 500;
constexpr std::uint32_t kPlaceFromHereDraw = 750;

/// `draw` is one of those above. The arguments, and what they refer to, must outlive the plan.
CurrentPlan begun(const EnvState& state, const Attempt& attempt, std::uint32_t draw,
                  const ReachView& view) {
  return {
      .state = state,
      .view = view,
      .failed = attempt.failed,
      .seed = (std::uint64_t{state.episode} << 32U) + std::uint64_t{attempt.number} * 1000 + draw};
}

/// The plan that `make` finds; if there is none, the plan that it finds when it may repeat failed
/// stances.
template <class MakePlan>
Plan anew(CurrentPlan& plan, const MakePlan& make) {
  Plan result = make();
  if (result.trouble == ScriptedTrouble::kNone || plan.failed.empty()) return result;
  plan.failed = {};
  return make();
}

/// The plan that `make` finds with the held object upright, or else as upright as possible.
template <class MakePlan>
Plan leaning(CurrentPlan& plan, const MakePlan& make) {
  Plan result;
  // Upright, else leaning, else in any direction; radians.
  for (const float tolerance : {0.15F, 0.6F, -1.0F}) {
    plan.hand_options.direction_tolerance = tolerance;
    plan.failed_motions = 0;
    result = make();
    if (result.trouble != ScriptedTrouble::kNoPlacement) break;
  }
  return result;
}

/// Whether a search of the floor ends or goes on after trying a reach.
FloorSearch::Verdict verdictOn(const CurrentPlan& plan, const std::optional<ArmPath>& reaching) {
  using Verdict = FloorSearch::Verdict;
  if (reaching) return Verdict::kAccepted;
  return plan.failed_motions < kMostFailedMotions ? Verdict::kRejected : Verdict::kEnough;
}

ScriptedTrouble troubleOf(FloorSearch::Outcome outcome, ScriptedTrouble no_way,
                          ScriptedTrouble not_accepted) {
  return outcome == FloorSearch::Outcome::kNoWay ? no_way : not_accepted;
}

}  // namespace

Planner::Planner(const World& world, const SimulationOptions& options)
    : world_(world),
      scene_(world, options),
      arm_(world.robot()),
      floor_search_(scene_, world.robot()),
      reach_table_(arm_,
                   {world.robot().startPositions().begin(), world.robot().startPositions().end()},
                   kReachSamples),
      pick_view_(reach_table_, {}, {1, 0, 0}),
      reach_search_(scene_, arm_, reach_table_, options.task.success_distance),
      carries_(chooseCarries(scene_, arm_, reach_table_)) {}

Plan Planner::planTo(const BasePlace& start, const BaseRoute& route, const ArmPath& path,
                     PlanStep::Kind last) {
  Plan result = planOf(start, route, path, last);
  result.stance = reach_search_.stanceAt(result.steps.back().base, path.back());
  return result;
}

std::vector<Joints> Planner::carriesOf(const EnvState& state) const {
  std::vector<Joints> result;
  result.reserve(carries_.size());
  for (const Joints& carry : carries_) {
    Joints joints = state.joint_positions;
    for (const ControlledJoint& joint : world_.robot().controlledJoints()) {
      joints[joint.position] = carry[joint.position];
    }
    result.push_back(std::move(joints));
  }
  return result;
}

template <class Fold, class MakePlan>
Plan Planner::folded(CurrentPlan& plan, std::span<const Joints> carries, const Fold& fold,
                     const MakePlan& make) {
  const BasePlace start = scene_.baseOf(plan.state);
  Plan result = troubled(ScriptedTrouble::kNoFold);
  for (const Joints& carried : carries) {
    plan.failed_motions = 0;
    const std::optional<ArmPath> folding = fold(start, carried);
    if (!folding) continue;
    result = make(start, carried);
    if (result.trouble == ScriptedTrouble::kNone) {
      prepend(start, *folding, result);
      break;
    }
    // What the arm cannot reach from one fold, it cannot reach from another.
    const bool is_reached = result.trouble != ScriptedTrouble::kNoGrasp &&
                            result.trouble != ScriptedTrouble::kNoPlacement;
    if (!is_reached && plan.failed_motions == 0) break;
  }
  return result;
}

Plan Planner::planPick(const EnvState& state, const Attempt& attempt) {
  scene_.update(state);
  CurrentPlan plan = begun(state, attempt, kPickDraw, pick_view_);
  return anew(plan, [&] { return pick(plan); });
}

Plan Planner::pick(CurrentPlan& plan) {
  plan.is_thorough = reach_search_.isStiff();
  const Joints& joints = plan.state.joint_positions;
  std::vector<Joints> carries = carriesOf(plan.state);
  // If there is no room to fold the arm, the robot may still drive with the arm as it is.
  carries.push_back(joints);
  const auto pick_folded = [&] {
    return folded(
        plan, carries,
        [&](const BasePlace& start, const Joints& carried) {
          return reach_search_.fold(plan, start, joints, carried);
        },
        [&](const BasePlace& start, const Joints& carried) {
          return pickWith(plan, start, carried);
        });
  };
  Plan result = pick_folded();
  if (result.trouble != ScriptedTrouble::kNoGrasp || plan.is_thorough) return result;
  plan.is_thorough = true;
  return pick_folded();
}

Plan Planner::planPickFromHere(const EnvState& state, const Attempt& attempt, std::uint32_t reach) {
  scene_.update(state);
  CurrentPlan plan = begun(state, attempt, kPickFromHereDraw + reach, pick_view_);
  plan.is_thorough = reach_search_.isStiff();
  Plan result = pickFromHere(plan);
  if (result.trouble == ScriptedTrouble::kNone || plan.is_thorough) return result;
  plan.is_thorough = true;
  plan.failed_motions = 0;
  return pickFromHere(plan);
}

Plan Planner::pickFromHere(CurrentPlan& plan) {
  BasePlace base = scene_.baseOf(plan.state);
  const std::optional<ArmPath> reaching =
      reach_search_.reachTarget(plan, base, plan.state.joint_positions);
  return planFromHere(plan.state, reaching, base, PlanStep::Kind::kGrasp);
}

Plan Planner::planFromHere(const EnvState& state, const std::optional<ArmPath>& reaching,
                           const BasePlace& turned, PlanStep::Kind last) {
  Plan not_reached = troubled(last == PlanStep::Kind::kGrasp ? ScriptedTrouble::kNoGrasp
                                                             : ScriptedTrouble::kNoPlacement);
  if (!reaching) return not_reached;
  const BasePlace start = scene_.baseOf(state);
  if (turned.yaw == start.yaw) return planTo(start, {}, *reaching, last);
  scene_.setJoints(state.joint_positions);
  if (!floor_search_.canTurn(start, turned.yaw)) return not_reached;
  return planTo(start, {turned}, *reaching, last);
}

FloorSearch::Target Planner::standsFor(const Vec3& point) const {
  // How far the edge of an object is from its center, where the hand reaches it.
  constexpr float kObject = 0.1F;
  FloorSearch::Target target{.point = point, .bearing = reach_table_.bearing()};
  // A long arm need not stretch; a short one has to be near.
  target.farthest = std::min(target.farthest, reach_table_.farthest() + kObject);
  target.nearest = std::min(target.nearest, 0.5F * target.farthest);
  return target;
}

Plan Planner::pickWith(CurrentPlan& plan, const BasePlace& start, const Joints& carried) {
  std::optional<ArmPath> reaching;
  const FloorSearch::Target target =
      standsFor(scene_.objectBox(plan.state.target).pose.translation);
  const FloorSearch::Answer answer =
      floor_search_.search(start, carried, target, [&](BasePlace& stance) {
        reaching = reach_search_.reachTarget(plan, stance, carried);
        return verdictOn(plan, reaching);
      });
  if (!reaching) {
    return troubled(
        troubleOf(answer.outcome, ScriptedTrouble::kNoWayToTarget, ScriptedTrouble::kNoGrasp));
  }
  return planTo(start, answer.route, *reaching, PlanStep::Kind::kGrasp);
}

ReachView Planner::placeView(const Pose& goal) const {
  const Vec3 up_of_object = rotate(conjugate(goal.rotation), {0, 1, 0});
  return {reach_table_, scene_.gripFromObject().translation,
          rotate(scene_.gripFromObject().rotation, up_of_object)};
}

Plan Planner::planPlaceFromHere(const EnvState& state, const Attempt& attempt,
                                std::uint32_t reach) {
  scene_.update(state);
  const ReachView view = placeView(state.goal);
  CurrentPlan plan = begun(state, attempt, kPlaceFromHereDraw + reach, view);
  return leaning(plan, [&] {
    BasePlace base = scene_.baseOf(state);
    const std::optional<ArmPath> reaching =
        reach_search_.reachGoal(plan, base, state.joint_positions);
    return planFromHere(state, reaching, base, PlanStep::Kind::kRelease);
  });
}

Plan Planner::planPlace(const EnvState& state, const Attempt& attempt) {
  scene_.update(state);
  const ReachView view = placeView(state.goal);
  CurrentPlan plan = begun(state, attempt, kPlaceDraw, view);
  return anew(plan, [&] { return place(plan); });
}

Plan Planner::place(CurrentPlan& plan) {
  return folded(
      plan, carriesOf(plan.state),
      [&](const BasePlace& start, const Joints& carried) {
        return reach_search_.liftAndFold(plan, start, plan.state.joint_positions, carried);
      },
      [&](const BasePlace& start, const Joints& carried) {
        return leaning(plan, [&] { return placeWith(plan, start, carried); });
      });
}

Plan Planner::placeWith(CurrentPlan& plan, const BasePlace& start, const Joints& carried) {
  std::optional<ArmPath> reaching;
  const FloorSearch::Target target = standsFor(plan.state.goal.translation);
  const FloorSearch::Answer answer =
      floor_search_.search(start, carried, target, [&](BasePlace& stance) {
        reaching = reach_search_.reachGoal(plan, stance, carried);
        return verdictOn(plan, reaching);
      });
  if (!reaching) {
    return troubled(
        troubleOf(answer.outcome, ScriptedTrouble::kNoWayToGoal, ScriptedTrouble::kNoPlacement));
  }
  return planTo(start, answer.route, *reaching, PlanStep::Kind::kRelease);
}

}  // namespace galactic::scripted
