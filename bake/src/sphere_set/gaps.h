#pragma once
#include <span>
#include <vector>

#include "sphere_set/fit_task.h"

namespace galactic::bake::sphere_set {

/// Signed distance of `p` to the sphere's surface, negative inside, meters.
[[nodiscard]] double outside(const FitTask& task, const Candidate& sphere, const Vec3d& p);

/// Signed distance of each point to the union of the spheres: negative inside, infinite without
/// spheres.
[[nodiscard]] std::vector<double> gapsOf(const FitTask& task, std::span<const Candidate> spheres,
                                         std::span<const Vec3d> points);

/// The largest of the gaps, at least 0.
[[nodiscard]] double largestOf(std::span<const double> gaps);

}  // namespace galactic::bake::sphere_set
