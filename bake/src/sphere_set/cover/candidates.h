#pragma once
#include <span>
#include <vector>

#include "sphere_set/cover/cover_matrix.h"
#include "sphere_set/fit_task.h"
#include "sphere_set/solid/point_grid.h"

namespace galactic::bake::sphere_set {

/// The pool, and for each point whether a sphere within tau covers it.
struct Candidates {
  CandidatePool pool;
  std::vector<char> coverable;
};

/// Spacing of the lattice on which spheres of one radius are tried, meters.
[[nodiscard]] double latticeSpacing(const FitTask& task, std::uint32_t radius_index);

/// Spheres within tau on lattices through the solid, the largest radius first; a smaller radius is
/// tried only where it reaches points that no larger one covers. The centers just below the
/// highest level that tau allows are pushed onto it, where they cover most.
[[nodiscard]] Candidates findCandidates(const FitTask& task, std::span<const Vec3d> points);

/// Adds to the pool spheres of the smallest radius for the points that are not `coverable`: for
/// each the least protrusion that covers it, and what is nearly as good. Afterwards the pool covers
/// every point.
void addThinCandidates(const FitTask& task, std::span<const Vec3d> points,
                       std::span<const char> coverable, CandidatePool& pool);

/// A sphere of the smallest radius around `p`, lifted onto the near side of the support.
[[nodiscard]] Candidate sphereAround(const FitTask& task, const Vec3d& p);

/// Whether a sphere with this center stays on the near side of the task's support.
[[nodiscard]] bool staysAbove(const FitTask& task, const Vec3d& center, double radius);

}  // namespace galactic::bake::sphere_set
