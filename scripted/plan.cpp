#include "scripted/plan.h"

namespace galactic::scripted {
namespace {

std::vector<PlanStep> stepsOf(const BasePlace& base, const ArmPath& path) {
  std::vector<PlanStep> steps;
  steps.reserve(path.size());
  for (const Joints& joints : path) steps.push_back({PlanStep::Kind::kMoveArm, base, {}, joints});
  return steps;
}

/// The step from one place of a route to the next. A turn may end on a place of the lattice that is
/// almost the same.
PlanStep baseStep(const BasePlace& from, const BasePlace& to) {
  constexpr float kSamePlace = 1e-3F;
  const Vec3 way = to.position - from.position;
  const bool drives = way.x * way.x + way.z * way.z > kSamePlace * kSamePlace;
  return {drives ? PlanStep::Kind::kDrive : PlanStep::Kind::kTurn, to, from.position, {}};
}

}  // namespace

Plan planOf(const BasePlace& start, const BaseRoute& route, const ArmPath& path,
            PlanStep::Kind last) {
  Plan plan;
  plan.steps.reserve(route.size() + path.size() + 1);
  BasePlace at = start;
  for (const BasePlace& place : route) {
    plan.steps.push_back(baseStep(at, place));
    at = place;
  }
  const std::vector<PlanStep> steps = stepsOf(at, path);
  plan.steps.insert(plan.steps.end(), steps.begin(), steps.end());
  plan.steps.push_back({last, at, {}, {}});
  return plan;
}

void prepend(const BasePlace& base, const ArmPath& path, Plan& plan) {
  const std::vector<PlanStep> steps = stepsOf(base, path);
  plan.steps.insert(plan.steps.begin(), steps.begin(), steps.end());
}

Plan troubled(ScriptedTrouble trouble) {
  Plan plan;
  plan.trouble = trouble;
  return plan;
}

}  // namespace galactic::scripted
