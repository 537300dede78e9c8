// The laser as a part of the observation of a batch.
#include "sensors/laser.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "galactic/batch_simulator.h"
#include "support/homes/box_world.h"

namespace galactic::test::laser_test {
namespace {

using testing::HasSubstr;

/// The side of a cell, and the radius of the sphere that blocks it, meters: a beam may end as much
/// before a wall, and half a cell behind.
constexpr float kEarly = BoxRoom::kSpacing + 0.015F;
constexpr float kLate = BoxRoom::kSpacing / 2;
constexpr float kWest = 0.25F;
constexpr float kEast = 2.75F;

/// Walls at 0.25 m and 2.75 m of a room of 3 m, and a board 50 to 60 cm above the floor at 2 m.
std::vector<Block> walls() {
  return {plainFloor(),
          {{0, 0, 0}, {kWest, 2, 3}},
          {{kEast, 0, 0}, {3, 2, 3}},
          {{0, 0, 0}, {3, 2, 0.25F}},
          {{0, 0, 2.75F}, {3, 2, 3}},
          {{2, 0.5F, 0}, {3, 0.6F, 3}}};
}

/// In the middle, looking along +X; a cube of 20 cm is not on the way of a beam.
Start middle(float turn = 0) { return {{1.5F, 0, 1.5F}, turn, {{1.5F, 1.5F, 1.5F}}}; }

SimulationOptions withLaser(const LaserOptions& laser) {
  SimulationOptions options;
  options.envs = 1;
  options.threads = 1;
  options.sensors.laser = laser;
  return options;
}

BatchSimulator made(const BoxWorld& world, const LaserOptions& laser) {
  return BatchSimulator::create(world.world(), withLaser(laser)).value();
}

/// The scan of an env, in shares of the range.
std::span<const float> scanOf(const BatchSimulator& batch, std::size_t env = 0) {
  const ObservationPart& part = batch.observationParts().back();
  EXPECT_EQ(part.name, "laser");
  return batch.observations().subspan(env * batch.observationSize() + part.first, part.size);
}

void expectNear(float share, float range, float wall) {
  EXPECT_GT(share * range, wall - kEarly);
  EXPECT_LT(share * range, wall + kLate);
}

std::string faultOf(const BoxWorld& world, const LaserOptions& laser) {
  const auto batch = BatchSimulator::create(world.world(), withLaser(laser));
  return batch ? "none" : batch.error().text();
}

TEST(Laser, IsOffUnlessAskedFor) {
  const BoxWorld world(walls(), {middle()});
  const BatchSimulator without = made(world, {});
  const BatchSimulator with = made(world, {.beams = 5});
  EXPECT_EQ(without.observationParts().back().name, "time");
  EXPECT_EQ(with.observationSize(), without.observationSize() + 5);
  EXPECT_TRUE(std::ranges::equal(without.observations(),
                                 with.observations().first(without.observationSize())));
}

TEST(Laser, TellsBeamsFromTheRightToTheLeft) {
  // Nearer to the right wall, which is at large z.
  const BoxWorld world(walls(), {{{1.5F, 0, 2}, 0, {{1.5F, 1.5F, 1.5F}}}});
  const BatchSimulator batch = made(world, {.beams = 3, .fov_degrees = 180, .range = 2});
  const std::span<const float> scan = scanOf(batch);
  ASSERT_EQ(scan.size(), 3U);
  expectNear(scan[0], 2, 0.75F);
  expectNear(scan[1], 2, 1.25F);
  expectNear(scan[2], 2, 1.75F);
}

TEST(Laser, SpreadsItsBeamsEvenlyOverAWholeTurn) {
  const BoxWorld world(walls(), {{{1, 0, 1.5F}, 0, {{1.5F, 1.5F, 1.5F}}}});
  const BatchSimulator batch = made(world, {.beams = 4, .range = 3});
  const std::span<const float> scan = scanOf(batch);
  expectNear(scan[0], 3, 0.75F);  // behind
  expectNear(scan[1], 3, 1.25F);
  expectNear(scan[2], 3, 1.75F);  // ahead
  expectNear(scan[3], 3, 1.25F);
}

TEST(Laser, TurnsWithTheBase) {
  // Left of +X is -Z.
  const BoxWorld world(walls(), {{{1, 0, 1}, 1.5707963F, {{1.5F, 1.5F, 1.5F}}}});
  const BatchSimulator batch = made(world, {.beams = 3, .fov_degrees = 180, .range = 2});
  const std::span<const float> scan = scanOf(batch);
  expectNear(scan[0], 2, 1.75F);
  expectNear(scan[1], 2, 0.75F);
  expectNear(scan[2], 2, 0.75F);
}

/// A single height.
Span at(float height) { return {height, height}; }

TEST(Laser, LooksAtOneHeightAfterTheOther) {
  const BoxWorld world(walls(), {{{1, 0, 1.5F}, 0, {{1.5F, 1.5F, 1.5F}}}});
  const BatchSimulator batch =
      made(world, {.beams = 1, .heights = {at(0.25F), at(0.55F), at(0.25F)}, .range = 3});
  const std::span<const float> scan = scanOf(batch);
  ASSERT_EQ(scan.size(), 3U);
  expectNear(scan[0], 3, 1.75F);
  expectNear(scan[1], 3, 1);
  EXPECT_EQ(scan[2], scan[0]);
}

TEST(Laser, SeesWhatIsSomewhereInARangeOfHeights) {
  const BoxWorld world(walls(), {{{1, 0, 1.5F}, 0, {{1.5F, 1.5F, 1.5F}}}});
  const BatchSimulator batch = made(
      world, {.beams = 1, .heights = {{0.1F, 0.45F}, {0.1F, 0.9F}, {0.65F, 0.9F}}, .range = 3});
  const std::span<const float> scan = scanOf(batch);
  expectNear(scan[0], 3, 1.75F);  // under the board
  expectNear(scan[1], 3, 1);
  expectNear(scan[2], 3, 1.75F);  // above it
}

TEST(Laser, SeesObjectsThatAreSomewhereInARangeOfHeights) {
  // A cube of 20 cm whose face is 60 cm ahead, 20 to 40 cm above the floor.
  Start start = middle();
  start.objects = {{2.2F, 0.2F, 1.5F}};
  const BoxWorld world(walls(), {start});
  const BatchSimulator batch =
      made(world, {.beams = 1,
                   .heights = {{0.05F, 0.21F}, {0.05F, 0.9F}, {0.39F, 0.45F}, {0.41F, 0.45F}},
                   .range = 2});
  const std::span<const float> scan = scanOf(batch);
  EXPECT_NEAR(scan[0] * 2, 0.6F, 1e-5F);
  EXPECT_NEAR(scan[2] * 2, 0.6F, 1e-5F);
  EXPECT_GT(scan[3] * 2, 1);
  // The board is nearer.
  expectNear(scan[1], 2, 0.5F);
}

TEST(Laser, KeepsBetweenItsRanges) {
  const BoxWorld world(walls(), {middle()});
  const BatchSimulator batch = made(world, {.beams = 8, .range = 0.5F});
  for (const float share : scanOf(batch)) EXPECT_EQ(share, 1);
  const BatchSimulator far = made(world, {.beams = 1, .range = 4, .least_range = 3});
  EXPECT_EQ(scanOf(far)[0], 0.75F);
}

TEST(Laser, SeesWhatRestsAndNotWhatIsHeld) {
  RobotPackFields robot = cartRobot();
  robot.end_effector->grasp_radius = 0.12F;
  // A cube in reach of the hand, which is drawn in: its face is 60 cm ahead.
  Start start = middle();
  start.objects = {{2.2F, 0.2F, 1.5F}};
  const BoxWorld world(walls(), robot, episodesFrom({start}));
  SimulationOptions options = withLaser({.beams = 1, .range = 2});
  options.task.kind = TaskKind::kNone;
  BatchSimulator batch = BatchSimulator::create(world.world(), options).value();
  EXPECT_NEAR(scanOf(batch)[0] * 2, 0.6F, 1e-5F);
  std::vector<float> actions(kCartActions, 0);
  actions[0] = 1;                // the arm
  actions[kCartJoints + 2] = 1;  // the hand
  for (int step = 0; step < 4 && batch.envState(0).held < 0; ++step) batch.step(actions);
  const EnvState after = batch.envState(0);
  ASSERT_EQ(after.held, 0);
  // It was pushed clear of the cube.
  expectNear(scanOf(batch)[0], 2, kEast - after.world_from_root.translation.x);
}

TEST(Laser, SitsWhereTheRecipeSays) {
  RobotPackFields robot = cartRobot();
  robot.base->root_height = 0;
  // 25 cm ahead, 55 cm high, turned to the left by a right angle.
  const float half = std::sqrt(0.5F);
  robot.laser = LaserFields{.link = 0,
                            .link_from_laser = Pose{{0.25F, 0.55F, 0}, {0, half, 0, half}},
                            .field_of_view = 3.1415927F,
                            .least_range = 0,
                            .range = 4,
                            .noise = 0};
  const BoxWorld world(walls(), robot, episodesFrom({{{1.5F, 0, 2}, 0, {{1.5F, 1.5F, 1.5F}}}}));
  const BatchSimulator batch = made(world, {.beams = 3});
  const std::span<const float> scan = scanOf(batch);
  expectNear(scan[0], 4, 0.25F);  // ahead: the board
  expectNear(scan[1], 4, 1.75F);  // to the left
  expectNear(scan[2], 4, 1.5F);   // behind
  // Options count before it.
  const BatchSimulator lower = made(world, {.beams = 3, .heights = {at(0.25F)}, .range = 2});
  expectNear(scanOf(lower)[0], 2, 1);
}

TEST(Laser, MustNotBeCarriedByAnArm) {
  RobotPackFields robot = cartRobot();
  robot.laser = LaserFields{.link = 1};
  const BoxWorld world(walls(), robot, episodesFrom({middle()}));
  EXPECT_EQ(
      faultOf(world, {.beams = 3}),
      "robot cart, link arm: carries the laser, and an action or an episode moves it; a planar "
      "laser must be fixed to the base");
  EXPECT_EQ(faultOf(world, {}), "none");
}

TEST(Laser, IsRefusedWhereItSeesNothing) {
  const BoxWorld world(walls(), {middle()});
  EXPECT_THAT(
      faultOf(world, {.beams = 3, .heights = {at(0.25F), {4, 5}}}),
      HasSubstr(
          "scans scene kitchen 4-5 m above the floor at 0.000 m, where nothing is free (its grids "
          "reach from -0.5 to 3 m); give other laser-heights"));
  EXPECT_THAT(faultOf(world, {.beams = 3, .range = 1, .least_range = 1}),
              HasSubstr("laser-range is 1 m and laser-min-range 1 m, expected a range above"));
}

TEST(Laser, LooksFromTheFloorOnWhichTheRobotStands) {
  // A platform 40 cm high, from which the board is at a height of 10 to 20 cm.
  std::vector<Block> blocks = walls();
  blocks.push_back({{0, 0, 0}, {1.25F, 0.4F, 3}});
  const BoxWorld world(blocks, {{{1.75F, 0, 1.5F}, 0, {{1.5F, 1.5F, 1.5F}}},
                                {{0.75F, 0.4F, 1.5F}, 0, {{1.5F, 1.5F, 1.5F}}}});
  SimulationOptions options = withLaser({.beams = 1, .heights = {at(0.15F)}, .range = 3});
  options.envs = 2;
  options.order = EpisodeOrder::kLinear;
  const BatchSimulator batch = BatchSimulator::create(world.world(), options).value();
  expectNear(scanOf(batch, 0)[0], 3, 1);
  expectNear(scanOf(batch, 1)[0], 3, 1.25F);
}

TEST(Laser, TakesFloorsForOneOnlyWithinABandOfTheLowest) {
  // Steps of 9 cm: the third is two of them above the first, and has a plane of its own, in which
  // the board is.
  std::vector<Block> blocks = walls();
  blocks.push_back({{0, 0, 1}, {1.25F, 0.09F, 3}});
  blocks.push_back({{0, 0, 2}, {1.25F, 0.18F, 3}});
  const std::vector<Vec3> none{{1.5F, 1.5F, 1.5F}};
  const BoxWorld world(blocks, {{{0.75F, 0, 0.6F}, 0, none},
                                {{0.75F, 0.09F, 1.5F}, 0, none},
                                {{0.75F, 0.18F, 2.4F}, 0, none}});
  SimulationOptions options = withLaser({.beams = 1, .heights = {at(0.33F)}, .range = 3});
  options.envs = 3;
  options.order = EpisodeOrder::kLinear;
  const BatchSimulator batch = BatchSimulator::create(world.world(), options).value();
  expectNear(scanOf(batch, 0)[0], 3, 2);
  expectNear(scanOf(batch, 1)[0], 3, 2);
  expectNear(scanOf(batch, 2)[0], 3, 1.25F);
}

TEST(Laser, HasNoiseOfTheGivenDeviation) {
  const BoxWorld world(walls(), {middle()});
  constexpr float kNoise = 0.02F;
  SimulationOptions options = withLaser({.beams = 64, .range = 3});
  options.envs = 64;
  const BatchSimulator still = BatchSimulator::create(world.world(), options).value();
  options.sensors.laser.noise = kNoise;
  BatchSimulator noisy = BatchSimulator::create(world.world(), options).value();
  const std::vector<float> actions(64 * kCartActions, 0);
  double sum = 0;
  double squares = 0;
  int count = 0;
  int beyond_one = 0;
  for (int step = 0; step < 4; ++step) {
    for (std::size_t env = 0; env < 64; ++env) {
      for (std::size_t n = 0; n < 64; ++n) {
        const double error =
            3.0 * static_cast<double>(scanOf(noisy, env)[n] - scanOf(still, env)[n]);
        sum += error;
        squares += error * error;
        beyond_one += std::abs(error) > static_cast<double>(kNoise) ? 1 : 0;
        ++count;
      }
    }
    noisy.step(actions);
  }
  // 16384 numbers: their mean has a deviation of 1/128 of one's.
  EXPECT_NEAR(sum / count, 0, 5 * static_cast<double>(kNoise) / 128);
  EXPECT_NEAR(std::sqrt(squares / count), static_cast<double>(kNoise),
              0.05 * static_cast<double>(kNoise));
  // A normal distribution has 31.7 % beyond one deviation.
  EXPECT_NEAR(static_cast<double>(beyond_one) / count, 0.317, 0.04);
}

TEST(Laser, HasNoNoiseWhereNothingReturns) {
  const BoxWorld world(walls(), {middle()});
  // The nearest wall is 1.25 m away.
  SimulationOptions options = withLaser({.beams = 64, .range = 1, .noise = 0.05F});
  const BatchSimulator batch = BatchSimulator::create(world.world(), options).value();
  for (const float share : scanOf(batch)) EXPECT_EQ(share, 1);
}

TEST(Laser, HasNoiseOfTheDeviationThatAnEpisodeHasDrawn) {
  const BoxWorld world(walls(), {middle()});
  SimulationOptions options = withLaser({.beams = 64, .range = 3});
  options.envs = 256;
  const BatchSimulator still = BatchSimulator::create(world.world(), options).value();
  options.sensors.laser.noise = {0.005F, 0.05F};
  const BatchSimulator noisy = BatchSimulator::create(world.world(), options).value();
  double squares = 0;
  int in_lower_half = 0;
  for (std::size_t env = 0; env < 256; ++env) {
    const auto drawn = static_cast<double>(noisy.episodeNoise(env).laser);
    ASSERT_GE(drawn, 0.005);
    ASSERT_LE(drawn, 0.05);
    in_lower_half += drawn < 0.0275 ? 1 : 0;
    for (std::size_t n = 0; n < 64; ++n) {
      const double error =
          3.0 * static_cast<double>(scanOf(noisy, env)[n] - scanOf(still, env)[n]) / drawn;
      squares += error * error;
    }
  }
  // Of each env, by what it has drawn.
  EXPECT_NEAR(std::sqrt(squares / (256 * 64)), 1, 0.05);
  // Half of 256, within four deviations.
  EXPECT_NEAR(in_lower_half, 128, 32);
  EXPECT_EQ(still.episodeNoise(0).laser, 0);
}

TEST(Laser, HasTheSameNoiseInAnyEnvWhereAnEpisodeIsNamed) {
  const BoxWorld world(walls(), {middle(), middle()});
  SimulationOptions options = withLaser({.beams = 21, .noise = {0.01F, 0.03F}});
  options.envs = 9;
  BatchSimulator batch = BatchSimulator::create(world.world(), options).value();
  const auto scans = [&] {
    std::set<std::vector<float>> found;
    for (std::size_t env = 0; env < 9; ++env) {
      const std::span<const float> scan = scanOf(batch, env);
      found.emplace(scan.begin(), scan.end());
    }
    return found;
  };
  EXPECT_EQ(scans().size(), 9U);
  // The second that each env begins.
  batch.reset(std::vector<std::int32_t>(9, BatchSimulator::kNextEpisode));
  batch.reset(std::vector<std::int32_t>{1, 0, 1, 0, 1, 0, 1, 0, 1});
  EXPECT_EQ(scans().size(), 2U);
  const std::vector<float> actions(9 * kCartActions, 0);
  batch.step(actions);
  EXPECT_EQ(scans().size(), 2U);
  batch.reset(std::vector<std::int32_t>(9, 1), EpisodeChoice::kDrawn);
  EXPECT_EQ(scans().size(), 9U);
}

TEST(Laser, DependsOnTheEnvAlone) {
  const BoxWorld world(walls(), {middle(), middle(1), middle(2)});
  SimulationOptions options =
      withLaser({.beams = 21, .heights = {at(0.25F), at(0.8F)}, .noise = 0.01F});
  options.envs = 70;
  options.task.most_steps = 5;
  const auto scansOf = [&](std::uint32_t threads, std::uint32_t envs, std::uint32_t rank) {
    SimulationOptions some = options;
    some.threads = threads;
    some.envs = envs;
    some.ranks = 70 / envs;
    some.rank = rank;
    BatchSimulator batch = BatchSimulator::create(world.world(), some).value();
    std::vector<float> actions(envs * kCartActions, 0.5F);
    std::vector<float> scans;
    for (int step = 0; step < 12; ++step) {
      batch.step(actions);
      const std::span<const float> scan = scanOf(batch, envs - 1);
      scans.insert(scans.end(), scan.begin(), scan.end());
      const std::span<const float> last = batch.finalObservations();
      if (batch.dones()[envs - 1] != 0) {
        scans.insert(scans.end(), last.end() - 42, last.end());
      }
    }
    return scans;
  };
  const std::vector<float> wanted = scansOf(1, 70, 0);
  EXPECT_GT(wanted.size(), 12U * 42U);
  EXPECT_EQ(scansOf(3, 70, 0), wanted);
  EXPECT_EQ(scansOf(1, 1, 69), wanted);
  EXPECT_EQ(scansOf(2, 35, 1), wanted);
}

}  // namespace
}  // namespace galactic::test::laser_test
