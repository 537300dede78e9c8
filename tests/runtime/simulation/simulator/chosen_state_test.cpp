// States that somebody has chosen: envs go on from them as if they had come there by themselves.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "runtime/simulation/batch_trace.h"
#include "support/homes/small_home_actor.h"
#include "support/homes/task_twins.h"

namespace galactic::test::chosen_state_test {
namespace {

using testing::Contains;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;

/// A yaw through a quaternion and back, at arm's length.
constexpr float kTolerance = 2e-5F;

SimulationOptions optionsOf(std::uint32_t envs, std::uint32_t threads = 1) {
  SimulationOptions options;
  options.envs = envs;
  options.threads = threads;
  options.body_transforms = true;
  options.task.most_steps = 120;
  options.sensors.target_goal = true;
  options.sensors.target_up = true;
  options.sensors.near_objects = 2;
  return options;
}

std::vector<std::uint32_t> all(const BatchSimulator& simulator) {
  std::vector<std::uint32_t> envs(simulator.envCount());
  std::iota(envs.begin(), envs.end(), 0U);
  return envs;
}

std::vector<EnvState> statesOf(const BatchSimulator& simulator) {
  std::vector<EnvState> states;
  for (const std::uint32_t env : all(simulator)) states.push_back(simulator.envState(env));
  return states;
}

/// Whether the one env of `simulator` is in `state` now.
bool isSet(BatchSimulator& simulator, const EnvState& state) {
  return simulator.setStates(std::array{0U}, std::array{state}).value().front() != 0;
}

std::string refusalOf(BatchSimulator& simulator, const EnvState& state) {
  const std::vector<std::byte> before = simulator.saveState();
  const auto set = simulator.setStates(std::array{0U}, std::array{state});
  EXPECT_EQ(simulator.saveState(), before);
  return set ? "none" : set.error().text();
}

float farthest(const Pose& a, const Pose& b) {
  const Vec3 away = a.translation - b.translation;
  const auto [x, y, z, w] = a.rotation;
  // Of two quaternions of one rotation.
  const float cosine = x * b.rotation.x + y * b.rotation.y + z * b.rotation.z + w * b.rotation.w;
  return std::max(std::sqrt(dot(away, away)), std::abs(1 - std::abs(cosine)));
}

void expectSameState(const EnvState& set, const EnvState& wanted) {
  EXPECT_EQ(set.scene, wanted.scene);
  EXPECT_EQ(set.episode, wanted.episode);
  EXPECT_EQ(set.step, wanted.step);
  EXPECT_EQ(set.held, wanted.held);
  EXPECT_EQ(set.target, wanted.target);
  EXPECT_EQ(set.goal, wanted.goal);
  EXPECT_LT(farthest(set.world_from_root, wanted.world_from_root), kTolerance);
  EXPECT_LT(farthest(set.world_from_grip, wanted.world_from_grip), kTolerance);
  ASSERT_EQ(set.joint_positions.size(), wanted.joint_positions.size());
  for (std::size_t n = 0; n < set.joint_positions.size(); ++n) {
    EXPECT_NEAR(set.joint_positions[n], wanted.joint_positions[n], kTolerance);
  }
  ASSERT_EQ(set.objects.size(), wanted.objects.size());
  for (std::size_t n = 0; n < set.objects.size(); ++n) {
    EXPECT_LT(farthest(set.objects[n], wanted.objects[n]), kTolerance) << n;
  }
}

/// Acts in a small home until many of its envs hold something, and a step more.
class Actors {
 public:
  explicit Actors(std::uint32_t envs) {
    for (std::uint32_t env = 0; env < envs; ++env) actors_.emplace_back(env + 11);
  }

  [[nodiscard]] std::vector<float> act(const BatchSimulator& simulator) {
    std::vector<float> actions;
    for (std::size_t env = 0; env < actors_.size(); ++env) {
      if (simulator.dones()[env] != 0) actors_[env].begin();
      const SmallHomeRow row = actors_[env].act(simulator.envState(env));
      actions.insert(actions.end(), row.begin(), row.end());
    }
    return actions;
  }

 private:
  std::vector<WildActor> actors_;
};

/// A simulator after some steps of actors.
BatchSimulator played(const World& world, const SimulationOptions& options, int steps) {
  BatchSimulator simulator = simulatorOf(world, options);
  Actors actors(options.envs);
  for (int step = 0; step < steps; ++step) simulator.step(actors.act(simulator));
  return simulator;
}

/// The one env of a simulator that has carried the target of its episode until it holds it.
BatchSimulator holding(const World& world, SimulationOptions options) {
  options.envs = 1;
  options.order = EpisodeOrder::kLinear;
  BatchSimulator simulator = simulatorOf(world, options);
  for (int step = 0; step < 100 && simulator.envState(0).held < 0; ++step) {
    simulator.step(solve(simulator.envState(0)));
  }
  EXPECT_EQ(simulator.envState(0).held, static_cast<std::int32_t>(simulator.envState(0).target));
  return simulator;
}

TEST(ChosenStates, OfOtherEnvsAreWhereTheyCameByThemselves) {
  const SmallHome home;
  constexpr std::uint32_t kEnvs = 64;
  int held = 0;
  int set = 0;
  int seen = 0;
  for (const int steps : {1, 17, 40, 70}) {
    const BatchSimulator from = played(home.world(), optionsOf(kEnvs), steps);
    BatchSimulator to = simulatorOf(home.world(), optionsOf(kEnvs));
    const std::vector<EnvState> states = statesOf(from);
    const std::vector<std::uint8_t> were_set = to.setStates(all(to), states).value();
    for (std::size_t env = 0; env < kEnvs; ++env) {
      ++seen;
      if (were_set[env] == 0) continue;
      ++set;
      SCOPED_TRACE(env);
      expectSameState(to.envState(env), states[env]);
      held += states[env].held >= 0 ? 1 : 0;
      const Placement& start = home.world().episodes().placements(
          home.world().episodes().episodes()[states[env].episode])[states[env].target];
      const bool has_target_moved =
          !(states[env].objects[states[env].target] == start.pose) &&
          states[env].held != static_cast<std::int32_t>(states[env].target);
      for (const ObservationPart& part : from.observationParts()) {
        // Where it rests counts as where it began.
        if (has_target_moved && part.name.ends_with("_target")) continue;
        for (std::size_t n = part.first; n < part.first + part.size; ++n) {
          const std::size_t at = env * from.observationSize() + n;
          EXPECT_NEAR(to.observations()[at], from.observations()[at], 1e-3F) << part.name;
        }
      }
    }
  }
  EXPECT_GT(held, 20);
  // Robots that still leave what they let go of further away than their hands reach.
  EXPECT_GT(set, seen * 95 / 100);
}

TEST(ChosenStates, AreGoneOnFromAlikeByAnyNumberOfThreads) {
  const SmallHome home;
  constexpr std::uint32_t kEnvs = 40;
  const std::vector<EnvState> states = statesOf(played(home.world(), optionsOf(kEnvs), 45));
  BatchSimulator first = simulatorOf(home.world(), optionsOf(kEnvs, 1));
  BatchSimulator second = simulatorOf(home.world(), optionsOf(kEnvs, 3));
  ASSERT_EQ(first.setStates(all(first), states).value(),
            second.setStates(all(second), states).value());
  // Again, one by one, the last first: each depends on nothing but itself.
  for (std::uint32_t env = kEnvs; env-- > 0;) {
    ASSERT_TRUE(second.setStates(std::array{env}, std::array{states[env]}).has_value());
    ASSERT_TRUE(first.setStates(std::array{env}, std::array{states[env]}).has_value());
  }
  Actors actors(kEnvs);
  for (int step = 0; step < 200; ++step) {
    ASSERT_EQ(BatchTrace(first).hashes(), BatchTrace(second).hashes()) << step;
    const std::vector<float> actions = actors.act(first);
    first.step(actions);
    second.step(actions);
  }
  EXPECT_GT(first.statistics().drops, 5U);
}

TEST(ChosenStates, AreSavedAndRestoredWithTheirGoals) {
  const SmallHome home;
  BatchSimulator simulator = simulatorOf(home.world(), optionsOf(1));
  EnvState state = simulator.envState(0);
  state.goal.translation = state.goal.translation + Vec3{0.2F, 0, 0.1F};
  state.step = 118;
  ASSERT_TRUE(isSet(simulator, state));
  EXPECT_EQ(simulator.envState(0).goal, state.goal);
  EXPECT_EQ(simulator.envObjects(0).goal, state.goal);
  BatchSimulator other = simulatorOf(home.world(), optionsOf(1));
  ASSERT_TRUE(other.restoreState(simulator.saveState()));
  EXPECT_EQ(other.envState(0).goal, state.goal);
  const std::vector<float> still(kSmallHomeActions);
  for (BatchSimulator* one : {&simulator, &other}) {
    one->step(still);
    EXPECT_THAT(one->dones(), ElementsAre(0));
    one->step(still);
    EXPECT_THAT(one->endings(), ElementsAre(EpisodeEnd::kTimeOut));
    // The next episode has its own.
    EXPECT_EQ(one->envState(0).goal,
              home.world().episodes().episodes()[one->envState(0).episode].goal);
  }
}

TEST(ChosenStates, PutTheTargetWhereItSucceeds) {
  const SmallHome home;
  BatchSimulator simulator = simulatorOf(home.world(), optionsOf(1));
  EnvState state = simulator.envState(0);
  state.objects[state.target] = state.goal;
  ASSERT_TRUE(isSet(simulator, state));
  std::vector<float> terminates(kSmallHomeActions);
  terminates[kTerminate] = 1;
  simulator.step(terminates);
  EXPECT_THAT(simulator.endings(), ElementsAre(EpisodeEnd::kSuccess));
}

TEST(ChosenStates, HaveTheirTargetsObservedWhereTheyAre) {
  const SmallHome home;
  BatchSimulator simulator = simulatorOf(home.world(), optionsOf(1));
  EnvState state = simulator.envState(0);
  state.objects[state.target].translation.z += 0.2F;
  ASSERT_TRUE(isSet(simulator, state));
  BatchSimulator other = simulatorOf(home.world(), optionsOf(1));
  ASSERT_TRUE(other.restoreState(simulator.saveState()));
  const auto& parts = simulator.observationParts();
  const auto part = std::ranges::find(parts, "grip_target", &ObservationPart::name);
  const std::vector<float> still(kSmallHomeActions);
  for (BatchSimulator* one : {&simulator, &other}) {
    for (int step = 0; step < 3; ++step) {
      const float* seen = one->observations().data() + part->first;
      const EnvState now = one->envState(0);
      const Vec3 way = now.objects[now.target].translation - now.world_from_grip.translation;
      EXPECT_NEAR(dot({seen[0], seen[1], seen[2]}, {seen[0], seen[1], seen[2]}), dot(way, way),
                  1e-5F);
      one->step(still);
      EXPECT_NEAR(one->rewards()[0], other.rewards()[0], 1e-6F);
    }
  }
}

TEST(ChosenStates, PayForThePickOfATargetOnce) {
  const SmallHome home;
  const BatchSimulator from = holding(home.world(), optionsOf(1));
  // Laid down beside its place in the middle of the episode; and so at its beginning.
  EnvState state = from.envState(0);
  state.held = -1;
  state.objects[state.target] =
      home.world()
          .episodes()
          .placements(home.world().episodes().episodes()[state.episode])[state.target]
          .pose;
  state.objects[state.target].translation.z += 0.02F;
  for (const std::uint32_t step : {0U, 40U}) {
    state.step = step;
    BatchSimulator simulator = simulatorOf(home.world(), optionsOf(1));
    ASSERT_TRUE(isSet(simulator, state));
    float earned = 0;
    for (int n = 0; n < 40 && simulator.envState(0).held < 0; ++n) {
      simulator.step(solve(simulator.envState(0)));
      earned = std::max(earned, simulator.rewards()[0]);
    }
    ASSERT_GE(simulator.envState(0).held, 0);
    const float pick = simulator.options().task.pick_reward;
    EXPECT_GT(pick, 1);
    EXPECT_EQ(earned > pick - 1, step == 0) << earned;
  }
}

TEST(ChosenStates, HoldWhatFollowsTheHandAndIsLetGoOf) {
  const SmallHome home;
  const BatchSimulator from = holding(home.world(), optionsOf(1));
  EnvState state = from.envState(0);
  const Pose grip_from_object =
      inverse(state.world_from_grip) * state.objects[static_cast<std::size_t>(state.held)];
  // Higher, and turned: the state's own grip and object stay as they were.
  state.joint_positions[kLift] += 0.15F;
  state.joint_positions[kShoulder] += 0.2F;
  BatchSimulator simulator = simulatorOf(home.world(), optionsOf(1));
  ASSERT_TRUE(isSet(simulator, state));
  const EnvState now = simulator.envState(0);
  EXPECT_NEAR(now.world_from_grip.translation.y, state.world_from_grip.translation.y + 0.15F,
              1e-5F);
  const Pose& object = now.objects[static_cast<std::size_t>(now.held)];
  EXPECT_LT(farthest(object, now.world_from_grip * grip_from_object), kTolerance);
  // It has been picked before: that is not paid for again.
  std::vector<float> actions(kSmallHomeActions);
  actions[kHand] = -1;
  simulator.step(actions);
  EXPECT_EQ(simulator.statistics().drops, 1U);
  EXPECT_EQ(simulator.statistics().grasps, 0U);
}

/// From the grasp point to the box of what a state holds, meters.
double fromHand(const World& world, const EnvState& state) {
  const auto held = static_cast<std::size_t>(state.held);
  const Episode& episode = world.episodes().episodes()[state.episode];
  const OrientedBox& box = world.objectOf(world.episodes().placements(episode)[held]).box;
  const Double3 grip =
      double3(inverse(state.objects[held] * box.pose) * state.world_from_grip.translation);
  const Double3 half = double3(box.half_extents);
  double squared = 0;
  for (std::size_t n = 0; n < 3; ++n) {
    const double beyond = std::max(std::abs(grip[n]) - half[n], 0.0);
    squared += beyond * beyond;
  }
  return std::sqrt(squared);
}

/// The small home with posts in its boxes, which a hand cannot grasp at the edges of these.
WorldFields homeOfPosts() {
  WorldFields fields = smallHomeWorld();
  constexpr float kDiagonal = 0.70710678F;
  for (ObjectFields& object : fields.objects.objects) {
    object.hull_planes.emplace();
    for (const float x : {-kDiagonal, kDiagonal}) {
      for (const float z : {-kDiagonal, kDiagonal}) {
        object.hull_planes->push_back({{x, 0, z}, 0.05F});
      }
    }
  }
  return fields;
}

/// By the wider rule of grasping, their boxes, whatever rule the simulator has.
TEST(ChosenStates, HoldWhatTheHandTouchesAlone) {
  const SmallHome home(homeOfPosts());
  const EnvState state = holding(home.world(), optionsOf(1)).envState(0);
  const auto reach = static_cast<double>(home.world().robot().endEffector()->grasp_radius);
  BatchSimulator simulator = simulatorOf(home.world(), optionsOf(1));
  const std::vector<std::byte> before = simulator.saveState();
  constexpr unsigned kSeed = 20261130;
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<float> away(-0.12F, 0.12F);
  constexpr int kCases = 500;
  int touched = 0;
  int cases = 0;
  while (cases < kCases) {
    EnvState moved = state;
    Pose& object = moved.objects[static_cast<std::size_t>(moved.held)];
    object.translation = object.translation + Vec3{away(random), away(random), away(random)};
    const float half_yaw = 10 * away(random);
    object.rotation = object.rotation * Quat{0, std::sin(half_yaw), 0, std::cos(half_yaw)};
    const double distance = fromHand(home.world(), moved);
    // What a pose's way through floats may cost is allowed.
    constexpr double kUnsure = 0.002;
    if (std::abs(distance - reach) < kUnsure) continue;
    ++cases;
    ASSERT_EQ(isSet(simulator, moved), distance < reach) << distance;
    if (distance < reach) {
      ++touched;
      ASSERT_TRUE(simulator.restoreState(before));
    }
    ASSERT_EQ(simulator.saveState(), before);
  }
  EXPECT_GT(touched, kCases / 10);
  EXPECT_LT(touched, kCases * 9 / 10);
}

TEST(ChosenStates, StayInTheHandForAsLongAsTheyAreHanded) {
  const SmallHome home;
  SimulationOptions options = optionsOf(1);
  options.task.kind = TaskKind::kNone;
  options.task.most_steps = 0;
  BatchSimulator leader = holding(home.world(), options);
  const EnvState first = leader.envState(0);
  BatchSimulator follower = simulatorOf(home.world(), options);
  BatchSimulator other = simulatorOf(home.world(), options);
  ASSERT_TRUE(isSet(follower, first));
  std::mt19937 random(7);
  std::uniform_real_distribution<float> drawn(-1, 1);
  for (int step = 0; step < 300; ++step) {
    std::vector<float> actions(kSmallHomeActions);
    for (float& action : actions) action = drawn(random);
    actions[kHand] = 1;
    actions.back() = -1;
    leader.step(actions);
    const EnvState led = leader.envState(0);
    const FollowedState there{.world_from_root = led.world_from_root,
                              .joint_positions = led.joint_positions,
                              .objects = led.objects,
                              .held = led.held};
    follower.follow(actions, std::span(&there, 1));
    ASSERT_TRUE(isSet(other, follower.envState(0))) << step;
    ASSERT_TRUE(isSet(leader, other.envState(0))) << step;
    ASSERT_EQ(leader.envState(0).held, first.held);
  }
}

TEST(ChosenStates, AreInTheirEpisodesAndCountAsBegun) {
  const SmallHome home;
  SimulationOptions options = optionsOf(2);
  options.order = EpisodeOrder::kLinear;
  BatchSimulator simulator = simulatorOf(home.world(), options);
  const std::vector<EnvState> states = statesOf(simulator);
  ASSERT_NE(states[0].episode, states[1].episode);
  const std::vector<std::uint8_t> were_set =
      simulator.setStates(std::array{1U}, std::array{states[0]}).value();
  EXPECT_THAT(were_set, ElementsAre(1));
  EXPECT_EQ(simulator.envState(1).episode, states[0].episode);
  EXPECT_EQ(simulator.envState(1).begun, states[1].begun + 1);
  expectSameState(simulator.envState(1), states[0]);
  // The other env knows nothing of it.
  EXPECT_EQ(simulator.envState(0).begun, states[0].begun);
  EXPECT_EQ(simulator.statistics().episodes, 0U);
}

TEST(ChosenStates, WithRobotsInWallsOrObjectsOrWithoutAFloorLeaveTheEnvAsItWas) {
  const SmallHome home;
  BatchSimulator simulator = simulatorOf(home.world(), optionsOf(1));
  const EnvState state = simulator.envState(0);
  const std::vector<std::byte> before = simulator.saveState();
  const auto moved = [&](const Vec3& to) {
    EnvState changed = state;
    changed.world_from_root.translation = to;
    return changed;
  };
  const float height = state.world_from_root.translation.y;
  EXPECT_FALSE(isSet(simulator, moved({1.5F, height, 1.5F})));   // In the table.
  EXPECT_FALSE(isSet(simulator, moved({2.98F, height, 1.5F})));  // Half outside.
  EXPECT_FALSE(isSet(simulator, moved({50, height, -50})));
  EXPECT_FALSE(isSet(simulator, moved({0.5F, height + 2, 0.5F})));
  // An object on the base, out of the hand's reach.
  EnvState buried = state;
  buried.objects.back().translation = state.world_from_root.translation;
  EXPECT_FALSE(isSet(simulator, buried));
  EXPECT_EQ(simulator.saveState(), before);
  EXPECT_TRUE(isSet(simulator, moved({0.5F, height + 0.005F, 0.5F})));
  EXPECT_NEAR(simulator.envState(0).world_from_root.translation.y, height, 0.006F);
}

TEST(ChosenStates, WithWhatTheHandHasJustLetGoOfAreTaken) {
  const SmallHome home;
  BatchSimulator from = holding(home.world(), optionsOf(1));
  std::vector<float> actions(kSmallHomeActions);
  actions[kHand] = -1;
  from.step(actions);
  ASSERT_EQ(from.envState(0).held, -1);
  BatchSimulator to = simulatorOf(home.world(), optionsOf(1));
  ASSERT_TRUE(isSet(to, from.envState(0)));
  // And left as it can be: upwards.
  actions[kLift] = 1;
  to.step(actions);
  EXPECT_EQ(to.statistics().refused, 0U);
  EXPECT_GT(to.envState(0).world_from_grip.translation.y,
            from.envState(0).world_from_grip.translation.y + 0.04F);
}

TEST(ChosenStates, KeepJointsWithinTheirLimits) {
  const SmallHome home;
  BatchSimulator simulator = simulatorOf(home.world(), optionsOf(1));
  EnvState state = simulator.envState(0);
  state.joint_positions[kLift] = 5;
  state.joint_positions[kShoulder] += 6.28318531F;
  ASSERT_TRUE(isSet(simulator, state));
  EXPECT_FLOAT_EQ(simulator.envState(0).joint_positions[kLift], 0.8F);
  EXPECT_LT(std::abs(simulator.envState(0).joint_positions[kShoulder]), 3.1416F);
}

TEST(ChosenStates, HaveTheLuckOfTheirEnvOrOfTheirEpisode) {
  const SmallHome home;
  SimulationOptions options = optionsOf(2);
  options.noise.motion = 0.3F;
  BatchSimulator simulator = simulatorOf(home.world(), options);
  const EnvState state = simulator.envState(0);
  std::vector<float> actions(2 * kSmallHomeActions);
  actions[kLift] = actions[kSmallHomeActions + kLift] = 1;
  const auto lifts = [&](EpisodeChoice choice) {
    EXPECT_THAT(simulator.setStates(all(simulator), std::array{state, state}, choice).value(),
                Each(1));
    simulator.step(actions);
    return std::array{simulator.envState(0).joint_positions[kLift],
                      simulator.envState(1).joint_positions[kLift]};
  };
  const auto drawn = lifts(EpisodeChoice::kDrawn);
  EXPECT_NE(drawn[0], drawn[1]);
  const auto named = lifts(EpisodeChoice::kNamed);
  EXPECT_EQ(named[0], named[1]);
}

TEST(ChosenStates, ThatAreNoneOfThisWorldAreRefused) {
  const SmallHome home;
  BatchSimulator simulator = simulatorOf(home.world(), optionsOf(1));
  const EnvState state = simulator.envState(0);
  const auto refused = [&](const auto& change) {
    EnvState changed = state;
    change(changed);
    return refusalOf(simulator, changed);
  };
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(refused([](EnvState& s) { s.episode = 99; }), HasSubstr("is in episode 99"));
  EXPECT_THAT(refused([](EnvState& s) { s.episode = 2; }), HasSubstr("cannot be started"));
  EXPECT_THAT(refused([](EnvState& s) { s.objects.pop_back(); }),
              HasSubstr("states: state 0 has 1 objects, and its episode 2"));
  EXPECT_THAT(refused([](EnvState& s) { s.joint_positions.clear(); }),
              HasSubstr("has 0 joint positions, and the robot 4"));
  EXPECT_THAT(refused([](EnvState& s) { s.step = 121; }),
              HasSubstr("is after 121 steps, and an episode has 120"));
  EXPECT_THAT(refused([](EnvState& s) { s.held = 2; }), HasSubstr("holds object 2 of 2"));
  EXPECT_THAT(refused([](EnvState& s) { s.held = -2; }), HasSubstr("holds object -2"));
  EXPECT_THAT(refused([](EnvState& s) { s.target = 5; }), HasSubstr("has the target 5"));
  for (const auto& number : {&Vec3::x, &Vec3::y, &Vec3::z}) {
    for (const float wrong : {kNan, 1e30F}) {
      EXPECT_THAT(refused([&](EnvState& s) { s.world_from_root.translation.*number = wrong; }),
                  HasSubstr("has world_from_root.translation ("));
      EXPECT_THAT(refused([&](EnvState& s) { s.goal.translation.*number = wrong; }),
                  HasSubstr("has goal.translation ("));
      EXPECT_THAT(refused([&](EnvState& s) { s.objects[1].translation.*number = wrong; }),
                  HasSubstr("has objects[1].translation ("));
    }
  }
  EXPECT_THAT(refused([](EnvState& s) { s.joint_positions[1] = kNan; }),
              HasSubstr("has joint_positions[1] nan, expected a finite number of at most 1e+06"));
  EXPECT_THAT(refused([](EnvState& s) {
                s.objects[0].rotation = {0, 0, 0, 0};
              }),
              HasSubstr("has objects[0].rotation (0, 0, 0, 0), expected a unit quaternion: w, x"));
  EXPECT_THAT(refused([](EnvState& s) {
                s.held = 1;
                s.world_from_grip.translation.y = kNan;
              }),
              HasSubstr("has world_from_grip.translation ("));
  // As (x, y, z, w), where (w, x, y, z) is wanted.
  EXPECT_THAT(refused([](EnvState& s) {
                s.world_from_root.rotation = {1, 0, 0, 0};
              }),
              HasSubstr("has world_from_root.rotation tilted by 3.14 rad, expected at most 0.1"));
  EXPECT_THAT(refused([](EnvState& s) {
                s.world_from_root.rotation = {std::sin(0.055F), 0, 0, std::cos(0.055F)};
              }),
              HasSubstr("tilted by 0.11 rad"));
  EXPECT_THAT([&] { static_cast<void>(simulator.setStates(std::array{7U}, std::array{state})); },
              testing::ThrowsMessage<ErrorException>(HasSubstr("found env 7")));
  EXPECT_THROW(static_cast<void>(simulator.setStates(std::array{0U}, {})), ErrorException);
}

TEST(ChosenStates, HaveTheYawOfRootsThatAreHardlyTilted) {
  const SmallHome home;
  BatchSimulator simulator = simulatorOf(home.world(), optionsOf(1));
  EnvState state = simulator.envState(0);
  const Quat upright = state.world_from_root.rotation;
  state.world_from_root.rotation = upright * Quat{std::sin(0.045F), 0, 0, std::cos(0.045F)};
  ASSERT_TRUE(isSet(simulator, state));
  const Quat now = simulator.envState(0).world_from_root.rotation;
  EXPECT_EQ(now.x, 0);
  EXPECT_EQ(now.z, 0);
  EXPECT_NEAR(std::abs(now.y * upright.y + now.w * upright.w), 1, 1e-3F);
}

TEST(ChosenStates, OfEnvsThatAreNamedTwiceAreRefused) {
  const SmallHome home;
  BatchSimulator simulator = simulatorOf(home.world(), optionsOf(3));
  const std::vector<EnvState> states = statesOf(simulator);
  const std::vector<std::byte> before = simulator.saveState();
  const auto set = simulator.setStates(std::array{2U, 0U, 2U}, states);
  ASSERT_FALSE(set);
  EXPECT_EQ(set.error().text(), "envs: has env 2 twice, expected each once");
  const auto restored = simulator.restoreState(before, std::array{2U, 0U, 2U});
  ASSERT_FALSE(restored);
  EXPECT_EQ(restored.error().text(), set.error().text());
  EXPECT_EQ(simulator.saveState(), before);
  constexpr std::uint32_t kNone = BatchSimulator::kNoEnv;
  EXPECT_TRUE(simulator.restoreState(before, std::array{kNone, 0U, kNone}));
}

TEST(ChosenStates, WithOtherGoalsAreRefusedWhereWaysLeadToThoseOfEpisodes) {
  const SmallHome home;
  SimulationOptions options = optionsOf(1);
  options.sensors.geodesic = true;
  BatchSimulator simulator = simulatorOf(home.world(), options);
  EnvState state = simulator.envState(0);
  EXPECT_TRUE(isSet(simulator, state));
  state.goal.translation.x += 0.1F;
  EXPECT_THAT(refusalOf(simulator, state), HasSubstr("another goal than its episode"));
}

TEST(ChosenStates, EndNoWaitOfOtherEnvs) {
  const SmallHome home;
  SimulationOptions options = optionsOf(2);
  options.auto_reset = false;
  options.task.most_steps = 1;
  BatchSimulator simulator = simulatorOf(home.world(), options);
  const EnvState state = simulator.envState(0);
  simulator.step(std::vector<float>(2 * kSmallHomeActions));
  EXPECT_THAT(simulator.idle(), Each(1));
  ASSERT_TRUE(isSet(simulator, state));
  EXPECT_THAT(simulator.idle(), ElementsAre(0, 1));
  // What the last step returned stays.
  EXPECT_THAT(simulator.endings(), Each(EpisodeEnd::kTimeOut));
  simulator.step(std::vector<float>(2 * kSmallHomeActions));
  EXPECT_THAT(simulator.endings(), ElementsAre(EpisodeEnd::kTimeOut, EpisodeEnd::kNone));
}

}  // namespace
}  // namespace galactic::test::chosen_state_test
