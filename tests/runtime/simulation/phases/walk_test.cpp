// Moves that are looked at on their way: SimulationOptions::continuous_collision.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numbers>
#include <random>
#include <vector>

#include "galactic/batch_simulator.h"
#include "support/homes/box_world.h"
#include "support/packs/grid_builder.h"

namespace galactic::test::walk_test {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kArmStep = 0.3F;
constexpr std::array<float, 3> kRadii{0.12F, 0.05F, 0.015F};

SimulationOptions optionsOf(std::uint32_t envs, bool continuous) {
  SimulationOptions options;
  options.envs = envs;
  options.threads = 1;
  options.order = EpisodeOrder::kLinear;
  options.task.kind = TaskKind::kNone;
  options.task.most_steps = 0;
  options.continuous_collision = continuous;
  return options;
}

BatchSimulator simulatorOf(const BoxWorld& world, std::uint32_t envs, bool continuous,
                           std::uint32_t threads = 1) {
  SimulationOptions options = optionsOf(envs, continuous);
  options.threads = threads;
  return BatchSimulator::create(world.world(), options).value();
}

/// The middles of a cart's ball, of the one at its arm's end, and of the one on its wrist.
std::array<Vec3, 3> ballsOf(const EnvState& state) {
  const Pose& root = state.world_from_root;
  const float arm = state.joint_positions[0];
  const float wrist = state.joint_positions[1];
  return {root * Vec3{0, 0.3F, 0}, root * Vec3{arm, 0.3F, 0},
          root * Vec3{arm - 0.03F * std::cos(wrist), 0.3F, 0.03F * std::sin(wrist)}};
}

TEST(Walk, StopsAnArmBeforeAThinPlateThatOthersReachThrough) {
  // Shorter than a step of the arm away, and 1 cm thick.
  const float plate = 1.2F;
  const BoxWorld world({plainFloor(), {{plate, 0.2F, 1}, {plate + 0.01F, 0.4F, 2}}},
                       {{.base = {1, 0, 1.5F}, .objects = {{0.25F, 2.5F, 0.25F}}}});
  for (const bool continuous : {false, true}) {
    BatchSimulator simulator = simulatorOf(world, 1, continuous);
    const std::array<float, kCartActions> reach{1, 0, 0, 0, 0, 0};
    simulator.step(reach);
    const EnvState state = simulator.envState(0);
    const float tip = ballsOf(state)[1].x + kRadii[1];
    if (continuous) {
      // Contact is judged by columns.
      EXPECT_LE(tip, plate + 0.5F * BoxRoom::kSpacing);
      EXPECT_GT(tip, 1.12F);
      EXPECT_EQ(simulator.statistics().slid, 1U);
    } else {
      EXPECT_FLOAT_EQ(state.joint_positions[0], kArmStep);
      EXPECT_GT(tip, plate + 0.05F);
    }
    EXPECT_EQ(simulator.statistics().refused, 0U);
  }
}

/// Upright plates of 5 mm, and carts among them.
struct PlateRoom {
  std::vector<Block> blocks{plainFloor()};
  std::vector<Start> starts;

  PlateRoom(std::mt19937& random, std::size_t carts) {
    constexpr float kThick = 0.005F;
    for (int n = 0; n < 8; ++n) {
      const float x = uniformIn(random, 0.2F, 2.3F);
      const float z = uniformIn(random, 0.2F, 2.3F);
      const float length = uniformIn(random, 0.2F, 0.6F);
      const bool along_x = n % 2 == 0;
      blocks.push_back(
          {{x, 0.1F, z}, {x + (along_x ? length : kThick), 0.5F, z + (along_x ? kThick : length)}});
    }
    for (std::size_t n = 0; n < carts; ++n) {
      starts.push_back({.base = {uniformIn(random, 0.3F, 2.7F), 0, uniformIn(random, 0.3F, 2.7F)},
                        .yaw = uniformIn(random, -kPi, kPi),
                        .objects = {{0.25F, 2.5F, 0.25F}}});
    }
  }

  /// Whether the straight way from one point to the other crosses a plate.
  [[nodiscard]] bool isBetween(const Vec3& from, const Vec3& to) const {
    return std::any_of(blocks.begin() + 1, blocks.end(), [&](const Block& block) {
      float enters = 0;
      float leaves = 1;
      const auto clip = [&](float least, float most, float a, float b) {
        if (a == b) {
          if (a < least || a > most) leaves = -1;
          return;
        }
        const float first = (least - a) / (b - a);
        const float second = (most - a) / (b - a);
        enters = std::max(enters, std::min(first, second));
        leaves = std::min(leaves, std::max(first, second));
      };
      clip(block.min.x, block.max.x, from.x, to.x);
      clip(block.min.z, block.max.z, from.z, to.z);
      return enters <= leaves;
    });
  }
};

/// Drives, turns and reaches at random.
std::vector<float> randomMoves(std::mt19937& random, std::size_t carts) {
  std::vector<float> actions(carts * kCartActions);
  for (std::size_t n = 0; n < carts; ++n) {
    for (std::size_t a = 0; a < 4; ++a) {
      actions[n * kCartActions + a] = uniformIn(random, -1, 1);
    }
  }
  return actions;
}

/// Whether the base is where its drive alone leads.
bool hasSlid(const EnvState& before, const EnvState& after) {
  const Vec3 way = after.world_from_root.translation - before.world_from_root.translation;
  const Vec3 ahead = rotate(after.world_from_root.rotation, {1, 0, 0});
  return std::fabs(way.x * ahead.z - way.z * ahead.x) > 1e-4F;
}

struct Crossings {
  std::size_t looked_at = 0;
  std::size_t crossed = 0;
  std::uint64_t refused = 0;
};

Crossings crossingsIn(const PlateRoom& room, bool continuous, std::uint32_t seed) {
  const BoxWorld world(room.blocks, room.starts);
  const std::size_t carts = room.starts.size();
  BatchSimulator simulator = simulatorOf(world, static_cast<std::uint32_t>(carts), continuous);
  std::mt19937 random(seed);
  Crossings result;
  for (int step = 0; step < 40; ++step) {
    std::vector<EnvState> before;
    for (std::size_t n = 0; n < carts; ++n) before.push_back(simulator.envState(n));
    simulator.step(randomMoves(random, carts));
    for (std::size_t n = 0; n < carts; ++n) {
      const EnvState after = simulator.envState(n);
      if (hasSlid(before[n], after)) continue;
      const std::array<Vec3, 3> from = ballsOf(before[n]);
      const std::array<Vec3, 3> to = ballsOf(after);
      for (std::size_t ball = 0; ball < 2; ++ball) {
        ++result.looked_at;
        result.crossed += room.isBetween(from[ball], to[ball]) ? 1U : 0U;
      }
    }
  }
  result.refused = simulator.statistics().refused;
  return result;
}

TEST(Walk, PassesThroughNoPlate) {
  constexpr std::uint32_t kSeed = 1801;
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  Crossings jumps;
  Crossings walks;
  for (std::uint32_t round = 0; round < 10; ++round) {
    const PlateRoom room(random, 32);
    for (const bool continuous : {false, true}) {
      const Crossings found = crossingsIn(room, continuous, kSeed + round);
      Crossings& sum = continuous ? walks : jumps;
      sum.looked_at += found.looked_at;
      sum.crossed += found.crossed;
      sum.refused += found.refused;
    }
  }
  std::printf(
      "ends alone: %zu of %zu cross a plate, %llu refused; the way, too: %zu of %zu, %llu\n",
      jumps.crossed, jumps.looked_at, static_cast<unsigned long long>(jumps.refused), walks.crossed,
      walks.looked_at, static_cast<unsigned long long>(walks.refused));
  EXPECT_GT(jumps.crossed, 100U);
  EXPECT_GT(walks.looked_at, 10000U);
  EXPECT_EQ(walks.crossed, 0U);
}

/// A cart whose arm reaches out, before a wall from which the rule of the published code pushes it
/// back by `slide` at once.
struct BeforeWall {
  float arm = 0;
  float wall = 0;
  float slide = 0;
  std::vector<Block> others{};
  Vec3 cube;
};

constexpr Vec3 kBeforeWall{1.5F, 0, 1.5F};

/// How far the cart is from where it began.
float slidBy(const EnvState& state) {
  const Vec3 way = state.world_from_root.translation - kBeforeWall;
  return std::hypot(way.x, way.z);
}

/// Where the cart is after it has reached out further, `grasps` or not.
EnvState reachingAtWall(const BeforeWall& place, bool grasps) {
  RobotPackFields robot = cartRobot();
  robot.start_positions = {place.arm, 0};
  std::vector<Block> blocks{plainFloor(), {{place.wall, 0, 0}, {place.wall + 0.1F, 1, 3}}};
  blocks.insert(blocks.end(), place.others.begin(), place.others.end());
  const BoxWorld world(blocks, robot,
                       episodesFrom({{.base = kBeforeWall, .objects = {place.cube}}}));
  SimulationOptions options = optionsOf(1, true);
  options.slide = {.attempts = 1, .direction = SlideDirection::kTowardsBase, .step = place.slide};
  BatchSimulator simulator = BatchSimulator::create(world.world(), options).value();
  const float hand = grasps ? 1.0F : 0.0F;
  simulator.step(std::array<float, kCartActions>{0, 0, 0, 0, hand, 0});
  simulator.step(std::array<float, kCartActions>{1, 0, 0, 0, hand, 0});
  const EnvState state = simulator.envState(0);
  EXPECT_EQ(state.held, grasps ? 0 : -1);
  return state;
}

TEST(Walk, SlidesThroughNoRestingObject) {
  // Between the cart's ball and those of its arm, and out of the way.
  BeforeWall place{.arm = 0.55F, .wall = 2.12F, .slide = 0.48F, .cube = {1.8F, 0.2F, 1.5F}};
  const EnvState stopped = reachingAtWall(place, false);
  EXPECT_EQ(slidBy(stopped), 0);
  EXPECT_GE(stopped.joint_positions[0], place.arm);
  place.cube.z = 2.5F;
  EXPECT_NEAR(slidBy(reachingAtWall(place, false)), place.slide, 1e-3F);
}

TEST(Walk, SlidesThroughNothingWithWhatItHolds) {
  // Under the plate is room for the robot, but not for the cube in its hand.
  const Block plate{{1.8F, 0.445F, 1.2F}, {1.81F, 0.6F, 1.8F}};
  BeforeWall place{
      .arm = 0.5F, .wall = 2.36F, .slide = 0.7F, .others = {plate}, .cube = {2.2F, 0.28F, 1.5F}};
  const EnvState stopped = reachingAtWall(place, true);
  EXPECT_EQ(slidBy(stopped), 0);
  EXPECT_GE(stopped.joint_positions[0], place.arm);
  place.others.clear();
  EXPECT_NEAR(slidBy(reachingAtWall(place, true)), place.slide, 1e-3F);
}

TEST(Walk, IsTheSameToTheBitWhereNothingIsInTheWay) {
  std::mt19937 random(1802);
  std::vector<Start> starts;
  for (int n = 0; n < 20; ++n) {
    starts.push_back({.base = {1.5F, 0, 1.5F},
                      .yaw = uniformIn(random, -kPi, kPi),
                      .objects = {{0.25F, 2.5F, 0.25F}}});
  }
  const BoxWorld world({plainFloor()}, starts);
  BatchSimulator jumps = simulatorOf(world, 20, false);
  BatchSimulator walks = simulatorOf(world, 20, true);
  for (int step = 0; step < 4; ++step) {
    const std::vector<float> actions = randomMoves(random, 20);
    jumps.step(actions);
    walks.step(actions);
  }
  EXPECT_EQ(walks.statistics().slid + walks.statistics().refused, 0U);
  for (std::size_t n = 0; n < 20; ++n) {
    EXPECT_EQ(jumps.envState(n).world_from_root, walks.envState(n).world_from_root);
    EXPECT_EQ(jumps.envState(n).world_from_grip, walks.envState(n).world_from_grip);
    EXPECT_EQ(jumps.envState(n).joint_positions, walks.envState(n).joint_positions);
  }
}

TEST(Walk, ClimbsNoFurtherThanAStepMay) {
  // From x = 1 on, each 4 cm are 4 cm higher.
  std::vector<Block> blocks{plainFloor()};
  for (int n = 0; n < 20; ++n) {
    const float from = 1 + 0.04F * static_cast<float>(n);
    blocks.push_back({{from, 0, 0}, {3, 0.04F * static_cast<float>(n + 1), 3}});
  }
  // High above the base, so that only the floor counts.
  RobotPackFields robot = cartRobot();
  for (auto& sphere : robot.spheres) sphere.center.y = 1.1F;
  const BoxWorld world(blocks, robot,
                       episodesFrom({{.base = {0.6F, 0, 1.5F}, .objects = {{0.3F, 0.2F, 2.6F}}}}));
  BatchSimulator simulator = simulatorOf(world, 1, true);
  const std::array<float, kCartActions> ahead{0, 0, 1, 0, 0, 0};
  float height = 0;
  for (int step = 0; step < 20; ++step) {
    simulator.step(ahead);
    const float now = simulator.envState(0).world_from_root.translation.y;
    EXPECT_LE(now - height, GroundOptions{}.most_rise + 1e-4F) << "step " << step;
    height = now;
  }
  EXPECT_GT(height, 0.2F);
}

TEST(Walk, TurnsAJointWithoutLimitsTheShortWay) {
  std::mt19937 random(77);
  constexpr std::uint32_t kCarts = 48;
  const PlateRoom room(random, kCarts);
  const BoxWorld world(room.blocks, room.starts);
  BatchSimulator simulator = simulatorOf(world, kCarts, true);
  constexpr float kWristStep = 0.25F;
  const auto wrist = [&](std::size_t cart) { return simulator.envState(cart).joint_positions[1]; };
  std::array<float, kCarts> before{};
  int hindered = 0;
  int crossings = 0;
  for (int step = 0; step < 80; ++step) {
    std::vector<float> actions;
    for (std::uint32_t cart = 0; cart < kCarts; ++cart) {
      actions.insert(actions.end(), {uniformIn(random, -1, 1), 1, uniformIn(random, 0, 1),
                                     uniformIn(random, -1, 1), 0, 0});
    }
    simulator.step(actions);
    for (std::size_t cart = 0; cart < kCarts; ++cart) {
      const float turned = std::remainder(wrist(cart) - before[cart], 2 * kPi);
      EXPECT_GE(turned, -1e-5F) << "cart " << cart << ", step " << step;
      EXPECT_LE(turned, kWristStep + 1e-5F) << "cart " << cart << ", step " << step;
      const bool crosses = wrist(cart) < before[cart] - kPi;
      crossings += crosses ? 1 : 0;
      hindered += crosses && turned < kWristStep - 1e-3F ? 1 : 0;
      before[cart] = wrist(cart);
    }
  }
  EXPECT_GT(crossings, 20);
  EXPECT_GT(hindered, 0) << "nothing was in the way of a joint that came to the end of its turn";
}

TEST(Walk, DoesNotDependOnThreadsNorOnOtherEnvs) {
  std::mt19937 random(1803);
  const PlateRoom room(random, 40);
  const BoxWorld world(room.blocks, room.starts);
  BatchSimulator one = simulatorOf(world, 40, true);
  BatchSimulator three = simulatorOf(world, 40, true, 3);
  BatchSimulator few = simulatorOf(world, 7, true);
  for (int step = 0; step < 30; ++step) {
    const std::vector<float> actions = randomMoves(random, 40);
    one.step(actions);
    three.step(actions);
    few.step(std::span(actions).first(7 * kCartActions));
  }
  EXPECT_GT(one.statistics().slid, 10U);
  for (std::size_t n = 0; n < 40; ++n) {
    const EnvState state = one.envState(n);
    EXPECT_EQ(state.world_from_root, three.envState(n).world_from_root);
    EXPECT_EQ(state.joint_positions, three.envState(n).joint_positions);
    if (n >= 7) continue;
    EXPECT_EQ(state.world_from_root, few.envState(n).world_from_root);
    EXPECT_EQ(state.joint_positions, few.envState(n).joint_positions);
  }
}

}  // namespace
}  // namespace galactic::test::walk_test
