#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "simulation/collision/floor_query.h"
#include "simulation/phases/chunk.h"
#include "simulation/state/batch_state.h"
#include "simulation/state/model.h"

namespace galactic::simulation {

/// For each env of a chunk all bits if it is selected, else none.
using EnvMask = std::array<std::uint32_t, kChunk>;

/// Stores the frames of the candidates in `wanted` as the bodies of their envs, if the run wants
/// bodies.
void keepBodies(const ChunkStep& step, const EnvMask& wanted) noexcept;

/// Copies the pose of one env to another.
void copyPose(const PoseArrays& from, const PoseArrays& to, std::size_t variables) noexcept;

/// Computes where the robots would be after their actions: base, then joints, each within its
/// limits.
void proposePoses(const ChunkStep& step) noexcept;

/// Puts the candidates on the floor under them.
void followFloor(const ChunkStep& step) noexcept;

/// Forward kinematics of the candidates, down to spheres and grip.
void placeBodies(const ChunkStep& step) noexcept;

/// Accepts each candidate that penetrates nothing, if need be after pushing it clear (paper,
/// appendix I.1); if that fails, the robot stays where it was.
void moveRobots(const ChunkStep& step) noexcept;

/// The floor probe of a candidate under which there is no floor.
[[nodiscard]] Vec3 floorProbe(const ChunkStep& step, std::size_t e) noexcept;

/// The floor under a base in the scene of the chunk's env `e`, mostly without a query of the grid.
[[nodiscard]] FloorUnder floorUnder(const ChunkStep& step, std::size_t e,
                                    const Vec3& base) noexcept;

}  // namespace galactic::simulation
