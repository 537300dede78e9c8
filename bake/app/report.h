#pragma once
#include <filesystem>

#include "bake_run.h"
#include "galactic/error.h"

namespace galactic::bake {

/// Writes what was baked and what failed as JSON, atomically.
[[nodiscard]] Result<void> writeReport(const std::filesystem::path& path, const BakeRun& run);

}  // namespace galactic::bake
