// Steps that are made elsewhere: what follows from them is what follows from the simulator's own.
#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "support/homes/every_option.h"
#include "support/homes/small_home_actor.h"
#include "support/homes/task_twins.h"

namespace galactic::test::follow_test {
namespace {

/// An angle through a quaternion and back, and what hangs on it at arm's length.
constexpr float kTolerance = 2e-5F;
constexpr int kSteps = 1500;

SimulationOptions optionsOf(std::uint32_t envs) {
  SimulationOptions options;
  options.envs = envs;
  options.threads = 1;
  options.task = everyReward();
  options.task.most_steps = 120;
  options.sensors = everySensor();
  // What jumps where the robot is a hair elsewhere: past an edge, or into another cell.
  options.sensors.laser = {};
  options.sensors.geodesic = false;
  options.task.geodesic_weight = 0;
  // A follower is told that something was in the way, and not what.
  options.task.knock_penalty = 0;
  options.noise = {
      .motion = 0.1F, .motion_bias = 0.1F, .localization = 0.05F, .action_delay = {0, 2}};
  options.auto_reset = false;
  return options;
}

FollowedState followedOf(const EnvState& state, bool was_hindered) {
  return {.world_from_root = state.world_from_root,
          .joint_positions = state.joint_positions,
          .objects = state.objects,
          .held = state.held,
          .was_hindered = was_hindered};
}

/// Begins the next episode where one has ended.
void renew(BatchSimulator& simulator) {
  std::vector<std::int32_t> resets;
  for (const std::uint8_t done : simulator.dones()) {
    resets.push_back(done != 0 ? BatchSimulator::kNextEpisode : BatchSimulator::kStays);
  }
  simulator.reset(resets);
}

/// A simulator that steps, and one that follows it.
class Pair {
 public:
  explicit Pair(std::uint32_t envs)
      : leader_(simulatorOf(home_.world(), optionsOf(envs))),
        follower_(simulatorOf(home_.world(), optionsOf(envs))) {
    for (std::uint32_t env = 0; env < envs; ++env) actors_.emplace_back(env + 7);
  }

  void step() {
    const std::size_t envs = leader_.envCount();
    std::vector<float> actions;
    std::vector<std::uint64_t> refused;
    for (std::size_t env = 0; env < envs; ++env) {
      const SmallHomeRow row = actors_[env].act(leader_.envState(env));
      actions.insert(actions.end(), row.begin(), row.end());
      refused.push_back(leader_.statistics(env).refused);
    }
    leader_.step(actions);
    std::vector<EnvState> states;
    for (std::size_t env = 0; env < envs; ++env) states.push_back(leader_.envState(env));
    std::vector<FollowedState> followed;
    for (std::size_t env = 0; env < envs; ++env) {
      followed.push_back(followedOf(states[env], leader_.statistics(env).refused != refused[env]));
    }
    follower_.follow(actions, followed);
  }
  void renewBoth() {
    for (std::size_t env = 0; env < actors_.size(); ++env) {
      if (leader_.dones()[env] != 0) actors_[env].begin();
    }
    renew(leader_);
    renew(follower_);
  }

  [[nodiscard]] const BatchSimulator& leader() const { return leader_; }
  [[nodiscard]] const BatchSimulator& follower() const { return follower_; }

 private:
  SmallHome home_;
  BatchSimulator leader_;
  BatchSimulator follower_;
  std::vector<WildActor> actors_;
};

TEST(AFollower, ObservesAndJudgesWhatTheStepsThatItFollowsDo) {
  Pair pair(5);
  int episodes = 0;
  int held = 0;
  for (int n = 0; n < kSteps; ++n) {
    pair.step();
    const auto wanted = pair.leader().observations();
    const auto found = pair.follower().observations();
    ASSERT_EQ(found.size(), wanted.size());
    for (std::size_t k = 0; k < wanted.size(); ++k) {
      ASSERT_NEAR(found[k], wanted[k], kTolerance) << "step " << n << ", number " << k;
    }
    for (std::size_t env = 0; env < pair.leader().envCount(); ++env) {
      ASSERT_EQ(pair.follower().endings()[env], pair.leader().endings()[env]) << "step " << n;
      ASSERT_EQ(pair.follower().picks()[env], pair.leader().picks()[env]) << "step " << n;
      constexpr float kWeights = 20;
      ASSERT_NEAR(pair.follower().rewards()[env], pair.leader().rewards()[env],
                  kWeights * kTolerance);
      episodes += pair.leader().dones()[env];
      held += pair.leader().envState(env).held >= 0 ? 1 : 0;
    }
    pair.renewBoth();
  }
  EXPECT_GT(episodes, 50);
  EXPECT_GT(held, kSteps / 5);
  const SimulationStatistics wanted = pair.leader().statistics();
  const SimulationStatistics found = pair.follower().statistics();
  EXPECT_EQ(found.grasps, wanted.grasps);
  EXPECT_EQ(found.drops, wanted.drops + wanted.restored);
  EXPECT_EQ(found.successes, wanted.successes);
  EXPECT_GT(found.successes, 5U);
  EXPECT_EQ(found.picks, wanted.picks);
  EXPECT_GT(found.picks, 20U);
  EXPECT_EQ(found.refused, wanted.refused);
}

TEST(AFollower, TakesAPoseThatNoStepWouldAllow) {
  SmallHome home;
  BatchSimulator simulator = simulatorOf(home.world(), optionsOf(1));
  EnvState state = simulator.envState(0);
  // In the middle of the table, which a step refuses; a distractor on the floor.
  state.world_from_root.translation = {1.5F, 0.1F, 1.5F};
  state.objects[0].translation = {0.3F, 0.0F, 0.4F};
  const FollowedState there = followedOf(state, true);
  simulator.follow(SmallHomeRow{}, std::span(&there, 1));
  const EnvState now = simulator.envState(0);
  EXPECT_NEAR(now.world_from_root.translation.x, 1.5F, kTolerance);
  EXPECT_EQ(now.objects[0].translation, state.objects[0].translation);
  for (const ObservationPart& part : simulator.observationParts()) {
    if (part.name != "bump") continue;
    EXPECT_EQ(simulator.observations()[part.first], 1);
  }
  // A step goes on from there: nothing but a way out is free.
  SmallHomeRow ahead{};
  ahead[kForward] = 1;
  simulator.step(ahead);
  EXPECT_LT(
      distance(simulator.envState(0).world_from_root.translation, now.world_from_root.translation),
      0.5);
}

}  // namespace
}  // namespace galactic::test::follow_test
