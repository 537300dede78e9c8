#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "policy/kernels.h"
#include "support/random_stream.h"

namespace galactic::policy {

/// What a network says about the actions of one env.
struct ActionValues {
  /// One for each continuous action.
  const float* mean = nullptr;
  const float* log_deviation = nullptr;
  /// For each discrete action its logits.
  std::span<const float* const> logits;
};

/// Decides actions from what a network says. Holds scratch memory: one for each thread.
class ActionSampler {
 public:
  /// `values`: of each discrete action, what it may be.
  ActionSampler(std::size_t continuous, std::vector<std::vector<float>> values);

  /// Means, and the values with the largest logits, the first of equal ones.
  void takeLikeliest(const ActionValues& said, std::span<float> actions) const noexcept;

  /// Normally distributed numbers, and values with the probabilities that the logits give.
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
