#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "policy/kernels.h"
#include "support/random_stream.h"

namespace galactic::policy {

/// What a network outputs for the actions of one env.
struct ActionValues {
  /// One value for each continuous action.
  const float* mean = nullptr;
  const float* log_deviation = nullptr;
  /// The logits of each discrete action.
  std::span<const float* const> logits;
};

/// Turns the outputs of a network into actions. Holds scratch memory: use one for each thread.
class ActionSampler {
 public:
  /// `values`: for each discrete action, the values that it can take.
  ActionSampler(std::size_t continuous, std::vector<std::vector<float>> values);

  /// Takes means, and the values with the largest logits (the first of equal ones).
  void takeLikeliest(const ActionValues& said, std::span<float> actions) const noexcept;

  /// Samples from normal distributions, and values with the probabilities that the logits give.
  void sample(const Kernels& kernels, const ActionValues& said, RandomStream random,
              std::span<float> actions) noexcept;

 private:
  [[nodiscard]] std::size_t likeliest(const float* logits, std::size_t count) const noexcept;

  std::size_t continuous_;
  std::vector<std::vector<float>> values_;
  std::vector<std::uint32_t> words_;
  std::vector<float> noise_;
  std::vector<float> exponents_;
};

}  // namespace galactic::policy
