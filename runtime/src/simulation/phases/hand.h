#pragma once
#include <cstddef>
#include <cstdint>

#include "simulation/phases/chunk.h"

namespace galactic::simulation {

/// Grasps and releases as the actions say: the nearest object that the grip's query sphere touches
/// keeps its pose in the grip; a released one lands (paper, appendix I.2) or goes back to the pose,
/// rotation included, that it had before it was grasped.
void useHands(const ChunkStep& step) noexcept;

/// The hand of the chunk's env `e`, which is empty, holds the resting object `object` where it is.
void takeInHand(const ChunkStep& step, std::size_t e, std::uint32_t object) noexcept;

/// The object in the hand rests at `world_from_object` now.
void layDown(const ChunkStep& step, std::size_t e, const Pose& world_from_object) noexcept;

}  // namespace galactic::simulation
