// The rules of the task one by one, played by hand in the small home.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "support/homes/small_home_actor.h"
#include "support/homes/task_twins.h"
#include "support/oracles/task_oracle.h"

namespace galactic::test::task_test {
namespace {

using testing::ElementsAre;

/// Sums of some hundred rewards in floats.
constexpr double kReturnTolerance = 1e-4;
/// A pose through a quaternion and back, meters and components.
constexpr float kPoseTolerance = 1e-5F;
/// Far more than any part of the task takes.
constexpr int kPatience = 150;

/// One env of the first episode, played step by step.
class Player {
 public:
  explicit Player(const TaskOptions& task, const SimulationOptions& options = {})
      : simulator_(simulatorOf(home_.world(), single(task, options))), start_(state()) {}

  [[nodiscard]] EnvState state() const { return simulator_.envState(0); }
  [[nodiscard]] const EnvState& start() const { return start_; }
  [[nodiscard]] BatchSimulator& simulator() { return simulator_; }
  [[nodiscard]] const World& world() const { return home_.world(); }
  [[nodiscard]] float reward() const { return simulator_.rewards()[0]; }
  [[nodiscard]] bool done() const { return simulator_.dones()[0] != 0; }
  [[nodiscard]] bool success() const { return simulator_.successes()[0] != 0; }
  [[nodiscard]] bool hasPicked() const { return simulator_.envObjects(0).has_picked; }
  [[nodiscard]] SimulationStatistics sum() const { return simulator_.statistics(); }
  [[nodiscard]] bool holdsTarget() const {
    return state().held == static_cast<std::int32_t>(state().target);
  }
  [[nodiscard]] bool failed() const { return done() && !success() && sum().failures == 1; }

  void step(const SmallHomeRow& row) { simulator_.step(row); }

  /// Nothing but a hand that keeps what it holds.
  void wait() { step(keeping()); }
  void release() { step({}); }
  void terminate() {
    SmallHomeRow row = keeping();
    row[kTerminate] = 1;
    step(row);
  }

  /// Until something is in the hand.
  void fetchObject(std::size_t number) {
    for (int n = 0; n < kPatience && state().held < 0 && !done(); ++n) {
      step(fetch(state(), number));
    }
  }
  void fetchTarget() {
    fetchObject(start_.target);
    ASSERT_TRUE(holdsTarget());
  }
  /// The target over a place, still in the hand.
  void carryTo(const Vec3& place) {
    constexpr double kNear = 0.05;
    for (int n = 0; n < kPatience; ++n) {
      if (distance(state().objects[start_.target].translation, place) < kNear) return;
      step(carry(state(), place));
      ASSERT_FALSE(done());
    }
    FAIL() << "the target does not get there";
  }
  void carryToGoal() { carryTo(start_.goal.translation); }
  /// Up and away from the table's other objects, but over the table.
  void carryAway() {
    Vec3 place = start_.objects[start_.target].translation;
    place.y += 0.1F;
    carryTo(place);
  }

 private:
  static SimulationOptions single(const TaskOptions& task, SimulationOptions options) {
    options.envs = 1;
    options.threads = 1;
    options.order = EpisodeOrder::kLinear;
    options.task = task;
    return options;
  }

  [[nodiscard]] SmallHomeRow keeping() const {
    SmallHomeRow row{};
    row[kHand] = state().held >= 0 ? 1.0F : 0.0F;
    return row;
  }

  SmallHome home_;
  BatchSimulator simulator_;
  EnvState start_;
};

constexpr std::uint32_t kOther = 0;

TEST(Rearrange, IsASuccessWhenTheRobotTerminatesWithTheTargetAtTheGoal) {
  Player player({});
  player.fetchTarget();
  player.carryToGoal();
  player.release();
  EXPECT_FALSE(player.done()) << "the robot has not said so yet";
  player.terminate();
  EXPECT_TRUE(player.done());
  EXPECT_TRUE(player.success());
  EXPECT_EQ(player.sum().successes, 1U);
  EXPECT_EQ(player.sum().failures, 0U);
}

TEST(Rearrange, PaysTheWholeWayAndBothRewards) {
  // Distances telescope: what is paid for them depends on the first and the last state only.
  TaskOptions task;
  task.action_weight = 0;
  Player player(task);
  double paid = 0;
  EnvState last;
  while (!player.done() && player.sum().steps < 2 * kPatience) {
    last = player.state();
    player.step(solve(last));
    paid += static_cast<double>(player.reward());
  }
  ASSERT_TRUE(player.success());
  // The last step changed nothing: the arm was still and the target lay.
  const double way = TaskOracle::reachOf(player.start()) - TaskOracle::reachOf(last) +
                     TaskOracle::transportOf(player.start()) - TaskOracle::transportOf(last);
  EXPECT_NEAR(paid, 15 + way, kReturnTolerance);
}

TEST(Rearrange, PaysAllTermsInTheLastStep) {
  Player player({});
  player.fetchTarget();
  player.carryToGoal();
  player.release();
  const EnvState before = player.state();
  SmallHomeRow row{};
  row[kLift] = 1;
  row[kTerminate] = 1;
  player.step(row);
  ASSERT_TRUE(player.success());
  // The last actions were zeros. The arm has risen by 5 cm; the target has not moved.
  Vec3 grip = before.world_from_grip.translation;
  grip.y += 0.05F;
  const double reach = distance(grip, before.objects[before.target].translation);
  EXPECT_NEAR(static_cast<double>(player.reward()),
              10 + TaskOracle::reachOf(before) - reach - 0.001, kReturnTolerance);
  EXPECT_GT(std::abs(TaskOracle::reachOf(before) - reach), 0.01);
}

TEST(Rearrange, FailsWhenTheRobotTerminatesElsewhere) {
  Player at_start({});
  at_start.terminate();
  EXPECT_TRUE(at_start.failed());
  Player held({});
  held.fetchTarget();
  held.carryToGoal();
  held.terminate();
  EXPECT_TRUE(held.failed()) << "at the goal, but still in the hand";
}

TEST(Rearrange, FailsWhenTheTargetIsReleasedElsewhere) {
  Player player({.failure_penalty = 2});
  player.fetchTarget();
  player.carryAway();
  player.release();
  EXPECT_TRUE(player.failed());
  EXPECT_EQ(player.sum().drops + player.sum().restored, 1U);
  EXPECT_LT(player.reward(), -1);
}

TEST(Rearrange, FailsWhenAnotherObjectIsGrasped) {
  Player player({});
  player.fetchObject(kOther);
  EXPECT_TRUE(player.failed());
  EXPECT_EQ(player.sum().grasps, 1U);
}

TEST(Rearrange, DoesNotCarryOutAReleaseElsewhereWithSafeDrop) {
  Player player({.drop_fails = false});
  player.fetchTarget();
  player.carryAway();
  for (int n = 0; n < 5; ++n) player.release();
  EXPECT_TRUE(player.holdsTarget());
  EXPECT_FALSE(player.done());
  EXPECT_EQ(player.sum().drops + player.sum().restored, 0U);
  player.carryToGoal();
  player.release();
  EXPECT_EQ(player.state().held, -1);
  EXPECT_EQ(player.sum().drops, 1U);
  player.terminate();
  EXPECT_TRUE(player.success());
}

TEST(Rearrange, GoesOnWithAnotherObjectInTheHandWithSafeDrop) {
  Player player({.drop_fails = false});
  player.fetchObject(kOther);
  EXPECT_EQ(player.state().held, static_cast<std::int32_t>(kOther));
  EXPECT_FALSE(player.done());
  player.release();
  EXPECT_EQ(player.state().held, -1) << "another object may be released anywhere";
  EXPECT_FALSE(player.done());
}

TEST(Rearrange, PaysForWhatSafeDropOverlooks) {
  constexpr float kPenalty = 1000;
  Player player({.drop_penalty = kPenalty, .drop_fails = false});
  player.fetchTarget();
  player.carryAway();
  EXPECT_GT(player.reward(), -1) << "nothing was wrong yet";
  for (int n = 0; n < 2; ++n) {
    player.release();
    EXPECT_NEAR(player.reward(), -kPenalty, 1) << "away from the goal";
  }
  player.carryToGoal();
  EXPECT_GT(player.reward(), -1);
  player.release();
  EXPECT_GT(player.reward(), -1);
  player.terminate();
  EXPECT_GT(player.reward(), 9);

  Player other({.drop_penalty = kPenalty, .drop_fails = false});
  other.fetchObject(kOther);
  EXPECT_NEAR(other.reward(), -kPenalty, 1);
  other.release();
  EXPECT_GT(other.reward(), -1);

  Player strict({.drop_penalty = kPenalty});
  strict.fetchObject(kOther);
  EXPECT_TRUE(strict.failed());
  EXPECT_GT(strict.reward(), -1) << "a failure is paid for by failure_penalty";
}

TEST(Rearrange, IsJudgedAtTheReleaseWithoutTerminate) {
  Player player({.needs_terminate = false});
  player.terminate();
  EXPECT_FALSE(player.done()) << "the action does nothing";
  player.fetchTarget();
  player.carryToGoal();
  player.terminate();
  EXPECT_FALSE(player.done());
  player.release();
  EXPECT_TRUE(player.success());
  Player elsewhere({.needs_terminate = false});
  elsewhere.fetchTarget();
  elsewhere.carryAway();
  elsewhere.release();
  EXPECT_TRUE(elsewhere.failed());
}

TEST(Rearrange, IsNotTerminatedInTheFirstStepsWhereAsked) {
  constexpr std::uint32_t kFirst = 3;
  Player player({.terminate_after = kFirst});
  for (std::uint32_t n = 0; n < kFirst; ++n) {
    player.terminate();
    EXPECT_FALSE(player.done()) << n;
  }
  player.terminate();
  EXPECT_TRUE(player.failed());
}

TEST(Rearrange, PaysThePickOnceInAnEpisode) {
  Player player({.pick_reward = 1000});
  int paid = 0;
  const auto fetch_and_release = [&] {
    for (int n = 0; n < kPatience && !player.holdsTarget(); ++n) {
      player.step(fetch(player.state(), player.start().target));
      paid += player.reward() > 500 ? 1 : 0;
    }
    ASSERT_TRUE(player.holdsTarget());
    player.carryToGoal();
    player.release();
    ASSERT_FALSE(player.done());
  };
  fetch_and_release();
  EXPECT_EQ(paid, 1);
  fetch_and_release();
  EXPECT_EQ(player.sum().grasps, 2U);
  EXPECT_EQ(paid, 1);
}

TEST(Picks, TellAtTheEndOfAnEpisodeThatTheTargetHadBeenInTheHand) {
  Player player({.most_steps = kPatience});
  player.fetchTarget();
  EXPECT_THAT(player.simulator().picks(), ElementsAre(0)) << "it goes on";
  player.carryToGoal();
  player.release();
  EXPECT_TRUE(player.hasPicked());
  while (!player.done()) player.wait();
  EXPECT_THAT(player.simulator().endings(), ElementsAre(EpisodeEnd::kTimeOut));
  EXPECT_THAT(player.simulator().picks(), ElementsAre(1));
  EXPECT_FALSE(player.hasPicked()) << "the next episode has begun";
  EXPECT_EQ(player.sum().picks, 1U);
  player.wait();
  EXPECT_THAT(player.simulator().picks(), ElementsAre(0));
  while (!player.done()) player.wait();
  EXPECT_THAT(player.simulator().picks(), ElementsAre(0));
  EXPECT_EQ(player.sum().episodes, 2U);
  EXPECT_EQ(player.sum().picks, 1U);
}

TEST(Picks, AreNoneOfOtherObjects) {
  Player player({});
  player.fetchObject(kOther);
  ASSERT_TRUE(player.failed());
  EXPECT_THAT(player.simulator().picks(), ElementsAre(0));
}

TEST(Picks, StayUntilTheNextStepWhereTheCallerBeginsEpisodes) {
  SimulationOptions options;
  options.auto_reset = false;
  Player player({}, options);
  player.fetchTarget();
  player.carryAway();
  player.release();
  ASSERT_TRUE(player.failed());
  EXPECT_THAT(player.simulator().picks(), ElementsAre(1));
  EXPECT_TRUE(player.hasPicked());
  player.simulator().reset(std::vector{BatchSimulator::kNextEpisode});
  EXPECT_THAT(player.simulator().picks(), ElementsAre(1));
  EXPECT_FALSE(player.hasPicked());
  player.terminate();
  ASSERT_TRUE(player.done());
  EXPECT_THAT(player.simulator().picks(), ElementsAre(0));
  EXPECT_EQ(player.sum().picks, 1U);
  EXPECT_EQ(player.sum().episodes, 2U);
}

TEST(Picks, AreLostWhereTheEnvWaits) {
  SimulationOptions options;
  options.auto_reset = false;
  Player player({.kind = TaskKind::kMobilePick}, options);
  player.fetchTarget();
  EXPECT_THAT(player.simulator().picks(), ElementsAre(1));
  player.wait();
  EXPECT_THAT(player.simulator().idle(), ElementsAre(1));
  EXPECT_THAT(player.simulator().picks(), ElementsAre(0));
  EXPECT_TRUE(player.hasPicked());
  EXPECT_EQ(player.sum().picks, 1U);
}

TEST(Picks, AreThoseOfEpisodesThatBeginInTheHandToo) {
  Player holding({});
  holding.fetchTarget();
  Player player({});
  const std::vector<EnvState> states{holding.state()};
  ASSERT_TRUE(player.simulator().setStates(std::vector{0U}, states));
  EXPECT_TRUE(player.hasPicked());
  player.terminate();
  ASSERT_TRUE(player.done());
  EXPECT_THAT(player.simulator().picks(), ElementsAre(1));
}

TEST(Picks, AreNoneWhereTheCallerChoosesTheNextEpisodeInTheStep) {
  Player player({});
  player.fetchTarget();
  const std::int32_t wanted = 3;
  SmallHomeRow row{};
  row[kTerminate] = 1;
  player.simulator().step(row, std::span(&wanted, 1));
  EXPECT_THAT(player.simulator().picks(), ElementsAre(0));
  EXPECT_EQ(player.sum().picks, 0U);
}

TEST(MobilePick, IsASuccessWhenTheTargetIsInTheHand) {
  Player player({.kind = TaskKind::kMobilePick});
  player.terminate();
  EXPECT_FALSE(player.done()) << "the action does nothing";
  player.fetchObject(player.start().target);
  EXPECT_TRUE(player.success());
  EXPECT_GT(player.reward(), 14);
}

TEST(MobilePick, FailsWithAnotherObjectInTheHand) {
  Player player({.kind = TaskKind::kMobilePick});
  player.fetchObject(kOther);
  EXPECT_TRUE(player.failed());
  Player lenient({.kind = TaskKind::kMobilePick, .drop_fails = false});
  lenient.fetchObject(kOther);
  EXPECT_FALSE(lenient.done());
}

TEST(Task, EndsWithItsTimeAsNeitherSuccessNorFailure) {
  Player player({.most_steps = 12});
  for (int n = 0; n < 11; ++n) {
    player.wait();
    EXPECT_FALSE(player.done());
  }
  player.wait();
  EXPECT_TRUE(player.done());
  EXPECT_FALSE(player.success());
  EXPECT_EQ(player.sum().failures, 0U);
  EXPECT_EQ(player.sum().episodes, 1U);
  EXPECT_EQ(player.state().step, 0U) << "the next episode has begun";
  EXPECT_EQ(player.state().episode, 1U);
}

TEST(Task, PrefersSuccessToTheEndOfTheTime) {
  Player probe({.kind = TaskKind::kMobilePick});
  probe.fetchObject(probe.start().target);
  const auto steps = static_cast<std::uint32_t>(probe.sum().steps);
  Player player({.kind = TaskKind::kMobilePick, .most_steps = steps});
  player.fetchObject(player.start().target);
  EXPECT_TRUE(player.success());
}

TEST(Task, HasNoEndWithoutATimeLimit) {
  Player player({.most_steps = 0});
  for (int n = 0; n < 1000; ++n) player.wait();
  EXPECT_EQ(player.sum().episodes, 0U);
  EXPECT_EQ(player.state().step, 1000U);
}

TEST(Task, LeavesDistractorsOutWhenAskedTo) {
  Player player({.distractors = false});
  EXPECT_EQ(player.state().objects.size(), 1U);
  EXPECT_EQ(player.state().target, 0U);
  const Player with({});
  EXPECT_EQ(with.state().objects.size(), 2U);
  EXPECT_EQ(player.state().objects[0], with.state().objects[with.state().target]);
  player.fetchTarget();
}

TEST(Task, TakesEpisodesInOrderAndSkipsTheOneThatCannotStart) {
  Player player({.most_steps = 1});
  EXPECT_EQ(std::vector(player.simulator().skippedEpisodes().begin(),
                        player.simulator().skippedEpisodes().end()),
            std::vector<std::uint32_t>{2});
  std::vector<std::uint32_t> episodes;
  for (int n = 0; n < 6; ++n) {
    episodes.push_back(player.state().episode);
    player.wait();
  }
  EXPECT_EQ(episodes, (std::vector<std::uint32_t>{0, 1, 3, 0, 1, 3}));
}

TEST(Task, BeginsTheEpisodeThatTheCallerAsksFor) {
  Player player({});
  player.fetchTarget();
  const std::int32_t wanted = 3;
  SmallHomeRow row{};
  row[kTerminate] = 1;
  player.simulator().step(row, std::span(&wanted, 1));
  EXPECT_EQ(player.state().episode, 3U);
  EXPECT_EQ(player.state().held, -1);
  EXPECT_EQ(player.state().step, 0U);
  EXPECT_EQ(player.reward(), 0);
  EXPECT_FALSE(player.done());
}

TEST(Task, TakesWhatIsNotANumberAsZero) {
  Player player({});
  SmallHomeRow row{};
  row.fill(std::numeric_limits<float>::quiet_NaN());
  player.step(row);
  EXPECT_EQ(player.sum().nan_actions, row.size());
  EXPECT_EQ(player.state().world_from_grip, player.start().world_from_grip);
  EXPECT_EQ(player.state().joint_positions, player.start().joint_positions);
  EXPECT_FALSE(player.done());
}

TEST(Task, ClampsActionsToTheLargestStep) {
  Player player({});
  SmallHomeRow row{};
  row[kLift] = 100;
  player.step(row);
  EXPECT_NEAR(player.state().joint_positions[kLift], player.start().joint_positions[kLift] + 0.05F,
              kPoseTolerance);
}

void expectNear(const Pose& a, const Pose& b) {
  EXPECT_NEAR(a.translation.x, b.translation.x, kPoseTolerance);
  EXPECT_NEAR(a.translation.y, b.translation.y, kPoseTolerance);
  EXPECT_NEAR(a.translation.z, b.translation.z, kPoseTolerance);
  const float same = a.rotation.x * b.rotation.x + a.rotation.y * b.rotation.y +
                     a.rotation.z * b.rotation.z + a.rotation.w * b.rotation.w;
  EXPECT_NEAR(std::abs(same), 1, kPoseTolerance);
}

TEST(Hand, KeepsThePoseOfTheObjectInTheGrip) {
  Player player({});
  const Pose before = player.start().objects[player.start().target];
  player.fetchTarget();
  EnvState state = player.state();
  expectNear(state.objects[state.target], before);
  const Pose grip_from_object = inverse(state.world_from_grip) * state.objects[state.target];
  const Pose grip_before = state.world_from_grip;
  player.carryToGoal();
  state = player.state();
  expectNear(inverse(state.world_from_grip) * state.objects[state.target], grip_from_object);
  EXPECT_GT(distance(state.world_from_grip.translation, grip_before.translation), 0.1);
  EXPECT_GT(aside(state.objects[state.target].translation, before.translation), 0.1);
}

TEST(Hand, ReleasesOntoTheTable) {
  Player player({});
  player.fetchTarget();
  player.carryToGoal();
  const Pose held = player.state().objects[player.start().target];
  player.release();
  const Pose rests = player.state().objects[player.start().target];
  EXPECT_EQ(player.sum().drops, 1U);
  EXPECT_EQ(rests.translation.x, held.translation.x);
  EXPECT_EQ(rests.translation.z, held.translation.z);
  expectNear({rests.translation, held.rotation}, rests);
  constexpr float kTableTop = 0.7F;
  EXPECT_GE(rests.translation.y, kTableTop);
  EXPECT_LE(rests.translation.y, kTableTop + 0.002F);
}

TEST(Hand, ReleasesAnywhereWhereNoTaskHasAGoal) {
  Player player({.kind = TaskKind::kNone, .drop_fails = false});
  player.fetchTarget();
  player.carryAway();
  player.release();
  EXPECT_EQ(player.state().held, -1);
  EXPECT_EQ(player.sum().drops, 1U);
}

TEST(Hand, PutsTheObjectBackWhereItWasWhenThereIsNoPlace) {
  SimulationOptions options;
  options.placement.attempts = 0;  // no place is looked for
  Player player({}, options);
  player.fetchTarget();
  player.carryToGoal();
  player.release();
  EXPECT_EQ(player.sum().restored, 1U);
  EXPECT_EQ(player.sum().drops, 0U);
  EXPECT_TRUE(player.failed()) << "away from the goal";
}

TEST(Hand, RestoresTheWholePose) {
  SimulationOptions options;
  options.placement.attempts = 0;
  Player player({.kind = TaskKind::kNone}, options);
  player.fetchTarget();
  SmallHomeRow row{};
  row[kHand] = 1;
  row[kLift] = 1;
  player.step(row);
  row[kLift] = 0;
  row[kShoulder] = 1;
  for (int n = 0; n < 5; ++n) player.step(row);
  const Pose held = player.state().objects[player.start().target];
  const Pose before = player.start().objects[player.start().target];
  EXPECT_LT(std::abs(held.rotation.w * before.rotation.w + held.rotation.y * before.rotation.y),
            0.99F)
      << "it was turned in the hand";
  player.release();
  EXPECT_EQ(player.sum().restored, 1U);
  EXPECT_EQ(player.state().objects[player.start().target], before);
  EXPECT_EQ(player.state().held, -1);
}

TEST(Hand, LaysObjectsDownTheSameWayInAnyEnvThatPlaysAnEpisodeByItsName) {
  constexpr std::uint32_t kEnvs = 3;
  const SmallHome home;
  SimulationOptions options;
  options.envs = kEnvs;
  options.task.kind = TaskKind::kNone;
  // What touches something where it is let go is jittered.
  options.placement.most_lift = 0;
  BatchSimulator simulator = simulatorOf(home.world(), options);
  const auto everywhere = [&](const SmallHomeRow& row) {
    std::vector<float> rows;
    for (std::uint32_t n = 0; n < kEnvs; ++n) rows.insert(rows.end(), row.begin(), row.end());
    simulator.step(rows);
  };
  std::mt19937 random(12);
  for (int episode = 0; episode < 12; ++episode) {
    simulator.reset(std::vector<std::int32_t>(kEnvs, 0));
    const EnvState start = simulator.envState(0);
    for (int n = 0; n < kPatience && simulator.envState(0).held < 0; ++n) {
      everywhere(fetch(simulator.envState(0), start.target));
    }
    ASSERT_GE(simulator.envState(0).held, 0);
    // As near to another object as the hand gets.
    Vec3 beside = start.objects[(start.target + 1) % start.objects.size()].translation;
    beside.x += uniformIn(random, -0.12F, 0.12F);
    beside.z += uniformIn(random, -0.12F, 0.12F);
    for (int n = 0; n < kPatience / 2; ++n) everywhere(carry(simulator.envState(0), beside));
    everywhere({});
    for (std::uint32_t env = 1; env < kEnvs; ++env) {
      EXPECT_EQ(simulator.envState(env).objects, simulator.envState(0).objects);
    }
  }
  EXPECT_GT(simulator.statistics().drops, 10U);
}

}  // namespace
}  // namespace galactic::test::task_test
