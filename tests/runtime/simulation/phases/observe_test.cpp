// Observations against a plain reference in double precision that sees only the state of the env.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "galactic/option_text.h"
#include "support/homes/every_option.h"
#include "support/homes/small_home_actor.h"
#include "support/homes/task_twins.h"
#include "support/oracles/resting_oracle.h"
#include "support/oracles/task_oracle.h"

namespace galactic::test::observe_test {
namespace {

constexpr std::uint32_t kSeed = 7;
constexpr std::uint32_t kEnvs = 20;
/// Floats of a few meters, through a handful of rotations.
constexpr double kTolerance = 1e-4;

SimulationOptions optionsOf(const TaskOptions& task) {
  SimulationOptions options;
  options.envs = kEnvs;
  options.threads = 1;
  options.task = task;
  return options;
}

std::span<const float> rowOf(const BatchSimulator& simulator, std::span<const float> rows,
                             std::size_t env) {
  return rows.subspan(env * simulator.observationSize(), simulator.observationSize());
}

void expectObserved(std::span<const float> row, const std::vector<double>& wanted) {
  ASSERT_EQ(row.size(), wanted.size());
  for (std::size_t n = 0; n < row.size(); ++n) {
    ASSERT_NEAR(static_cast<double>(row[n]), wanted[n], kTolerance) << "element " << n;
  }
}

/// Drives wild episodes and compares every observation, the final ones too.
class Observed {
 public:
  explicit Observed(const TaskOptions& task) : task_(task), twins_(home_.world(), optionsOf(task)) {
    for (std::uint32_t env = 0; env < kEnvs; ++env) actors_.emplace_back(kSeed + env);
  }

  void run(int steps) {
    checkAll();
    for (int step = 0; step < steps; ++step) {
      SCOPED_TRACE("step " + std::to_string(step));
      act();
      twins_.step(actions_);
      checkFinals();
      twins_.renew();
      checkAll();
      if (testing::Test::HasFatalFailure()) return;
    }
  }

  int finals = 0;
  int holding = 0;
  int moved_targets = 0;
  int rows = 0;

 private:
  void act() {
    for (std::size_t env = 0; env < kEnvs; ++env) {
      const SmallHomeRow row = actors_[env].act(twins_.batch().envState(env));
      std::copy(row.begin(), row.end(),
                actions_.begin() + static_cast<std::ptrdiff_t>(env * kSmallHomeActions));
    }
  }

  /// Where an episode ended: the last observation of it.
  void checkFinals() {
    const BatchSimulator& batch = twins_.batch();
    for (std::size_t env = 0; env < kEnvs; ++env) {
      if (batch.dones()[env] == 0) continue;
      ++finals;
      actors_[env].begin();
      expectObserved(rowOf(batch, batch.finalObservations(), env),
                     observationOf(home_.world(), task_, twins_.after(env)));
    }
  }

  /// The state in which the env is now: the next episode's first where one ended.
  void checkAll() {
    const BatchSimulator& batch = twins_.batch();
    for (std::size_t env = 0; env < kEnvs; ++env) {
      const EnvState state = batch.envState(env);
      expectObserved(rowOf(batch, batch.observations(), env),
                     observationOf(home_.world(), task_, state));
      const Episode& episode = home_.world().episodes().episodes()[state.episode];
      const Pose& start = home_.world().episodes().placements(episode)[episode.target].pose;
      ++rows;
      holding += state.held >= 0 ? 1 : 0;
      moved_targets += state.objects[state.target] == start ? 0 : 1;
    }
  }

  SmallHome home_;
  TaskOptions task_;
  TaskTwins twins_;
  std::vector<WildActor> actors_;
  std::vector<float> actions_ = std::vector<float>(kEnvs * kSmallHomeActions);
};

void expectBothSides(int count, int all) {
  EXPECT_GE(10 * count, all);
  EXPECT_LE(10 * count, 9 * all);
}

TEST(Observation, IsThatOfTheStateAfterTheStep) {
  RecordProperty("seed", static_cast<int>(kSeed));
  Observed observed({.most_steps = 50});
  observed.run(300);
  EXPECT_GT(observed.finals, 50);
  expectBothSides(observed.holding, observed.rows);
  expectBothSides(observed.moved_targets, observed.rows);
}

TEST(Observation, FollowsTheTargetWhenAskedTo) {
  Observed observed({.most_steps = 50, .observes_current_target = true});
  observed.run(300);
  EXPECT_GT(observed.finals, 50);
  expectBothSides(observed.moved_targets, observed.rows);
}

TEST(Observation, IsTheSameWithoutDistractorsAndWithoutATimeLimit) {
  Observed observed({.most_steps = 0, .distractors = false});
  observed.run(200);
  EXPECT_GT(observed.finals, 10);
}

TEST(Observation, NamesItsParts) {
  const SmallHome home;
  const BatchSimulator simulator = simulatorOf(home.world(), optionsOf({}));
  const std::vector<std::pair<std::string, std::size_t>> wanted{
      {"robot_target", 3}, {"grip_target", 3}, {"robot_grip", 3}, {"robot_goal", 3},
      {"grip_goal", 3},    {"is_holding", 1},  {"joints", 4},     {"time", 3}};
  std::size_t first = 0;
  ASSERT_EQ(simulator.observationParts().size(), wanted.size());
  for (std::size_t n = 0; n < wanted.size(); ++n) {
    const ObservationPart& part = simulator.observationParts()[n];
    EXPECT_EQ(part.name, wanted[n].first);
    EXPECT_EQ(part.size, wanted[n].second);
    EXPECT_EQ(part.first, first);
    first += part.size;
  }
  EXPECT_EQ(simulator.observationSize(), first);
  EXPECT_EQ(simulator.observations().size(), kEnvs * first);
}

/// Simulators that differ in sensors alone, each with what everySensor() says of its one.
class SensorsAlone {
 public:
  explicit SensorsAlone(const World& world) {
    all_.envs = kEnvs;
    all_.threads = 1;
    all_.sensors = everySensor();
    SimulationOptions none = all_;
    none.sensors = {};
    const std::size_t usual = simulatorOf(world, none).observationParts().size();
    std::vector<OptionText> details;
    std::vector<OptionText> switches;
    const std::vector<OptionText> defaults = listOptions(none);
    for (const OptionText& option : listOptions(all_)) {
      if (std::ranges::find(defaults, option) != defaults.end()) continue;
      const bool adds = simulatorOf(world, with(none, {option})).observationParts().size() > usual;
      (adds ? switches : details).push_back(option);
    }
    for (const OptionText& option : switches) {
      std::vector<OptionText> alone = details;
      alone.push_back(option);
      simulators.push_back(simulatorOf(world, with(none, alone)));
      EXPECT_EQ(simulators.back().observationParts().size(), usual + 1) << option.name;
    }
  }

  [[nodiscard]] const SimulationOptions& all() const { return all_; }

  std::vector<BatchSimulator> simulators;

 private:
  static SimulationOptions with(SimulationOptions options, const std::vector<OptionText>& texts) {
    EXPECT_FALSE(setOptions(texts, OptionScope::kAll, options));
    return options;
  }

  SimulationOptions all_;
};

TEST(Observation, HasEachPartAsIfItsSensorWereTheOnlyOne) {
  const SmallHome home;
  SensorsAlone alone(home.world());
  BatchSimulator together = simulatorOf(home.world(), alone.all());
  const std::vector<ObservationPart>& parts = together.observationParts();
  constexpr std::size_t kUsualParts = 8;
  ASSERT_EQ(parts.size(), kUsualParts + alone.simulators.size());
  std::vector<WildActor> actors;
  for (std::uint32_t env = 0; env < kEnvs; ++env) actors.emplace_back(kSeed + env);
  std::vector<float> actions(kEnvs * kSmallHomeActions);
  for (int step = 0; step < 60; ++step) {
    for (std::size_t n = 0; n < alone.simulators.size(); ++n) {
      const BatchSimulator& single = alone.simulators[n];
      const ObservationPart& mine = single.observationParts().back();
      const auto theirs = std::ranges::find(parts, mine.name, &ObservationPart::name);
      ASSERT_NE(theirs, parts.end()) << mine.name;
      ASSERT_EQ(theirs->size, mine.size) << mine.name;
      for (std::size_t env = 0; env < kEnvs; ++env) {
        const auto found = rowOf(together, together.observations(), env);
        const auto wanted = rowOf(single, single.observations(), env);
        ASSERT_THAT(found.subspan(theirs->first, mine.size),
                    testing::ElementsAreArray(wanted.subspan(mine.first, mine.size)))
            << mine.name << ", step " << step << ": do sense() and observationParts() agree?";
      }
    }
    for (std::size_t env = 0; env < kEnvs; ++env) {
      if (together.dones()[env] != 0) actors[env].begin();
      std::ranges::copy(actors[env].act(together.envState(env)),
                        actions.begin() + static_cast<std::ptrdiff_t>(env * kSmallHomeActions));
    }
    together.step(actions);
    for (BatchSimulator& single : alone.simulators) single.step(actions);
  }
}

TEST(Observation, CountsTheTimeDown) {
  const SmallHome home;
  BatchSimulator simulator = simulatorOf(home.world(), optionsOf({.most_steps = 100}));
  const std::vector<float> nothing(kEnvs * kSmallHomeActions);
  const auto time = [&] {
    const std::span<const float> row = simulator.observations().first(simulator.observationSize());
    return std::vector<float>(row.end() - 3, row.end());
  };
  EXPECT_EQ(time(), (std::vector<float>{1, 1, 1}));
  for (int step = 0; step < 90; ++step) simulator.step(nothing);
  EXPECT_NEAR(static_cast<double>(time()[0]), 0.1, kTolerance);
  EXPECT_NEAR(static_cast<double>(time()[1]), 0.5, kTolerance);
  EXPECT_EQ(time()[2], 1);
}

TEST(Observation, TellsTheWayFromTheTargetWhereItIsToTheGoal) {
  const SmallHome home;
  SimulationOptions options = optionsOf({.most_steps = 50});
  options.sensors.target_goal = true;
  BatchSimulator simulator = simulatorOf(home.world(), options);
  const ObservationPart part = simulator.observationParts().back();
  ASSERT_EQ(part.name, "target_goal");
  std::vector<WildActor> actors;
  for (std::uint32_t env = 0; env < kEnvs; ++env) actors.emplace_back(kSeed + env);
  std::vector<float> actions(kEnvs * kSmallHomeActions);
  int moved = 0;
  for (int step = 0; step < 200; ++step) {
    for (std::size_t env = 0; env < kEnvs; ++env) {
      const EnvState state = simulator.envState(env);
      const Double3 left = turnedInto(state.world_from_root.rotation,
                                      difference(double3(state.goal.translation),
                                                 double3(state.objects[state.target].translation)));
      const auto row = rowOf(simulator, simulator.observations(), env).subspan(part.first, 3);
      expectObserved(row, {left.begin(), left.end()});
      const Episode& episode = home.world().episodes().episodes()[state.episode];
      const Pose& start = home.world().episodes().placements(episode)[episode.target].pose;
      moved += state.objects[state.target] == start ? 0 : 1;
      if (simulator.dones()[env] != 0) actors[env].begin();
      std::ranges::copy(actors[env].act(state),
                        actions.begin() + static_cast<std::ptrdiff_t>(env * kSmallHomeActions));
    }
    simulator.step(actions);
  }
  expectBothSides(moved, static_cast<int>(kEnvs) * 200);
}

/// Something that follows in the row.
constexpr LaserOptions kLaser{.beams = 3};

SimulationOptions sensing(const SensorOptions& sensors) {
  SimulationOptions options = optionsOf({.kind = TaskKind::kNone});
  options.sensors = sensors;
  return options;
}

ObservationPart partBeforeLaser(const BatchSimulator& simulator) {
  return simulator.observationParts().end()[-2];
}

/// The same state with something else in the hand: a view of it.
FollowedState followedFrom(const EnvState& state, std::int32_t held) {
  return {.world_from_root = state.world_from_root,
          .joint_positions = state.joint_positions,
          .objects = state.objects,
          .held = held};
}

TEST(Observation, TellsHowTheTargetIsTilted) {
  const SmallHome home;
  BatchSimulator simulator =
      simulatorOf(home.world(), sensing({.target_up = true, .laser = kLaser}));
  const ObservationPart part = partBeforeLaser(simulator);
  ASSERT_EQ(part.name, "target_up");
  const auto observed = [&](std::size_t env) {
    return rowOf(simulator, simulator.observations(), env).subspan(part.first, part.size);
  };
  std::mt19937 random(kSeed);
  std::vector<EnvState> states;
  std::vector<FollowedState> followed;
  std::vector<Double3> tops;
  states.reserve(kEnvs);
  for (std::size_t env = 0; env < kEnvs; ++env) {
    EnvState& state = states.emplace_back(simulator.envState(env));
    const Quat& facing = state.world_from_root.rotation;
    expectObserved(observed(env), {0, 1, 0});
    const Quat turn = randomQuat(random);
    Quat& target = state.objects[state.target].rotation;
    target = turn * target;
    tops.push_back(turnedInto(facing, double3(rotate(turn, {0, 1, 0}))));
    followed.push_back(
        followedFrom(state, env % 2 == 0 ? -1 : static_cast<std::int32_t>(state.target)));
  }
  simulator.follow(std::vector<float>(kEnvs * kSmallHomeActions), followed);
  for (std::size_t env = 0; env < kEnvs; ++env) {
    SCOPED_TRACE(env);
    expectObserved(observed(env), {tops[env].begin(), tops[env].end()});
  }
}

/// The ways from the hand to the `count` nearest boxes, in the robot's frame, one after the other.
std::vector<double> waysToNearest(const World& world, const EnvState& state, std::size_t count) {
  constexpr double kFarthest = 1;
  const Double3 hand = double3(state.world_from_grip.translation);
  const auto placements = world.episodes().placements(world.episodes().episodes()[state.episode]);
  std::vector<std::pair<double, Double3>> ways;
  for (std::size_t n = 0; n < state.objects.size(); ++n) {
    if (n == state.target || static_cast<std::int32_t>(n) == state.held) continue;
    const BoxSolid box(world.objectOf(placements[n]).box, state.objects[n]);
    const Double3 way = difference(box.nearestTo(hand), hand);
    ways.emplace_back(std::sqrt(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]), way);
  }
  std::erase_if(ways, [&](const auto& way) { return way.first > kFarthest; });
  std::ranges::sort(ways);
  ways.resize(count, {kFarthest, {0, kFarthest, 0}});
  std::vector<double> row;
  for (const auto& [length, way] : ways) {
    const Double3 seen = turnedInto(state.world_from_root.rotation, way);
    row.insert(row.end(), seen.begin(), seen.end());
  }
  return row;
}

TEST(Observation, TellsTheWaysToTheObjectsNearTheHand) {
  constexpr std::uint32_t kNear = 3;
  const SmallHome home;
  BatchSimulator simulator =
      simulatorOf(home.world(), sensing({.near_objects = kNear, .laser = kLaser}));
  const ObservationPart part = partBeforeLaser(simulator);
  ASSERT_EQ(part.name, "near_objects");
  ASSERT_EQ(part.size, 3 * kNear);
  std::mt19937 random(kSeed);
  int there = 0;
  int elements = 0;
  for (int round = 0; round < 20; ++round) {
    std::vector<EnvState> states;
    std::vector<FollowedState> followed;
    states.reserve(kEnvs);
    for (std::size_t env = 0; env < kEnvs; ++env) {
      EnvState& state = states.emplace_back(simulator.envState(env));
      for (Pose& object : state.objects) {
        const auto away = [&] { return uniformIn(random, -1.2F, 1.2F); };
        object = {state.world_from_grip.translation + Vec3{away(), away(), away()},
                  randomQuat(random)};
      }
      const auto count = static_cast<std::int32_t>(state.objects.size());
      followed.push_back(followedFrom(state, static_cast<std::int32_t>(env) % (count + 1) - 1));
    }
    simulator.follow(std::vector<float>(kEnvs * kSmallHomeActions), followed);
    for (std::size_t env = 0; env < kEnvs; ++env) {
      SCOPED_TRACE(env);
      const std::vector<double> wanted =
          waysToNearest(home.world(), simulator.envState(env), kNear);
      expectObserved(rowOf(simulator, simulator.observations(), env).subspan(part.first, part.size),
                     wanted);
      for (std::size_t n = 1; n < wanted.size(); n += 3) {
        ++elements;
        there += wanted[n] == 1 ? 0 : 1;
      }
    }
  }
  expectBothSides(there, elements);
}

TEST(Observation, TellsOfNoMoreObjectsNearTheHandThanItCan) {
  const SmallHome home;
  SimulationOptions options = optionsOf({});
  options.sensors.near_objects = kMostNearObjects;
  EXPECT_EQ(simulatorOf(home.world(), options).observationParts().back().size,
            3 * kMostNearObjects);
  options.sensors.near_objects = kMostNearObjects + 1;
  const Result<BatchSimulator> more = BatchSimulator::create(home.world(), options);
  ASSERT_FALSE(more);
  EXPECT_EQ(more.error().code, ErrorCode::kInvalidInput);
  EXPECT_EQ(more.error().message, "near-objects is 17, expected 0 to 16");
}

TEST(Observation, FeelsWhatWasInTheWayAndPaysForIt) {
  const SmallHome home;
  SimulationOptions options = optionsOf({.most_steps = 50});
  options.envs = 1;
  options.slide.attempts = 0;
  BatchSimulator plain = simulatorOf(home.world(), options);
  options.sensors.bump = true;
  options.task.bump_penalty = 0.5F;
  BatchSimulator feeling = simulatorOf(home.world(), options);
  ASSERT_EQ(feeling.observationParts().back().name, "bump");
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<float> uniform(-1, 1);
  std::vector<float> actions(kSmallHomeActions);
  int bumps = 0;
  constexpr int kSteps = 400;
  for (int step = 0; step < kSteps; ++step) {
    for (float& action : actions) action = uniform(random);
    actions[kSmallHomeActions - 4] = 1;
    const std::uint64_t before = feeling.statistics().refused;
    plain.step(actions);
    feeling.step(actions);
    const bool bumped = feeling.statistics().refused != before;
    bumps += bumped ? 1 : 0;
    const bool ended = feeling.dones()[0] != 0;
    const auto last = ended ? feeling.finalObservations() : feeling.observations();
    EXPECT_EQ(last.back(), bumped ? 1 : 0) << "step " << step;
    if (ended) {
      EXPECT_EQ(feeling.observations().back(), 0) << "step " << step;
    }
    EXPECT_NEAR(static_cast<double>(plain.rewards()[0] - feeling.rewards()[0]), bumped ? 0.5 : 0.0,
                kTolerance);
  }
  expectBothSides(bumps, kSteps);
}

}  // namespace
}  // namespace galactic::test::observe_test
