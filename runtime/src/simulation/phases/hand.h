#pragma once
#include <cstddef>
#include <cstdint>

#include "simulation/phases/chunk.h"

namespace galactic::simulation {

/// Grasps and releases according to the actions. A grasp takes the nearest object that the grip's
/// query sphere touches, which then keeps its pose in the grip. A released object lands (paper,
/// appendix I.2) or goes back to the pose, rotation included, that it had before it was grasped.
void useHands(const ChunkStep& step) noexcept;

/// Puts the resting object `object` into the empty hand of the chunk's env `e`, without moving it.
void takeInHand(const ChunkStep& step, std::size_t e, std::uint32_t object) noexcept;

/// Lays the object in the hand to rest at `world_from_object`.
void layDown(const ChunkStep& step, std::size_t e, const Pose& world_from_object) noexcept;

}  // namespace galactic::simulation
