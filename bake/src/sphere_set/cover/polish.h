#pragma once
#include <span>
#include <vector>

#include "sphere_set/fit_task.h"

namespace galactic::bake::sphere_fit {

/// Moves the spheres a little, each in turn, so that the mean square of the gaps at `points` and of
/// the protrusions falls. No gap grows beyond eps, or beyond the largest that there was; no sphere
/// protrudes beyond tau, or beyond what it did; none leaves the near side of the support.
void polish(const FitTask& task, std::span<const Vec3d> points, int sweeps,
            std::vector<Candidate>& spheres);

}  // namespace galactic::bake::sphere_fit
