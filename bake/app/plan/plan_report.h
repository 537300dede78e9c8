#pragma once
#include <vector>

#include "galactic/bake/world_pack.h"
#include "galactic/error.h"
#include "options.h"
#include "plan/plan.h"
#include "plan/plan_outcome.h"

namespace galactic::bake {

/// What is reported of a plan.
struct PlanSummary {
  const WorldPlan& plan;
  const PlanOutcome& outcome;
  /// What the world pack lists; empty where none was linked.
  std::vector<LinkedPack> world;
};

/// The member of a plan's report that says how the run went: whatever else is in it does not depend
/// on what was baked before.
inline constexpr const char* kRunKey = "run";

/// What was baked, what failed, what was left out, and what the world lists.
[[nodiscard]] Json planReport(const PlanSummary& summary);

/// The command's --report, where it wants one.
[[nodiscard]] Result<void> writePlanReport(const PlanSummary& summary, const BakeCommand& command);

}  // namespace galactic::bake
