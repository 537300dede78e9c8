#pragma once
#include <cstdint>
#include <vector>

#include "sphere_set/fit_task.h"

namespace galactic::bake::sphere_set {

/// How much work a cover is worth: operations, never time, so that results are reproducible.
struct Effort {
  /// Operations of the local search per sphere of the cover that it starts from, first on the
  /// coarse lattices and then in each round.
  std::uint64_t search = 1'500'000;
  std::uint64_t refine = 600'000;
  /// Most operations of one search.
  std::uint64_t limit = 30'000'000;
  int rounds = 3;
  int polish_sweeps = 16;
};

/// The points of a surface that covers are made and checked on. They depend on their spacing only,
/// so covers of one solid for several tolerances may share them.
struct SurfacePoints {
  /// Of the points to cover, meters; 0: none yet.
  double spacing = 0;
  std::vector<Vec3d> points;
  /// Denser ones, which the cover is checked on.
  std::vector<Vec3d> dense;
};

/// A small set of spheres that covers a solid, and what its solver can promise.
struct Cover {
  std::vector<Candidate> spheres;
  /// No reachable surface point is further from the union than this.
  double guaranteed_gap = 0;
  /// No sphere protrudes further than this.
  double guaranteed_protrusion = 0;
  /// What sampling adds to eps in the guarantee.
  double slack = 0;
};

/// What sampling may add to eps, as a share of it, where tolerances are called met.
inline constexpr double kSlackOfEps = 0.18;

/// Whether a surface of this area, square meters, is so large that the points that stand for it lie
/// too far apart for that.
[[nodiscard]] bool isTooLarge(double area, double eps);

/// As few spheres as found that cover the task's solid. Empty where the surface has no point that
/// needs cover. `surface`: of the same solid and support; replaced where other spacings are needed.
[[nodiscard]] Cover solveCover(const FitTask& task, const Effort& effort, SurfacePoints& surface);

}  // namespace galactic::bake::sphere_set
