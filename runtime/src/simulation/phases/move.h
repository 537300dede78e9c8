#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "simulation/collision/floor_query.h"
#include "simulation/phases/chunk.h"
#include "simulation/state/batch_state.h"
#include "simulation/state/model.h"

namespace galactic::simulation {

/// All bits of the envs of a chunk that something is done for.
using EnvMask = std::array<std::uint32_t, kChunk>;

/// The frames of some candidates become the bodies of their envs, where the run wants these.
void keepBodies(const ChunkStep& step, const EnvMask& wanted) noexcept;

/// The pose of one env becomes that of another.
void copyPose(const PoseArrays& from, const PoseArrays& to, std::size_t variables) noexcept;

/// Where the robots would be after their actions: base, then joints, each within its limits.
void proposePoses(const ChunkStep& step) noexcept;

/// Puts the candidates on the floor under them.
void followFloor(const ChunkStep& step) noexcept;

/// Forward kinematics of the candidates, down to spheres and grip.
void placeBodies(const ChunkStep& step) noexcept;

/// Accepts each candidate that penetrates nothing, if need be after it was pushed clear (paper,
/// appendix I.1); where that fails the robot stays where it was.
void moveRobots(const ChunkStep& step) noexcept;

/// The floor probe of a candidate under which there is no floor.
[[nodiscard]] Vec3 floorProbe(const ChunkStep& step, std::size_t e) noexcept;

/// What is under a base in the scene of the chunk's env `e`, mostly without a query.
[[nodiscard]] FloorUnder floorUnder(const ChunkStep& step, std::size_t e,
                                    const Vec3& base) noexcept;

}  // namespace galactic::simulation
