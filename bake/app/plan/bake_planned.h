#pragma once
#include "galactic/bake/bake_cache.h"
#include "galactic/bake/file_digests.h"
#include "plan/plan.h"
#include "plan/plan_outcome.h"
#include "plan/texture_checks.h"

namespace galactic::bake {

/// What the bakes of one plan share.
struct PlanTools {
  /// Null where nothing is remembered.
  const BakeCache* cache = nullptr;
  FileDigests& digests;
  TextureChecks& textures;
  /// Of each bake.
  unsigned jobs = 1;
};

/// Makes one pack, or finds that it was made before. Thread-safe for different packs.
[[nodiscard]] PackOutcome bakePlanned(const PlannedPack& pack, const PlanTools& tools);

}  // namespace galactic::bake
