// Noise of motion and localization: as large as it says, of each env's own luck, and the same
// whenever the same happens again.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include "runtime/simulation/batch_trace.h"

namespace galactic::test::robot_noise_test {
namespace {

using testing::HasSubstr;

/// Mean and deviation of this many numbers are known to a hundredth of the deviation, and to less.
constexpr std::uint32_t kEnvs = 4000;
constexpr double kMeanError = 4 / 63.0;       // four deviations of a mean of kEnvs, in deviations
constexpr double kDeviationError = 4 / 89.0;  // the same of a deviation
/// Of floats that are differences of meters and radians.
constexpr double kRounding = 1e-4;
constexpr double kForwardStep = 0.1;
constexpr double kTurnStep = 0.05;
constexpr double kSlideStep = 0.3;
constexpr double kWristStep = 0.25;

/// The actions of a cart.
enum CartAction : std::size_t { kSlide, kWrist, kForward, kTurn, kHand, kTerminate };
using CartRow = std::array<float, kCartActions>;
static_assert(kTerminate + 1 == kCartActions);

/// Nothing but a floor, and one episode that begins in its middle.
BoxWorld emptyWorld() {
  return {{plainFloor()},
          std::vector<Start>{{.base = {1.5F, 0, 1.5F}, .objects = {{2.8F, 0, 2.8F}}}}};
}

SimulationOptions noisy(const RobotNoise& noise, std::uint32_t envs = kEnvs) {
  SimulationOptions options;
  options.envs = envs;
  options.threads = 1;
  options.seed = 5;
  options.noise = noise;
  options.task.kind = TaskKind::kNone;
  options.task.most_steps = 0;
  return options;
}

BatchSimulator made(const BoxWorld& world, const SimulationOptions& options) {
  return BatchSimulator::create(world.world(), options).value();
}

std::vector<float> everywhere(std::size_t envs, const CartRow& row) {
  std::vector<float> actions;
  actions.reserve(envs * row.size());
  for (std::size_t env = 0; env < envs; ++env)
    actions.insert(actions.end(), row.begin(), row.end());
  return actions;
}

double yawOf(const EnvState& state) {
  const Quat& q = state.world_from_root.rotation;
  return 2 * std::atan2(static_cast<double>(q.y), static_cast<double>(q.w));
}

/// What a robot did in a step, in largest steps: as its actions count.
using Motions = std::array<double, 4>;

Motions motionsBetween(const EnvState& before, const EnvState& after) {
  const Vec3 way = after.world_from_root.translation - before.world_from_root.translation;
  const double yaw = yawOf(after);
  const auto joint = [&](std::size_t n) {
    return static_cast<double>(after.joint_positions[n] - before.joint_positions[n]);
  };
  return {
      joint(0) / kSlideStep, std::remainder(joint(1), 6.283185307179586) / kWristStep,
      (static_cast<double>(way.x) * std::cos(yaw) - static_cast<double>(way.z) * std::sin(yaw)) /
          kForwardStep,
      -std::remainder(yaw - yawOf(before), 6.283185307179586) / kTurnStep};
}

/// What all robots do in a step.
std::vector<Motions> motionsOf(BatchSimulator& simulator, const CartRow& row) {
  std::vector<EnvState> before;
  for (std::size_t env = 0; env < simulator.envCount(); ++env) {
    before.push_back(simulator.envState(env));
  }
  simulator.step(everywhere(simulator.envCount(), row));
  std::vector<Motions> motions;
  for (std::size_t env = 0; env < simulator.envCount(); ++env) {
    motions.push_back(motionsBetween(before[env], simulator.envState(env)));
  }
  return motions;
}

struct Spread {
  double mean = 0;
  double deviation = 0;
};

/// Of values of all envs.
template <class Value>
Spread spreadOf(std::size_t count, const Value& value) {
  double sum = 0;
  double squares = 0;
  for (std::size_t n = 0; n < count; ++n) {
    sum += value(n);
    squares += value(n) * value(n);
  }
  const auto all = static_cast<double>(count);
  return {sum / all, std::sqrt(squares / all - sum * sum / (all * all))};
}

template <class Value>
void expectSpread(std::size_t count, double mean, double deviation, const Value& value) {
  const Spread found = spreadOf(count, value);
  EXPECT_NEAR(found.mean, mean, deviation * kMeanError + kRounding);
  EXPECT_NEAR(found.deviation, deviation, deviation * kDeviationError + kRounding);
}

/// Of two values of each env that have nothing to do with each other.
template <class A, class B>
void expectApart(std::size_t count, const A& a, const B& b) {
  const Spread of_a = spreadOf(count, a);
  const Spread of_b = spreadOf(count, b);
  const Spread both =
      spreadOf(count, [&](std::size_t n) { return (a(n) - of_a.mean) * (b(n) - of_b.mean); });
  EXPECT_NEAR(both.mean, 0, of_a.deviation * of_b.deviation * kMeanError);
}

TEST(MotionNoise, IsAShareOfEachMotionOfItsOwn) {
  const BoxWorld world = emptyWorld();
  BatchSimulator simulator = made(world, noisy({.motion = 0.1F}));
  // The arm out, so that it can come back.
  simulator.step(everywhere(kEnvs, {1, 0, 0, 0, 0, 0}));
  const CartRow row{-0.5F, 0.4F, 0.8F, -0.6F, 0, 0};
  const std::vector<Motions> first = motionsOf(simulator, row);
  const std::vector<Motions> second = motionsOf(simulator, {0.5F, -0.4F, -0.8F, 0.6F, 0, 0});
  const auto share = [&](const std::vector<Motions>& done, std::size_t motion) {
    return [&done, motion](std::size_t env) { return done[env][motion]; };
  };
  for (const std::size_t motion : {kSlide, kWrist, kForward}) {
    SCOPED_TRACE(motion);
    const double asked = static_cast<double>(row[motion]);
    expectSpread(kEnvs, asked, 0.1 * std::abs(asked), share(first, motion));
    expectSpread(kEnvs, -asked, 0.1 * std::abs(asked), share(second, motion));
    expectApart(kEnvs, share(first, motion), share(second, motion));
    expectApart(kEnvs, share(first, motion), share(first, (motion + 1) % 4));
    // Neighbors.
    expectApart(kEnvs - 1, share(first, motion),
                [&](std::size_t env) { return first[env + 1][motion]; });
  }
  // Driving turns, too.
  expectSpread(kEnvs, -0.6, 0.1 * std::hypot(0.6, 0.8), share(first, kTurn));
}

TEST(MotionNoise, TurnsABaseThatDrivesButDrivesNoneThatTurns) {
  const BoxWorld world = emptyWorld();
  BatchSimulator simulator = made(world, noisy({.motion = 0.2F}));
  const std::vector<Motions> driven = motionsOf(simulator, {0, 0, -0.5F, 0, 0, 0});
  expectSpread(kEnvs, 0, 0.1, [&](std::size_t env) { return driven[env][kTurn]; });
  expectSpread(kEnvs, -0.5, 0.1, [&](std::size_t env) { return driven[env][kForward]; });
  const std::vector<Motions> turned = motionsOf(simulator, {0, 0, 0, 0.5F, 0, 0});
  expectSpread(kEnvs, 0.5, 0.1, [&](std::size_t env) { return turned[env][kTurn]; });
  for (const Motions& motions : turned) ASSERT_EQ(motions[kForward], 0);
}

TEST(MotionNoise, LeavesRobotsThatAreAskedToStandWhereTheyAre) {
  const BoxWorld world = furnishedWorld();
  SimulationOptions options = optionsFor(32);
  options.noise = {.motion = 1, .motion_bias = 1, .localization = 1};
  options.task = {.kind = TaskKind::kNone, .most_steps = 0};
  BatchSimulator simulator = made(world, options);
  for (std::uint32_t step = 0; step < 20; ++step) {
    simulator.step(actionsFor(simulator, 0, step));
  }
  std::vector<EnvState> before;
  for (std::size_t env = 0; env < 32; ++env) before.push_back(simulator.envState(env));
  std::vector<float> nothing(32 * simulator.actionCount());
  // Hands that hold something keep it.
  for (std::size_t env = 0; env < 32; ++env)
    nothing[(env + 1) * simulator.actionCount() - 2] = 0.9F;
  for (int step = 0; step < 10; ++step) simulator.step(nothing);
  for (std::size_t env = 0; env < 32; ++env) {
    const EnvState after = simulator.envState(env);
    EXPECT_EQ(after.world_from_root.translation.x, before[env].world_from_root.translation.x);
    EXPECT_EQ(after.world_from_root.translation.z, before[env].world_from_root.translation.z);
    EXPECT_EQ(after.world_from_root.rotation, before[env].world_from_root.rotation);
    EXPECT_EQ(after.joint_positions, before[env].joint_positions);
  }
}

TEST(MotionBias, StaysForAnEpisodeAndIsAnotherInTheNext) {
  const BoxWorld world = emptyWorld();
  SimulationOptions options = noisy({.motion_bias = 0.1F});
  options.task.most_steps = 4;
  BatchSimulator simulator = made(world, options);
  const CartRow row{0.25F, 0.4F, 0.8F, 0.6F, 0, 0};
  std::vector<std::vector<Motions>> done;
  for (int step = 0; step < 3; ++step) done.push_back(motionsOf(simulator, row));
  // The last step of the episode begins another one.
  simulator.step(everywhere(kEnvs, row));
  ASSERT_EQ(simulator.statistics().episodes, kEnvs);
  const std::vector<Motions> next = motionsOf(simulator, row);
  for (std::size_t motion = 0; motion < 4; ++motion) {
    SCOPED_TRACE(motion);
    const double asked = static_cast<double>(row[motion]);
    const double deviation = motion == kTurn ? 0.1 * std::hypot(0.6, 0.8) : 0.1 * asked;
    const auto of = [motion](const std::vector<Motions>& all) {
      return [&all, motion](std::size_t env) { return all[env][motion]; };
    };
    expectSpread(kEnvs, asked, deviation, of(done[0]));
    expectSpread(kEnvs, asked, deviation, of(next));
    expectApart(kEnvs, of(done[0]), of(next));
    for (std::size_t env = 0; env < kEnvs; ++env) {
      ASSERT_NEAR(done[1][env][motion], done[0][env][motion], 20 * kRounding);
      ASSERT_NEAR(done[2][env][motion], done[0][env][motion], 20 * kRounding);
    }
  }
}

TEST(MotionBias, ComesOnTopOfWhatIsOffInEachStep) {
  const BoxWorld world = emptyWorld();
  BatchSimulator simulator = made(world, noisy({.motion = 0.3F, .motion_bias = 0.4F}));
  const std::vector<Motions> done = motionsOf(simulator, {0, 0.5F, 0, 0, 0, 0});
  expectSpread(kEnvs, 0.5, 0.5 * 0.5, [&](std::size_t env) { return done[env][kWrist]; });
}

TEST(MotionNoise, KeepsJointsWithinTheirLimits) {
  const BoxWorld world = emptyWorld();
  BatchSimulator simulator = made(world, noisy({.motion = 1, .motion_bias = 1}, 256));
  int at_end = 0;
  for (int step = 0; step < 20; ++step) {
    const float side = step % 6 < 3 ? 1.0F : -1.0F;
    simulator.step(everywhere(256, {side, side, 0, 0, 0, 0}));
    for (std::size_t env = 0; env < 256; ++env) {
      const std::vector<float> joints = simulator.envState(env).joint_positions;
      ASSERT_GE(joints[0], 0);
      ASSERT_LE(joints[0], 0.6F);
      ASSERT_LE(std::abs(joints[1]), 3.1415927F);
      at_end += joints[0] == 0 || joints[0] == 0.6F ? 1 : 0;
    }
  }
  EXPECT_GT(at_end, 20 * 256 / 10);
  EXPECT_LT(at_end, 20 * 256 * 9 / 10);
}

TEST(MotionNoise, IsNothingThatTheRobotPaysFor) {
  const BoxWorld world = emptyWorld();
  SimulationOptions options = noisy({.motion = 0.5F, .motion_bias = 0.5F}, 3);
  options.task = {.kind = TaskKind::kRearrange,
                  .reach_weight = 0,
                  .transport_weight = 0,
                  .action_weight = 1,
                  .most_steps = 0};
  BatchSimulator simulator = made(world, options);
  simulator.step(everywhere(3, {0.5F, -0.25F, 0, 0, 0, 0}));
  simulator.step(everywhere(3, {0.25F, 0.25F, 0, 0, 0, 0}));
  // The squared changes of what it asked for.
  EXPECT_THAT(simulator.rewards(), testing::Each(-(0.25F * 0.25F + 0.5F * 0.5F)));
}

double drawnMotion(const BatchSimulator& simulator, std::size_t env) {
  return static_cast<double>(simulator.episodeNoise(env).motion);
}

TEST(DrawnNoise, IsAsEachEpisodeHasDrawnIt) {
  const BoxWorld world = emptyWorld();
  SimulationOptions options = noisy({.motion = {0.1F, 0.4F}});
  options.task.most_steps = 2;
  BatchSimulator simulator = made(world, options);
  std::vector<double> drawn;
  for (std::size_t env = 0; env < kEnvs; ++env) {
    drawn.push_back(drawnMotion(simulator, env));
    ASSERT_GE(drawn[env], 0.1);
    ASSERT_LE(drawn[env], 0.4);
  }
  const auto of_drawn = [&](std::size_t env) { return drawn[env]; };
  expectSpread(kEnvs, 0.25, 0.3 / std::sqrt(12), of_drawn);
  // It is what the robots do, and stays until the episode ends.
  const std::vector<Motions> done = motionsOf(simulator, {0, 0.5F, 0, 0, 0, 0});
  expectSpread(kEnvs, 0, 1,
               [&](std::size_t env) { return (done[env][kWrist] / 0.5 - 1) / drawn[env]; });
  for (std::size_t env = 0; env < kEnvs; ++env) ASSERT_EQ(drawnMotion(simulator, env), drawn[env]);
  simulator.step(everywhere(kEnvs, {}));
  ASSERT_EQ(simulator.statistics().episodes, kEnvs);
  const auto next = [&](std::size_t env) { return drawnMotion(simulator, env); };
  expectSpread(kEnvs, 0.25, 0.3 / std::sqrt(12), next);
  expectApart(kEnvs, of_drawn, next);
}

TEST(DrawnNoise, HasDrawsOfItsOwnForEachOption) {
  const BoxWorld world = emptyWorld();
  const BatchSimulator simulator =
      made(world, noisy({.motion = {0, 1}, .motion_bias = {0, 1}, .localization = {0, 1}}));
  const auto of = [&](float EpisodeNoise::*part) {
    return [&simulator, part](std::size_t env) {
      return static_cast<double>(simulator.episodeNoise(env).*part);
    };
  };
  expectApart(kEnvs, of(&EpisodeNoise::motion), of(&EpisodeNoise::motion_bias));
  expectApart(kEnvs, of(&EpisodeNoise::motion), of(&EpisodeNoise::localization));
  expectApart(kEnvs, of(&EpisodeNoise::motion_bias), of(&EpisodeNoise::localization));
  EXPECT_EQ(simulator.episodeNoise(0).laser, 0);
}

TEST(DrawnNoise, OfOneNumberIsThatNumber) {
  const BoxWorld world = emptyWorld();
  const BatchSimulator simulator =
      made(world, noisy({.motion = 0.3F, .motion_bias = 0.2F, .localization = 0.1F}, 3));
  for (std::size_t env = 0; env < 3; ++env) {
    const EpisodeNoise noise = simulator.episodeNoise(env);
    EXPECT_EQ(noise.motion, 0.3F);
    EXPECT_EQ(noise.motion_bias, 0.2F);
    EXPECT_EQ(noise.localization, 0.1F);
  }
}

/// A number that all episodes have, and ranges from which each draws its own.
SimulationOptions wild(std::uint32_t envs, std::uint32_t threads = 1) {
  SimulationOptions options = optionsFor(envs, threads);
  options.noise = {.motion = {0.1F, 0.5F}, .motion_bias = 0.2F, .localization = {0, 0.2F}};
  return options;
}

TEST(RobotNoise, IsTheSameForAnyNumberOfThreadsAndOfOtherEnvs) {
  const BoxWorld world = furnishedWorld();
  BatchSimulator one = made(world, wild(203));
  const auto wanted = tracesOf(one, 120);
  EXPECT_GT(one.statistics().episodes, 203U);
  for (const std::uint32_t threads : {2U, 5U}) {
    BatchSimulator many = made(world, wild(203, threads));
    EXPECT_EQ(tracesOf(many, 120), wanted);
  }
  SimulationOptions options = wild(1);
  options.ranks = 203;
  for (const std::uint32_t env : {0U, 16U, 202U}) {
    options.rank = env;
    BatchSimulator alone = made(world, options);
    EXPECT_EQ(tracesOf(alone, 120, env).front(), wanted[env]) << "env " << env;
  }
  BatchSimulator plain = made(world, optionsFor(203));
  EXPECT_NE(tracesOf(plain, 120), wanted);
}

/// Traces of all envs after the episode `episode` has begun in them and some steps were done; what
/// the robots do in an env depends on nothing but the step.
std::vector<std::uint64_t> tracesInEpisode(BatchSimulator& simulator, std::int32_t episode) {
  simulator.reset(std::vector<std::int32_t>(simulator.envCount(), episode));
  const auto step = [&](float forward) {
    simulator.step(everywhere(simulator.envCount(), {0.1F, 0.2F, forward, 0.3F, 0, 0}));
  };
  // What the step before it returned is not of the episode.
  step(0.5F);
  BatchTrace trace(simulator);
  for (int n = 1; n < 30; ++n) {
    step(n < 15 ? 0.5F : -0.5F);
    trace.add(simulator);
  }
  return trace.hashes();
}

TEST(RobotNoise, OfAnEpisodeThatIsNamedIsTheSameInAnyEnv) {
  const BoxWorld world = furnishedWorld();
  BatchSimulator simulator = made(world, wild(20));
  for (std::uint32_t step = 0; step < 7; ++step) simulator.step(actionsFor(simulator, 0, step));
  const std::vector<std::uint64_t> named = tracesInEpisode(simulator, 3);
  EXPECT_THAT(named, testing::Each(named.front()));
  const std::vector<std::uint64_t> again = tracesInEpisode(simulator, 3);
  EXPECT_EQ(again, named);
  EXPECT_NE(tracesInEpisode(simulator, 4), named);
  // With another seed, another luck.
  simulator.restart(77);
  EXPECT_NE(tracesInEpisode(simulator, 3).front(), named.front());
  // Those whose turn it is have luck of their own.
  const BoxWorld empty = emptyWorld();
  BatchSimulator turns = made(empty, wild(20));
  const std::vector<std::uint64_t> own = tracesInEpisode(turns, BatchSimulator::kNextEpisode);
  EXPECT_EQ(std::count(own.begin(), own.end(), own.front()), 1);
}

TEST(RobotNoise, GoesOnWhereAStateIsRestored) {
  const BoxWorld world = furnishedWorld();
  BatchSimulator first = made(world, wild(24));
  for (std::uint32_t step = 0; step < 25; ++step) first.step(actionsFor(first, 0, step));
  // Some of them in an episode that was named.
  std::vector<std::int32_t> episodes(24, BatchSimulator::kStays);
  for (std::size_t env = 0; env < 24; env += 3) episodes[env] = 1;
  first.reset(episodes);
  for (std::uint32_t step = 25; step < 35; ++step) first.step(actionsFor(first, 0, step));
  const std::vector<std::byte> saved = first.saveState();
  BatchSimulator second = made(world, wild(24, 2));
  ASSERT_TRUE(second.restoreState(saved));
  EXPECT_EQ(second.saveState(), saved);
  EXPECT_TRUE(std::ranges::equal(second.observations(), first.observations()));
  for (std::uint32_t step = 35; step < 120; ++step) {
    const std::vector<float> actions = actionsFor(first, 0, step);
    first.step(actions);
    second.step(actions);
    ASSERT_EQ(BatchTrace(second).hashes(), BatchTrace(first).hashes()) << "step " << step;
  }
  // Without the noise it is a state of something else.
  BatchSimulator plain = made(world, optionsFor(24));
  const Result<void> refused = plain.restoreState(saved);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message,
              HasSubstr("expected motion-noise=0, found motion-noise=0.1-0.5"));
}

/// Where a part of the observation begins.
std::size_t placeOf(const BatchSimulator& simulator, const std::string& name) {
  for (const ObservationPart& part : simulator.observationParts()) {
    if (part.name == name) return part.first;
  }
  ADD_FAILURE() << name;
  return 0;
}

Vec3 observed(const BatchSimulator& simulator, const std::string& name, std::size_t env) {
  const float* at = simulator.observations().data() + env * simulator.observationSize() +
                    placeOf(simulator, name);
  return {at[0], at[1], at[2]};
}

/// How far a robot is from where it takes itself to be, in its own frame, as two points tell that
/// it observes.
struct Belief {
  /// Counter-clockwise, radians.
  double turn = 0;
  double ahead = 0;
  double aside = 0;
};

Belief beliefOf(const BatchSimulator& noisy, const BatchSimulator& exact, std::size_t env) {
  const Vec3 target = observed(noisy, "robot_target", env);
  const Vec3 goal = observed(noisy, "robot_goal", env);
  const Vec3 true_target = observed(exact, "robot_target", env);
  const Vec3 true_goal = observed(exact, "robot_goal", env);
  const auto angle = [](const Vec3& v) {
    return std::atan2(-static_cast<double>(v.z), static_cast<double>(v.x));
  };
  const double turn =
      std::remainder(angle(true_goal - true_target) - angle(goal - target), 6.283185307179586);
  // true = turned(seen) + where it takes itself to be.
  const auto x = static_cast<double>(goal.x);
  const auto z = static_cast<double>(goal.z);
  return {turn, static_cast<double>(true_goal.x) - (std::cos(turn) * x + std::sin(turn) * z),
          static_cast<double>(true_goal.z) - (std::cos(turn) * z - std::sin(turn) * x)};
}

TEST(LocalizationNoise, GrowsWithWhatTheRobotHasMoved) {
  const BoxWorld world = emptyWorld();
  BatchSimulator noisy_one = made(world, noisy({.localization = 0.1F}));
  BatchSimulator exact = made(world, noisy({}));
  const auto believed = [&](std::size_t env) { return beliefOf(noisy_one, exact, env); };
  const auto step = [&](const CartRow& row) {
    noisy_one.step(everywhere(kEnvs, row));
    exact.step(everywhere(kEnvs, row));
  };
  for (std::size_t env = 0; env < kEnvs; ++env) ASSERT_NEAR(believed(env).turn, 0, kRounding);
  // On the spot: the heading alone.
  for (int n = 0; n < 16; ++n) step({0, 0, 0, 1, 0, 0});
  expectSpread(kEnvs, 0, 0.1 * kTurnStep * 4, [&](std::size_t env) { return believed(env).turn; });
  expectSpread(kEnvs, 0, 0, [&](std::size_t env) { return believed(env).ahead; });
  noisy_one.reset(std::vector<std::int32_t>(kEnvs, BatchSimulator::kNextEpisode));
  exact.reset(std::vector<std::int32_t>(kEnvs, BatchSimulator::kNextEpisode));
  for (std::size_t env = 0; env < kEnvs; ++env) ASSERT_NEAR(believed(env).turn, 0, kRounding);
  // Ahead: the length, and the heading, which leads aside.
  for (int n = 0; n < 9; ++n) step({0, 0, 1, 0, 0, 0});
  expectSpread(kEnvs, 0, 0.1 * kTurnStep * 3, [&](std::size_t env) { return believed(env).turn; });
  const Spread along = spreadOf(kEnvs, [&](std::size_t env) { return believed(env).ahead; });
  EXPECT_NEAR(along.deviation, 0.1 * kForwardStep * 3, 0.1 * 0.1 * kForwardStep * 3);
  const Spread aside = spreadOf(kEnvs, [&](std::size_t env) { return believed(env).aside; });
  // 0.1 m times the sum of headings, each of which goes on: sqrt(1 + 4 + ... + 81) of their steps.
  EXPECT_NEAR(aside.deviation, kForwardStep * 0.1 * kTurnStep * std::sqrt(204.0 + 81.0), 0.0015);
  // A robot that takes itself to look too far to the left takes itself to have come to the left,
  // which is -Z: the two grow together by 1 + 2 + ... + 9 of the variance of a step.
  double together = 0;
  for (std::size_t env = 0; env < kEnvs; ++env) {
    together += believed(env).turn * believed(env).aside / kEnvs;
  }
  const double of_a_step = kForwardStep * 0.1 * kTurnStep * 0.1 * kTurnStep;
  EXPECT_NEAR(together, -45 * of_a_step, 5 * of_a_step);
}

TEST(LocalizationNoise, ChangesNothingButWhatIsKnownOfPlaces) {
  const BoxWorld world = furnishedWorld();
  SimulationOptions options = optionsFor(48);
  options.sensors.target_goal = true;
  BatchSimulator exact = made(world, options);
  options.noise.localization = 0.2F;
  BatchSimulator lost = made(world, options);
  const std::vector<std::string> changed{"robot_target", "grip_target", "robot_goal", "grip_goal",
                                         "target_goal"};
  int differ = 0;
  int all = 0;
  for (std::uint32_t step = 0; step < 100; ++step) {
    const std::vector<float> actions = actionsFor(exact, 0, step);
    exact.step(actions);
    lost.step(actions);
    ASSERT_TRUE(std::ranges::equal(lost.rewards(), exact.rewards()));
    ASSERT_TRUE(std::ranges::equal(lost.endings(), exact.endings()));
    for (std::size_t env = 0; env < 48; ++env) {
      ASSERT_EQ(lost.envState(env).world_from_root, exact.envState(env).world_from_root);
      for (const ObservationPart& part : exact.observationParts()) {
        const std::size_t at = env * exact.observationSize() + part.first;
        const bool is_same = std::ranges::equal(lost.observations().subspan(at, part.size),
                                                exact.observations().subspan(at, part.size));
        const bool may_differ = std::ranges::find(changed, part.name) != changed.end();
        ASSERT_TRUE(is_same || may_differ) << part.name;
        if (part.name != "robot_goal") continue;
        ++all;
        differ += is_same ? 0 : 1;
      }
    }
  }
  EXPECT_GT(10 * differ, 8 * all);
}

TEST(LocalizationNoise, LeavesWhatIsInTheHandWhereItIs) {
  const BoxWorld world = furnishedWorld();
  SimulationOptions options = optionsFor(64);
  options.task.observes_current_target = true;
  BatchSimulator exact = made(world, options);
  options.noise.localization = 0.2F;
  BatchSimulator lost = made(world, options);
  int held = 0;
  int resting = 0;
  for (std::uint32_t step = 0; step < 200; ++step) {
    const std::vector<float> actions = actionsFor(exact, 0, step);
    exact.step(actions);
    lost.step(actions);
    for (std::size_t env = 0; env < 64; ++env) {
      const EnvState state = exact.envState(env);
      if (state.step < 10) continue;
      const bool is_held = state.held == static_cast<std::int32_t>(state.target);
      ++(is_held ? held : resting);
      EXPECT_EQ(observed(lost, "grip_target", env) == observed(exact, "grip_target", env), is_held);
    }
  }
  EXPECT_GT(held, 100);
  EXPECT_GT(resting, 100);
}

TEST(RobotNoise, OutOfItsRangeMakesNoSimulator) {
  const BoxWorld world = emptyWorld();
  const auto refusal = [&](const RobotNoise& noise) {
    const Result<BatchSimulator> simulator = BatchSimulator::create(world.world(), noisy(noise, 1));
    return simulator ? "" : simulator.error().message;
  };
  EXPECT_EQ(refusal({.motion = 1, .motion_bias = 1, .localization = 1}), "");
  const std::string wanted = ", expected 0 to 1, or a range from 0 to 1 such as 0.1-0.3";
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(refusal({.motion = -0.5F}), "motion-noise is -0.5" + wanted);
  EXPECT_EQ(refusal({.motion_bias = 1.5F}), "motion-bias is 1.5" + wanted);
  EXPECT_EQ(refusal({.localization = kNan}), "localization-noise is nan-nan" + wanted);
  EXPECT_EQ(refusal({.motion = {0, 1}}), "");
  EXPECT_EQ(refusal({.motion = {0.5F, 0.25F}}), "motion-noise is 0.5-0.25" + wanted);
  EXPECT_EQ(refusal({.motion = {-0.5F, 0.25F}}), "motion-noise is -0.5-0.25" + wanted);
  EXPECT_EQ(refusal({.motion = {0, kNan}}), "motion-noise is 0-nan" + wanted);
}

}  // namespace
}  // namespace galactic::test::robot_noise_test
