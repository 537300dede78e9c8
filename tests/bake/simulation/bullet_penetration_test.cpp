// Over many random steps in real scenes no accepted state penetrates anything: the robot's and a
// held object's spheres against the column grids and boxes, one by one, and against Bullet's exact
// shapes.
#include <gtest/gtest.h>

#include "penetration_run.h"
#include "support/asset_mesh.h"
#include "support/source_folder.h"

namespace galactic::test::bullet_penetration_test {
namespace {

constexpr const char* kPublishedScene = "published_physics/scene.ply";
constexpr const char* kPublishedEpisodes = "published_physics/episodes.episode_set.json";

void expectNothingPenetrates(const PenetrationRun& run) {
  const PenetrationReport report = searchPenetrations(run);
  print(report);
  const Findings& found = report.found;
  EXPECT_EQ(found.states, run.envs * run.steps);
  for (const std::size_t n : {0U, 1U}) {
    EXPECT_EQ(found.in_grid[n], 0U);
    EXPECT_EQ(found.in_objects[n], 0U);
    EXPECT_EQ(found.in_scene[n], 0U);
  }
  EXPECT_LE(found.deepest, StateChecker::kDeepest);
  // The steps were such that something could have happened.
  EXPECT_LE(2 * report.skipped, report.episodes);
  EXPECT_GT(10 * (report.seen.refused + report.seen.slid), report.seen.steps);
  EXPECT_GT(report.seen.grasps, 100U);
  EXPECT_GT(found.held_spheres, 10000U);
  EXPECT_LT(2 * found.excepted, found.held_spheres);
  EXPECT_GT(found.near_objects, 10000U);
  EXPECT_GT(found.exact, 100000U);
  EXPECT_GT(found.shallow, 100U);
  EXPECT_GT(found.deepest, 0.0F);
}

TEST(Penetration, NeverHappensInTheSampleApartment) {
  expectNothingPenetrates({test::sourceFolder() / "packs/sample/apartment.glb"});
}

TEST(Penetration, NeverHappensInThePublishedScene) {
  if (!hasAsset(kPublishedScene)) GTEST_SKIP() << "no asset " << kPublishedScene;
  const std::filesystem::path folder = assetsFolder();
  expectNothingPenetrates({folder / kPublishedScene, folder / kPublishedEpisodes});
}

}  // namespace
}  // namespace galactic::test::bullet_penetration_test
