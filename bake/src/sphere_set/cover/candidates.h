#pragma once
#include <span>
#include <vector>

#include "sphere_set/cover/cover_matrix.h"
#include "sphere_set/fit_task.h"
#include "sphere_set/solid/point_grid.h"

namespace galactic::bake::sphere_set {

/// The pool, and for each point whether a sphere that protrudes by at most tau covers it.
struct Candidates {
  CandidatePool pool;
  std::vector<char> coverable;
};

/// Spacing of the lattice of centers on which spheres of one radius are tried, meters.
[[nodiscard]] double latticeSpacing(const FitTask& task, std::uint32_t radius_index);

/// Spheres that protrude by at most tau, on lattices through the solid, largest radius first. A
/// smaller radius is tried only where it reaches points that no larger sphere covers. Centers just
/// below the highest level that tau allows are pushed onto that level, where they cover most.
[[nodiscard]] Candidates findCandidates(const FitTask& task, std::span<const Vec3d> points);

/// Adds spheres of the smallest radius to the pool for the points that are not `coverable`: for
/// each point, the one that covers it with the least protrusion, and those that are nearly as good.
/// Afterwards the pool covers every point.
void addThinCandidates(const FitTask& task, std::span<const Vec3d> points,
                       std::span<const char> coverable, CandidatePool& pool);

/// A sphere of the smallest radius around `p`, moved to the near side of the support if necessary.
[[nodiscard]] Candidate sphereAround(const FitTask& task, const Vec3d& p);

/// Whether a sphere with this center stays on the near side of the task's support.
[[nodiscard]] bool staysAbove(const FitTask& task, const Vec3d& center, double radius);

}  // namespace galactic::bake::sphere_set
