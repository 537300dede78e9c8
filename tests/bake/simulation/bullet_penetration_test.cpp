// Over many random steps in real scenes no accepted state penetrates anything: the robot's and a
// held object's spheres against the column grids and boxes, one by one, and against Bullet's exact
// shapes.
#include <gtest/gtest.h>

#include "penetration_run.h"
#include "support/asset_mesh.h"
#include "support/build_paths.h"

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
  // What docs/simulation.md says: about one move in a hundred.
  EXPECT_GT(found.swept_straight, 1000U);
  if (run.continuous) {
    EXPECT_EQ(found.tunneled_straight, 0U);
    // Where they slide, what lies on the straight line is gone around.
    EXPECT_LT(500 * found.tunneled, found.swept);
  } else {
    EXPECT_LT(30 * found.tunneled, found.swept);
  }
}

TEST(BulletScene, SeesWhatIsOnTheWayOfABallAndOfAPoint) {
  // A square of 1 m, upright.
  bake::TriangleMesh plate;
  plate.vertices = {{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}};
  plate.triangles = {{0, 1, 2}, {0, 2, 3}};
  BulletScene scene(plate);
  for (const float radius : {0.0F, 0.05F}) {
    EXPECT_TRUE(scene.crosses({-0.1F, 0.5F, 0.3F}, {0.1F, 0.5F, 0.3F}, radius));
    EXPECT_FALSE(scene.crosses({-0.3F, 0.5F, 0.3F}, {-0.1F, 0.5F, 0.3F}, radius));
    EXPECT_FALSE(scene.crosses({-0.1F, 1.2F, 0.3F}, {0.1F, 1.2F, 0.3F}, radius));
  }
  // Beside the plate's edge, closer than the ball is wide.
  EXPECT_TRUE(scene.crosses({-0.1F, 1.03F, 0.3F}, {0.1F, 1.03F, 0.3F}, 0.05F));
  EXPECT_FALSE(scene.crosses({-0.1F, 1.03F, 0.3F}, {0.1F, 1.03F, 0.3F}, 0));
}

TEST(Penetration, NeverHappensInTheSampleApartment) {
  expectNothingPenetrates({test::sourceFolder() / "packs/sample/apartment.glb"});
}

TEST(Penetration, NeverHappensToThoseWhoLookAtTheirWay) {
  expectNothingPenetrates({.mesh = test::sourceFolder() / "packs/sample/apartment.glb",
                           .steps = 500,
                           .continuous = true});
}

TEST(Penetration, NeverHappensInThePublishedScene) {
  if (!hasAsset(kPublishedScene)) GTEST_SKIP() << "no asset " << kPublishedScene;
  const std::filesystem::path folder = assetsFolder();
  expectNothingPenetrates({folder / kPublishedScene, folder / kPublishedEpisodes});
}

}  // namespace
}  // namespace galactic::test::bullet_penetration_test
