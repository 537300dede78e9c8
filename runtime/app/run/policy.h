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

  /// Fills in the actions of step `step` (from 0, in order), env by env, as BatchSimulator::step
  /// takes them. Fails if the source of the actions fails.
  [[nodiscard]] virtual Result<void> act(std::uint64_t step, std::span<float> actions) = 0;

  /// Forgets the past: all envs begin anew, with the random numbers of a batch whose first env has
  /// this number over all ranks. Policies that depend only on the state have nothing to forget.
  virtual void restart(std::uint32_t /*first_env*/) {}

  /// Whether joints lag behind the positions that actions ask for, as with motors, from the next
  /// episode on. Most policies see where the joints are and need not know.
  virtual void expectLag(bool /*lags*/) {}
};

/// The name of the policy that solves the task with a plan: see ScriptedPolicy.
inline constexpr std::string_view kScriptedPolicy = "scripted";

/// What the numbers of a generated policy depend on: those of an env only on its number over all
/// ranks, so that they are the same in any batch that contains the env.
struct PolicyShape {
  ActionLayout actions;
  std::uint64_t seed = 0;
  /// Number over all ranks of the batch's first env.
  std::uint64_t first_env = 0;
};

/// Whether there is a policy of this name that generates its actions.
[[nodiscard]] bool isGeneratedPolicy(std::string_view name);

/// Makes the policy of a name that isGeneratedPolicy() accepts:
/// - random: each action uniform in [-1, 1), but terminate is 1 once in 500 steps, otherwise 0;
/// - forward: the same, but the base always drives ahead, uniform in [0, 1);
/// - zero: only zeros, which leave the robot where it is and its hand open.
/// The numbers are hashes (XXH3) of step, env and action: reproducible everywhere.
[[nodiscard]] std::unique_ptr<Policy> makeGeneratedPolicy(std::string_view name,
                                                          const PolicyShape& shape);

}  // namespace galactic
