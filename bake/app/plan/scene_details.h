#pragma once
#include <vector>

#include "galactic/bake/episode_generator.h"
#include "plan/plan.h"

namespace galactic::bake {

/// The triangles of the scenes among `assets`, and the receptacles of those of a dataset, read
/// again from what their packs are made of: a pack holds neither, and may come from the cache.
[[nodiscard]] SceneDetailSource sceneDetails(const std::vector<PlannedPack>& assets);

}  // namespace galactic::bake
