#include "run/policy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace galactic::policy_test {
namespace {

constexpr ActionLayout kLayout{.joints = 7};
constexpr std::size_t kActions = kLayout.count();

std::vector<float> actionsOf(std::string_view name, const PolicyShape& shape, std::uint64_t step,
                             std::size_t envs) {
  std::vector<float> actions(envs * shape.actions.count(), -9);
  EXPECT_TRUE(makeGeneratedPolicy(name, shape)->act(step, actions));
  return actions;
}

TEST(Policy, KnowsItsNames) {
  EXPECT_TRUE(isGeneratedPolicy("random"));
  EXPECT_TRUE(isGeneratedPolicy("forward"));
  EXPECT_TRUE(isGeneratedPolicy("zero"));
  EXPECT_FALSE(isGeneratedPolicy("Random"));
  EXPECT_FALSE(isGeneratedPolicy("replay:x"));
}

TEST(Policy, ZeroDoesNothing) {
  const auto actions = actionsOf("zero", {.actions = kLayout}, 3, 5);
  ASSERT_FALSE(actions.empty());
  for (const float action : actions) EXPECT_EQ(action, 0);
}

TEST(Policy, GivesAnEnvTheSameActionsInEveryBatch) {
  const PolicyShape whole{.actions = kLayout, .seed = 5};
  const PolicyShape part{.actions = kLayout, .seed = 5, .first_env = 6};
  for (const std::string_view name : {"random", "forward"}) {
    const std::vector<float> all = actionsOf(name, whole, 17, 10);
    const std::vector<float> some = actionsOf(name, part, 17, 3);
    EXPECT_TRUE(std::equal(some.begin(), some.end(), all.begin() + 6 * kActions));
  }
}

TEST(Policy, DependsOnSeedStepAndEnv) {
  const std::vector<float> first = actionsOf("random", {.actions = kLayout, .seed = 5}, 17, 2);
  EXPECT_NE(first, actionsOf("random", {.actions = kLayout, .seed = 6}, 17, 2));
  EXPECT_NE(first, actionsOf("random", {.actions = kLayout, .seed = 5}, 18, 2));
  EXPECT_FALSE(std::equal(first.begin(), first.begin() + kActions, first.begin() + kActions));
}

TEST(Policy, IsUniformAndTerminatesSeldom) {
  constexpr std::size_t kEnvs = 100;
  constexpr std::uint64_t kSteps = 1000;
  for (const ActionLayout& layout :
       {kLayout, ActionLayout{.joints = kLayout.joints + 1},
        ActionLayout{.joints = kLayout.joints, .drives_sideways = true}}) {
    const std::size_t actions = layout.count();
    const auto policy = makeGeneratedPolicy("random", {.actions = layout, .seed = 1});
    const auto ahead = makeGeneratedPolicy("forward", {.actions = layout, .seed = 1});
    std::vector<float> row(kEnvs * actions);
    std::vector<double> sums(actions);
    std::size_t terminates = 0;
    for (std::uint64_t step = 0; step < kSteps; ++step) {
      ASSERT_TRUE(policy->act(step, row));
      for (std::size_t n = 0; n < row.size(); ++n) {
        ASSERT_GE(row[n], -1);
        ASSERT_LE(row[n], 1);
        const bool is_terminate = n % actions == actions - 1;
        if (is_terminate) {
          ASSERT_TRUE(row[n] == 0 || row[n] == 1);
          terminates += row[n] == 1 ? 1U : 0U;
        } else {
          sums[n % actions] += static_cast<double>(row[n]);
        }
      }
      ASSERT_TRUE(ahead->act(step, row));
      for (std::size_t n = layout.forward(); n < row.size(); n += actions) {
        ASSERT_GE(row[n], 0);
        ASSERT_LT(row[n], 1);
      }
    }
    // 100,000 numbers: the mean's deviation is 0.0018, of 200 events 14.
    for (std::size_t n = 0; n + 1 < actions; ++n) EXPECT_NEAR(sums[n] / 1e5, 0, 0.01) << n;
    EXPECT_NEAR(static_cast<double>(terminates), 200, 70);
  }
}

}  // namespace
}  // namespace galactic::policy_test
