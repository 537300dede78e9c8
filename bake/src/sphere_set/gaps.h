#pragma once
#include <span>
#include <vector>

#include "sphere_set/fit_task.h"

namespace galactic::bake::sphere_set {

/// Distance of `p` to the sphere's inside: negative in it, meters.
[[nodiscard]] double outside(const FitTask& task, const Candidate& sphere, const Vec3d& p);

/// For each point its distance to the union of the spheres: negative inside, infinite without any.
[[nodiscard]] std::vector<double> gapsOf(const FitTask& task, std::span<const Candidate> spheres,
                                         std::span<const Vec3d> points);

/// The greatest of the gaps, at least 0.
[[nodiscard]] double largestOf(std::span<const double> gaps);

}  // namespace galactic::bake::sphere_set
