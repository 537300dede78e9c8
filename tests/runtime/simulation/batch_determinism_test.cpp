// What an env does depends on nothing but the world, the seed, its number and its actions.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <random>
#include <vector>

#include "batch_trace.h"
#include "support/sanitized.h"

namespace galactic::test::batch_determinism_test {
namespace {

BatchSimulator made(const BoxWorld& world, const SimulationOptions& options) {
  return BatchSimulator::create(world.world(), options).value();
}

/// Something of everything happened, so that equal traces mean something.
void expectBusy(const SimulationStatistics& seen) {
  std::printf(
      "steps %llu refused %llu slid %llu grasps %llu drops %llu restored %llu ends %llu\n",
      static_cast<unsigned long long>(seen.steps), static_cast<unsigned long long>(seen.refused),
      static_cast<unsigned long long>(seen.slid), static_cast<unsigned long long>(seen.grasps),
      static_cast<unsigned long long>(seen.drops), static_cast<unsigned long long>(seen.restored),
      static_cast<unsigned long long>(seen.episodes));
  EXPECT_GT(seen.refused, seen.steps / 100);
  EXPECT_GT(seen.slid, seen.steps / 100);
  EXPECT_GT(seen.episodes, 0U);
}

TEST(BatchSimulator, GivesTheSameBitsForAnyNumberOfThreads) {
  const BoxWorld world = furnishedWorld();
  // Neither the envs nor their chunks divide evenly.
  BatchSimulator one = made(world, optionsFor(203, 1));
  const auto wanted = tracesOf(one, 250);
  expectBusy(one.statistics());
  EXPECT_GT(one.statistics().grasps, 100U);
  EXPECT_GT(one.statistics().drops + one.statistics().restored, 100U);
  for (const std::uint32_t threads : {2U, 7U}) {
    BatchSimulator many = made(world, optionsFor(203, threads));
    ASSERT_EQ(many.threadCount(), threads);
    EXPECT_EQ(tracesOf(many, 250), wanted);
    EXPECT_EQ(many.statistics().reward, one.statistics().reward);
    EXPECT_EQ(many.statistics().slid, one.statistics().slid);
  }
}

/// So many that threads ask the memory ahead for envs at which another one may be at work.
TEST(BatchSimulator, GivesTheSameBitsForManyEnvsOfSeveralThreads) {
  const BoxWorld world = furnishedWorld();
  constexpr std::uint32_t kEnvs = 3000;
  BatchSimulator one = made(world, optionsFor(kEnvs, 1));
  BatchSimulator many = made(world, optionsFor(kEnvs, 3));
  EXPECT_EQ(tracesOf(many, 30), tracesOf(one, 30));
  EXPECT_GT(one.statistics().grasps, 100U);
  EXPECT_GT(one.statistics().drops, 100U);
}

TEST(BatchSimulator, KnowsEachOfManyFloorsAsIfThereWereNoOther) {
  // Terraces, each lower than the one before, with walls between them.
  constexpr int kEdge = 5;
  constexpr float kWidth = 0.6F;
  std::vector<Block> blocks;
  std::vector<Start> starts;
  for (int n = 0; n < kEdge * kEdge; ++n) {
    const int row = n / kEdge;
    const float x = kWidth * static_cast<float>(n - row * kEdge);
    const float z = kWidth * static_cast<float>(row);
    const float height = 0.05F * static_cast<float>(kEdge * kEdge - n);
    blocks.push_back({{x, -0.4F, z}, {x + kWidth, height, z + kWidth}});
    blocks.push_back({{x, height, z}, {x + 0.1F, height + 0.4F, z + kWidth}});
    blocks.push_back({{x, height, z}, {x + kWidth, height + 0.4F, z + 0.1F}});
    starts.push_back({.base = {x + 0.35F, height, z + 0.35F}, .objects = {{2.9F, 2.5F, 2.9F}}});
  }
  SimulationOptions options = optionsFor(kEdge * kEdge);
  options.order = EpisodeOrder::kLinear;
  options.task.kind = TaskKind::kNone;
  const BoxWorld world(blocks, starts);
  BatchSimulator together = made(world, options);
  options.threads = 3;
  BatchSimulator by_threads = made(world, options);
  options.threads = 1;
  std::vector<std::unique_ptr<BoxWorld>> worlds;
  std::vector<BatchSimulator> alone;
  // Each floor is mapped once more for one that is alone: where a sanitizer watches, for a few.
  constexpr std::uint32_t kStride = kIsSanitized ? 8 : 1;
  for (std::uint32_t env = 0; env < starts.size(); env += kStride) {
    worlds.push_back(std::make_unique<BoxWorld>(blocks, std::vector{starts[env]}));
    alone.push_back(made(*worlds.back(), options));
  }
  for (std::uint32_t step = 0; step < 30; ++step) {
    const std::vector<float> actions = actionsFor(together, 0, step);
    together.step(actions);
    by_threads.step(actions);
    for (std::uint32_t n = 0; n < alone.size(); ++n) {
      const std::uint32_t env = n * kStride;
      alone[n].step(actions);
      const Pose wanted = alone[n].envState(env).world_from_root;
      ASSERT_EQ(together.envState(env).world_from_root, wanted) << env << " in step " << step;
      ASSERT_EQ(by_threads.envState(env).world_from_root, wanted) << env << " in step " << step;
    }
  }
  EXPECT_EQ(together.statistics().episodes, 0U);
  EXPECT_GT(together.statistics().slid, 100U);
  EXPECT_GT(together.statistics().refused, 0U);
}

TEST(BatchSimulator, GivesTheSameBitsAgain) {
  const BoxWorld world = furnishedWorld();
  BatchSimulator first = made(world, optionsFor(40));
  BatchSimulator second = made(world, optionsFor(40));
  const auto wanted = tracesOf(first, 100);
  EXPECT_EQ(tracesOf(second, 100), wanted);
  SimulationOptions other = optionsFor(40);
  other.seed = 12;
  BatchSimulator third = made(world, other);
  EXPECT_NE(tracesOf(third, 100), wanted);
}

TEST(BatchSimulator, DoesNotLetEnvsInfluenceEachOther) {
  const BoxWorld world = furnishedWorld();
  for (const EpisodeOrder order : {EpisodeOrder::kShuffled, EpisodeOrder::kLinear}) {
    SimulationOptions options = optionsFor(512, 2);
    options.order = order;
    BatchSimulator large = made(world, options);
    const auto traces = tracesOf(large, 100);
    options.envs = 1;
    for (const std::uint32_t env : {0U, 1U, 17U, 300U, 511U}) {
      options.ranks = 512;
      options.rank = env;
      BatchSimulator single = made(world, options);
      ASSERT_EQ(tracesOf(single, 100, env).front(), traces[env]) << "env " << env;
    }
    options.envs = 64;
    options.ranks = 8;
    options.rank = 5;
    BatchSimulator shard = made(world, options);
    const auto sharded = tracesOf(shard, 100, 5 * 64);
    EXPECT_TRUE(std::equal(sharded.begin(), sharded.end(), traces.begin() + 5 * 64));
  }
}

/// Objects all over the floor, so that robots with something in their hands touch others.
BoxWorld crowdedWorld() {
  const std::vector<Block> blocks{plainFloor(),
                                  {{0, 0, 0}, {3, 2, 0.1F}},
                                  {{0, 0, 2.9F}, {3, 2, 3}},
                                  {{0, 0, 0}, {0.1F, 2, 3}},
                                  {{2.9F, 0, 0}, {3, 2, 3}},
                                  {{1.2F, 0, 1.2F}, {1.8F, 0.6F, 1.6F}}};
  std::vector<Start> starts;
  for (int n = 0; n < 8; ++n) {
    // The first in reach of the hand.
    Start start{.base = {0.8F, 0, 0.8F}, .objects = {{1.02F, 0.2F, 0.8F}}};
    for (int k = 0; k < 5; ++k) {
      start.objects.push_back({0.35F + 0.42F * static_cast<float>((n + k * 3) % 6), 0.15F,
                               0.3F + 0.45F * static_cast<float>((2 * n + k) % 6)});
    }
    starts.push_back(start);
  }
  return {blocks, starts};
}

/// The hand takes what is there in the first steps, and keeps it.
void fillHolding(std::uint32_t env, std::uint32_t step, std::span<float> row) {
  RandomStream slow(97, env, 0, step / 8);
  RandomStream fast(5, env, 0, step);
  const auto from_to = [](RandomStream& random, float least, float most) {
    return least + (most - least) * random.unit();
  };
  row[0] = step < 2 ? 1 : from_to(slow, -1, 1);
  row[1] = from_to(fast, -1, 1);
  row[2] = from_to(slow, -0.4F, 1.3F);
  row[3] = from_to(slow, -1, 1);
  row[4] = 1;
  row[5] = 0;
}

TEST(BatchSimulator, LetsNoOtherEnvDecideWhereOneThatHoldsSomethingSlides) {
  const BoxWorld world = crowdedWorld();
  constexpr std::uint32_t kEnvs = 96;
  SimulationOptions options = optionsFor(kEnvs);
  options.task.most_steps = 300;
  options.task.drop_fails = false;
  BatchSimulator many = made(world, options);
  options.envs = 1;
  options.ranks = kEnvs;
  std::vector<BatchSimulator> alone;
  for (options.rank = 0; options.rank < kEnvs; ++options.rank) {
    alone.push_back(made(world, options));
  }
  std::vector<float> actions(kEnvs * kCartActions);
  for (std::uint32_t step = 0; step < 300; ++step) {
    for (std::uint32_t env = 0; env < kEnvs; ++env) {
      const std::span<float> row = std::span(actions).subspan(env * kCartActions, kCartActions);
      fillHolding(env, step, row);
      alone[env].step(row);
    }
    many.step(actions);
    for (std::uint32_t env = 0; env < kEnvs; ++env) {
      ASSERT_EQ(alone[env].envState(0).world_from_root, many.envState(env).world_from_root)
          << "env " << env << " in step " << step;
    }
  }
  EXPECT_GT(many.statistics().grasps, kEnvs / 2);
  EXPECT_GT(many.statistics().slid, 1000U);
}

TEST(BatchSimulator, CountsWhatHappenedInOneEnvAsIfItWereAlone) {
  const BoxWorld world = furnishedWorld();
  SimulationOptions options = optionsFor(64, 2);
  BatchSimulator many = made(world, options);
  (void)tracesOf(many, 200);
  options.envs = 1;
  options.ranks = 64;
  SimulationStatistics sum;
  for (std::uint32_t env = 0; env < 64; ++env) {
    options.rank = env;
    BatchSimulator single = made(world, options);
    (void)tracesOf(single, 200, env);
    const SimulationStatistics own = many.statistics(env);
    const SimulationStatistics alone = single.statistics();
    visitStatistics([&](const char* name, auto member) {
      EXPECT_EQ(own.*member, alone.*member) << name;
      sum.*member += alone.*member;
    });
  }
  const SimulationStatistics all = many.statistics();
  visitStatistics(
      [&](const char* name, auto member) { EXPECT_EQ(all.*member, sum.*member) << name; });
  EXPECT_GT(all.episodes, 0U);
  EXPECT_GT(all.slid, 500U);
  EXPECT_GT(all.refused, 50U);
}

TEST(BatchSimulator, SharesEpisodesAmongRanksInAPartition) {
  const BoxWorld world = furnishedWorld();
  SimulationOptions options = optionsFor(8);
  options.order = EpisodeOrder::kPartition;
  BatchSimulator whole = made(world, options);
  const auto traces = tracesOf(whole, 100);
  options.envs = 4;
  options.ranks = 2;
  options.rank = 1;
  BatchSimulator half = made(world, options);
  const auto sharded = tracesOf(half, 100, 4);
  EXPECT_TRUE(std::equal(sharded.begin(), sharded.end(), traces.begin() + 4));
}

TEST(BatchSimulator, DoesTheSameInTwoHalves) {
  const BoxWorld world = furnishedWorld();
  for (const std::uint32_t threads : {1U, 2U}) {
    BatchSimulator expected = made(world, optionsFor(100, threads));
    BatchSimulator halves = made(world, optionsFor(100, threads));
    BatchTrace trace(halves);
    for (std::uint32_t step = 0; step < 100; ++step) {
      const std::vector<float> actions = actionsFor(halves, 0, step);
      // Both ways may alternate.
      if (step % 5 == 4) {
        halves.step(actions);
      } else {
        halves.beginStep(actions);
        halves.endStep();
      }
      trace.add(halves);
    }
    EXPECT_EQ(trace.hashes(), tracesOf(expected, 100));
    EXPECT_EQ(halves.statistics().steps, expected.statistics().steps);
  }
}

TEST(BatchSimulator, DoesTheSameWhenPhasesAreMeasuredOrBodiesAreNotWanted) {
  const BoxWorld world = furnishedWorld();
  SimulationOptions options = optionsFor(50);
  options.body_transforms = false;
  BatchSimulator plain = made(world, options);
  BatchSimulator measured = made(world, options);
  measured.samplePhases(3);
  EXPECT_EQ(tracesOf(plain, 100), tracesOf(measured, 100));
  EXPECT_TRUE(plain.bodyTransforms().empty());
  options.body_transforms = true;
  BatchSimulator with_bodies = made(world, options);
  EXPECT_EQ(with_bodies.bodyTransforms().size(), 50 * with_bodies.bodyCount());
  for (std::uint32_t step = 0; step < 100; ++step) {
    with_bodies.step(actionsFor(with_bodies, 0, step));
  }
  EXPECT_TRUE(std::ranges::equal(plain.observations(), with_bodies.observations()));
}

TEST(BatchSimulator, DoesTheSameWithTheRobotsSpheresInAnyOrder) {
  // Balls all over the cart and its arm, so that several penetrate things at a time.
  constexpr std::uint32_t kSeed = 701;
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  RobotPackFields robot = cartRobot();
  robot.spheres.clear();
  for (GroupFields& group : robot.groups) {
    group.first_sphere = static_cast<std::uint32_t>(robot.spheres.size());
    group.sphere_count = 12;
    for (std::uint32_t n = 0; n < 12; ++n) {
      const float height = group.link == 0 ? 0.3F : 0.0F;
      robot.spheres.push_back(
          {{uniformIn(random, -0.1F, 0.1F), height + uniformIn(random, -0.1F, 0.2F),
            uniformIn(random, -0.1F, 0.1F)},
           n % 3});
    }
  }
  const BoxWorld world = furnishedWorld(robot);
  BatchSimulator simulator = made(world, optionsFor(64));
  const auto wanted = tracesOf(simulator, 150);
  expectBusy(simulator.statistics());
  for (int round = 0; round < 4; ++round) {
    for (const GroupFields& group : robot.groups) {
      for (std::uint32_t n = 11; n > 0; --n) {
        const auto other = static_cast<std::uint32_t>(random() % (n + 1));
        std::swap(robot.spheres[group.first_sphere + n], robot.spheres[group.first_sphere + other]);
      }
    }
    const BoxWorld permuted = furnishedWorld(robot);
    BatchSimulator same = made(permuted, optionsFor(64));
    EXPECT_EQ(tracesOf(same, 150), wanted);
  }
}

}  // namespace
}  // namespace galactic::test::batch_determinism_test
