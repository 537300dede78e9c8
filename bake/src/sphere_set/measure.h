#pragma once
#include <span>

#include "galactic/bake/sphere_set.h"
#include "sphere_set/fit_task.h"

namespace galactic::bake::sphere_fit {

/// Measures spheres, at least one, on samples that no solver has seen. Their protrusions may be
/// wrong: they are measured. All zero where no surface needs cover.
[[nodiscard]] SphereSetQuality measure(const FitTask& task, std::span<const Candidate> spheres);

}  // namespace galactic::bake::sphere_fit
