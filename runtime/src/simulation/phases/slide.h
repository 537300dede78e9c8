#pragma once
#include <cstddef>

#include "simulation/phases/chunk.h"

namespace galactic::simulation {

/// Slides the candidate of the chunk's env `e`, of which isFree() has just said that it is not
/// free, along what blocks it: moves its base until it is. Whether it succeeded.
bool slideClear(const ChunkStep& step, std::size_t e) noexcept;

}  // namespace galactic::simulation
