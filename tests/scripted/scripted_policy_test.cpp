// The scripted policy on the project's own world, from the first step to the reward.
#include "scripted/scripted_policy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "galactic/batch_simulator.h"
#include "scripted_world.h"

namespace galactic::test::scripted_policy_test {
namespace {

/// What came of each env's first episode.
struct Outcomes {
  std::vector<float> actions;
  std::vector<std::uint32_t> steps;
  std::vector<bool> successes;
  std::vector<double> returns;
  std::vector<float> last_rewards;
  std::vector<ScriptedPhase> phases;

  [[nodiscard]] std::size_t successCount() const {
    return static_cast<std::size_t>(std::count(successes.begin(), successes.end(), true));
  }
};

/// Plays each env until its first episode is over; afterwards its actions are zero.
Outcomes play(const World& world, const SimulationOptions& options) {
  BatchSimulator simulator = MemoryPack::opened(BatchSimulator::create(world, options));
  ScriptedPolicy policy = MemoryPack::opened(ScriptedPolicy::create(world, options));
  const std::size_t envs = simulator.envCount();
  const std::size_t count = simulator.actionCount();
  Outcomes outcomes{{},
                    std::vector<std::uint32_t>(envs, 0),
                    std::vector<bool>(envs, false),
                    std::vector<double>(envs, 0),
                    std::vector<float>(envs, 0),
                    std::vector<ScriptedPhase>(envs, ScriptedPhase::kPick)};
  std::vector<float> actions(envs * count);
  std::size_t over = 0;
  while (over < envs) {
    policy.act(simulator, actions);
    for (std::size_t env = 0; env < envs; ++env) {
      if (outcomes.steps[env] == 0) outcomes.phases[env] = policy.phase(env);
    }
    outcomes.actions.insert(outcomes.actions.end(), actions.begin(), actions.end());
    simulator.step(actions);
    for (std::size_t env = 0; env < envs; ++env) {
      if (outcomes.steps[env] != 0) continue;
      outcomes.returns[env] += static_cast<double>(simulator.rewards()[env]);
      if (simulator.dones()[env] == 0) continue;
      ++over;
      outcomes.steps[env] = static_cast<std::uint32_t>(outcomes.actions.size() / (envs * count));
      outcomes.successes[env] = simulator.successes()[env] != 0;
      outcomes.last_rewards[env] = simulator.rewards()[env];
    }
  }
  return outcomes;
}

class ScriptedPolicyInTheSampleWorld : public testing::Test {
 protected:
  static constexpr std::uint32_t kEpisodes = 20;
  static constexpr std::uint64_t kSeed = 3;

  static void SetUpTestSuite() {
    made_ = std::make_unique<ScriptedWorld>(sampleWorld(kEpisodes, kSeed));
  }
  static void TearDownTestSuite() { made_.reset(); }

  static SimulationOptions options() {
    SimulationOptions options;
    options.envs = kEpisodes;
    options.threads = 1;
    options.order = EpisodeOrder::kPartition;
    return options;
  }
  static const World& world() { return made_->world(); }

 private:
  static inline std::unique_ptr<ScriptedWorld> made_;
};

TEST_F(ScriptedPolicyInTheSampleWorld, SolvesMostEpisodesTheSameWayEachTime) {
  const Outcomes outcomes = play(world(), options());
  RecordProperty("successes", static_cast<int>(outcomes.successCount()));
  std::printf("seed %u: %zu of %u episodes solved\n", static_cast<unsigned>(kSeed),
              outcomes.successCount(), kEpisodes);
  EXPECT_GE(outcomes.successCount(), kEpisodes * 8 / 10);
  for (std::size_t env = 0; env < kEpisodes; ++env) {
    if (!outcomes.successes[env]) continue;
    const TaskOptions task;
    EXPECT_LT(outcomes.steps[env], task.most_steps);
    // The last step pays the success and moves nothing.
    EXPECT_NEAR(outcomes.last_rewards[env], task.success_reward, 0.1F);
    EXPECT_GT(outcomes.returns[env], static_cast<double>(task.success_reward + task.pick_reward));
  }

  // Other threads, other number of envs.
  SimulationOptions fewer = options();
  fewer.envs = 3;
  fewer.threads = 2;
  const Outcomes again = play(world(), fewer);
  const std::size_t row = outcomes.actions.size() / outcomes.steps.size();
  ASSERT_GT(row, 0U);
  const std::size_t count = world().robot().controlledJoints().size() + 4;
  for (std::size_t env = 0; env < fewer.envs; ++env) {
    EXPECT_EQ(again.steps[env], outcomes.steps[env]);
    EXPECT_EQ(again.returns[env], outcomes.returns[env]);
    for (std::size_t step = 0; step < again.steps[env]; ++step) {
      for (std::size_t n = 0; n < count; ++n) {
        ASSERT_EQ(again.actions[(step * fewer.envs + env) * count + n],
                  outcomes.actions[(step * kEpisodes + env) * count + n])
            << "env " << env << " step " << step;
      }
    }
  }
}

TEST_F(ScriptedPolicyInTheSampleWorld, SteersARobotThatDoesNotDoQuiteWhatItIsAsked) {
  SimulationOptions inexact = options();
  inexact.noise.motion = 0.1F;
  inexact.noise.motion_bias = 0.1F;
  const Outcomes outcomes = play(world(), inexact);
  EXPECT_GE(outcomes.successCount(), kEpisodes * 8 / 10);

  // Other threads, other number of envs.
  inexact.envs = 3;
  inexact.threads = 2;
  const Outcomes again = play(world(), inexact);
  const auto same_steps = std::ranges::equal(again.steps, std::span(outcomes.steps).first(3));
  EXPECT_TRUE(same_steps);
}

TEST_F(ScriptedPolicyInTheSampleWorld, PicksAndWaitsWhereThatIsTheTask) {
  SimulationOptions pick = options();
  pick.envs = 4;
  pick.task.kind = TaskKind::kMobilePick;
  const Outcomes outcomes = play(world(), pick);
  EXPECT_GE(outcomes.successCount(), 3U);
}

TEST_F(ScriptedPolicyInTheSampleWorld, SucceedsWithoutATerminateAction) {
  SimulationOptions without = options();
  without.envs = 4;
  without.task.needs_terminate = false;
  without.task.distractors = false;
  EXPECT_GE(play(world(), without).successCount(), 3U);
}

TEST_F(ScriptedPolicyInTheSampleWorld, ActsByTheThresholdsOfActions) {
  SimulationOptions other = options();
  other.envs = 4;
  other.action = {.grasp = 0, .release = -0.9F, .terminate = -0.5F};
  EXPECT_GE(play(world(), other).successCount(), 3U);
  other.noise.action_delay = 2;
  EXPECT_GE(play(world(), other).successCount(), 3U);
  other.action.release = -1;
  const auto policy = ScriptedPolicy::create(world(), other);
  ASSERT_FALSE(policy.has_value());
  EXPECT_EQ(policy.error().code, ErrorCode::kUnsupported);
}

TEST_F(ScriptedPolicyInTheSampleWorld, ActsAheadOfWhatArrivesLate) {
  const Outcomes prompt = play(world(), options());
  SimulationOptions late = options();
  for (const std::uint32_t delay : {1U, 5U}) {
    late.noise.action_delay = delay;
    const Outcomes outcomes = play(world(), late);
    EXPECT_EQ(outcomes.successes, prompt.successes);
    std::size_t alike = 0;
    for (std::size_t env = 0; env < kEpisodes; ++env) {
      // It waits for what comes of a grasp, of letting go and of the end, and is on its way else.
      const std::uint32_t waits = outcomes.steps[env] - prompt.steps[env];
      alike += waits == 3 * delay ? 1U : 0U;
    }
    EXPECT_GE(alike, kEpisodes * 8 / 10) << "others had to plan more often";
  }
}

TEST_F(ScriptedPolicyInTheSampleWorld, BearsLateActionsThatAreNotDoneExactly) {
  SimulationOptions late = options();
  late.noise.action_delay = {0, 2};
  late.noise.motion = 0.1F;
  late.noise.motion_bias = 0.1F;
  const Outcomes outcomes = play(world(), late);
  EXPECT_GE(outcomes.successCount(), kEpisodes * 8 / 10);
}

TEST_F(ScriptedPolicyInTheSampleWorld, RefusesToHaveNothingToDo) {
  SimulationOptions none = options();
  none.task.kind = TaskKind::kNone;
  const auto policy = ScriptedPolicy::create(world(), none);
  ASSERT_FALSE(policy.has_value());
  EXPECT_EQ(policy.error().code, ErrorCode::kUnsupported);
  EXPECT_EQ(policy.error().message,
            "the task is none, which has nothing to plan for; use rearrange or mobile pick");
}

SimulationOptions optionsOf(std::uint32_t envs) {
  SimulationOptions options;
  options.envs = envs;
  options.threads = 1;
  return options;
}

/// A cube on a table, and its goal at `goal` along it, meters.
ScriptedWorld tableWorld(float goal) {
  MeshBuilder room = madeRoom(4, 3);
  room.box({2.2F, 0, 1}, {2.8F, 0.5F, 2});
  return stickWorld(room.build(), {0.8F, 0, 1.5F}, {2.4F, 0.501F, 1.3F}, {2.4F, 0.501F, goal});
}

TEST(ScriptedPolicy, DrivesARobotThatCouldDriveSidewaysAheadOnly) {
  MeshBuilder room = madeRoom(4, 3);
  room.box({2.2F, 0, 1}, {2.8F, 0.5F, 2});
  const Vec3 base{0.8F, 0, 1.5F};
  const Vec3 cube{2.4F, 0.501F, 1.3F};
  const Vec3 goal{2.4F, 0.501F, 1.7F};
  RobotPackFields robot = stickRobot();
  const Outcomes without =
      play(stickWorld(room.build(), base, cube, goal, robot).world(), optionsOf(1));
  robot.base->sideways_step = 0.1F;
  const ScriptedWorld made = stickWorld(room.build(), base, cube, goal, robot);
  const ActionLayout layout = ActionLayout::of(made.world().robot());
  ASSERT_TRUE(layout.drives_sideways);
  const Outcomes with = play(made.world(), optionsOf(1));
  EXPECT_EQ(with.successCount(), 1U);
  EXPECT_EQ(with.steps, without.steps);
  for (std::size_t n = layout.sideways(); n < with.actions.size(); n += layout.count()) {
    ASSERT_EQ(with.actions[n], 0);
  }
}

/// In how many steps the policy solves an episode in which others have driven away first.
std::size_t stepsAfterOthers(const World& world, std::uint32_t delay) {
  SimulationOptions options = optionsOf(1);
  options.noise.action_delay = delay;
  BatchSimulator simulator = MemoryPack::opened(BatchSimulator::create(world, options));
  ScriptedPolicy policy = MemoryPack::opened(ScriptedPolicy::create(world, options));
  std::vector<float> actions(simulator.actionCount());
  actions[simulator.actionLayout().forward()] = -1;
  actions[simulator.actionLayout().turn()] = 1;
  constexpr int kOthers = 8;
  for (int step = 0; step < kOthers; ++step) simulator.step(actions);
  for (std::size_t steps = 1; steps < 400; ++steps) {
    policy.act(simulator, actions);
    simulator.step(actions);
    if (simulator.dones()[0] != 0) return simulator.successes()[0] != 0 ? steps : 0;
  }
  return 0;
}

TEST(ScriptedPolicy, LetsWhatOthersAskedForArriveBeforeItPlans) {
  const ScriptedWorld made = tableWorld(1.7F);
  const std::size_t prompt = stepsAfterOthers(made.world(), 0);
  ASSERT_GT(prompt, 0U);
  constexpr std::uint32_t kDelay = 6;
  // And, as ever, before it looks what has come of a grasp, of letting go and of the end.
  EXPECT_EQ(stepsAfterOthers(made.world(), kDelay), prompt + 4 * kDelay);
}

TEST(ScriptedPolicy, GivesUpWhereThereIsNoWayAndStandsStill) {
  MeshBuilder room = madeRoom(4, 3);
  room.box({1.95F, 0, 0}, {2.05F, 2.5F, 3});
  room.box({3.2F, 0, 1}, {3.8F, 0.5F, 2});
  const ScriptedWorld made =
      stickWorld(room.build(), {0.8F, 0, 1.5F}, {3.5F, 0.501F, 1.2F}, {3.5F, 0.501F, 1.8F});
  const SimulationOptions options = optionsOf(1);
  BatchSimulator simulator = MemoryPack::opened(BatchSimulator::create(made.world(), options));
  ScriptedPolicy policy = MemoryPack::opened(ScriptedPolicy::create(made.world(), options));
  std::vector<float> actions(simulator.actionCount(), 1);
  for (int step = 0; step < 3; ++step) {
    policy.act(simulator, actions);
    for (const float action : actions) EXPECT_EQ(action, 0);
    simulator.step(actions);
  }
  EXPECT_EQ(policy.phase(0), ScriptedPhase::kGaveUp);
  EXPECT_EQ(policy.trouble(0), ScriptedTrouble::kNoWayToTarget);
  EXPECT_EQ(nameOf(policy.trouble(0)), "no way to target");
}

TEST(ScriptedPolicy, PlansAnewWhereItMeetsTheSameEpisodeBegunAgain) {
  const ScriptedWorld made = tableWorld(1.7F);
  const SimulationOptions options = optionsOf(1);
  BatchSimulator simulator = MemoryPack::opened(BatchSimulator::create(made.world(), options));
  ScriptedPolicy policy = MemoryPack::opened(ScriptedPolicy::create(made.world(), options));
  std::vector<float> actions(simulator.actionCount(), 0);
  policy.allowPlans(0);
  policy.act(simulator, actions);
  simulator.step(actions);
  policy.act(simulator, actions);
  ASSERT_EQ(policy.phase(0), ScriptedPhase::kGaveUp);

  policy.allowPlans(ScriptedPolicy::kMostPlans);
  policy.act(simulator, actions);
  EXPECT_EQ(policy.phase(0), ScriptedPhase::kGaveUp);
  const std::int32_t episode = 0;
  simulator.reset(std::span(&episode, 1));
  std::ranges::fill(actions, 0.0F);
  for (int step = 0; step < 3; ++step) simulator.step(actions);
  policy.act(simulator, actions);
  EXPECT_EQ(policy.phase(0), ScriptedPhase::kPick);
}

/// What `call` is refused with.
template <class Call>
Error refusalOf(const Call& call) {
  try {
    call();
  } catch (const ErrorException& refused) {
    EXPECT_EQ(refused.error().code, ErrorCode::kInvalidInput);
    return refused.error();
  }
  ADD_FAILURE() << "expected a refusal";
  return {};
}

TEST(ScriptedPolicy, RefusesToActInOtherEnvsThanItsOwnAndByArraysOfAnotherLength) {
  const ScriptedWorld made = tableWorld(1.7F);
  const ScriptedWorld other_world = tableWorld(1.75F);
  const SimulationOptions options = optionsOf(2);
  BatchSimulator simulator = MemoryPack::opened(BatchSimulator::create(made.world(), options));
  ScriptedPolicy policy = MemoryPack::opened(ScriptedPolicy::create(made.world(), options));
  const std::size_t count = simulator.actionCount();
  std::vector<float> actions(3 * count, 0.5F);
  const std::span<float> two = std::span(actions).first(2 * count);
  const std::vector<std::uint8_t> where{1, 1, 1};

  const auto refusal = [&](const BatchSimulator& acted_in, std::span<float> acted,
                           std::span<const std::uint8_t> in = {}) {
    const Error error = refusalOf([&] { policy.act(acted_in, acted, in); });
    EXPECT_EQ(error.where, "ScriptedPolicy::act");
    return error.message;
  };
  for (const std::uint32_t envs : {1U, 3U}) {
    const BatchSimulator others =
        MemoryPack::opened(BatchSimulator::create(made.world(), optionsOf(envs)));
    EXPECT_EQ(refusal(others, std::span(actions).first(envs * count)),
              "found a simulator of " + std::to_string(envs) +
                  " envs, expected the 2 that the policy was made for");
  }
  const BatchSimulator elsewhere =
      MemoryPack::opened(BatchSimulator::create(other_world.world(), options));
  EXPECT_EQ(refusal(elsewhere, two),
            "found a simulator of another world than the one that the policy was made for; make a "
            "policy for that one, too");
  const std::string expected = ", expected " + std::to_string(2 * count);
  EXPECT_EQ(refusal(simulator, actions),
            "\"actions\" has the length " + std::to_string(3 * count) + expected);
  EXPECT_EQ(refusal(simulator, two.first(count)),
            "\"actions\" has the length " + std::to_string(count) + expected);
  EXPECT_EQ(refusal(simulator, two, where), "\"where\" has the length 3, expected 2");
  EXPECT_EQ(refusal(simulator, two, std::span(where).first(1)),
            "\"where\" has the length 1, expected 2");

  const std::vector<float> zeros(2 * count, 0);
  simulator.beginStep(zeros);
  EXPECT_EQ(refusal(simulator, two), "found a step that has begun; end it first, with endStep()");
  simulator.endStep();
  EXPECT_EQ(std::ranges::count(actions, 0.5F), static_cast<std::ptrdiff_t>(actions.size()));

  policy.act(simulator, two, std::span(where).first(2));
  EXPECT_NE(std::ranges::count(two, 0.5F), static_cast<std::ptrdiff_t>(two.size()));
}

TEST(ScriptedPolicy, KeepsItsWorld) {
  const ScriptedWorld made = tableWorld(1.7F);
  const SimulationOptions options = optionsOf(1);
  BatchSimulator simulator = MemoryPack::opened(BatchSimulator::create(made.world(), options));
  auto world = std::make_unique<World>(made.world());
  ScriptedPolicy policy = MemoryPack::opened(ScriptedPolicy::create(*world, options));
  world.reset();
  std::vector<float> actions(simulator.actionCount());
  policy.act(simulator, actions);
  EXPECT_EQ(policy.phase(0), ScriptedPhase::kPick);
  EXPECT_EQ(policy.trouble(0), ScriptedTrouble::kNone);
}

TEST(ScriptedPolicy, IsNotMadeOfOptionsOutOfTheirRanges) {
  const ScriptedWorld made = tableWorld(1.7F);
  SimulationOptions options = optionsOf(1);
  options.placement.attempts = 4'000'000'000;
  const auto policy = ScriptedPolicy::create(made.world(), options);
  ASSERT_FALSE(policy.has_value());
  EXPECT_EQ(policy.error().code, ErrorCode::kInvalidInput);
}

TEST(ScriptedPolicy, RefusesToTellOfEnvsThatItDoesNotHave) {
  const ScriptedWorld made = tableWorld(1.7F);
  const ScriptedPolicy policy =
      MemoryPack::opened(ScriptedPolicy::create(made.world(), optionsOf(2)));
  EXPECT_EQ(policy.phase(1), ScriptedPhase::kPick);
  EXPECT_EQ(policy.trouble(1), ScriptedTrouble::kNone);
  const Error phase = refusalOf([&] { (void)policy.phase(2); });
  EXPECT_EQ(phase.where, "ScriptedPolicy::phase");
  EXPECT_EQ(phase.message, "found env 2, expected one below 2");
  const Error trouble = refusalOf([&] { (void)policy.trouble(2); });
  EXPECT_EQ(trouble.where, "ScriptedPolicy::trouble");
  EXPECT_EQ(trouble.message, "found env 2, expected one below 2");
}

TEST(ScriptedPolicy, GivesUpWhereTheArmWouldHaveToUnwindForever) {
  // The way back is looked at neither in millions of places nor with a tree that grows along it.
  RobotPackFields robot = stickRobot();
  robot.limits[0] = {-1e7F, 1e7F};
  robot.controlled_joints[0] = {0, 0.2F, -1e7F, 1e7F};
  robot.start_positions[0] = 1e6F;
  MeshBuilder room = madeRoom(4, 3);
  room.box({2.2F, 0, 1}, {2.8F, 0.5F, 2});
  const ScriptedWorld made =
      stickWorld(room.build(), {0.8F, 0, 1.5F}, {2.5F, 0.501F, 1.2F}, {2.5F, 0.501F, 1.8F}, robot);
  const SimulationOptions options = optionsOf(1);
  BatchSimulator simulator = MemoryPack::opened(BatchSimulator::create(made.world(), options));
  ScriptedPolicy policy = MemoryPack::opened(ScriptedPolicy::create(made.world(), options));
  std::vector<float> actions(simulator.actionCount(), 1);
  policy.act(simulator, actions);
  EXPECT_EQ(policy.phase(0), ScriptedPhase::kGaveUp);
  EXPECT_EQ(policy.trouble(0), ScriptedTrouble::kNoGrasp);
}

}  // namespace
}  // namespace galactic::test::scripted_policy_test
