#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "galactic/bake/sphere_set.h"

namespace galactic::bake {

/// Which set of each curve to take, so that all together have at most `budget` spheres (0: no
/// limit, the finest sets) and the robot's surface is approximated best: from the coarsest sets on,
/// the step that lowers the error times the area most per sphere is taken while one fits. Where
/// even the coarsest sets have more, those are taken. Curves may be empty. Deterministic.
[[nodiscard]] std::vector<std::size_t> spendBudget(const std::vector<SphereCurve>& curves,
                                                   std::uint32_t budget);

}  // namespace galactic::bake
