// Scanned objects, where the assets are on this machine.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "galactic/bake/sphere_set.h"
#include "sphere_set/shapes.h"
#include "support/asset_mesh.h"
#include "support/try.h"

namespace galactic::bake::real_objects_test {
namespace {

constexpr std::uint32_t kSeed = 20250406;

/// A scanned object, and the number of spheres that the published rule gives it.
struct Scan {
  std::string file;
  std::size_t published = 0;
};

std::vector<Scan> scans() {
  return {{"ycb/002_master_chef_can/textured.obj", 20},
          {"ycb/003_cracker_box/textured.obj", 40},
          {"ycb/005_tomato_soup_can/textured.obj", 8},
          {"ycb/007_tuna_fish_can/textured.obj", 8},
          {"ycb/009_gelatin_box/textured.obj", 12},
          {"ycb/010_potted_meat_can/textured.obj", 12},
          {"ycb/024_bowl/textured.obj", 18}};
}

Result<TriangleMesh> loadScan(const std::string& file) {
  MeshImportOptions options;
  options.up = UpAxis::kZ;
  ASSIGN_OR_RETURN(const auto asset, importMesh(test::assetsFolder() / file, options));
  ASSIGN_OR_RETURN(auto clean, placeAndClean(asset));
  return std::move(clean.mesh);
}

TEST(SphereSetsOfScans, AreLessThanHalfOfThePublishedRules) {
  std::size_t ours = 0;
  std::size_t published = 0;
  for (const Scan& scan : scans()) {
    if (!test::hasAsset(scan.file)) continue;
    SCOPED_TRACE(scan.file);
    const auto mesh = loadScan(scan.file);
    ASSERT_TRUE(mesh);
    SphereSetOptions options;
    options.support = HalfSpace{{0, 1, 0}, mesh->bounds.min.y};
    const auto set = fitSphereSet(*mesh, options);
    ASSERT_TRUE(set) << set.error().message;
    ours += set->spheres.size();
    published += scan.published;
    EXPECT_LE(set->spheres.size(), scan.published);
    EXPECT_LT(set->quality.gap.max, 0.017);
    for (const Point& p : test::randomSurfacePoints(*mesh, kSeed, 20'000)) {
      EXPECT_LT(test::gapOf(p, set->spheres, options.radii), 0.017);
    }
    // The bowl's wall is thin: on the plane its lowest spheres stick out upwards.
    const bool thin = set->quality.thin_points > 0;
    EXPECT_LE(set->quality.protrusion.max, thin ? 0.030 : 0.020);
    EXPECT_EQ(set->meets_tolerances, !thin);
  }
  if (published == 0) GTEST_SKIP() << "no YCB objects in the assets folder";
  EXPECT_LT(2 * ours, published);
}

TEST(SphereSetsOfScans, AreTheSameOnAnyNumberOfThreads) {
  const std::string file = scans()[5].file;
  if (!test::hasAsset(file)) GTEST_SKIP() << file << " is not in the assets folder";
  const auto mesh = loadScan(file);
  ASSERT_TRUE(mesh);
  const SphereSetOptions options;
  const auto one = fitSphereSet(*mesh, options);
  const auto three = fitSphereSet(*mesh, options, 3);
  ASSERT_TRUE(one && three);
  EXPECT_EQ(one->spheres, three->spheres);
}

}  // namespace
}  // namespace galactic::bake::real_objects_test
