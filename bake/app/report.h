#pragma once
#include <filesystem>

#include "bake_run.h"
#include "galactic/error.h"

namespace galactic::bake {

/// What was baked and what failed.
[[nodiscard]] Json reportOf(const BakeRun& run);

/// Writes what was baked and what failed as JSON, atomically.
[[nodiscard]] Result<void> writeReport(const std::filesystem::path& path, const BakeRun& run);

}  // namespace galactic::bake
