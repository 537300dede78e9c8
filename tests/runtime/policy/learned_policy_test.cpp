// Learned policies: against a plain double-precision network, and the promises about threads,
// company, episodes and memory.
#include "galactic/learned_policy.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "runtime/policy/policy_run.h"
#include "runtime/simulation/counted_new.h"
#include "support/oracles/policy_oracle.h"
#include "support/packs/policy_pack_builder.h"
#include "support/sanitized.h"

namespace galactic::test::learned_policy_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// A batch of envs with a policy, and what is seen there: numbers that look random.
class Acting {
 public:
  Acting(const PolicyContent& content, std::size_t envs, const LearnedPolicyOptions& options)
      : content_(content),
        file_(encodePolicyPack(content, smallPolicyProvenance())),
        pack_(*PackFile::view(file_.bytes(), "made.pack")),
        needs_(*policyInterface(pack_)),
        batch_(batchFor(needs_, envs)),
        policy_(*LearnedPolicy::create(pack_, batch_, options)),
        actions_(envs * batch_.actions) {}

  /// What env number `env` of all sees in step `step`.
  [[nodiscard]] PolicySight sightOf(std::size_t env, std::size_t step) const {
    WeightStream numbers(1000 * env + step + 1);
    PolicySight sight;
    sight.observation = numbers.take(batch_.observation_size, 2);
    if (!needs_.image) return sight;
    const std::size_t pixels = std::size_t{needs_.image->width} * needs_.image->height;
    sight.color.resize(3 * pixels);
    for (std::uint8_t& byte : sight.color) {
      byte = static_cast<std::uint8_t>(127.5F + numbers.next(127));
    }
    sight.depth = numbers.take(pixels, 6, 6);
    return sight;
  }

  /// Acts once; env n of the batch sees what env `envs[n]` of all sees.
  std::vector<float> act(const std::vector<std::size_t>& envs, std::size_t step,
                         const std::vector<std::uint8_t>& dones, std::size_t color_bytes = 3) {
    observations_.clear();
    color_.clear();
    depth_.clear();
    for (const std::size_t env : envs) {
      const PolicySight sight = sightOf(env, step);
      observations_.insert(observations_.end(), sight.observation.begin(), sight.observation.end());
      depth_.insert(depth_.end(), sight.depth.begin(), sight.depth.end());
      for (std::size_t n = 0; n < sight.color.size(); n += 3) {
        for (std::size_t c = 0; c < 3; ++c) color_.push_back(sight.color[n + c]);
        if (color_bytes == 4) color_.push_back(99);
      }
    }
    policy_.act({observations_, dones, color_, depth_}, actions_);
    return actions_;
  }

  [[nodiscard]] std::size_t actions() const { return batch_.actions; }
  LearnedPolicy& policy() { return policy_; }
  [[nodiscard]] const PackFile& pack() const { return pack_; }
  [[nodiscard]] const PolicyBatch& batch() const { return batch_; }
  [[nodiscard]] const PolicyContent& content() const { return content_; }
  PolicyInputs lastInputs() { return {observations_, {}, color_, depth_}; }
  std::span<float> lastActions() { return actions_; }

 private:
  PolicyContent content_;
  AlignedBytes file_;
  PackFile pack_;
  PolicyInterface needs_;
  PolicyBatch batch_;
  LearnedPolicy policy_;
  std::vector<float> actions_;
  std::vector<float> observations_;
  std::vector<std::uint8_t> color_;
  std::vector<float> depth_;
};

std::vector<std::size_t> countedFrom(std::size_t first, std::size_t count) {
  std::vector<std::size_t> envs(count);
  for (std::size_t n = 0; n < count; ++n) envs[n] = first + n;
  return envs;
}

/// Whether an episode ended in env `env` before step `step`.
std::uint8_t doneAt(std::size_t env, std::size_t step) {
  return step > 0 && (env * 7 + step * 5) % 6 == 0 ? 1 : 0;
}

std::vector<std::uint8_t> donesOf(const std::vector<std::size_t>& envs, std::size_t step) {
  std::vector<std::uint8_t> dones;
  for (const std::size_t env : envs) dones.push_back(doneAt(env, step));
  return dones;
}

constexpr LearnedPolicyOptions kLikeliest{.samples = false, .threads = 1};

/// Compares the likeliest actions of some steps with the oracle's.
void expectLikeOracle(const PolicyContent& content, std::size_t envs, std::size_t steps) {
  Acting acting(content, envs, kLikeliest);
  std::vector<PolicyOracle> oracles(envs, PolicyOracle(acting.content()));
  std::vector<std::vector<float>> previous(envs, std::vector<float>(acting.actions()));
  const std::vector<std::size_t> all = countedFrom(0, envs);
  // The sums have thousands of terms: float rounding alone moves them so far.
  constexpr double kTolerance = 2e-5;
  std::size_t decided = 0;
  for (std::size_t step = 0; step < steps; ++step) {
    const std::vector<float> actions = acting.act(all, step, donesOf(all, step));
    for (std::size_t env = 0; env < envs; ++env) {
      if (doneAt(env, step) != 0) {
        oracles[env].reset();
        std::ranges::fill(previous[env], 0.0F);
      }
      PolicySight sight = acting.sightOf(env, step);
      sight.previous_actions = previous[env];
      const auto values = oracles[env].run(sight);
      const std::vector<double> wanted = oracles[env].likeliest(values);
      for (std::size_t n = 0; n < wanted.size(); ++n) {
        const float action = actions[env * acting.actions() + n];
        ASSERT_NEAR(static_cast<double>(action), wanted[n], kTolerance)
            << "action " << n << ", env " << env << ", step " << step;
        decided += wanted[n] == 1 ? 1U : 0U;
        previous[env][n] = std::clamp(action, -1.0F, 1.0F);
      }
    }
  }
  if (envs * steps < 10) return;
  // Decisions go both ways.
  const std::size_t decisions = envs * steps * content.discrete.size();
  EXPECT_GE(decided, decisions / 20);
  EXPECT_LE(decided, decisions * 19 / 20);
}

TEST(LearnedPolicy, ActsLikeThePlainNetworkWithALayerOfEveryKind) {
  expectLikeOracle(smallPolicy(), 7, 20);
}

TEST(LearnedPolicy, ActsLikeThePlainNetworkWithoutCamera) {
  expectLikeOracle(policyNetwork("state"), 5, 4);
  expectLikeOracle(policyNetwork("state_gru"), 5, 12);
}

TEST(LearnedPolicy, ActsLikeThePlainNetworkOnImages) {
  expectLikeOracle(policyNetwork("depth_gru"), 3, 4);
  expectLikeOracle(policyNetwork("simple_cnn"), 1, 2);
  // Under sanitizers the plain network takes half a minute for each of these; all kinds of their
  // layers were in a small one.
  if (kIsSanitized) return;
  expectLikeOracle(policyNetwork("resnet9"), 1, 2);
  expectLikeOracle(policyNetwork("resnet18"), 1, 1);
}

TEST(LearnedPolicy, IgnoresTheFourthByteOfColors) {
  Acting three(smallPolicy(), 3, kLikeliest);
  Acting four(smallPolicy(), 3, kLikeliest);
  EXPECT_EQ(three.act({0, 1, 2}, 0, {}), four.act({0, 1, 2}, 0, {}, 4));
}

TEST(LearnedPolicy, DoesTheSameOnAnyNumberOfThreadsAndInAnyCompany) {
  for (const PolicyContent& content :
       {smallPolicy(), policyNetwork("state"), policyNetwork("state_gru")}) {
    constexpr std::size_t kEnvs = 230;
    constexpr std::size_t kSteps = 5;
    Acting together(content, kEnvs, {.seed = 4, .threads = 1});
    Acting threads(content, kEnvs, {.seed = 4, .threads = 3});
    // The same envs in batches of their own, as other ranks have them.
    std::map<std::size_t, Acting> apart;
    for (const auto& [first, count] :
         {std::pair(0U, 1U), std::pair(1U, 99U), std::pair(100U, 130U)}) {
      apart.try_emplace(first, content, count,
                        LearnedPolicyOptions{.seed = 4, .first_env = first, .threads = 2});
    }
    for (std::size_t step = 0; step < kSteps; ++step) {
      const std::vector<std::size_t> all = countedFrom(0, kEnvs);
      const std::vector<float> wanted = together.act(all, step, donesOf(all, step));
      EXPECT_EQ(threads.act(all, step, donesOf(all, step)), wanted);
      std::vector<float> joined;
      for (auto& [first, acting] : apart) {
        const std::size_t count = acting.lastActions().size() / acting.actions();
        const std::vector<std::size_t> envs = countedFrom(first, count);
        const std::vector<float> part = acting.act(envs, step, donesOf(envs, step));
        joined.insert(joined.end(), part.begin(), part.end());
      }
      EXPECT_EQ(joined, wanted);
    }
  }
}

TEST(LearnedPolicy, BeginsAnewWhereAnEpisodeEnded) {
  Acting acting(smallPolicy(), 2, kLikeliest);
  const std::vector<float> first = acting.act({0, 0}, 0, {});
  const std::vector<float> second = acting.act({0, 0}, 0, {1, 0});
  const std::size_t count = acting.actions();
  EXPECT_TRUE(
      std::equal(first.begin(), first.begin() + static_cast<std::ptrdiff_t>(count), second.begin()))
      << "the env whose episode ended is as at first";
  EXPECT_NE(first[count], second[count]) << "the other one remembers";
  acting.policy().reset();
  EXPECT_EQ(acting.act({0, 0}, 0, {}), first);
}

TEST(LearnedPolicy, DrawsFromTheDistributionThatTheNetworkGives) {
  const PolicyContent content = policyNetwork("state");
  constexpr std::size_t kEnvs = 20000;
  Acting acting(content, kEnvs, {.seed = 9, .threads = 2});
  // All envs see the same, so that their actions are draws of one distribution.
  const std::vector<float> actions = acting.act(std::vector<std::size_t>(kEnvs, 3), 0, {});
  PolicyOracle oracle(content);
  const auto values = oracle.run(acting.sightOf(3, 0));
  const std::size_t count = acting.actions();
  const auto& mean = values[content.continuous->mean];
  const auto& log_deviation = values[content.continuous->log_deviation];
  ASSERT_FALSE(mean.empty());
  ASSERT_FALSE(content.discrete.empty());
  for (std::size_t n = 0; n < mean.size(); ++n) {
    double sum = 0;
    double squares = 0;
    for (std::size_t env = 0; env < kEnvs; ++env) {
      const double z =
          (static_cast<double>(actions[env * count + n]) - mean[n]) / std::exp(log_deviation[n]);
      sum += z;
      squares += z * z;
    }
    // Five standard errors.
    EXPECT_NEAR(sum / kEnvs, 0, 0.036) << n;
    EXPECT_NEAR(squares / kEnvs, 1, 0.05) << n;
  }
  for (std::size_t n = 0; n < content.discrete.size(); ++n) {
    const auto& logits = values[content.discrete[n].logits];
    const double wanted = 1 / (1 + std::exp(logits[0] - logits[1]));
    double ones = 0;
    for (std::size_t env = 0; env < kEnvs; ++env) {
      const float action = actions[env * count + mean.size() + n];
      ASSERT_TRUE(action == 0 || action == 1);
      ones += static_cast<double>(action);
    }
    EXPECT_NEAR(ones / kEnvs, wanted, 0.018) << n;
  }
}

TEST(LearnedPolicy, DrawsOtherNumbersInEachStepEnvAndForEachSeed) {
  const PolicyContent content = policyNetwork("state");
  Acting acting(content, 2, {.seed = 1, .threads = 1});
  Acting again(content, 2, {.seed = 1, .threads = 1});
  Acting other(content, 2, {.seed = 2, .threads = 1});
  const std::vector<float> first = acting.act({0, 0}, 0, {});
  EXPECT_EQ(again.act({0, 0}, 0, {}), first);
  EXPECT_NE(first[0], first[acting.actions()]);
  EXPECT_NE(other.act({0, 0}, 0, {})[0], first[0]);
  EXPECT_NE(acting.act({0, 0}, 0, {})[0], first[0]);
}

TEST(LearnedPolicy, DrawsTheSameAgainAfterAReset) {
  Acting acting(smallPolicy(), 3, {.seed = 6, .threads = 1});
  const std::vector<float> first = acting.act({0, 1, 2}, 0, {});
  EXPECT_NE(acting.act({0, 1, 2}, 0, {}), first);
  acting.policy().reset();
  EXPECT_EQ(acting.act({0, 1, 2}, 0, {}), first);
}

TEST(LearnedPolicy, RemembersItsActionsAsSimulationsClampThem) {
  // It asks for 3 more than in the step before.
  PolicyContent content;
  content.interface.name = "counter";
  content.layers = {{{}, layer::Constant{{3}}},
                    {{}, layer::PreviousAction{}},
                    {{0, 1}, layer::Sum{}},
                    {{}, layer::Constant{{-5}}}};
  content.continuous = {.count = 1, .mean = 2, .log_deviation = 3};
  Acting acting(content, 1, kLikeliest);
  EXPECT_THAT(acting.act({0}, 0, {}), ElementsAre(3));
  EXPECT_THAT(acting.act({0}, 1, {}), ElementsAre(4));
}

TEST(LearnedPolicy, ReadsPartsWhereverTheyLieInTheObservation) {
  const AlignedBytes file(encodePolicyPack(policyNetwork("state"), smallPolicyProvenance()));
  const PackFile pack = PackFile::view(file.bytes(), "made.pack").value();
  const PolicyBatch together = batchFor(policyInterface(pack).value(), 1);
  PolicyBatch apart = together;
  apart.observation_size = 0;
  for (ObservationPart& part : apart.observation) {
    part.first = apart.observation_size + 2;
    apart.observation_size = part.first + part.size;
  }
  const std::vector<float> seen = WeightStream(3).take(together.observation_size, 2);
  std::vector<float> spread(apart.observation_size, 1000);
  for (std::size_t n = 0; n < apart.observation.size(); ++n) {
    const auto& [name, first, size] = together.observation[n];
    std::copy_n(seen.data() + first, size, spread.data() + apart.observation[n].first);
  }
  const auto acted = [&](const PolicyBatch& batch, const std::vector<float>& observations) {
    std::vector<float> actions(batch.actions);
    LearnedPolicy::create(pack, batch, kLikeliest)->act({observations, {}, {}, {}}, actions);
    return actions;
  };
  EXPECT_EQ(acted(apart, spread), acted(together, seen));
}

TEST(LearnedPolicy, DrawsAnActionOfManyValuesByItsLogits) {
  PolicyBuilder builder(1);
  builder.content.interface.name = "many";
  const std::uint32_t logits = builder.add({{}, layer::Constant{.values = {0, 1, -40, 0.5F, 2}}});
  builder.content.discrete = {{.logits = logits, .values = {-1, -0.5F, 0, 0.25F, 1}}};
  constexpr std::size_t kEnvs = 20000;
  Acting sampling(builder.content, kEnvs, {.seed = 3, .threads = 1});
  std::map<float, double> seen;
  for (const float action : sampling.act(std::vector<std::size_t>(kEnvs), 0, {})) {
    seen[action] += 1.0 / kEnvs;
  }
  const double sum = 1 + std::exp(1) + std::exp(0.5) + std::exp(2);
  EXPECT_EQ(seen.size(), 4U) << "one value is never drawn";
  EXPECT_NEAR(seen[-1], 1 / sum, 0.012);
  EXPECT_NEAR(seen[-0.5F], std::exp(1) / sum, 0.015);
  EXPECT_NEAR(seen[0.25F], std::exp(0.5) / sum, 0.013);
  EXPECT_NEAR(seen[1], std::exp(2) / sum, 0.018);
  Acting likeliest(builder.content, 1, kLikeliest);
  EXPECT_EQ(likeliest.act({0}, 0, {}), std::vector<float>{1});
}

TEST(LearnedPolicy, AllocatesNothingWhenItActs) {
  for (const std::uint32_t threads : {1U, 3U}) {
    Acting acting(smallPolicy(), 200, {.threads = threads});
    static_cast<void>(acting.act(countedFrom(0, 200), 0, {}));
    const std::uint64_t before = allocationCount();
    for (int step = 0; step < 10; ++step) {
      acting.policy().act(acting.lastInputs(), acting.lastActions());
    }
    EXPECT_EQ(allocationCount(), before);
  }
}

TEST(LearnedPolicy, RefusesABatchThatIsNone) {
  Acting acting(smallPolicy(), 2, kLikeliest);
  const auto refusal = [&](const PolicyBatch& batch) {
    const auto policy = LearnedPolicy::create(acting.pack(), batch, kLikeliest);
    return policy ? std::string("none") : policy.error().text();
  };
  EXPECT_EQ(refusal(acting.batch()), "none");
  PolicyBatch empty = acting.batch();
  empty.envs = 0;
  EXPECT_THAT(refusal(empty), HasSubstr("has no envs"));
  for (const std::size_t first : {acting.batch().observation_size, ~std::size_t{0}}) {
    PolicyBatch beyond = acting.batch();
    beyond.observation.back().first = first;
    EXPECT_THAT(refusal(beyond), HasSubstr("expected them within its"));
  }
}

TEST(LearnedPolicy, TellsItsThreadsAndItsMemory) {
  Acting acting(policyNetwork("simple_cnn"), 4, {.threads = 2});
  EXPECT_EQ(acting.policy().threadCount(), 2U);
  EXPECT_GT(acting.policy().memoryBytes(), 4'000'000U * sizeof(float));
  EXPECT_LT(acting.policy().memoryBytes(), 50'000'000U);
  EXPECT_EQ(Acting(smallPolicy(), 2, {.threads = 9}).policy().threadCount(), 2U);
}

}  // namespace
}  // namespace galactic::test::learned_policy_test
