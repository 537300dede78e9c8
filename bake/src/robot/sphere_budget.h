#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "galactic/bake/sphere_set.h"

namespace galactic::bake {

/// The sets of one curve, by rising count.
using SphereSets = std::span<const SphereSet>;

/// Which set of each curve to take, so that all together have at most `budget` spheres (0: no
/// limit, the tightest sets) and the robot's surface is approximated best: from the loosest sets
/// on, the step that lowers the error times the area most per sphere is taken while one fits. Where
/// even the loosest sets have more, those are taken. Curves may be empty. Deterministic.
[[nodiscard]] std::vector<std::size_t> spendBudget(const std::vector<SphereSets>& curves,
                                                   std::uint32_t budget);

}  // namespace galactic::bake
