#include "policy/action_sampler.h"

#include <algorithm>
#include <utility>

namespace galactic::policy {
namespace {

/// Random numbers that are made together.
constexpr std::size_t kNoise = 16;

std::size_t roundedUp(std::size_t count, std::size_t step) {
  return (count + step - 1) / step * step;
}

std::size_t mostValues(const std::vector<std::vector<float>>& values) {
  std::size_t most = 0;
  for (const std::vector<float>& of_action : values) most = std::max(most, of_action.size());
  return most;
}

}  // namespace

ActionSampler::ActionSampler(std::size_t continuous, std::vector<std::vector<float>> values)
    : continuous_(continuous),
      values_(std::move(values)),
      words_(kNoise),
      noise_(roundedUp(continuous, kNoise)),
      exponents_(roundedUp(std::max(continuous, mostValues(values_)), kLane)) {}

void ActionSampler::takeLikeliest(const ActionValues& said,
                                  std::span<float> actions) const noexcept {
  std::copy_n(said.mean, continuous_, actions.begin());
  for (std::size_t n = 0; n < values_.size(); ++n) {
    actions[continuous_ + n] = values_[n][likeliest(said.logits[n], values_[n].size())];
  }
}

void ActionSampler::sample(const Kernels& kernels, const ActionValues& said, RandomStream random,
                           std::span<float> actions) noexcept {
  for (std::size_t first = 0; first < continuous_; first += kNoise) {
    for (std::size_t n = 0; n < kNoise; n += 2) {
      const std::uint64_t bits = random.next();
      words_[n] = static_cast<std::uint32_t>(bits);
      words_[n + 1] = static_cast<std::uint32_t>(bits >> 32U);
    }
    kernels.gaussians(words_.data(), noise_.data() + first);
  }
  if (continuous_ > 0) {
    std::copy_n(said.log_deviation, continuous_, exponents_.begin());
    kernels.exp(exponents_.data(), exponents_.data(), continuous_);
  }
  for (std::size_t n = 0; n < continuous_; ++n) {
    actions[n] = said.mean[n] + exponents_[n] * noise_[n];
  }
  for (std::size_t n = 0; n < values_.size(); ++n) {
    const std::size_t count = values_[n].size();
    const float* logits = said.logits[n];
    const float largest = logits[likeliest(logits, count)];
    std::transform(logits, logits + count, exponents_.begin(),
                   [largest](float logit) { return logit - largest; });
    kernels.exp(exponents_.data(), exponents_.data(), count);
    float sum = 0;
    for (std::size_t k = 0; k < count; ++k) sum += exponents_[k];
    float left = random.unit() * sum;
    std::size_t chosen = 0;
    while (chosen + 1 < count && !(left < exponents_[chosen])) left -= exponents_[chosen++];
    actions[continuous_ + n] = values_[n][chosen];
  }
}

std::size_t ActionSampler::likeliest(const float* logits, std::size_t count) const noexcept {
  return static_cast<std::size_t>(std::max_element(logits, logits + count) - logits);
}

}  // namespace galactic::policy
