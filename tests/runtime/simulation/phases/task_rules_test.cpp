// Reward, end and success of every step of wild episodes against a plain reference of the paper's
// appendix A that sees only what an onlooker sees.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <ostream>
#include <string>
#include <vector>

#include "support/homes/every_option.h"
#include "support/homes/small_home_actor.h"
#include "support/homes/task_twins.h"
#include "support/oracles/task_oracle.h"
#include "support/sanitized.h"

namespace galactic::test::task_rules_test {
namespace {

constexpr std::uint32_t kSeed = 20240611;
constexpr std::uint32_t kEnvs = 24;
constexpr int kSteps = kIsSanitized ? 150 : 400;
/// Distances of a few meters in floats, times weights up to 3.
constexpr double kRewardTolerance = 1e-4;

/// How the steps of a run ended.
struct Tally {
  int ended = 0;
  int successes = 0;
  int failures = 0;
  int late = 0;
  std::array<int, kEpisodeEnds> endings{};
  int grasps = 0;
  int picks = 0;
};

/// One case: which task, and which outcomes are to be seen in 10 to 90 % of its episodes.
struct Case {
  std::string name;
  SimulationOptions options;
  bool sees_success = true;
  bool sees_failure = true;
  bool sees_late = true;
  /// The mistakes that the case is to show, each at least five times.
  std::vector<EpisodeEnd> mistakes{};
};

std::ostream& operator<<(std::ostream& out, const Case& one) { return out << one.name; }

SimulationOptions optionsOf(const TaskOptions& task) {
  SimulationOptions options;
  options.envs = kEnvs;
  options.threads = 2;
  options.task = task;
  options.task.most_steps = 42;
  return options;
}

constexpr EpisodeEnd kWrongTerminate = EpisodeEnd::kWrongTerminate;
constexpr EpisodeEnd kWrongRelease = EpisodeEnd::kWrongRelease;
constexpr EpisodeEnd kWrongObject = EpisodeEnd::kWrongObject;

Case paperCase() {
  return {.name = "Paper",
          .options = optionsOf({}),
          .mistakes = {kWrongTerminate, kWrongRelease, kWrongObject}};
}

Case unusualCase() {
  TaskOptions task = everyReward();
  // The oracle does not see for what: observe_test, task_test and geodesic_test do.
  task.bump_penalty = 0;
  task.knock_penalty = 0;
  task.drop_penalty = 0;
  task.geodesic_weight = 0;
  Case unusual{.name = "UnusualNumbers", .options = optionsOf(task)};
  unusual.options.action = {.grasp = 0.2F, .release = -0.5F, .terminate = 0.9F};
  unusual.options.task.most_steps = 30;
  return unusual;
}

std::vector<Case> cases() {
  const TaskOptions none{.kind = TaskKind::kNone};
  const TaskOptions pick{.kind = TaskKind::kMobilePick};
  const TaskOptions lenient_pick{.kind = TaskKind::kMobilePick, .drop_fails = false};
  const TaskOptions no_terminate{.needs_terminate = false};
  const TaskOptions safe_drop{.drop_fails = false};
  const TaskOptions neither{.needs_terminate = false, .drop_fails = false};
  const TaskOptions alone{.distractors = false};
  return {paperCase(),
          unusualCase(),
          {.name = "NoTerminate",
           .options = optionsOf(no_terminate),
           .mistakes = {kWrongRelease, kWrongObject}},
          {.name = "SafeDrop", .options = optionsOf(safe_drop), .mistakes = {kWrongTerminate}},
          {.name = "SafeDropNoTerminate", .options = optionsOf(neither), .sees_failure = false},
          {.name = "NoDistractors", .options = optionsOf(alone)},
          {.name = "MobilePick", .options = optionsOf(pick), .mistakes = {kWrongObject}},
          {.name = "MobilePickAnything", .options = optionsOf(lenient_pick), .sees_failure = false},
          {.name = "None",
           .options = optionsOf(none),
           .sees_success = false,
           .sees_failure = false,
           .sees_late = false}};
}

class TaskRules : public testing::TestWithParam<Case> {
 protected:
  /// Compares one env's last step.
  void check(TaskTwins& twins, std::size_t env, const EnvState& after, const Judgement& wanted) {
    const BatchSimulator& batch = twins.batch();
    ASSERT_NEAR(static_cast<double>(batch.rewards()[env]), wanted.reward, kRewardTolerance);
    ASSERT_EQ(batch.dones()[env] != 0, wanted.done);
    ASSERT_EQ(batch.successes()[env] != 0, wanted.success);
    ASSERT_EQ(batch.endings()[env], wanted.end);
    ++tally_.endings[static_cast<std::size_t>(wanted.end)];
    if (!wanted.done) {
      expectSameState(batch.envState(env), after);
      return;
    }
    ++tally_.ended;
    tally_.successes += wanted.success ? 1 : 0;
    tally_.failures += wanted.failure ? 1 : 0;
    tally_.late += !wanted.success && !wanted.failure ? 1 : 0;
  }

  void expectSeen(bool expected, int count) const {
    if (!expected) return;
    // One in twenty at least: some options make an end rare.
    EXPECT_GE(20 * count, tally_.ended);
    EXPECT_LE(20 * count, 19 * tally_.ended);
  }

  Tally tally_;
};

TEST_P(TaskRules, AreThoseOfThePaper) {
  RecordProperty("seed", static_cast<int>(kSeed));
  const SmallHome home;
  const SimulationOptions& options = GetParam().options;
  TaskTwins twins(home.world(), options);
  std::vector<TaskOracle> oracles(kEnvs, TaskOracle(options.task, options.action));
  std::vector<WildActor> actors;
  for (std::uint32_t env = 0; env < kEnvs; ++env) actors.emplace_back(kSeed + env);
  std::vector<float> actions(kEnvs * kSmallHomeActions);
  double reward = 0;
  for (int step = 0; step < kSteps; ++step) {
    std::vector<EnvState> before;
    for (std::size_t env = 0; env < kEnvs; ++env) {
      before.push_back(twins.batch().envState(env));
      const SmallHomeRow row = actors[env].act(before.back());
      std::copy(row.begin(), row.end(),
                actions.begin() + static_cast<std::ptrdiff_t>(env * kSmallHomeActions));
    }
    twins.step(actions);
    for (std::size_t env = 0; env < kEnvs; ++env) {
      SCOPED_TRACE("step " + std::to_string(step) + " env " + std::to_string(env));
      const EnvState after = twins.after(env);
      const auto row =
          std::span<const float>(actions).subspan(env * kSmallHomeActions, kSmallHomeActions);
      const Judgement wanted = oracles[env].judge(before[env], after, row);
      ASSERT_NO_FATAL_FAILURE(check(twins, env, after, wanted));
      ASSERT_EQ(twins.batch().picks()[env] != 0, wanted.done && oracles[env].hasPicked());
      ASSERT_EQ(twins.hasPicked(env), oracles[env].hasPicked());
      reward += wanted.reward;
      tally_.grasps += before[env].held < 0 && after.held >= 0 ? 1 : 0;
      if (!wanted.done) continue;
      tally_.picks += oracles[env].hasPicked() ? 1 : 0;
      oracles[env].begin();
      actors[env].begin();
    }
    twins.renew();
    for (std::size_t env = 0; env < kEnvs; ++env) {
      expectSameState(twins.batch().envState(env), twins.after(env));
    }
  }
  const SimulationStatistics sum = twins.batch().statistics();
  EXPECT_EQ(sum.steps, std::uint64_t{kEnvs} * kSteps);
  EXPECT_EQ(sum.episodes, static_cast<std::uint64_t>(tally_.ended));
  EXPECT_EQ(sum.successes, static_cast<std::uint64_t>(tally_.successes));
  EXPECT_EQ(sum.failures, static_cast<std::uint64_t>(tally_.failures));
  EXPECT_EQ(sum.picks, static_cast<std::uint64_t>(tally_.picks));
  EXPECT_EQ(sum.grasps, static_cast<std::uint64_t>(tally_.grasps));
  EXPECT_GT(sum.nan_actions, 0U);
  EXPECT_NEAR(sum.reward, reward, kRewardTolerance * kSteps);
  EXPECT_GT(tally_.grasps, kSteps / 10);
  EXPECT_GT(tally_.ended, kSteps / 4);
  expectSeen(true, tally_.picks);
  expectSeen(GetParam().sees_success, tally_.successes);
  expectSeen(GetParam().sees_failure, tally_.failures);
  expectSeen(GetParam().sees_late, tally_.late);
  for (const EpisodeEnd mistake : GetParam().mistakes) {
    EXPECT_GE(tally_.endings[static_cast<std::size_t>(mistake)], 5) << static_cast<int>(mistake);
  }
  std::printf("seed %u: %d episodes, %d successes, %d failures, %d late, %d grasps, %d picks\n",
              kSeed, tally_.ended, tally_.successes, tally_.failures, tally_.late, tally_.grasps,
              tally_.picks);
}

INSTANTIATE_TEST_SUITE_P(Options, TaskRules, testing::ValuesIn(cases()),
                         [](const auto& one) { return one.param.name; });

}  // namespace
}  // namespace galactic::test::task_rules_test
