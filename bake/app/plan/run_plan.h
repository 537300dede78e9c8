#pragma once
#include "plan/plan.h"
#include "plan/plan_outcome.h"

namespace galactic::bake {

/// Makes the packs of a plan as `command` wants it: on its threads, within its memory, its shard
/// only, from its cache where nothing has changed; the episodes last, where all assets are there.
/// Shows on the terminal how it goes. A stop request (Ctrl-C) is heeded between packs. The bytes of
/// the packs depend on neither threads nor shards nor the cache.
[[nodiscard]] PlanOutcome runPlan(const WorldPlan& plan, const BakeCommand& command);

}  // namespace galactic::bake
