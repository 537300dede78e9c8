#pragma once
#include <nlohmann/json.hpp>
#include <optional>

#include "command.h"
#include "galactic/bake/assets.h"

namespace galactic::bake {

using Json = nlohmann::ordered_json;

// What became of a pack, for people and for programs.

/// Prints what was baked: the figures of the kind, warnings, seconds.
void printTable(const Made& made, Verbosity verbosity);

/// The pack's entries of the report: one for each object, of other kinds one.
[[nodiscard]] Json reportEntries(const Made& made);

// The same of each kind.

void printTable(const SceneOutcome& outcome, const Made& made, Verbosity verbosity);
void printTable(const ObjectSetOutcome& outcome, const Made& made, Verbosity verbosity);
void printTable(const RobotOutcome& outcome, const Made& made, Verbosity verbosity);
void printTable(const EpisodeOutcome& outcome, const Made& made, Verbosity verbosity);
void printTable(const WorldOutcome& outcome, const Made& made, Verbosity verbosity);
[[nodiscard]] Json reportEntries(const SceneOutcome& outcome, const Made& made);
[[nodiscard]] Json reportEntries(const ObjectSetOutcome& outcome, const Made& made);
[[nodiscard]] Json reportEntries(const RobotOutcome& outcome, const Made& made);
[[nodiscard]] Json reportEntries(const EpisodeOutcome& outcome, const Made& made);
[[nodiscard]] Json reportEntries(const WorldOutcome& outcome, const Made& made);

// Parts of several kinds.

/// Two lines: triangles, clusters and bytes before and after; textures. Nothing where there is
/// none.
void printRenderMeshes(const std::optional<BakedRenderMeshes>& meshes);
/// The same of many assets together.
void printRenderMeshes(const RenderBakeStatistics& figures, std::size_t textures);
[[nodiscard]] Json renderReport(const BakedRenderMeshes& meshes);

/// Spheres of each radius, largest radius first, as "2+5+0".
[[nodiscard]] std::string sphereCounts(const std::vector<SetSphere>& spheres, std::size_t radii);
/// A length's mean, 95th percentile and maximum in millimeters.
[[nodiscard]] std::string millimeters(const LengthStatistics& lengths);
/// The figures of a sphere set for a report.
[[nodiscard]] Json sphereSetReport(const SphereSet& set, std::size_t radii);

[[nodiscard]] Json jsonOf(const LinkedPack& pack);

}  // namespace galactic::bake
