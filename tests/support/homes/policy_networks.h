#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "galactic/policy_pack.h"

namespace galactic::test {

/// Numbers that look random and are the same everywhere: multiples of 2^-12.
class WeightStream {
 public:
  explicit WeightStream(std::uint64_t seed) : state_(seed * 0x9E3779B97F4A7C15ULL + 1) {}

  /// In [-scale, scale).
  float next(float scale) {
    state_ ^= state_ >> 12U;
    state_ ^= state_ << 25U;
    state_ ^= state_ >> 27U;
    const auto top = static_cast<std::int32_t>((state_ * 0x2545F4914F6CDD1DULL) >> 51U);
    return scale * (static_cast<float>(top) * 0x1p-12F - 1);
  }
  std::vector<float> take(std::size_t count, float scale, float offset = 0) {
    std::vector<float> values(count);
    for (float& value : values) value = offset + next(scale);
    return values;
  }

 private:
  std::uint64_t state_;
};

/// Puts a policy together layer by layer, with weights of a stream, scaled so that values neither
/// vanish nor grow from layer to layer. Each function returns the layer's number.
class PolicyBuilder {
 public:
  explicit PolicyBuilder(std::uint64_t seed) : weights_(seed) {}

  std::uint32_t add(PolicyLayer layer);
  std::uint32_t linear(std::uint32_t from, std::uint32_t inputs, std::uint32_t outputs,
                       bool bias = true);
  struct Kernel {
    std::uint32_t inputs = 0;
    std::uint32_t outputs = 0;
    std::uint32_t size = 1;
    std::uint32_t stride = 1;
    std::uint32_t padding = 0;
    bool bias = false;
  };
  std::uint32_t convolution(std::uint32_t from, const Kernel& kernel);
  std::uint32_t groupNorm(std::uint32_t from, std::uint32_t channels, std::uint32_t groups);
  std::uint32_t layerNorm(std::uint32_t from, std::uint32_t size);
  std::uint32_t normalize(std::uint32_t from, std::uint32_t channels);
  std::uint32_t gru(std::uint32_t from, std::uint32_t inputs, std::uint32_t size);
  std::uint32_t relu(std::uint32_t from) { return add({{from}, layer::Relu{}}); }
  std::uint32_t tanh(std::uint32_t from) { return add({{from}, layer::Tanh{}}); }

  /// Adds the paper's heads on a vector of `size`: means, logarithms of deviations, two decisions.
  void heads(std::uint32_t from, std::uint32_t size, std::uint32_t continuous = 9);

  PolicyContent content;
  WeightStream& weights() { return weights_; }

 private:
  WeightStream weights_;
};

/// The observation of a simulation with so many joints.
std::vector<PolicyPart> plainObservation(std::uint32_t joints = 7);

/// The networks that robots learn with, for one of seven joints: "state" (two layers of 128),
/// "state_gru" (the same and a GRU), "depth_gru" (that with a depth camera); and the paper's:
/// "simple_cnn", "resnet9", "resnet18".
PolicyContent policyNetwork(const std::string& name, std::uint64_t seed = 1);

/// A policy with a layer of every kind, as small as each can be and still be wrong in every field.
PolicyContent smallPolicy();

PolicyProvenance smallPolicyProvenance();

}  // namespace galactic::test
