#pragma once
#include <cstddef>

#include "simulation/phases/chunk.h"
#include "simulation/phases/contacts.h"

namespace galactic::simulation {

/// Slides the candidate of the chunk's env `e` along its obstacles: moves its base until nothing
/// hinders it. `met`: what hinders it at its current place, as the last query found. Returns
/// whether it succeeded.
bool slideClear(const ChunkStep& step, std::size_t e, Hindrance met) noexcept;

}  // namespace galactic::simulation
