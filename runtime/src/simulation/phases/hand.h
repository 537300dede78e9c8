#pragma once
#include "simulation/phases/chunk.h"

namespace galactic::simulation {

/// Grasps and releases as the actions say: the nearest object that the grip's query sphere touches
/// keeps its pose in the grip; a released one lands (paper, appendix I.2) or goes back to the pose,
/// rotation included, that it had before it was grasped.
void useHands(const ChunkStep& step) noexcept;

}  // namespace galactic::simulation
