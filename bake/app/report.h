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

/// What was asked of each pack, what was baked and what failed.
[[nodiscard]] Json reportOf(std::span<const PackJob> packs, const BuildOutcome& outcome);
/// The same of a world, with what was left out and what the world lists. The member "run" says how
/// the run went; nothing else depends on what was baked before.
[[nodiscard]] Json reportOf(const WorldPlan& plan, const BuildOutcome& outcome);

/// Writes a report, atomically.
[[nodiscard]] Result<void> writeReport(const std::filesystem::path& path, const Json& report);

/// What was made of a dataset or recipe, what is left out, and warnings, for people.
void printWorldTable(const WorldPlan& plan, const BuildOutcome& outcome, Verbosity verbosity);

/// What is missing, for people.
void printMissing(const std::vector<LeftOut>& missing);
/// The same for programs.
[[nodiscard]] Json missingReport(const std::vector<LeftOut>& missing);

}  // namespace galactic::bake
