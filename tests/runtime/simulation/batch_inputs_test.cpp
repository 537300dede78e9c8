// Wild actions, resets, and episodes that cannot be started.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "batch_trace.h"

namespace galactic::test::batch_inputs_test {
namespace {

using testing::Each;
using testing::ElementsAre;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kHuge = std::numeric_limits<float>::max();

BatchSimulator made(const BoxWorld& world, const SimulationOptions& options) {
  return BatchSimulator::create(world.world(), options).value();
}

/// Traces of two batches, one given `wild`, the other `tame` in the places that `chosen` picks.
template <class Chosen>
void expectSame(float wild, float tame, const Chosen& chosen) {
  const BoxWorld world = furnishedWorld();
  BatchSimulator first = made(world, optionsFor(37));
  BatchSimulator second = made(world, optionsFor(37));
  BatchTrace first_trace(first);
  BatchTrace second_trace(second);
  for (std::uint32_t step = 0; step < 60; ++step) {
    std::vector<float> actions = actionsFor(first, 0, step);
    std::vector<float> others = actions;
    for (std::size_t n = 0; n < actions.size(); ++n) {
      if (!chosen(step * actions.size() + n)) continue;
      actions[n] = wild;
      others[n] = tame;
    }
    first.step(actions);
    second.step(others);
    first_trace.add(first);
    second_trace.add(second);
  }
  EXPECT_EQ(first_trace.hashes(), second_trace.hashes());
}

TEST(Actions, LieWhereTheirLayoutSays) {
  const BoxWorld world = furnishedWorld();
  auto simulator = BatchSimulator::create(world.world(), optionsFor(1)).value();
  const ActionLayout layout = simulator.actionLayout();
  EXPECT_EQ(layout.joints, world.world().robot().controlledJoints().size());
  ASSERT_EQ(layout.count(), simulator.actionCount());
  const auto stateAfter = [&](std::size_t action) {
    simulator.restart(1);
    std::vector<float> actions(layout.count());
    actions[action] = 1;
    simulator.step(actions);
    return simulator.envState(0);
  };
  const EnvState still = stateAfter(layout.hand());
  for (std::size_t joint = 0; joint < layout.joints; ++joint) {
    const EnvState moved = stateAfter(joint);
    EXPECT_NE(moved.joint_positions, still.joint_positions) << joint;
  }
  const EnvState ahead = stateAfter(layout.forward());
  EXPECT_NE(ahead.world_from_root.translation, still.world_from_root.translation);
  EXPECT_EQ(ahead.world_from_root.rotation, still.world_from_root.rotation);
  const EnvState turned = stateAfter(layout.turn());
  EXPECT_EQ(turned.world_from_root.translation, still.world_from_root.translation);
  EXPECT_LT(yawOf(turned.world_from_root.rotation), yawOf(still.world_from_root.rotation));
  EXPECT_EQ(simulator.dones()[0], 0);
  static_cast<void>(stateAfter(layout.terminate()));
  EXPECT_EQ(simulator.dones()[0], 1);
}

TEST(Actions, ThatAreNotANumberAreTakenAsZero) {
  expectSame(kNan, 0, [](std::size_t n) { return n % 7 == 0; });
  expectSame(-kNan, 0, [](std::size_t) { return true; });
}

TEST(Actions, BeyondOneAreClamped) {
  for (const float wild : {1.0001F, 2.0F, 1e30F, kHuge, kInfinity}) {
    expectSame(wild, 1, [](std::size_t n) { return n % 5 == 0; });
    expectSame(-wild, -1, [](std::size_t n) { return n % 5 == 0; });
  }
}

TEST(Actions, ThatAreNotANumberAreCounted) {
  const BoxWorld world = furnishedWorld();
  BatchSimulator simulator = made(world, optionsFor(20, 2));
  std::vector<float> actions(20 * simulator.actionCount());
  simulator.step(actions);
  EXPECT_EQ(simulator.statistics().nan_actions, 0U);
  actions[0] = kNan;
  actions[3] = kInfinity;
  actions[77] = -kNan;
  actions.back() = kNan;
  simulator.step(actions);
  EXPECT_EQ(simulator.statistics().nan_actions, 3U);
  simulator.step(actions);
  EXPECT_EQ(simulator.statistics().nan_actions, 6U);
  for (const float value : simulator.observations()) ASSERT_TRUE(std::isfinite(value));
}

TEST(Options, OutOfTheirRangesMakeNoSimulator) {
  const BoxWorld world = furnishedWorld();
  const auto refusal = [&](const auto& change) {
    SimulationOptions options = optionsFor(2);
    change(options);
    const Result<BatchSimulator> simulator = BatchSimulator::create(world.world(), options);
    return simulator ? "made" : simulator.error().text();
  };
  EXPECT_EQ(refusal([](SimulationOptions&) {}), "made");
  EXPECT_EQ(refusal([](SimulationOptions& options) { options.slide.step = kNan; }),
            "simulation options: slide-step is nan, expected 0 to 1000");
  EXPECT_EQ(refusal([](SimulationOptions& options) { options.task.success_distance = -1; }),
            "simulation options: success-distance is -1, expected 0 to 1000");
  // Rounding tells how high a level floor is.
  EXPECT_EQ(refusal([](SimulationOptions& options) { options.ground.most_drop = 0; }),
            "simulation options: floor-drop is 0, expected 0.001 to 1000");
  EXPECT_EQ(refusal([](SimulationOptions& options) { options.order = EpisodeOrder{9}; }),
            "simulation options: order is 9, expected shuffled, linear or partition");
}

TEST(Resets, BeginTheEpisodeThatIsAskedFor) {
  const BoxWorld world = furnishedWorld();
  BatchSimulator simulator = made(world, optionsFor(20));
  BatchSimulator fresh = made(world, [] {
    SimulationOptions options = optionsFor(7);
    options.order = EpisodeOrder::kLinear;
    return options;
  }());
  for (std::uint32_t step = 0; step < 10; ++step) simulator.step(actionsFor(simulator, 0, step));
  std::vector<std::int32_t> resets(20, -1);
  resets[4] = 6;
  resets[19] = 0;
  const std::vector<std::uint32_t> before{simulator.envState(5).episode,
                                          simulator.envState(5).step};
  simulator.step(actionsFor(simulator, 0, 10), resets);
  EXPECT_EQ(simulator.envState(4).episode, 6U);
  EXPECT_EQ(simulator.envState(19).episode, 0U);
  EXPECT_EQ(simulator.envState(5).episode, before[0]);
  EXPECT_EQ(simulator.envState(5).step, before[1] + 1);
  for (const std::size_t env : {4U, 19U}) {
    EXPECT_EQ(simulator.envState(env).step, 0U);
    EXPECT_EQ(simulator.envState(env).held, -1);
    EXPECT_EQ(simulator.rewards()[env], 0);
    EXPECT_EQ(simulator.dones()[env], 0);
    EXPECT_EQ(simulator.successes()[env], 0);
    // As at the start of a run: the fourth usable episode begins there as in a linear order.
    const std::size_t same = env == 4 ? 4 : 0;
    ASSERT_EQ(fresh.envState(same).episode, simulator.envState(env).episode);
    EXPECT_EQ(fresh.envState(same).world_from_root, simulator.envState(env).world_from_root);
    EXPECT_EQ(fresh.envState(same).objects, simulator.envState(env).objects);
    EXPECT_EQ(fresh.envState(same).joint_positions, simulator.envState(env).joint_positions);
    const std::size_t size = simulator.observationSize();
    EXPECT_TRUE(std::ranges::equal(fresh.observations().subspan(same * size, size),
                                   simulator.observations().subspan(env * size, size)));
  }
}

/// Numbers that begin no episode in furnishedWorld(): those of skipped ones, and of none.
const std::vector<std::int32_t> kOfNoStart{2, 5, 7, 0x7FFFFFFF, -3, -0x7FFFFFFF - 1};

TEST(Resets, ToWhatCannotBeStartedLeaveAStepAsItIsWithout) {
  const BoxWorld world = furnishedWorld();
  SimulationOptions options = optionsFor(static_cast<std::uint32_t>(kOfNoStart.size()));
  options.task.most_steps = 4;
  BatchSimulator simulator = made(world, options);
  BatchSimulator plain = made(world, options);
  BatchTrace trace(simulator);
  BatchTrace plain_trace(plain);
  for (std::uint32_t step = 0; step < 10; ++step) {
    simulator.step(actionsFor(simulator, 0, step), kOfNoStart);
    plain.step(actionsFor(plain, 0, step));
    trace.add(simulator);
    plain_trace.add(plain);
  }
  EXPECT_EQ(trace.hashes(), plain_trace.hashes());
  EXPECT_EQ(simulator.statistics().episodes, 2 * kOfNoStart.size());
}

TEST(Resets, BetweenStepsToWhatCannotBeStartedLeaveTheEnvAsItIs) {
  const BoxWorld world = furnishedWorld();
  SimulationOptions options = optionsFor(static_cast<std::uint32_t>(kOfNoStart.size()));
  options.auto_reset = false;
  BatchSimulator simulator = made(world, options);
  for (std::uint32_t step = 0; step < 5; ++step) simulator.step(actionsFor(simulator, 0, step));
  const std::vector<std::byte> before = simulator.saveState();
  simulator.reset(kOfNoStart);
  EXPECT_EQ(simulator.saveState(), before);
}

TEST(Resets, InTheStepThatEndsAnEpisodeWin) {
  const BoxWorld world = furnishedWorld();
  SimulationOptions options = optionsFor(2);
  options.task.most_steps = 3;
  BatchSimulator simulator = made(world, options);
  const std::vector<float> actions(2 * simulator.actionCount());
  simulator.step(actions);
  simulator.step(actions);
  simulator.step(actions, std::vector<std::int32_t>{6, -1});
  EXPECT_THAT(simulator.dones(), ElementsAre(0, 1));
  EXPECT_EQ(simulator.envState(0).episode, 6U);
  EXPECT_EQ(simulator.envState(0).step, 0U);
  // The episode that the caller cut short is not one that ended.
  EXPECT_EQ(simulator.statistics().episodes, 1U);
}

TEST(Resets, BetweenStepsBeginTheNextEpisodeOrTheOneThatIsAskedFor) {
  const BoxWorld world = furnishedWorld();
  constexpr std::uint32_t kEnvs = 20;
  SimulationOptions options = optionsFor(kEnvs);
  options.task.most_steps = 40;
  BatchSimulator simulator = made(world, options);
  BatchSimulator stepped = made(world, options);
  for (std::uint32_t step = 0; step < 30; ++step) {
    simulator.step(actionsFor(simulator, 0, step));
    stepped.step(actionsFor(stepped, 0, step));
  }
  const SimulationStatistics before = simulator.statistics();
  std::vector<std::int32_t> episodes(kEnvs, BatchSimulator::kStays);
  episodes[3] = 6;
  episodes[17] = BatchSimulator::kNextEpisode;
  simulator.reset(episodes);
  EXPECT_EQ(simulator.envState(3).episode, 6U);
  EXPECT_EQ(simulator.envState(17).step, 0U);
  EXPECT_EQ(simulator.rewards()[17], stepped.rewards()[17]);
  EXPECT_EQ(simulator.statistics().steps, before.steps);
  EXPECT_EQ(simulator.statistics().episodes, before.episodes);
  for (const std::size_t env : {0U, 16U, 19U}) {
    EXPECT_EQ(simulator.envState(env).step, stepped.envState(env).step);
    EXPECT_EQ(simulator.envState(env).world_from_root, stepped.envState(env).world_from_root);
  }
  // The next one is that which the end of the time would have begun.
  while (stepped.envState(17).step != 0) stepped.step(actionsFor(stepped, 0, 99));
  EXPECT_EQ(simulator.envState(17).episode, stepped.envState(17).episode);
}

TEST(Resets, ThatTheCallerMakesAfterEachEndGiveTheEpisodesOfThoseThatStepsMake) {
  const BoxWorld world = furnishedWorld();
  constexpr std::uint32_t kEnvs = 20;
  SimulationOptions options = optionsFor(kEnvs);
  options.task.most_steps = 15;
  options.body_transforms = true;
  BatchSimulator renewing = made(world, options);
  options.auto_reset = false;
  BatchSimulator staying = made(world, options);
  int ends = 0;
  for (std::uint32_t step = 0; step < 100; ++step) {
    const std::vector<float> actions = actionsFor(renewing, 0, step);
    renewing.step(actions);
    staying.step(actions);
    std::vector<std::int32_t> episodes(kEnvs, BatchSimulator::kStays);
    for (std::size_t env = 0; env < kEnvs; ++env) {
      if (staying.dones()[env] == 0) continue;
      ++ends;
      episodes[env] = BatchSimulator::kNextEpisode;
      EXPECT_GT(staying.envState(env).step, 0U);
      const auto row_of = [&](std::span<const float> rows) {
        const std::size_t size = staying.observationSize();
        const std::span<const float> row = rows.subspan(env * size, size);
        return std::vector<float>(row.begin(), row.end());
      };
      EXPECT_EQ(row_of(staying.finalObservations()), row_of(staying.observations()));
      EXPECT_EQ(row_of(staying.finalObservations()), row_of(renewing.finalObservations()));
    }
    const std::vector<float> last(staying.finalObservations().begin(),
                                  staying.finalObservations().end());
    staying.reset(episodes);
    EXPECT_TRUE(std::ranges::equal(staying.finalObservations(), last));
    ASSERT_EQ(BatchTrace(staying).hashes(), BatchTrace(renewing).hashes()) << "step " << step;
  }
  EXPECT_GT(ends, 100);
}

TEST(Resets, AreWaitedForWhereAnEpisodeEndedAndNothingCountsMeanwhile) {
  const BoxWorld world = furnishedWorld();
  constexpr std::uint32_t kEnvs = 20;
  constexpr std::uint32_t kEpisodeSteps = 15;
  SimulationOptions options = optionsFor(kEnvs);
  options.task.most_steps = kEpisodeSteps;
  options.auto_reset = false;
  BatchSimulator simulator = made(world, options);
  // Time ends all episodes that have not ended before.
  std::vector<int> ends(kEnvs);
  for (std::uint32_t step = 0; step < kEpisodeSteps; ++step) {
    simulator.step(actionsFor(simulator, 0, step));
    for (std::size_t env = 0; env < kEnvs; ++env) ends[env] += simulator.dones()[env];
  }
  EXPECT_THAT(ends, testing::Each(1));
  EXPECT_EQ(std::ranges::count(simulator.idle(), 1), kEnvs);
  const SimulationStatistics before = simulator.statistics();
  EXPECT_EQ(before.episodes, kEnvs);
  EXPECT_LE(before.steps, std::uint64_t{kEnvs} * kEpisodeSteps);
  const std::vector<float> seen(simulator.observations().begin(), simulator.observations().end());
  std::vector<EnvState> states;
  for (std::size_t env = 0; env < kEnvs; ++env) states.push_back(simulator.envState(env));
  for (std::uint32_t step = 0; step < kEpisodeSteps; ++step) {
    simulator.step(actionsFor(simulator, 0, 1000 + step));
    ASSERT_EQ(std::ranges::count(simulator.dones(), 0), kEnvs);
    ASSERT_EQ(std::ranges::count(simulator.successes(), 0), kEnvs);
    ASSERT_EQ(std::ranges::count(simulator.endings(), EpisodeEnd::kNone), kEnvs);
    ASSERT_EQ(std::ranges::count(simulator.picks(), 0), kEnvs);
    ASSERT_EQ(std::ranges::count(simulator.rewards(), 0.0F), kEnvs);
  }
  EXPECT_TRUE(std::ranges::equal(simulator.observations(), seen));
  for (std::size_t env = 0; env < kEnvs; ++env) {
    const EnvState now = simulator.envState(env);
    EXPECT_EQ(now.step, states[env].step);
    EXPECT_EQ(now.world_from_root, states[env].world_from_root);
    EXPECT_EQ(now.joint_positions, states[env].joint_positions);
    EXPECT_EQ(now.objects, states[env].objects);
  }
  const SimulationStatistics after = simulator.statistics();
  EXPECT_EQ(after.episodes, before.episodes);
  EXPECT_EQ(after.steps, before.steps);
  EXPECT_EQ(after.refused, before.refused);
  EXPECT_EQ(after.reward, before.reward);
  // Nor does the step in which they begin episodes.
  simulator.step(actionsFor(simulator, 0, 2000), std::vector<std::int32_t>(kEnvs, 0));
  EXPECT_EQ(std::ranges::count(simulator.idle(), 0), kEnvs);
  EXPECT_EQ(simulator.statistics().steps, before.steps);
}

TEST(Resets, EndTheWaitWithTheEpisodeWhoseTurnItIsOrAChosenOne) {
  const BoxWorld world = furnishedWorld();
  constexpr std::uint32_t kEnvs = 3;
  SimulationOptions options = optionsFor(kEnvs);
  options.order = EpisodeOrder::kLinear;
  options.task.most_steps = 2;
  options.auto_reset = false;
  BatchSimulator simulator = made(world, options);
  const std::vector<float> actions(kEnvs * simulator.actionCount());
  for (int step = 0; step < 5; ++step) simulator.step(actions);
  // Also a state that is restored waits.
  ASSERT_TRUE(simulator.restoreState(simulator.saveState()).has_value());
  EXPECT_THAT(simulator.idle(), ElementsAre(1, 1, 1));
  const std::uint32_t first = simulator.envState(0).episode;
  simulator.reset(std::vector<std::int32_t>{BatchSimulator::kNextEpisode, 6,  //
                                            BatchSimulator::kStays});
  EXPECT_THAT(simulator.idle(), ElementsAre(0, 0, 1));
  EXPECT_NE(simulator.envState(0).episode, first);
  EXPECT_EQ(simulator.envState(1).episode, 6U);
  for (int step = 0; step < 2; ++step) simulator.step(actions);
  EXPECT_THAT(simulator.dones(), ElementsAre(1, 1, 0));
  simulator.step(actions, std::vector<std::int32_t>{4, -1, -1});
  EXPECT_THAT(simulator.idle(), ElementsAre(0, 1, 1));
  EXPECT_EQ(simulator.envState(0).episode, 4U);
  simulator.restart(options.seed);
  EXPECT_THAT(simulator.idle(), ElementsAre(0, 0, 0));
}

TEST(Resets, OfEverythingAreAsGoodAsNew) {
  const BoxWorld world = furnishedWorld();
  SimulationOptions options = optionsFor(20);
  options.task.most_steps = 25;
  BatchSimulator used = made(world, options);
  for (std::uint32_t step = 0; step < 60; ++step) used.step(actionsFor(used, 0, step));
  EXPECT_GT(used.statistics().refused, 0U);
  EXPECT_GT(used.statistics().slid, 0U);
  options.seed = 99;
  BatchSimulator fresh = made(world, options);
  used.restart(99);
  BatchTrace of_used(used);
  BatchTrace of_fresh(fresh);
  const auto expect_same_statistics = [&] {
    const SimulationStatistics a = used.statistics();
    const SimulationStatistics b = fresh.statistics();
    visitStatistics(
        [&](const char* name, auto member) { EXPECT_EQ(a.*member, b.*member) << name; });
  };
  expect_same_statistics();
  for (std::uint32_t step = 0; step < 60; ++step) {
    used.step(actionsFor(used, 0, step));
    fresh.step(actionsFor(fresh, 0, step));
    of_used.add(used);
    of_fresh.add(fresh);
  }
  EXPECT_EQ(of_used.hashes(), of_fresh.hashes());
  expect_same_statistics();
}

TEST(Episodes, InWhichTheRobotCannotStartAreSkippedAndListed) {
  const BoxWorld world = furnishedWorld();
  SimulationOptions options = optionsFor(50);
  options.order = EpisodeOrder::kLinear;
  options.task.most_steps = 2;
  BatchSimulator simulator = made(world, options);
  EXPECT_THAT(simulator.skippedEpisodes(), ElementsAre(2, 5));
  std::vector<bool> seen(7);
  for (std::uint32_t step = 0; step < 30; ++step) {
    simulator.step(actionsFor(simulator, 0, step));
    for (std::size_t env = 0; env < 50; ++env) seen[simulator.envState(env).episode] = true;
  }
  EXPECT_THAT(seen, ElementsAre(true, true, false, true, true, false, true));
}

TEST(Episodes, ThatNoneCanBeStartedIsAnError) {
  const BoxWorld world({plainFloor(), {{1, 0, 1}, {2, 2, 2}}},
                       {{.base = {1.5F, 0, 1.5F}, .objects = {{0.5F, 0, 0.5F}}},
                        {.base = {1.5F, 2.5F, 7}, .objects = {{0.5F, 0, 0.5F}}}});
  const auto simulator = BatchSimulator::create(world.world(), optionsFor(4));
  ASSERT_FALSE(simulator.has_value());
  EXPECT_EQ(simulator.error().code, ErrorCode::kInvalidInput);
  EXPECT_EQ(simulator.error().where, "episodes tidy");
  EXPECT_EQ(simulator.error().message,
            "the robot penetrates the scene or an object at the start of all 2 episodes; check "
            "that scene, robot and episodes belong together");
}

TEST(Episodes, ThatBeginInContactArePushedClear) {
  const BoxWorld world({plainFloor(), {{2, 0, 0}, {2.1F, 2, 3}}},
                       {{.base = {1.9F, 0, 1.5F}, .objects = {{0.5F, 0, 0.5F}}}});
  BatchSimulator simulator = made(world, optionsFor(1));
  EXPECT_TRUE(simulator.skippedEpisodes().empty());
  EXPECT_NEAR(simulator.envState(0).world_from_root.translation.x, 1.8749F, 1e-5F);
}

TEST(Episodes, MayLookInAnyDirectionHoweverOftenTheyTurned) {
  constexpr float kTurn = 2 * std::numbers::pi_v<float>;
  const auto start = [](float yaw) {
    const BoxWorld world({plainFloor()},
                         {{.base = {1.5F, 0, 1.5F}, .yaw = yaw, .objects = {{0.5F, 0, 0.5F}}}});
    BatchSimulator simulator = made(world, optionsFor(1));
    const std::vector<float> actions{0, 0, 1, 0, 0, 0};
    simulator.step(actions);
    return simulator.envState(0).world_from_root.translation;
  };
  const Vec3 wanted = start(0.5F);
  for (const float turns : {-1.0F, 1.0F, 100.0F, -1000.0F}) {
    const Vec3 found = start(0.5F + turns * kTurn);
    // Floats of thousands of radians are a millimeter apart.
    EXPECT_NEAR(found.x, wanted.x, 1e-4F) << turns;
    EXPECT_NEAR(found.z, wanted.z, 1e-4F) << turns;
  }
  const Vec3 far = start(1e9F);
  EXPECT_NEAR(std::hypot(far.x - 1.5F, far.z - 1.5F), 0.1F, 1e-5F);
}

TEST(Options, OfMoreEnvsThanNumbersCanTellApartAreRefused) {
  SimulationOptions options;
  options.envs = 65537;
  options.ranks = 65536;
  const Result<void> checked = checkOptions(options);
  ASSERT_FALSE(checked.has_value());
  EXPECT_EQ(checked.error().code, ErrorCode::kInvalidInput);
  EXPECT_EQ(checked.error().message,
            "ranks is 65536 and envs is 65537: 4295032832 envs in all, expected at most "
            "4294967296, as envs have numbers of 32 bits; take fewer ranks or fewer envs for each");
  options.rank = options.ranks - 1;
  const BoxWorld world = furnishedWorld();
  EXPECT_FALSE(BatchSimulator::create(world.world(), options).has_value());
  // The last one of these has the largest number.
  options.envs = 65536;
  EXPECT_TRUE(checkOptions(options).has_value());
}

TEST(Options, ThatMakeNoSenseAreErrors) {
  const BoxWorld world = furnishedWorld();
  const auto message = [&](const SimulationOptions& options) {
    const auto simulator = BatchSimulator::create(world.world(), options);
    return simulator ? std::string("accepted") : simulator.error().message;
  };
  SimulationOptions options = optionsFor(0);
  EXPECT_EQ(message(options), "envs is 0, expected 1 to 1048576");
  options = optionsFor(3);
  options.rank = 2;
  options.ranks = 2;
  EXPECT_EQ(message(options), "rank is 2, expected a number below ranks, which is 2");
  options.rank = options.ranks = 0;
  EXPECT_EQ(message(options), "ranks is 0, expected 1 to 65536");
}

}  // namespace
}  // namespace galactic::test::batch_inputs_test
