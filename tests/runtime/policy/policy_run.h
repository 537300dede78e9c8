#pragma once
#include <gtest/gtest.h>

#include <cstdint>
#include <optional>
#include <vector>

#include "galactic/learned_policy.h"

namespace galactic::test {

/// A batch with just the observation and the actions that a policy wants.
inline PolicyBatch batchFor(const PolicyInterface& needs, std::size_t envs) {
  PolicyBatch batch;
  batch.envs = envs;
  batch.actions = std::size_t{needs.continuous_actions} + needs.discrete_actions;
  for (const PolicyPart& part : needs.observation) {
    batch.observation.push_back({part.name, batch.observation_size, part.size});
    batch.observation_size += part.size;
  }
  return batch;
}

/// Lets a policy that was accepted act on two envs for two steps, where it takes no gigabytes to
/// see what it wants to see.
inline void actTwice(const PackFile& pack) {
  const Result<PolicyInterface> needs = policyInterface(pack);
  ASSERT_TRUE(needs.has_value()) << needs.error().message;
  const PolicyBatch batch = batchFor(*needs, 2);
  constexpr std::size_t kMost = 1U << 20U;
  if (batch.observation_size > kMost || batch.actions > kMost) return;
  std::size_t pixels = 0;
  if (needs->image) pixels = batch.envs * needs->image->width * needs->image->height;
  if (pixels > kMost) return;
  auto policy = LearnedPolicy::create(pack, batch, {.threads = 1});
  ASSERT_TRUE(policy.has_value()) << policy.error().message;
  const std::vector<float> observations(batch.envs * batch.observation_size, 0.5F);
  const std::vector<std::uint8_t> color(pixels * 3, 100);
  const std::vector<float> depth(pixels, 2);
  const std::vector<std::uint8_t> dones{0, 1};
  std::vector<float> actions(batch.envs * batch.actions);
  for (int step = 0; step < 2; ++step) {
    policy->act({observations, dones, color, depth}, actions);
  }
}

}  // namespace galactic::test
