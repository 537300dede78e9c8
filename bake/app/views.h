#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "command.h"
#include "galactic/bake/figures.h"

namespace galactic::bake {

// Prints for people what became of a pack. report.h does so for programs.

/// Prints what was baked: the figures for its kind, warnings and seconds.
void printTable(const PackFigures& pack, Verbosity verbosity);

// The same for each kind.

void printTable(const SceneFigures& scene, const PackFigures& pack, Verbosity verbosity);
void printTable(const ObjectSetFigures& set, const PackFigures& pack, Verbosity verbosity);
void printTable(const RobotFigures& robot, const PackFigures& pack, Verbosity verbosity);
void printTable(const EpisodeFigures& set, const PackFigures& pack, Verbosity verbosity);
void printTable(const WorldFigures& world, const PackFigures& pack, Verbosity verbosity);

/// Prints the middle part of the table: what a set of episodes holds and, if it was generated, how.
void printEpisodes(const EpisodeFigures& set, Verbosity verbosity);

// Parts that several kinds share.

/// Where the pack was written, or that it was not.
[[nodiscard]] std::string targetOf(const PackFigures& pack);

/// Prints two lines: triangles, clusters and bytes before and after; textures. Prints nothing if
/// there are no render meshes.
void printRenderMeshes(const std::optional<RenderFigures>& meshes);
/// The same for many assets together.
void printRenderMeshes(const RenderBakeStatistics& figures, std::uint64_t textures);

/// The number of spheres of each radius, largest radius first, such as "2+5+0".
[[nodiscard]] std::string sphereCounts(const SphereFigures& spheres);
/// The mean, 95th percentile and maximum of lengths, in millimeters.
[[nodiscard]] std::string millimeters(const LengthStatistics& lengths);

}  // namespace galactic::bake
