// How robots glide along what blocks them: properties over random rooms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>
#include <vector>

#include "galactic/batch_simulator.h"
#include "support/homes/box_world.h"
#include "support/packs/grid_builder.h"
#include "support/sanitized.h"

namespace galactic::test::glide_test {
namespace {

constexpr float kSize = BoxRoom::kSize;
constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kRounding = 1e-4F;

struct Room {
  std::vector<Block> blocks;
  std::vector<Start> starts;
};

/// Furniture, and carts that start close to it more often than not.
Room furnishedRoom(std::mt19937& random, std::size_t carts) {
  Room room;
  room.blocks = {plainFloor(),
                 {{0, 0, 0}, {0.1F, 1, kSize}},
                 {{kSize - 0.1F, 0, 0}, {kSize, 1, kSize}},
                 {{0, 0, 0}, {kSize, 1, 0.1F}},
                 {{0, 0, kSize - 0.1F}, {kSize, 1, kSize}}};
  for (int n = 0; n < 6; ++n) {
    const float x = uniformIn(random, 0, 2.5F);
    const float z = uniformIn(random, 0, 2.5F);
    room.blocks.push_back({{x, 0, z},
                           {x + uniformIn(random, 0.05F, 0.6F), uniformIn(random, 0.3F, 0.8F),
                            z + uniformIn(random, 0.05F, 0.6F)}});
  }
  for (std::size_t n = 0; n < carts; ++n) {
    room.starts.push_back(
        {.base = {uniformIn(random, 0.3F, 2.7F), 0, uniformIn(random, 0.3F, 2.7F)},
         .yaw = uniformIn(random, -kPi, kPi),
         .objects = {{0.25F, 2.5F, 0.25F}}});
  }
  return room;
}

/// Left and right exchanged: what is at z comes to kSize - z.
Room mirrored(const Room& room) {
  Room image = room;
  for (Block& block : image.blocks) {
    const float lo = block.min.z;
    block.min.z = kSize - block.max.z;
    block.max.z = kSize - lo;
  }
  for (Start& start : image.starts) {
    start.base.z = kSize - start.base.z;
    start.yaw = -start.yaw;
  }
  return image;
}

BatchSimulator simulatorOf(const BoxWorld& world, std::size_t envs) {
  SimulationOptions options;
  options.envs = static_cast<std::uint32_t>(envs);
  options.threads = 1;
  options.order = EpisodeOrder::kLinear;
  options.task.kind = TaskKind::kNone;
  options.task.most_steps = 0;
  return BatchSimulator::create(world.world(), options).value();
}

struct Moves {
  std::vector<float> actions;

  /// Carts drive, and if `all` also turn and reach.
  Moves(std::mt19937& random, std::size_t carts, bool all) : actions(carts * kCartActions) {
    for (std::size_t n = 0; n < carts; ++n) {
      float* row = actions.data() + n * kCartActions;
      row[0] = all ? uniformIn(random, -1, 1) : 0;
      row[1] = all ? uniformIn(random, -1, 1) : 0;
      row[2] = uniformIn(random, 0, 1);
      row[3] = all ? uniformIn(random, -1, 1) : 0;
    }
  }
  [[nodiscard]] Moves mirror() const {
    Moves image = *this;
    for (std::size_t n = 0; n < actions.size(); n += kCartActions) {
      image.actions[n + 1] = -actions[n + 1];
      image.actions[n + 3] = -actions[n + 3];
    }
    return image;
  }
};

constexpr std::size_t kCarts = 32;

TEST(Glide, IsTheSameToTheLeftAndToTheRight) {
  constexpr std::uint32_t kSeed = 1701;
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  std::uint64_t slid = 0;
  std::size_t same = 0;
  std::size_t all = 0;
  for (int round = 0; round < (kIsSanitized ? 5 : 25); ++round) {
    const Room room = furnishedRoom(random, kCarts);
    const Room image = mirrored(room);
    const BoxWorld world(room.blocks, room.starts);
    const BoxWorld other(image.blocks, image.starts);
    BatchSimulator left = simulatorOf(world, kCarts);
    BatchSimulator right = simulatorOf(other, kCarts);
    // A few steps only: what differs by rounding once is elsewhere for ever.
    for (int step = 0; step < 3; ++step) {
      const Moves moves(random, kCarts, true);
      left.step(moves.actions);
      right.step(moves.mirror().actions);
    }
    for (std::size_t n = 0; n < kCarts; ++n) {
      const Vec3 a = left.envState(n).world_from_root.translation;
      const Vec3 b = right.envState(n).world_from_root.translation;
      const bool is_image =
          std::fabs(a.x - b.x) < kRounding && std::fabs(a.z - (kSize - b.z)) < kRounding;
      same += is_image ? 1U : 0U;
      ++all;
    }
    slid += left.statistics().slid;
  }
  EXPECT_GT(slid, all / 4);
  // Two ways may be equally long but for rounding.
  EXPECT_GE(same, all - all / 100);
}

TEST(Glide, NeverMovesAgainstTheDriveNorFurtherThanDriven) {
  constexpr std::uint32_t kSeed = 1702;
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  std::uint64_t slid = 0;
  std::uint64_t refused = 0;
  std::uint64_t steps = 0;
  for (int round = 0; round < 10; ++round) {
    const Room room = furnishedRoom(random, kCarts);
    const BoxWorld world(room.blocks, room.starts);
    BatchSimulator simulator = simulatorOf(world, kCarts);
    std::vector<Vec3> before(kCarts);
    for (int step = 0; step < 40; ++step) {
      std::vector<float> yaw(kCarts);
      for (std::size_t n = 0; n < kCarts; ++n) {
        before[n] = simulator.envState(n).world_from_root.translation;
        const Vec3 ahead = rotate(simulator.envState(n).world_from_root.rotation, {1, 0, 0});
        yaw[n] = std::atan2(-ahead.z, ahead.x);
      }
      const Moves moves(random, kCarts, false);
      simulator.step(moves.actions);
      for (std::size_t n = 0; n < kCarts; ++n) {
        const Vec3 moved = simulator.envState(n).world_from_root.translation - before[n];
        const float ahead = moved.x * std::cos(yaw[n]) - moved.z * std::sin(yaw[n]);
        const float driven = 0.1F * moves.actions[n * kCartActions + 2];
        ASSERT_GE(ahead, -kRounding) << "cart " << n << " round " << round << " step " << step;
        // A corner may turn it aside by as much as it was driven into it.
        ASSERT_LE(std::hypot(moved.x, moved.z), 2 * driven + kRounding);
      }
    }
    slid += simulator.statistics().slid;
    refused += simulator.statistics().refused;
    steps += simulator.statistics().steps;
  }
  std::printf("%.1f %% slid, %.1f %% refused\n",
              100 * static_cast<double>(slid) / static_cast<double>(steps),
              100 * static_cast<double>(refused) / static_cast<double>(steps));
  EXPECT_GT(slid, steps / 5);
  EXPECT_LT(refused, steps / 20);
}

/// Blocked, and not only by rounding.
bool isIn(const BoxRoom& room, const Vec3& center, float radius) {
  constexpr double kDeeper = 1e-4;
  constexpr double kAside = 1e-5;
  for (const double x : {-kAside, kAside}) {
    for (const double z : {-kAside, kAside}) {
      const Point3 at{static_cast<double>(center.x) + x, static_cast<double>(center.y),
                      static_cast<double>(center.z) + z};
      if (!room.isBlocked(at, static_cast<double>(radius) - kDeeper)) return false;
    }
  }
  return true;
}

TEST(Glide, NeverEndsInFurniture) {
  constexpr std::uint32_t kSeed = 1704;
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  std::uint64_t slid = 0;
  std::uint64_t steps = 0;
  for (int round = 0; round < (kIsSanitized ? 10 : 60); ++round) {
    Room room = furnishedRoom(random, kCarts);
    // Plates, over which and under which an arm reaches closely.
    for (int n = 0; n < 16; ++n) {
      const Vec3 at{uniformIn(random, 0, 2.5F), uniformIn(random, 0.2F, 0.4F),
                    uniformIn(random, 0, 2.5F)};
      room.blocks.push_back({at, at + Vec3{0.5F, 0.03F, 0.4F}});
    }
    const BoxWorld world(room.blocks, room.starts);
    BatchSimulator simulator = simulatorOf(world, kCarts);
    for (int step = 0; step < 40; ++step) {
      simulator.step(Moves(random, kCarts, true).actions);
      for (std::size_t n = 0; n < kCarts; ++n) {
        const EnvState state = simulator.envState(n);
        const Vec3 cart = state.world_from_root.translation + Vec3{0, 0.3F, 0};
        ASSERT_FALSE(isIn(world.room(), cart, 0.12F)) << "round " << round << ", cart " << n;
        ASSERT_FALSE(isIn(world.room(), state.world_from_grip.translation, 0.05F))
            << "round " << round << ", cart " << n;
      }
    }
    slid += simulator.statistics().slid;
    steps += simulator.statistics().steps;
  }
  EXPECT_GT(slid, steps / 5);
}

TEST(Glide, LeavesTheDriveAsItIsWhereNothingBlocks) {
  constexpr std::uint32_t kSeed = 1703;
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  Tally blocked;
  for (int round = 0; round < 4; ++round) {
    const Room room = furnishedRoom(random, kCarts);
    const BoxWorld world(room.blocks, room.starts);
    BatchSimulator simulator = simulatorOf(world, kCarts);
    for (int step = 0; step < 20; ++step) {
      std::vector<EnvState> before;
      std::vector<std::uint64_t> moved_aside;
      const auto aside = [&](std::size_t n) {
        const SimulationStatistics seen = simulator.statistics(n);
        return seen.slid + seen.refused;
      };
      for (std::size_t n = 0; n < kCarts; ++n) {
        before.push_back(simulator.envState(n));
        moved_aside.push_back(aside(n));
      }
      const Moves moves(random, kCarts, true);
      simulator.step(moves.actions);
      for (std::size_t n = 0; n < kCarts; ++n) {
        blocked.add(aside(n) != moved_aside[n]);
        if (aside(n) != moved_aside[n]) continue;
        const Pose now = simulator.envState(n).world_from_root;
        const Vec3 ahead = rotate(now.rotation, {1, 0, 0});
        const Vec3 by = now.translation - before[n].world_from_root.translation;
        const float driven = 0.1F * moves.actions[n * kCartActions + kCartJoints];
        // No drift, neither ahead nor to a side.
        ASSERT_NEAR(by.x * ahead.x + by.z * ahead.z, driven, 1e-5F);
        ASSERT_NEAR(by.x * ahead.z - by.z * ahead.x, 0, 1e-5F);
      }
    }
  }
  blocked.expectBothSides();
}

TEST(Glide, GoesAlongAWallAsFarAsTheDriveGoesAlongIt) {
  // Columns from 1.88 m on are blocked for the cart's ball.
  const Block wall{{2, 0, 0}, {2.1F, 2, 3}};
  for (const float degrees : {5.0F, 20.0F, 45.0F, 70.0F, 85.0F}) {
    const float yaw = -degrees * kPi / 180;
    const BoxWorld world(
        {plainFloor(), wall},
        {{.base = {1.87F, 0, 0.5F}, .yaw = yaw, .objects = {{0.25F, 2.5F, 2.5F}}}});
    BatchSimulator simulator = simulatorOf(world, 1);
    const std::vector<float> drive{0, 0, 0.8F, 0, 0, 0};
    constexpr int kSteps = 15;
    float least = 10;
    for (int step = 0; step < kSteps; ++step) {
      simulator.step(drive);
      const float x = simulator.envState(0).world_from_root.translation.x;
      least = std::min(least, x);
      ASSERT_LT(x, 1.875F);
    }
    const Vec3 at = simulator.envState(0).world_from_root.translation;
    EXPECT_NEAR(at.z - 0.5F, kSteps * 0.08F * std::sin(degrees * kPi / 180), 1e-3F) << degrees;
    // No jitter: it stays at the wall.
    EXPECT_GT(least, 1.87F);
    EXPECT_EQ(simulator.statistics().refused, 0U);
  }
}

TEST(Glide, GoesRoundTheEndOfAWallThatItHitsWithItsEdge) {
  // The post's corner is 3 cm beside the middle of the cart, which is 12 cm wide.
  const Block post{{2, 0, 0}, {2.1F, 2, 1.4F}};
  const BoxWorld world({plainFloor(), post},
                       {{.base = {1.8F, 0, 1.46F}, .objects = {{0.25F, 2.5F, 2.5F}}}});
  BatchSimulator simulator = simulatorOf(world, 1);
  for (int step = 0; step < 12; ++step) {
    simulator.step(std::vector<float>{0, 0, 0.5F, 0, 0, 0});
  }
  EXPECT_GT(simulator.envState(0).world_from_root.translation.x, 2.1F);
}

}  // namespace
}  // namespace galactic::test::glide_test
