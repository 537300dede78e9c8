// Boxes and stable poses of scanned objects, where they are.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "box_checks.h"
#include "fit/stable_poses.h"
#include "galactic/bake/mesh_import.h"
#include "galactic/bake/oriented_box.h"
#include "support/asset_mesh.h"
#include "support/try.h"

namespace galactic::bake::fit_assets_test {
namespace {

constexpr const char* kObjects[] = {"ycb/002_master_chef_can/textured.obj",
                                    "ycb/003_cracker_box/textured.obj",
                                    "ycb/009_gelatin_box/textured.obj",
                                    "ycb/010_potted_meat_can/textured.obj",
                                    "ycb/024_bowl/textured.obj",
                                    "gso/ACE_Coffee_Mug_Kristen_16_oz_cup/model.obj"};

class ScannedObject : public testing::TestWithParam<const char*> {};

Result<TriangleMesh> loadObject(const std::string& relative) {
  MeshImportOptions options;
  options.up = UpAxis::kZ;
  ASSIGN_OR_RETURN(auto asset, importMesh(test::assetsFolder() / relative, options));
  ASSIGN_OR_RETURN(auto clean, placeAndClean(asset));
  return std::move(clean.mesh);
}

TEST_P(ScannedObject, LiesInItsBoxAndStandsInItsPoses) {
  if (!test::hasAsset(GetParam())) GTEST_SKIP() << GetParam() << " is not among the assets";
  const auto mesh = loadObject(GetParam());
  ASSERT_TRUE(mesh.has_value()) << mesh.error().message;
  for (const BoxFit way : {BoxFit::kYaw, BoxFit::kMinimum}) {
    const BoxFitResult fit = fitOrientedBox(mesh->vertices, way);
    test::expectTightAround(mesh->vertices, fit.box);
    EXPECT_LE(fit.volume, fit.axis_aligned_volume);
    EXPECT_LE(fit.volume * (way == BoxFit::kYaw ? 1 - kMinimumBoxSaving : 1), fit.pca_volume);
  }
  const auto poses = findStablePoses(*mesh);
  double sum = 0;
  bool upright = false;
  for (const StablePose& pose : poses) {
    sum += static_cast<double>(pose.likelihood);
    // The scans stand as they were scanned.
    upright = upright || rotate(conjugate(pose.rotation), {0, -1, 0}).y < -0.995F;
  }
  EXPECT_TRUE(upright);
  EXPECT_GT(sum, 0.2);
  EXPECT_LT(sum, 1 + 1e-6);
}

/// The folder of the object: the part of the path between the slashes.
std::string nameOf(const testing::TestParamInfo<const char*>& object) {
  const std::string path = object.param;
  return path.substr(4, path.rfind('/') - 4);
}

INSTANTIATE_TEST_SUITE_P(Assets, ScannedObject, testing::ValuesIn(kObjects), nameOf);

}  // namespace
}  // namespace galactic::bake::fit_assets_test
