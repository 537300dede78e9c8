#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "simulation/phases/chunk.h"

namespace galactic::simulation {

/// Where the targets of a chunk's envs are.
[[nodiscard]] PointRows targetsNow(const BatchState& state, std::size_t first) noexcept;

/// How far the target is from grip and goal, meters.
struct TargetDistances {
  float reach = 0;
  float transport = 0;
};
[[nodiscard]] TargetDistances measureTarget(const BatchState& state, std::size_t env) noexcept;

/// Where that side of the target points that was up when the episode began, in the world frame.
[[nodiscard]] Vec3 targetUp(const Model& model, const BatchState& state, std::size_t env) noexcept;

/// The length of the way along the floor to what matters now, the target or once it is held the
/// goal, meters; below 0 without a way, and where TaskOptions::geodesic_weight is 0.
struct WayLeft {
  float length = -1;
  bool is_to_goal = false;
};
[[nodiscard]] WayLeft measureWay(const Model& model, const BatchState& state,
                                 std::size_t env) noexcept;

/// Counts the step; rewards (paper, equation 1), dones, successes, endings and picks of it. Envs of
/// the batch that the caller resets (`resets`: empty, or a number with a start where so) get none:
/// their episode is neither rewarded nor counted.
void judge(const ChunkStep& step, std::span<const std::int32_t> resets) noexcept;

}  // namespace galactic::simulation
