#pragma once
#include <filesystem>

#include "bake_run.h"
#include "galactic/error.h"

namespace galactic::bake {

/// Imports one published episode set into a pack of its own and prints the closing table; the entry
/// of the report.
[[nodiscard]] Result<Json> importEpisodeFile(const std::filesystem::path& input, BakeRun& run);

/// Generates episodes in the packs of the command (scenes, objects, one robot), writes them into
/// one pack and prints the closing table; the entry of the report.
[[nodiscard]] Result<Json> generateEpisodePack(BakeRun& run);

}  // namespace galactic::bake
