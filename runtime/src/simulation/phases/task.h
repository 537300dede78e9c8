#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "simulation/phases/chunk.h"

namespace galactic::simulation {

/// The current positions of the targets of a chunk's envs.
[[nodiscard]] PointRows targetsNow(const BatchState& state, std::size_t first) noexcept;

/// Distances from the grip to the target and from the target to the goal, meters.
struct TargetDistances {
  float reach = 0;
  float transport = 0;
};
[[nodiscard]] TargetDistances measureTarget(const BatchState& state, std::size_t env) noexcept;

/// The current direction of the side of the target that was up when the episode began, in the world
/// frame.
[[nodiscard]] Vec3 targetUp(const Model& model, const BatchState& state, std::size_t env) noexcept;

/// The length of the way along the floor to the target or, while it is held, to the goal, meters;
/// negative if there is no way or TaskOptions::geodesic_weight is 0.
struct WayLeft {
  float length = -1;
  bool is_to_goal = false;
};
[[nodiscard]] WayLeft measureWay(const Model& model, const BatchState& state,
                                 std::size_t env) noexcept;

/// Counts the step and writes its rewards (paper, equation 1), dones, successes, endings and picks.
/// An env that the caller resets (`resets`: empty, or one number per env of the batch, with a start
/// for each env to reset) gets none of these: its episode is neither rewarded nor counted.
void judge(const ChunkStep& step, std::span<const std::int32_t> resets) noexcept;

}  // namespace galactic::simulation
