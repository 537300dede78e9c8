#pragma once
#include <vector>

#include "galactic/bake/episode_generator.h"
#include "plan/plan.h"

namespace galactic::bake {

/// The triangles of the scenes among `assets`, read again from what their packs are made of.
[[nodiscard]] SceneDetailSource sceneDetails(const std::vector<PlannedPack>& assets);

}  // namespace galactic::bake
