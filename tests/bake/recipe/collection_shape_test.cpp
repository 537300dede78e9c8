// Shapes of published objects: the frame, the published rule, and what cannot be taken.
#include "recipe/collection_shape.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "support/asset_mesh.h"

namespace galactic::test::collection_shape_test {
namespace {

using bake::CollectionObject;
using bake::HandSphere;
using bake::shapeFromCollection;
using bake::SphereTechnique;
using bake::UpAxis;
using testing::HasSubstr;

const std::vector<float> kRadii{0.015F, 0.05F, 0.12F};

CollectionObject object(SphereTechnique technique) {
  CollectionObject made;
  made.name = "thing";
  made.box_min = {-0.05, -0.02, 0};
  made.box_max = {0.03, 0.06, 0.125};
  made.technique = technique;
  return made;
}

TEST(CollectionShapes, TurnBoxesFromTheMeshFilesFrame) {
  const auto shape = shapeFromCollection(object(SphereTechnique::kBox), UpAxis::kZ, kRadii);
  ASSERT_TRUE(shape.has_value()) << shape.error().message;
  // (x, y, z) of the file is (x, z, -y) of the pack.
  EXPECT_EQ(shape->box.min, (Vec3{-0.05F, 0, -0.06F}));
  EXPECT_EQ(shape->box.max, (Vec3{0.03F, 0.125F, 0.02F}));
  const auto same = shapeFromCollection(object(SphereTechnique::kBox), UpAxis::kY, kRadii);
  ASSERT_TRUE(same.has_value());
  EXPECT_EQ(same->box.min, (Vec3{-0.05F, -0.02F, 0}));
  EXPECT_EQ(same->box.max, (Vec3{0.03F, 0.06F, 0.125F}));
}

TEST(CollectionShapes, TakeListedSpheresAsTheyAre) {
  CollectionObject listed = object(SphereTechnique::kListed);
  listed.spheres = {{.center = {0.01, 0.02, 0.03}, .radius = 0.015},
                    {.center = {0, 0.04, 0.05}, .radius = 0.05}};
  const auto shape = shapeFromCollection(listed, UpAxis::kZ, kRadii);
  ASSERT_TRUE(shape.has_value()) << shape.error().message;
  const std::vector<SetSphere> wanted{{{0, 0.05F, -0.04F}, 1}, {{0.01F, 0.03F, -0.02F}, 0}};
  EXPECT_EQ(shape->spheres, wanted);
  listed.spheres.clear();
  const auto none = shapeFromCollection(listed, UpAxis::kZ, kRadii);
  ASSERT_TRUE(none.has_value());
  EXPECT_TRUE(none->spheres.empty());
}

TEST(CollectionShapes, RefuseRadiiOutsideTheWorkingSetAndFlatBoxes) {
  CollectionObject listed = object(SphereTechnique::kListed);
  listed.spheres = {{.center = {0, 0, 0}, .radius = 0.04}};
  auto shape = shapeFromCollection(listed, UpAxis::kZ, kRadii);
  ASSERT_FALSE(shape.has_value());
  EXPECT_EQ(shape.error().code, ErrorCode::kInvalidInput);
  EXPECT_EQ(shape.error().where, "object 'thing'");
  EXPECT_THAT(shape.error().message,
              HasSubstr("up to 0.01 m off the working set 0.015,0.05,0.12; give its radii"));
  CollectionObject flat = object(SphereTechnique::kBox);
  flat.box_max[1] = flat.box_min[1];
  shape = shapeFromCollection(flat, UpAxis::kZ, kRadii);
  ASSERT_FALSE(shape.has_value());
  EXPECT_THAT(shape.error().message, HasSubstr("a box without volume"));
}

TEST(PublishedSpheres, FillABoxByHand) {
  // 10 x 10 x 10 cm, radius 0.05: two along each axis fall together in the middle; of 0.015 the
  // eight corners.
  CollectionObject cube = object(SphereTechnique::kBox);
  cube.box_min = {0, 0, 0};
  cube.box_max = {0.125, 0.125, 0.125};
  const auto spheres = publishedSpheres(cube, kRadii);
  ASSERT_EQ(spheres.size(), 16U);
  EXPECT_NEAR(spheres[0].radius, 0.05, 1e-8);
  EXPECT_NEAR(spheres[0].center[0], 0.05, 1e-8);
  EXPECT_NEAR(spheres[7].center[2], 0.075, 1e-8);
  EXPECT_NEAR(spheres[8].radius, 0.015, 1e-8);
  EXPECT_NEAR(spheres[8].center[1], 0.015, 1e-8);
  EXPECT_NEAR(spheres[15].center[1], 0.11, 1e-8);
}

TEST(PublishedSpheres, MissTheTopOfSlenderCylinders) {
  CollectionObject slender = object(SphereTechnique::kUprightCylinder);
  slender.box_min = {-0.02, -0.02, 0};
  slender.box_max = {0.02, 0.02, 0.3};
  double top = 0;
  for (const HandSphere& sphere : publishedSpheres(slender, kRadii)) {
    top = std::max(top, sphere.center[2] + sphere.radius);
  }
  EXPECT_LT(top, 0.15) << "the published rule counts its rings along x";
}

TEST(PublishedSpheres, StayInTheBoxOrAtItsMiddle) {
  for (const auto technique : {SphereTechnique::kBox, SphereTechnique::kUprightCylinder}) {
    const CollectionObject thing = object(technique);
    const auto spheres = publishedSpheres(thing, kRadii);
    ASSERT_FALSE(spheres.empty());
    for (const HandSphere& sphere : spheres) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_GE(sphere.center[axis] - sphere.radius, thing.box_min[axis] - 1e-9);
        EXPECT_LE(sphere.center[axis] + sphere.radius, thing.box_max[axis] + 1e-9);
      }
    }
  }
  // Too thin for the smallest radius: nothing.
  CollectionObject card = object(SphereTechnique::kBox);
  card.box_max[2] = 0.02;
  EXPECT_TRUE(publishedSpheres(card, kRadii).empty());
}

constexpr const char* kPublished = "galactic/data/replicacad_composite.collection.json";

TEST(PublishedSpheres, AreAsManyAsThePublishedSimulatorMakes) {
  if (!hasAsset(kPublished)) GTEST_SKIP() << "no asset " << kPublished;
  const auto collection = bake::readCollection(assetsFolder() / kPublished);
  ASSERT_TRUE(collection.has_value()) << collection.error().message;
  // Counted with an independent implementation of the rule, in floats.
  const std::map<std::string, std::size_t> counts{
      {"robotProxy", 106},         {"024_bowl", 18},
      {"003_cracker_box", 40},     {"010_potted_meat_can", 12},
      {"002_master_chef_can", 20}, {"004_sugar_box", 24},
      {"005_tomato_soup_can", 8},  {"009_gelatin_box", 12},
      {"008_pudding_box", 24},     {"007_tuna_fish_can", 8}};
  EXPECT_EQ(collection->objects.size(), counts.size());
  for (const CollectionObject& one : collection->objects) {
    SCOPED_TRACE(one.name);
    ASSERT_TRUE(counts.contains(one.name));
    EXPECT_EQ(publishedSpheres(one, kRadii).size(), counts.at(one.name));
  }
}

}  // namespace
}  // namespace galactic::test::collection_shape_test
