#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "command.h"
#include "galactic/bake/figures.h"

namespace galactic::bake {

// What became of a pack, for people. report.h has it for programs.

/// Prints what was baked: the figures of the kind, warnings, seconds.
void printTable(const PackFigures& pack, Verbosity verbosity);

// The same of each kind.

void printTable(const SceneFigures& scene, const PackFigures& pack, Verbosity verbosity);
void printTable(const ObjectSetFigures& set, const PackFigures& pack, Verbosity verbosity);
void printTable(const RobotFigures& robot, const PackFigures& pack, Verbosity verbosity);
void printTable(const EpisodeFigures& set, const PackFigures& pack, Verbosity verbosity);
void printTable(const WorldFigures& world, const PackFigures& pack, Verbosity verbosity);

/// What a set of episodes holds and, if it was generated, how: the middle of its table.
void printEpisodes(const EpisodeFigures& set, Verbosity verbosity);

// Parts of several kinds.

/// Where the pack was written, or that it was not.
[[nodiscard]] std::string targetOf(const PackFigures& pack);

/// Two lines: triangles, clusters and bytes before and after; textures. Nothing where there is
/// none.
void printRenderMeshes(const std::optional<RenderFigures>& meshes);
/// The same of many assets together.
void printRenderMeshes(const RenderBakeStatistics& figures, std::uint64_t textures);

/// Spheres of each radius, largest radius first, as "2+5+0".
[[nodiscard]] std::string sphereCounts(const SphereFigures& spheres);
/// A length's mean, 95th percentile and maximum in millimeters.
[[nodiscard]] std::string millimeters(const LengthStatistics& lengths);

}  // namespace galactic::bake
