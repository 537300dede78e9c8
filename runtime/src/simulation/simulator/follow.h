#pragma once
#include <span>

#include "simulation/phases/chunk.h"

namespace galactic::simulation {

/// Follows a step of the chunk's envs that was made elsewhere: see BatchSimulator::follow.
/// `actions` and `states`: those of the whole batch.
void followChunk(const ChunkStep& step, std::span<const float> actions,
                 std::span<const FollowedState> states) noexcept;

}  // namespace galactic::simulation
