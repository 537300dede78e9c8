#pragma once
#include <span>

#include "simulation/phases/chunk.h"

namespace galactic::simulation {

/// The motions that the robots of a chunk really make, in rows: joints, forward, turn. Equal to the
/// actions that reach them (arrivedOf()), unless RobotNoise changes motions.
[[nodiscard]] std::span<const EnvRow> motionsOf(const ChunkStep& step) noexcept;

/// Sets the believed pose of an env's robot, whose episode begins, to its true pose.
void beginOdometry(const Model& model, BatchState& state, std::size_t n) noexcept;

/// Updates the believed poses of a chunk's robots by their noisy perception of how they moved. Does
/// nothing without odometry.
void followOdometry(const ChunkStep& step) noexcept;

/// Moves world points, one for each env of a chunk, to where they would have to be for the robot at
/// its true pose to see them as it believes to from its believed pose. Only with odometry. `first`:
/// the chunk's first env.
void displace(const BatchState& state, std::size_t first, PointRows& points) noexcept;

}  // namespace galactic::simulation
