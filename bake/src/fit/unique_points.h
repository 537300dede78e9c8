#pragma once
#include <span>
#include <vector>

#include "galactic/pose.h"

namespace galactic::bake::fit {

/// `points` (finite) without repetitions, in ascending order of x, y, z: what is fitted to them
/// depends neither on their order nor on how often a mesh repeats its vertices.
[[nodiscard]] std::vector<Vec3> uniquePoints(std::span<const Vec3> points);

}  // namespace galactic::bake::fit
