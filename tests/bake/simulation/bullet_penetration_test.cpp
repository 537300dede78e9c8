// Over many random steps in real scenes no accepted state penetrates anything: the robot's and a
// held object's spheres against the column grids and boxes, one by one, and against Bullet's exact
// shapes.
#include <gtest/gtest.h>

#include <cstdio>
#include <random>

#include "home.h"
#include "state_checker.h"
#include "support/asset_mesh.h"
#include "support/source_folder.h"

namespace galactic::test::bullet_penetration_test {
namespace {

constexpr const char* kPublishedScene = "published_physics/scene.ply";
constexpr const char* kPublishedEpisodes = "published_physics/episodes.episode_set.json";
constexpr std::uint32_t kEnvs = 512;
constexpr std::uint32_t kSteps = 1000;
/// Bullet is asked about one state in so many.
constexpr std::uint32_t kSampled = 64;

const SampleThings& things() {
  static const SampleThings baked;
  return baked;
}

/// Random actions; hands keep what they have for a while, and half of the envs drive ahead.
std::vector<float> drawActions(std::uint32_t step, std::size_t count, std::mt19937& random) {
  std::vector<float> actions(kEnvs * count);
  for (std::size_t env = 0; env < kEnvs; ++env) {
    const std::span<float> row = std::span(actions).subspan(env * count, count);
    for (float& action : row) action = uniformIn(random, -1, 1);
    float& forward = row[count - 4];
    if (env % 2 == 0) forward = 0.5F + 0.5F * forward;
    row[count - 2] = (step + env) % 150 < 110 ? 1.0F : -1.0F;
    row[count - 1] = 0;
  }
  return actions;
}

Findings run(const Home& home, SimulationStatistics& statistics) {
  SimulationOptions options;
  options.envs = kEnvs;
  options.threads = 2;
  options.body_transforms = true;
  options.task.kind = TaskKind::kNone;
  options.task.most_steps = 200;
  auto simulator = MemoryPack::opened(BatchSimulator::create(home.world(), options));
  std::printf("skipped %zu of %zu episodes\n", simulator.skippedEpisodes().size(),
              home.world().episodes().episodes().size());
  EXPECT_LE(2 * simulator.skippedEpisodes().size(), home.world().episodes().episodes().size());
  BulletScene scene(home.mesh());
  StateChecker checker(home.world(), simulator, scene);
  std::mt19937 random(801);
  Findings found;
  for (std::uint32_t step = 0; step < kSteps; ++step) {
    simulator.step(drawActions(step, simulator.actionCount(), random));
    for (std::uint32_t env = 0; env < kEnvs; ++env) {
      checker.check(env, (env + step) % kSampled == 0, found);
    }
  }
  statistics = simulator.statistics();
  return found;
}

void report(const Findings& found, const SimulationStatistics& seen) {
  const auto number = [](std::uint64_t value) { return static_cast<unsigned long long>(value); };
  std::printf("states %llu: refused %llu, slid %llu, grasps %llu, drops %llu, restored %llu\n",
              number(found.states), number(seen.refused), number(seen.slid), number(seen.grasps),
              number(seen.drops), number(seen.restored));
  std::printf(
      "spheres: robot %llu, held %llu (excepted %llu), near objects %llu, exact %llu (%llu "
      "touch)\n",
      number(found.robot_spheres), number(found.held_spheres), number(found.excepted),
      number(found.near_objects), number(found.exact), number(found.shallow));
  std::printf("spheres of robots that released an object into themselves: %llu\n",
              number(found.released_into));
  for (const std::size_t n : {0U, 1U}) {
    std::printf("%s: in the grid %llu, in objects %llu, deep in the scene %llu\n",
                n == 0 ? "robot" : "held", number(found.in_grid[n]), number(found.in_objects[n]),
                number(found.in_scene[n]));
  }
}

void expectNothingPenetrates(const Home& home) {
  SimulationStatistics seen;
  const Findings found = run(home, seen);
  report(found, seen);
  EXPECT_EQ(found.states, std::uint64_t{kEnvs} * kSteps);
  for (const std::size_t n : {0U, 1U}) {
    EXPECT_EQ(found.in_grid[n], 0U);
    EXPECT_EQ(found.in_objects[n], 0U);
    EXPECT_EQ(found.in_scene[n], 0U);
  }
  // The steps were such that something could have happened.
  EXPECT_GT(10 * (seen.refused + seen.slid), seen.steps);
  EXPECT_GT(seen.grasps, 100U);
  EXPECT_GT(found.held_spheres, 10000U);
  EXPECT_LT(2 * found.excepted, found.held_spheres);
  EXPECT_GT(found.near_objects, 10000U);
  EXPECT_GT(found.exact, 100000U);
  EXPECT_GT(found.shallow, 100U);
}

TEST(Penetration, NeverHappensInTheSampleApartment) {
  const auto file = test::sourceFolder() / "packs/sample/apartment.glb";
  expectNothingPenetrates(Home({file}, things()));
}

TEST(Penetration, NeverHappensInThePublishedScene) {
  if (!hasAsset(kPublishedScene)) GTEST_SKIP() << "no asset " << kPublishedScene;
  const std::filesystem::path folder = assetsFolder();
  expectNothingPenetrates(Home({folder / kPublishedScene, folder / kPublishedEpisodes}, things()));
}

}  // namespace
}  // namespace galactic::test::bullet_penetration_test
