// What a policy sees of what it asked for: the actions of the last steps, the latest first.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "runtime/simulation/batch_trace.h"

namespace galactic::test::last_actions_test {
namespace {

constexpr std::uint32_t kEnvs = 37;
/// Several episodes of each env.
constexpr std::uint32_t kSteps = 150;

SimulationOptions observing(std::uint32_t last_actions, const DrawnCount& delay = 0) {
  SimulationOptions options = optionsFor(kEnvs);
  options.sensors.last_actions = last_actions;
  options.noise.action_delay = delay;
  return options;
}

BatchSimulator made(const BoxWorld& world, const SimulationOptions& options) {
  return BatchSimulator::create(world.world(), options).value();
}

std::span<const float> lastActions(const BatchSimulator& simulator, std::span<const float> rows,
                                   std::size_t env) {
  const ObservationPart& part = simulator.observationParts().back();
  EXPECT_EQ(part.name, "last_actions");
  return rows.subspan(env * simulator.observationSize() + part.first, part.size);
}

/// As a batch is asked for them: out of range and no numbers now and then.
std::vector<float> askedFor(const BatchSimulator& simulator, std::uint32_t step) {
  std::vector<float> actions = actionsFor(simulator, 0, step);
  for (std::size_t n = step % 5; n < actions.size(); n += 13) actions[n] *= 3;
  for (std::size_t n = step % 7; n < actions.size(); n += 101) {
    actions[n] = std::numeric_limits<float>::quiet_NaN();
  }
  return actions;
}

/// What is known of an env's episode, step by step, without the simulator.
class Asked {
 public:
  void begin() { steps_.clear(); }
  void add(std::span<const float> action) {
    std::vector<float>& step = steps_.emplace_back();
    for (const float value : action)
      step.push_back(std::isnan(value) ? 0 : std::clamp(value, -1.0F, 1.0F));
  }
  /// Of the last `count` steps.
  [[nodiscard]] std::vector<float> last(std::size_t count) const {
    std::vector<float> row;
    for (std::size_t n = 0; n < count; ++n) {
      const std::vector<float> nothing(kCartActions);
      const auto& step = n < steps_.size() ? steps_[steps_.size() - 1 - n] : nothing;
      row.insert(row.end(), step.begin(), step.end());
    }
    return row;
  }

 private:
  std::vector<std::vector<float>> steps_;
};

void expectRow(std::span<const float> found, const std::vector<float>& wanted) {
  EXPECT_EQ(std::vector<float>(found.begin(), found.end()), wanted);
}

TEST(LastActions, AreThoseThatWereAskedForTheLatestFirst) {
  const BoxWorld world = furnishedWorld();
  struct Case {
    std::uint32_t count;
    DrawnCount delay;
  };
  for (const auto& [count, delay] : {Case{1, 0}, Case{4, 0}, Case{2, {0, 3}}, Case{6, 2}}) {
    SCOPED_TRACE(std::to_string(count) + " with delay " + drawnText(delay));
    BatchSimulator simulator = made(world, observing(count, delay));
    std::vector<Asked> asked(kEnvs);
    std::size_t ended = 0;
    for (std::uint32_t step = 0; step < kSteps; ++step) {
      const std::vector<float> actions = askedFor(simulator, step);
      simulator.step(actions);
      for (std::size_t env = 0; env < kEnvs; ++env) {
        asked[env].add(std::span(actions).subspan(env * kCartActions, kCartActions));
        if (simulator.dones()[env] != 0) {
          ++ended;
          expectRow(lastActions(simulator, simulator.finalObservations(), env),
                    asked[env].last(count));
          asked[env].begin();
        }
        expectRow(lastActions(simulator, simulator.observations(), env), asked[env].last(count));
      }
      if (testing::Test::HasFailure()) return;
    }
    EXPECT_GT(ended, 2 * kEnvs);
  }
}

TEST(LastActions, DoNotChangeWhatRobotsDo) {
  const BoxWorld world = furnishedWorld();
  for (const DrawnCount& delay : {DrawnCount(0), DrawnCount(0, 3)}) {
    BatchSimulator seeing = made(world, observing(5, delay));
    BatchSimulator blind = made(world, observing(0, delay));
    for (std::uint32_t step = 0; step < kSteps; ++step) {
      const std::vector<float> actions = actionsFor(blind, 0, step);
      seeing.step(actions);
      blind.step(actions);
      for (std::size_t env = 0; env < kEnvs; ++env) {
        const EnvState here = seeing.envState(env);
        const EnvState there = blind.envState(env);
        ASSERT_EQ(here.world_from_root, there.world_from_root) << "step " << step;
        ASSERT_EQ(here.joint_positions, there.joint_positions) << "step " << step;
        ASSERT_EQ(here.held, there.held) << "step " << step;
      }
    }
  }
}

TEST(LastActions, OfAnIdleEnvStayWhateverItIsAsked) {
  const BoxWorld world = furnishedWorld();
  SimulationOptions options = observing(3);
  options.order = EpisodeOrder::kPartition;
  BatchSimulator simulator = made(world, options);
  const auto are_idle = [&] {
    return std::ranges::all_of(simulator.idle(), [](std::uint8_t idle) { return idle != 0; });
  };
  for (std::uint32_t step = 0; step < kSteps && !are_idle(); ++step) {
    simulator.step(actionsFor(simulator, 0, step));
  }
  ASSERT_TRUE(are_idle());
  const std::vector<float> before(simulator.observations().begin(), simulator.observations().end());
  EXPECT_TRUE(std::ranges::any_of(lastActions(simulator, before, 0),
                                  [](float value) { return value != 0; }));
  for (std::uint32_t step = 0; step < 7; ++step) {
    simulator.step(actionsFor(simulator, 0, kSteps + step));
    EXPECT_TRUE(std::ranges::equal(simulator.observations(), before)) << "step " << step;
  }
}

TEST(LastActions, OfMoreStepsThanItsMostMakeNoSimulator) {
  const BoxWorld world = furnishedWorld();
  EXPECT_EQ(made(world, observing(kMostLastActions)).observationParts().back().size,
            kMostLastActions * kCartActions);
  const auto more = BatchSimulator::create(world.world(), observing(kMostLastActions + 1));
  ASSERT_FALSE(more);
  EXPECT_EQ(more.error().message, "last-actions is 101, expected 0 to 100");
}

}  // namespace
}  // namespace galactic::test::last_actions_test
