// Actions that arrive late: by as many steps as it says, from where an episode begins, whatever
// becomes of the batch.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "runtime/simulation/batch_trace.h"

namespace galactic::test::action_delay_test {
namespace {

using testing::HasSubstr;

/// Far more than a hand and a robot need to do something.
constexpr std::uint32_t kSteps = 150;

SimulationOptions delayed(const DrawnCount& delay, std::uint32_t envs, std::uint32_t threads = 1) {
  SimulationOptions options = optionsFor(envs, threads);
  options.noise = {.motion = {0, 0.2F}, .localization = {0, 0.1F}, .action_delay = delay};
  // Of what was asked for, which is not what arrives.
  options.task.action_weight = 0;
  return options;
}

BatchSimulator made(const BoxWorld& world, const SimulationOptions& options) {
  return BatchSimulator::create(world.world(), options).value();
}

constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();

/// What reaches robots, as one would do it without the simulator.
class LateActions {
 public:
  explicit LateActions(std::size_t envs) : asked_(envs) {}

  /// `actions`: those of the next step of `simulator`.
  std::vector<float> arriving(const BatchSimulator& simulator, const std::vector<float>& actions) {
    const std::size_t count = simulator.actionCount();
    std::vector<float> arrived;
    for (std::size_t env = 0; env < asked_.size(); ++env) {
      std::vector<std::vector<float>>& asked = asked_[env];
      if (simulator.envState(env).step == 0) asked.clear();
      const auto row = actions.begin() + static_cast<std::ptrdiff_t>(env * count);
      asked.emplace_back(row, row + static_cast<std::ptrdiff_t>(count));
      const std::size_t delay = simulator.episodeNoise(env).action_delay;
      const bool has_come = delay < asked.size();
      // Hands are empty where episodes begin.
      std::vector<float> still(count, 0.0F);
      const auto& due = has_come ? asked[asked.size() - 1 - delay] : still;
      arrived.insert(arrived.end(), due.begin(), due.end());
    }
    return arrived;
  }

  /// What is on its way to an env of `simulator`.
  [[nodiscard]] std::vector<float> underWay(const BatchSimulator& simulator,
                                            std::size_t env) const {
    const bool has_begun = simulator.envState(env).step == 0;
    const std::vector<std::vector<float>> none;
    const std::vector<std::vector<float>>& asked = has_begun ? none : asked_[env];
    std::vector<float> before(simulator.actionCount(), 0.0F);
    before[simulator.actionLayout().hand()] = kNothing;
    before[simulator.actionLayout().terminate()] = kNothing;
    std::vector<float> actions;
    for (std::size_t ago = simulator.episodeNoise(env).action_delay; ago > 0; --ago) {
      const auto& action = ago <= asked.size() ? asked[asked.size() - ago] : before;
      actions.insert(actions.end(), action.begin(), action.end());
    }
    return actions;
  }

 private:
  /// By env, of its episode: step after step.
  std::vector<std::vector<std::vector<float>>> asked_;
};

TEST(ActionDelay, LetsRobotsDoWhatTheyWereAskedToStepsLater) {
  const BoxWorld world = furnishedWorld();
  constexpr std::uint32_t kEnvs = 53;
  for (const DrawnCount& delay : {DrawnCount(1), DrawnCount(4), DrawnCount(0, 3)}) {
    BatchSimulator late = made(world, delayed(delay, kEnvs));
    BatchSimulator prompt = made(world, delayed(0, kEnvs));
    LateActions oracle(kEnvs);
    for (std::uint32_t step = 0; step < kSteps; ++step) {
      const std::vector<float> actions = actionsFor(late, 0, step);
      prompt.step(oracle.arriving(late, actions));
      late.step(actions);
      ASSERT_EQ(BatchTrace(late).hashes(), BatchTrace(prompt).hashes())
          << "step " << step << ", delay " << drawnText(delay);
    }
    EXPECT_GT(late.statistics().episodes, 2 * kEnvs);
    EXPECT_GT(late.statistics().grasps, 20U);
    EXPECT_GT(late.statistics().failures, 20U) << "released or terminated";
  }
}

/// Whether two arrays have the same bits, numbers that are none included.
testing::AssertionResult areSame(const std::vector<float>& found,
                                 const std::vector<float>& wanted) {
  const bool same = found.size() == wanted.size() &&
                    (found.empty() ||
                     std::memcmp(found.data(), wanted.data(), found.size() * sizeof(float)) == 0);
  return same ? testing::AssertionSuccess()
              : testing::AssertionFailure() << testing::PrintToString(found) << ", expected "
                                            << testing::PrintToString(wanted);
}

TEST(ActionDelay, TellsWhatIsUnderWay) {
  const BoxWorld world = furnishedWorld();
  constexpr std::uint32_t kEnvs = 21;
  for (const std::uint32_t shown : {0U, 7U}) {
    SimulationOptions options = delayed({0, 4}, kEnvs);
    // More steps are kept than an action can be late by.
    options.sensors.last_actions = shown;
    BatchSimulator late = made(world, options);
    LateActions oracle(kEnvs);
    for (std::uint32_t step = 0; step < 40; ++step) {
      const std::vector<float> actions = actionsFor(late, 0, step);
      for (std::size_t env = 0; env < kEnvs; ++env) {
        ASSERT_TRUE(areSame(late.actionsUnderWay(env), oracle.underWay(late, env)))
            << "env " << env << ", step " << step;
      }
      static_cast<void>(oracle.arriving(late, actions));
      late.step(actions);
    }
    EXPECT_GT(late.statistics().episodes, 10U);
  }
  EXPECT_TRUE(made(world, delayed(0, 1)).actionsUnderWay(0).empty());
}

TEST(ActionDelay, IsPaidForWhenItIsAsked) {
  const BoxWorld world = furnishedWorld();
  SimulationOptions options = delayed(3, 20);
  options.task.kind = TaskKind::kRearrange;
  BatchSimulator free_of_charge = made(world, options);
  options.task.action_weight = 1;
  BatchSimulator charged = made(world, options);
  std::vector<float> before;
  for (std::uint32_t step = 0; step < 10; ++step) {
    const std::vector<float> actions = actionsFor(charged, 0, step);
    free_of_charge.step(actions);
    charged.step(actions);
    for (std::size_t env = 0; env < 20 && step > 0; ++env) {
      if (charged.envState(env).step != step + 1) continue;
      float change = 0;
      for (std::size_t joint = 0; joint < kCartJoints; ++joint) {
        const std::size_t at = env * kCartActions + joint;
        change += (actions[at] - before[at]) * (actions[at] - before[at]);
      }
      EXPECT_NEAR(free_of_charge.rewards()[env] - charged.rewards()[env], change, 1e-4F);
    }
    before = actions;
  }
}

TEST(ActionDelay, IsDrawnAnewInEachEpisodeFromTheWholeRange) {
  const BoxWorld world = furnishedWorld();
  constexpr std::uint32_t kEnvs = 3000;
  SimulationOptions options = delayed({1, 3}, kEnvs);
  options.task.most_steps = 2;
  BatchSimulator simulator = made(world, options);
  const auto drawn = [&] {
    std::vector<std::uint32_t> delays;
    for (std::size_t env = 0; env < kEnvs; ++env) {
      delays.push_back(simulator.episodeNoise(env).action_delay);
    }
    return delays;
  };
  const std::vector<std::uint32_t> first = drawn();
  for (const std::uint32_t delay : {1U, 2U, 3U}) {
    // Within five deviations of a third.
    EXPECT_NEAR(static_cast<double>(std::ranges::count(first, delay)), kEnvs / 3.0, 130) << delay;
  }
  const std::vector<float> still(kEnvs * kCartActions);
  simulator.step(still);
  EXPECT_EQ(drawn(), first) << "it stays for an episode";
  simulator.step(still);
  const std::vector<std::uint32_t> next = drawn();
  std::size_t same = 0;
  for (std::size_t env = 0; env < kEnvs; ++env) same += next[env] == first[env] ? 1U : 0U;
  EXPECT_NEAR(static_cast<double>(same), kEnvs / 3.0, 130);
}

TEST(ActionDelay, IsTheSameForAnyNumberOfThreadsAndOfOtherEnvs) {
  const BoxWorld world = furnishedWorld();
  BatchSimulator one = made(world, delayed({0, 4}, 75));
  const auto wanted = tracesOf(one, kSteps);
  BatchSimulator many = made(world, delayed({0, 4}, 75, 3));
  EXPECT_EQ(tracesOf(many, kSteps), wanted);
  SimulationOptions options = delayed({0, 4}, 1);
  options.ranks = 75;
  options.rank = 42;
  BatchSimulator alone = made(world, options);
  EXPECT_EQ(tracesOf(alone, kSteps, 42).front(), wanted[42]);
  BatchSimulator prompt = made(world, delayed(0, 75));
  EXPECT_NE(tracesOf(prompt, kSteps), wanted);
  // A restart begins with nothing under way.
  many.restart(one.options().seed);
  one.restart(one.options().seed);
  EXPECT_EQ(tracesOf(many, 30), tracesOf(one, 30));
}

TEST(ActionDelay, OfAnEpisodeThatIsNamedIsTheSameInAnyEnv) {
  const BoxWorld world = furnishedWorld();
  BatchSimulator simulator = made(world, delayed({0, 20}, 16));
  simulator.reset(std::vector<std::int32_t>(16, 3));
  const std::uint32_t delay = simulator.episodeNoise(0).action_delay;
  for (std::size_t env = 0; env < 16; ++env) {
    EXPECT_EQ(simulator.episodeNoise(env).action_delay, delay);
  }
}

TEST(ActionDelay, GoesOnWhereAStateIsRestored) {
  const BoxWorld world = furnishedWorld();
  constexpr std::uint32_t kEnvs = 24;
  BatchSimulator first = made(world, delayed({0, 5}, kEnvs));
  for (std::uint32_t step = 0; step < 43; ++step) first.step(actionsFor(first, 0, step));
  const std::vector<std::byte> saved = first.saveState();
  BatchSimulator second = made(world, delayed({0, 5}, kEnvs, 2));
  ASSERT_TRUE(second.restoreState(saved));
  EXPECT_EQ(second.saveState(), saved);
  for (std::uint32_t step = 43; step < kSteps; ++step) {
    const std::vector<float> actions = actionsFor(first, 0, step);
    first.step(actions);
    second.step(actions);
    ASSERT_EQ(BatchTrace(second).hashes(), BatchTrace(first).hashes()) << "step " << step;
  }
  BatchSimulator prompt = made(world, delayed(0, kEnvs));
  const Result<void> refused = prompt.restoreState(saved);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message,
              HasSubstr("expected action-delay=0, found action-delay=0-5"));
}

TEST(ActionDelay, OfOneEnvThatBecomesManyHasTheSameActionsUnderWay) {
  const BoxWorld world = furnishedWorld();
  SimulationOptions options = optionsFor(12);
  options.task.kind = TaskKind::kNone;
  options.task.most_steps = 0;
  options.noise.action_delay = 4;
  BatchSimulator simulator = made(world, options);
  for (std::uint32_t step = 0; step < 30; ++step) simulator.step(actionsFor(simulator, 0, step));
  const std::vector<std::byte> of_5 = simulator.saveState(std::vector<std::uint32_t>{5});
  const std::vector<std::uint32_t> others{0, 11};
  ASSERT_TRUE(simulator.restoreState(of_5, others));
  // What had been asked for arrives, whatever is asked for now.
  for (std::uint32_t step = 30; step < 35; ++step) {
    simulator.step(actionsFor(simulator, 0, step));
    const EnvState here = simulator.envState(5);
    for (const std::uint32_t env : others) {
      const EnvState there = simulator.envState(env);
      const bool is_same = there.world_from_root == here.world_from_root &&
                           there.joint_positions == here.joint_positions;
      EXPECT_EQ(is_same, step < 34) << "step " << step;
    }
  }
}

TEST(ActionDelay, HoldsTheHandStillWhateverItsThresholds) {
  const BoxWorld world = furnishedWorld();
  constexpr std::uint32_t kEnvs = 40;
  SimulationOptions options = optionsFor(kEnvs);
  options.task.kind = TaskKind::kNone;
  options.task.most_steps = 0;
  BatchSimulator holding = made(world, options);
  std::vector<std::uint32_t> envs;
  std::vector<EnvState> states;
  for (std::uint32_t step = 0; step < 300 && states.size() < 10; ++step) {
    holding.step(actionsFor(holding, 0, step));
    for (std::size_t env = 0; env < kEnvs && states.size() < 10; ++env) {
      if (holding.envState(env).held < 0) continue;
      envs.push_back(static_cast<std::uint32_t>(states.size()));
      states.push_back(holding.envState(env));
    }
  }
  ASSERT_EQ(states.size(), 10U);
  // A full hand that lets go at any number, and an empty one that grasps at any.
  options.envs = 10;
  options.action.release = 2;
  options.noise.action_delay = 6;
  BatchSimulator full = made(world, options);
  const std::vector<std::uint8_t> were_set = full.setStates(envs, states).value();
  const std::vector<float> hands_open(10 * kCartActions);
  for (std::uint32_t step = 0; step < 8; ++step) {
    full.step(hands_open);
    for (std::size_t env = 0; env < 10; ++env) {
      if (were_set[env] == 0) continue;
      EXPECT_EQ(full.envState(env).held >= 0, step < 6) << "step " << step;
    }
  }
  EXPECT_GT(std::ranges::count(were_set, 1), 4);
}

TEST(ActionDelay, OutOfItsRangeMakesNoSimulator) {
  const BoxWorld world = furnishedWorld();
  const auto refusal = [&](const DrawnCount& delay) {
    const auto simulator = BatchSimulator::create(world.world(), delayed(delay, 1));
    return simulator ? "" : simulator.error().message;
  };
  const std::string wanted =
      ", expected a whole number from 0 to 100, or a range of them such as 0-2";
  EXPECT_EQ(refusal(kMostActionDelay), "");
  EXPECT_EQ(refusal({0, kMostActionDelay}), "");
  EXPECT_EQ(refusal(101), "action-delay is 101" + wanted);
  EXPECT_EQ(refusal({3, 1}), "action-delay is 3-1" + wanted);
  EXPECT_EQ(refusal({0, 4'000'000'000}), "action-delay is 0-4000000000" + wanted);
}

}  // namespace
}  // namespace galactic::test::action_delay_test
