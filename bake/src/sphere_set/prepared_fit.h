#pragma once
#include <memory>

#include "galactic/bake/sphere_set.h"
#include "galactic/bake/triangle_mesh.h"
#include "galactic/error.h"
#include "sphere_set/cover/cover_solver.h"
#include "sphere_set/fit_task.h"
#include "sphere_set/measure.h"

namespace galactic::bake::sphere_set {

/// A mesh made ready, and the task on it.
struct PreparedFit {
  std::unique_ptr<const ExteriorSolid> solid;
  FitTask task;
};

/// Fails with kInvalidInput and kUnsupported as fitSphereSet does.
[[nodiscard]] Result<PreparedFit> prepareFit(const TriangleMesh& mesh,
                                             const SphereSetOptions& options, unsigned threads);

/// Why there is nothing to fit to: the surface is beyond the support's plane.
[[nodiscard]] tl::unexpected<Error> nothingToCover();
/// Whether an error is that one.
[[nodiscard]] bool isNothingToCover(const Error& error);

/// The cover as a sorted set, measured, but for volume and thin points, and judged by the
/// tolerances of `task`, whichever the cover was made for.
[[nodiscard]] SphereSet finishedSet(const FitTask& task, const Yardstick& yardstick,
                                    const Cover& cover);

/// Fails with kInvalidInput where an option is out of range, naming the option.
[[nodiscard]] Result<void> checkOptions(const SphereSetOptions& options);

/// Fails with kInvalidInput where the mesh has no triangles or vertices that are no numbers, and
/// with kUnsupported where it is too large.
[[nodiscard]] Result<void> checkMesh(const TriangleMesh& mesh);

}  // namespace galactic::bake::sphere_set
