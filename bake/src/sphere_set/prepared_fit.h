#pragma once
#include <memory>

#include "galactic/bake/sphere_set.h"
#include "galactic/bake/triangle_mesh.h"
#include "galactic/error.h"
#include "sphere_set/cover/cover_solver.h"
#include "sphere_set/fit_task.h"
#include "sphere_set/measure.h"

namespace galactic::bake::sphere_set {

/// A mesh prepared for fitting, and the task.
struct PreparedFit {
  std::unique_ptr<const ExteriorSolid> solid;
  FitTask task;
};

/// Fails with kInvalidInput and kUnsupported as fitSphereSet does.
[[nodiscard]] Result<PreparedFit> prepareFit(const TriangleMesh& mesh,
                                             const SphereSetOptions& options, unsigned threads);

/// The error that there is nothing to fit, because the surface is beyond the support's plane.
[[nodiscard]] tl::unexpected<Error> nothingToCover();
/// Whether an error is nothingToCover().
[[nodiscard]] bool isNothingToCover(const Error& error);

/// The cover as a sorted, measured set, without volume and thin points. It is judged by the
/// tolerances of `task`, even if the cover was made for others.
[[nodiscard]] SphereSet finishedSet(const FitTask& task, const Yardstick& yardstick,
                                    const Cover& cover);

/// Fails with kInvalidInput if an option is out of range, naming the option.
[[nodiscard]] Result<void> checkOptions(const SphereSetOptions& options);

/// Fails with kInvalidInput if the mesh has no triangles or has coordinates that are not numbers,
/// and with kUnsupported if it is too large.
[[nodiscard]] Result<void> checkMesh(const TriangleMesh& mesh);

}  // namespace galactic::bake::sphere_set
