#pragma once
#include <cstddef>

#include "simulation/phases/chunk.h"
#include "simulation/phases/contacts.h"

namespace galactic::simulation {

/// Slides the candidate of the chunk's env `e` along what hinders it: moves its base until nothing
/// does. `met`: what hinders it where it is, as found by the last look. Whether it succeeded.
bool slideClear(const ChunkStep& step, std::size_t e, Hindrance met) noexcept;

}  // namespace galactic::simulation
