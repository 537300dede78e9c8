#pragma once
#include <filesystem>

#include "bake_run.h"
#include "galactic/error.h"

namespace galactic::bake {

/// Bakes one URDF into its pack, prints the closing table, and returns its entry of the report.
[[nodiscard]] Result<Json> bakeRobotFile(const std::filesystem::path& input, BakeRun& run);

/// Prints a draft of a recipe for the command's only input.
[[nodiscard]] Result<void> printRecipeDraft(const BakeCommand& command);

}  // namespace galactic::bake
