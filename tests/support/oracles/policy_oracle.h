#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "galactic/policy_pack.h"

namespace galactic::test {

/// What a policy sees in one env.
struct PolicySight {
  /// The parts that it reads, one behind the other.
  std::vector<float> observation;
  std::vector<float> previous_actions;
  /// height x width x 3, and height x width.
  std::vector<std::uint8_t> color;
  std::vector<float> depth;
};

/// A policy in double precision, layer by layer as schema/policy.fbs says it, without any thought
/// of speed: what LearnedPolicy is compared with. Values are in the order channel, row, column.
class PolicyOracle {
 public:
  /// `content` must outlive it.
  explicit PolicyOracle(const PolicyContent& content);

  /// The values of all layers; moves the recurrent states on.
  std::vector<std::vector<double>> run(const PolicySight& sight);

  /// An episode begins.
  void reset();

  /// The likeliest actions, from what run() returned.
  [[nodiscard]] std::vector<double> likeliest(const std::vector<std::vector<double>>& values) const;

 private:
  const PolicyContent& content_;
  /// Of each layer; empty where it has none.
  std::vector<std::vector<double>> states_;
};

}  // namespace galactic::test
