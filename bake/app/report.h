#pragma once
#include <filesystem>
#include <span>
#include <vector>

#include "command.h"
#include "figure_json.h"
#include "galactic/bake/build.h"
#include "galactic/error.h"

namespace galactic::bake {

using Json = OrderedJson;

[[nodiscard]] const char* nameOf(PackState state);

/// For each pack what was requested, what was baked and what failed.
[[nodiscard]] Json reportOf(std::span<const PackJob> packs, const BuildOutcome& outcome);
/// The same for a world, with what was left out and what the world lists. Only the member "run",
/// which describes the run, depends on what had been baked before.
[[nodiscard]] Json reportOf(const WorldPlan& plan, const BuildOutcome& outcome);

/// Writes a report, atomically.
[[nodiscard]] Result<void> writeReport(const std::filesystem::path& path, const Json& report);

/// Prints what was made of a dataset or recipe, what was left out, and warnings.
void printWorldTable(const WorldPlan& plan, const BuildOutcome& outcome, Verbosity verbosity);

/// Prints what is missing.
void printMissing(const std::vector<LeftOut>& missing);
/// The same as JSON.
[[nodiscard]] Json missingReport(const std::vector<LeftOut>& missing);

}  // namespace galactic::bake
