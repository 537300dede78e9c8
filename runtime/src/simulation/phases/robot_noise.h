#pragma once
#include <span>

#include "simulation/phases/chunk.h"

namespace galactic::simulation {

/// What the robots of a chunk do of what their actions ask for, in rows: joints, forward, turn.
/// What reaches them (arrivedOf()), unless RobotNoise changes motions.
[[nodiscard]] std::span<const EnvRow> motionsOf(const ChunkStep& step) noexcept;

/// The robot of an env knows where it is: its episode begins.
void beginOdometry(const Model& model, BatchState& state, std::size_t n) noexcept;

/// Adds what the robots of a chunk have moved to where they take themselves to be. Only where there
/// is odometry.
void followOdometry(const ChunkStep& step) noexcept;

/// Moves points of the world, one for each env of a chunk, to where the robots take them to be
/// seen from themselves: they know the points by their place in the world. Only where there is
/// odometry. `first`: env of the chunk.
void displace(const BatchState& state, std::size_t first, PointRows& points) noexcept;

}  // namespace galactic::simulation
