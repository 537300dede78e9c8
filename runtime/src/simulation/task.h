#pragma once
#include <cstdint>
#include <span>

#include "simulation/chunk.h"

namespace galactic::simulation {

/// How an episode stands after a step.
enum class Verdict : std::uint8_t { kGoesOn, kSuccess, kFailure, kTimeOut };

/// Where the target is, and how far from grip and goal, metres.
struct TargetDistances {
  Vec3 target;
  float reach = 0;
  float transport = 0;
};
[[nodiscard]] TargetDistances measureTarget(const BatchState& state, std::size_t env) noexcept;

/// The verdict of the task's rules (paper, appendix A). `transport` is the distance of target and
/// goal after the step, in metres.
[[nodiscard]] Verdict verdictOf(const TaskOptions& task, const Env& env, float transport) noexcept;

/// Counts the step; rewards (paper, equation 1), dones and successes of it. Envs of the batch that
/// the caller resets (`resets`: empty, or not negative where so) get none: their episode is neither
/// rewarded nor counted.
void judge(const ChunkStep& step, std::span<const std::int32_t> resets) noexcept;

}  // namespace galactic::simulation
