#pragma once
#include <cstdint>
#include <vector>

#include "sphere_set/fit_task.h"

namespace galactic::bake::sphere_set {

/// How much work to spend on a cover, counted in operations and not in time, so that results are
/// reproducible.
struct Effort {
  /// Operations of the local search per sphere of its initial cover: `search` on the coarse
  /// lattices, `refine` in each round after that.
  std::uint64_t search = 1'500'000;
  std::uint64_t refine = 600'000;
  /// Maximum number of operations of one search.
  std::uint64_t limit = 30'000'000;
  int rounds = 3;
  int polish_sweeps = 16;
};

/// The points of a surface on which covers are made and checked. They depend only on their spacing,
/// so covers of one solid for several tolerances may share them.
struct SurfacePoints {
  /// Spacing of the points to cover, meters; 0: no points yet.
  double spacing = 0;
  std::vector<Vec3d> points;
  /// Denser points, on which the cover is checked.
  std::vector<Vec3d> dense;
};

/// A small set of spheres that covers a solid, and the solver's guarantees.
struct Cover {
  std::vector<Candidate> spheres;
  /// No reachable surface point is farther from the union of the spheres than this.
  double guaranteed_gap = 0;
  /// No sphere protrudes farther than this.
  double guaranteed_protrusion = 0;
  /// The amount that sampling adds to eps in the guarantee.
  double slack = 0;
};

/// The share of eps that sampling may add while the tolerances still count as met.
inline constexpr double kSlackOfEps = 0.18;

/// Whether a surface of this area (square meters) is so large that its sample points are too far
/// apart for kSlackOfEps.
[[nodiscard]] bool isTooLarge(double area, double eps);

/// The smallest cover of the task's solid that the search finds; empty if no point of the surface
/// needs cover. `surface`: points for the same solid and support, which are replaced if another
/// spacing is needed.
[[nodiscard]] Cover solveCover(const FitTask& task, const Effort& effort, SurfacePoints& surface);

}  // namespace galactic::bake::sphere_set
