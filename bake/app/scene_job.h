#pragma once
#include <filesystem>

#include "bake_run.h"
#include "galactic/error.h"

namespace galactic::bake {

/// Bakes one scene into its pack, prints the closing table, and returns its entry of the report.
[[nodiscard]] Result<Json> bakeSceneFile(const std::filesystem::path& input, BakeRun& run);

}  // namespace galactic::bake
