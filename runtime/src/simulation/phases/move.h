#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "simulation/phases/chunk.h"
#include "simulation/state/batch_state.h"
#include "simulation/state/model.h"

namespace galactic::simulation {

/// All bits of the envs of a chunk that something is done for.
using EnvMask = std::array<std::uint32_t, kChunk>;

/// The frames of some candidates become the bodies of their envs, where the run wants these.
void keepBodies(const ChunkStep& step, const EnvMask& wanted) noexcept;

/// Where the robots would be after their actions: base, then joints, each within its limits.
void proposePoses(const ChunkStep& step) noexcept;

/// Puts the candidates on the floor under them.
void followFloor(const ChunkStep& step) noexcept;

/// Forward kinematics of the candidates, down to spheres and grip.
void placeBodies(const ChunkStep& step) noexcept;

/// Accepts each candidate that penetrates nothing, if need be after it was pushed clear (paper,
/// appendix I.1); where that fails the robot stays where it was.
void moveRobots(const ChunkStep& step) noexcept;

/// Of a candidate under which there is no floor: the smallest sphere of the working set, standing
/// on a rise as high as the base may climb or, where that is too high for the room in which it was,
/// as high as by default. Where it is free there is a floor under it.
[[nodiscard]] Vec3 floorProbe(const ChunkStep& step, std::size_t e) noexcept;

/// How far a base at `base` (its y: the floor it comes from) is from the floor under it.
struct FloorUnder {
  Floor floor = Floor::kDrops;
  float height = 0;
};
[[nodiscard]] FloorUnder floorUnder(const Scene& scene, const Vec3& base,
                                    const GroundOptions& options) noexcept;
/// The same in the scene of the chunk's env `e`, mostly without a query.
[[nodiscard]] FloorUnder floorUnder(const ChunkStep& step, std::size_t e,
                                    const Vec3& base) noexcept;

}  // namespace galactic::simulation
