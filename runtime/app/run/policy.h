#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include "galactic/batch_simulator.h"
#include "galactic/error.h"

namespace galactic {

/// Where a run's actions come from.
class Policy {
 public:
  Policy() = default;
  virtual ~Policy() = default;
  Policy(const Policy&) = delete;
  Policy& operator=(const Policy&) = delete;
  Policy(Policy&&) = delete;
  Policy& operator=(Policy&&) = delete;

  /// Fills the actions of step `step` (from 0, in order), env after env, as BatchSimulator::step
  /// wants them. Fails as its source does.
  [[nodiscard]] virtual Result<void> act(std::uint64_t step, std::span<float> actions) = 0;

  /// Forgets what it did: all envs begin anew, with the random numbers of a batch whose first env
  /// has this number over all ranks. Policies that look at the state alone have nothing to forget.
  virtual void restart(std::uint32_t /*first_env*/) {}

  /// Whether joints get later to where actions ask them to be, as motors do, from the next episode
  /// on. Most policies look at where the joints are and need not know.
  virtual void expectLag(bool /*lags*/) {}
};

/// The name of the policy that solves the task with a plan: see ScriptedPolicy.
inline constexpr std::string_view kScriptedPolicy = "scripted";

/// What a generated policy's numbers depend on: an env's on its number over all ranks only, so that
/// they are the same for any batch that it is part of.
struct PolicyShape {
  ActionLayout actions;
  std::uint64_t seed = 0;
  /// Number of the batch's first env over all ranks.
  std::uint64_t first_env = 0;
};

/// Whether there is a policy of this name that makes up its actions.
[[nodiscard]] bool isGeneratedPolicy(std::string_view name);

/// The policy of a name that isGeneratedPolicy() accepts:
/// - random: each action uniform in [-1, 1), but terminate is 1 once in 500 steps, else 0;
/// - forward: the same, but the base always drives ahead, uniform in [0, 1);
/// - zero: nothing but zeros, which leaves the robot where it is and its hand open.
/// The numbers are hashes (XXH3) of step, env and action: reproducible everywhere.
[[nodiscard]] std::unique_ptr<Policy> makeGeneratedPolicy(std::string_view name,
                                                          const PolicyShape& shape);

}  // namespace galactic
