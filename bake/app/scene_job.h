#pragma once
#include <filesystem>

#include "bake_run.h"
#include "galactic/error.h"
#include "plan/plan.h"

namespace galactic::bake {

/// Bakes one scene into its pack, prints the closing table, and returns its entry of the report.
[[nodiscard]] Result<Json> bakeSceneFile(const std::filesystem::path& input, BakeRun& run);

/// The same of a scene instance of a dataset. What lacks is left out, with a warning.
[[nodiscard]] Result<Json> bakeInstancedScene(const InstancedScene& scene, BakeRun& run);

}  // namespace galactic::bake
