// Objects of known shape: box, resting poses, spheres, warnings.
#include "galactic/bake/object_baker.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "support/source_asset.h"
#include "support/test_meshes.h"

namespace galactic::test::object_baker_test {
namespace {

using bake::BakedObject;
using bake::bakeObject;
using bake::ObjectBakeOptions;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// What the box may be larger than its points by, meters.
constexpr float kBoxGrowth = 5e-6F;

/// 6 x 10 x 8 cm around the origin, moved up by `lift`.
bake::SourceAsset brick(float lift = 0) {
  return sourceAssetOf(
      MeshBuilder().box({-0.03F, lift - 0.05F, -0.04F}, {0.03F, lift + 0.05F, 0.04F}).build(),
      "brick");
}

/// Few large spheres: a fit takes hundredths of a second. For an object that is `scale` times as
/// large as the brick.
ObjectBakeOptions coarse(float scale = 1) {
  ObjectBakeOptions options;
  options.spheres.radii = {0.015F * scale, 0.03F * scale};
  options.spheres.eps = 0.02F * scale;
  options.spheres.tau = 0.03F * scale;
  return options;
}

/// The brick, so many times as large.
bake::SourceAsset scaledBrick(float scale) {
  bake::SourceAsset asset = brick();
  for (Vec3& p : asset.meshes[0].positions) p = p * scale;
  return asset;
}

BakedObject bakeWell(const bake::SourceAsset& asset, const ObjectBakeOptions& options) {
  auto object = bakeObject(asset, options);
  if (object) return std::move(*object);
  ADD_FAILURE() << object.error().text();
  return {};
}

TEST(ObjectBaker, GivesABrickItsBoxAndKeepsItsSurface) {
  const BakedObject object = bakeWell(brick(0.25F), coarse());
  EXPECT_EQ(object.name, "brick");
  EXPECT_NEAR(object.box.box.half_extents.x, 0.03F, kBoxGrowth);
  EXPECT_NEAR(object.box.box.half_extents.y, 0.05F, kBoxGrowth);
  EXPECT_NEAR(object.box.box.half_extents.z, 0.04F, kBoxGrowth);
  EXPECT_NEAR(object.box.box.pose.translation.y, 0.25F, kBoxGrowth);
  EXPECT_NEAR(object.box.volume, 0.06 * 0.1 * 0.08, 1e-6);
  EXPECT_EQ(object.bounds.min, (Vec3{-0.03F, 0.2F, -0.04F}));
  EXPECT_EQ(object.surface.triangles.size(), 12U);
  EXPECT_EQ(object.imported.triangles, 12U);
  EXPECT_THAT(object.warnings, IsEmpty());
}

TEST(ObjectBaker, RestsABrickOnItsSixFacesLargestFirst) {
  const BakedObject object = bakeWell(brick(), coarse());
  ASSERT_EQ(object.stable_poses.size(), 6U);
  float sum = 0;
  for (const StablePose& pose : object.stable_poses) sum += pose.likelihood;
  EXPECT_NEAR(sum, 1, 1e-5);
  // Half the edge that stands up: 6 cm on the largest face, 10 cm on the smallest.
  const std::vector<float> heights{0.03F, 0.03F, 0.04F, 0.04F, 0.05F, 0.05F};
  for (std::size_t n = 0; n < 6; ++n) {
    EXPECT_NEAR(object.stable_poses[n].height, heights[n], 1e-5) << n;
  }
}

TEST(ObjectBaker, KeepsSpheresAboveTheFaceOnWhichTheObjectRests) {
  const BakedObject object = bakeWell(brick(0.25F), coarse());
  ASSERT_FALSE(object.spheres.spheres.empty());
  EXPECT_TRUE(object.spheres.meets_tolerances);
  EXPECT_EQ(object.eps, 0.02F);
  EXPECT_EQ(object.tau, 0.03F);
  const auto lowest = [&](const BakedObject& made) {
    float low = 1;
    for (const SetSphere& sphere : made.spheres.spheres) {
      low = std::min(low, sphere.center.y - coarse().spheres.radii[sphere.radius_index]);
    }
    return low;
  };
  constexpr float kRounding = 1e-5F;
  EXPECT_GE(lowest(object), 0.2F - kRounding);
  ObjectBakeOptions free = coarse();
  free.keep_above_support = false;
  EXPECT_LT(lowest(bakeWell(brick(0.25F), free)), 0.2F - kRounding);
}

TEST(ObjectBaker, SaysWhenTheTolerancesCannotBeMet) {
  ObjectBakeOptions options = coarse();
  options.spheres.max_spheres = 1;
  const BakedObject object = bakeWell(brick(), options);
  EXPECT_FALSE(object.spheres.meets_tolerances);
  ASSERT_EQ(object.warnings.size(), 1U);
  EXPECT_THAT(object.warnings[0], testing::StartsWith("with 1 sphere there are gaps of up to "));
  EXPECT_THAT(object.warnings[0],
              HasSubstr("expected 20.0 and 30.0 mm; allow more with `max-spheres`"));
}

TEST(ObjectBaker, SaysWhenASurfaceIsTooLargeForTheTolerances) {
  ObjectBakeOptions options = coarse();
  options.spheres.eps = 0.002F;
  const BakedObject object = bakeWell(brick(), options);
  EXPECT_GT(object.spheres.guaranteed_gap, 1.18 * 0.002);
  EXPECT_FALSE(object.spheres.meets_tolerances);
  ASSERT_EQ(object.warnings.size(), 1U);
  EXPECT_THAT(
      object.warnings[0],
      testing::MatchesRegex("its surface of 0\\.038 m2 is so large that it is known at points "
                            "far apart: gaps are [23]\\.[0-9] mm at most, expected 2\\.0 "
                            "mm; give a wider `eps`, or bake its parts as objects"));
}

TEST(ObjectBaker, AsksAboutTheUnitOfTinyAndLargeObjectsAndRefusesHugeOnes) {
  constexpr float kTiny = 0.01F;
  EXPECT_THAT(bakeWell(scaledBrick(kTiny), coarse(kTiny)).warnings,
              testing::Contains("is only 1 mm large; is the unit right? `scale` sets meters per "
                                "unit"));
  constexpr float kLarge = 40;
  EXPECT_THAT(bakeWell(scaledBrick(kLarge), coarse(kLarge)).warnings,
              testing::Contains(testing::MatchesRegex(
                  "is [0-9.]+ m large; is the unit right\\? `scale` sets meters per unit")));
  const auto refused = bakeObject(scaledBrick(1000), coarse());
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().code, ErrorCode::kUnsupported);
  EXPECT_EQ(refused.error().where, "mesh");
  EXPECT_THAT(refused.error().message, HasSubstr("is its unit the centimeter or the millimeter?"));
}

TEST(ObjectBaker, KeepsTheWarningsOfTheImport) {
  bake::SourceAsset asset = brick();
  asset.warnings = {"texture 'wood.png' is missing"};
  EXPECT_THAT(bakeWell(asset, coarse()).warnings, ElementsAre("texture 'wood.png' is missing"));
}

TEST(ObjectBaker, RefusesOptionsAndMeshesThatGiveNoSpheres) {
  ObjectBakeOptions wrong = coarse();
  wrong.spheres.radii = {0.05F, 0.02F};
  auto refused = bakeObject(brick(), wrong);
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().where, "radii[1]");
  wrong = coarse();
  wrong.spheres.tau = -1;
  refused = bakeObject(brick(), wrong);
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().where, "tau");
  refused = bakeObject(sourceAssetOf({}), coarse());
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().code, ErrorCode::kInvalidInput);
}

TEST(ObjectBaker, UsesTheBoxThatWasAskedFor) {
  // A brick turned by an eighth of a turn about Y.
  bake::SourceAsset asset = brick();
  const double s = std::sqrt(0.5);
  asset.instances[0].world_from_mesh = {s, 0, s, 0, 0, 1, 0, 0, -s, 0, s, 0};
  ObjectBakeOptions options = coarse();
  for (const auto fit : {bake::BoxFit::kYaw, bake::BoxFit::kMinimum}) {
    options.box = fit;
    EXPECT_NEAR(bakeWell(asset, options).box.volume, 0.06 * 0.1 * 0.08, 1e-6);
  }
  options.box = bake::BoxFit::kAxisAligned;
  const BakedObject aligned = bakeWell(asset, options);
  EXPECT_NEAR(aligned.box.box.half_extents.x, (0.03 + 0.04) * s, kBoxGrowth);
  EXPECT_EQ(aligned.box.box.pose.rotation, Quat{});
}

TEST(ObjectBaker, TakesAShapeThatIsGiven) {
  ObjectBakeOptions options = coarse();
  options.authored = bake::AuthoredShape{.box = {{-0.03F, -0.05F, -0.04F}, {0.03F, 0.05F, 0.042F}},
                                         .spheres = {{{0, 0.01F, 0}, 1}, {{0, -0.02F, 0}, 0}}};
  const BakedObject object = bakeWell(brick(), options);
  EXPECT_EQ(object.box.box.half_extents, (Vec3{0.03F, 0.05F, 0.041F}));
  EXPECT_NEAR(object.box.box.pose.translation.z, 0.001F, 1e-8F);
  EXPECT_EQ(object.box.box.pose.rotation, Quat{});
  EXPECT_EQ(object.box.used, bake::BoxFit::kAxisAligned);
  EXPECT_NEAR(object.box.volume, 0.06 * 0.1 * 0.082, 1e-8);
  EXPECT_TRUE(object.authored_spheres);
  EXPECT_EQ(object.spheres.spheres, options.authored->spheres);
  // Two spheres leave the corners bare: the measurement says so, and no advice is given.
  EXPECT_GT(object.spheres.quality.gap.max, 0.03);
  EXPECT_EQ(object.spheres.guaranteed_gap, object.spheres.quality.gap.max);
  EXPECT_FALSE(object.spheres.meets_tolerances);
  EXPECT_THAT(object.warnings, IsEmpty());
}

TEST(ObjectBaker, FitsSpheresWhereOnlyABoxIsGivenAndDoubtsABoxOfAnotherMesh) {
  ObjectBakeOptions options = coarse();
  options.authored =
      bake::AuthoredShape{.box = {{-0.03F, -0.04F, -0.05F}, {0.03F, 0.04F, 0.05F}}, .spheres = {}};
  const BakedObject object = bakeWell(brick(), options);
  EXPECT_FALSE(object.authored_spheres);
  EXPECT_TRUE(object.spheres.meets_tolerances);
  EXPECT_THAT(object.warnings,
              ElementsAre("the box given for it is up to 10 mm off the mesh's; is it of this mesh, "
                          "and are `up` and `scale` right?"));
}

}  // namespace
}  // namespace galactic::test::object_baker_test
