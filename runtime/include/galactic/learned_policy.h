#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "galactic/batch_simulator.h"
#include "galactic/error.h"
#include "galactic/pack.h"
#include "galactic/policy_pack.h"

namespace galactic {

/// The batch that a policy acts in.
struct PolicyBatch {
  std::size_t envs = 0;
  /// Per env.
  std::size_t actions = 0;
  std::size_t observation_size = 0;
  /// The parts of an env's observation: BatchSimulator::observationParts().
  std::vector<ObservationPart> observation = {};
  /// Empty: not known.
  std::string robot = {};
};

/// The batch of a simulator.
[[nodiscard]] PolicyBatch policyBatchOf(const BatchSimulator& simulator);

struct LearnedPolicyOptions {
  /// Whether actions are drawn from the policy's distribution, as in training; otherwise they are
  /// its means and most likely values.
  bool samples = true;
  std::uint64_t seed = 1;
  /// Number of the batch's first env over all ranks.
  std::uint32_t first_env = 0;
  /// 0: one per processor. Actions do not depend on it.
  std::uint32_t threads = 0;
};

/// A policy's inputs for all envs, env after env.
struct PolicyInputs {
  /// Shape: envs x observation_size.
  std::span<const float> observations = {};
  /// 1 where an episode ended in the last step, which resets the recurrent state and the previous
  /// action; empty: nowhere. Shape: envs.
  std::span<const std::uint8_t> dones = {};
  /// Shape: envs x height x width x 3, or x 4, of which the last byte is ignored. Empty if the
  /// policy needs no color.
  std::span<const std::uint8_t> color = {};
  /// Shape: envs x height x width, meters. Empty if the policy needs no depth.
  std::span<const float> depth = {};
};

/// A policy pack's network, ready to act in a batch. What it does in an env depends only on (pack,
/// options, number of the env, what it has seen there). It is the same, bit for bit, for any number
/// of threads and of other envs, and on any processor. Acting neither allocates, nor throws, nor
/// locks, except that arrays of the wrong length throw ErrorException with kInvalidInput. Not safe
/// to call from several threads at once.
class LearnedPolicy {
 public:
  /// Arranges the weights for this processor; `pack` is not needed afterwards. Fails with
  /// kInvalidInput if `pack` holds no policy, if the robot, observation or actions of the batch are
  /// not those that the policy was trained for (the message names what differs), if the batch has
  /// no envs, or if a part of its observation is not within observation_size.
  [[nodiscard]] static Result<LearnedPolicy> create(const PackFile& pack, const PolicyBatch& batch,
                                                    const LearnedPolicyOptions& options);
  ~LearnedPolicy();
  LearnedPolicy(LearnedPolicy&&) noexcept;
  LearnedPolicy& operator=(LearnedPolicy&&) noexcept;

  /// Computes the actions of all envs for the next step. Shape of `actions`: envs x actions, as
  /// BatchSimulator::step() takes them. Call this once before each step.
  void act(const PolicyInputs& inputs, std::span<float> actions);

  /// Resets all envs, with the random numbers of a batch whose first env has this number.
  void reset(std::uint32_t first_env) noexcept;
  /// Resets all envs.
  void reset() noexcept;

  [[nodiscard]] const PolicyInterface& interface() const;
  [[nodiscard]] std::size_t threadCount() const;
  /// Memory used by weights, recurrent states and scratch space, bytes.
  [[nodiscard]] std::size_t memoryBytes() const;

 private:
  class Impl;
  explicit LearnedPolicy(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace galactic
