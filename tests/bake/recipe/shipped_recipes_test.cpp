// The recipes in packs/robots fit their robots, where those are at hand.
#include <gmock/gmock.h>

#include <cmath>
#include <ostream>

#include "galactic/bake/robot_import.h"
#include "galactic/bake/robot_recipe.h"
#include "recipe/collection_import.h"
#include "support/asset_mesh.h"
#include "support/build_paths.h"

namespace galactic::test::shipped_recipes_test {
namespace {

struct Shipped {
  const char* name;
  const char* urdf;
  std::size_t joints;
};

std::ostream& operator<<(std::ostream& out, const Shipped& shipped) { return out << shipped.name; }

class ShippedRecipes : public testing::TestWithParam<Shipped> {
 protected:
  [[nodiscard]] static Result<bake::RobotRecipe> read() {
    const std::filesystem::path folder = test::sourceFolder() / "packs/robots";
    return bake::readRobotRecipe(folder / (std::string(GetParam().name) + ".toml"));
  }
};

TEST_P(ShippedRecipes, Read) {
  const auto recipe = read();
  ASSERT_TRUE(recipe.has_value()) << recipe.error().text();
  EXPECT_EQ(recipe->name, GetParam().name);
  EXPECT_EQ(recipe->joints.size(), GetParam().joints);
  EXPECT_TRUE(recipe->camera.has_value());
}

TEST_P(ShippedRecipes, FitTheirRobot) {
  if (!hasAsset(GetParam().urdf)) GTEST_SKIP() << "no asset " << GetParam().urdf;
  const auto recipe = read();
  const auto robot = bake::importRobot(assetsFolder() / GetParam().urdf);
  ASSERT_TRUE(recipe.has_value());
  ASSERT_TRUE(robot.has_value()) << robot.error().text();
  const auto checked = bake::checkRecipe(*recipe, *robot);
  EXPECT_TRUE(checked.has_value()) << checked.error().text();
}

INSTANTIATE_TEST_SUITE_P(
    Robots, ShippedRecipes,
    testing::Values(
        Shipped{"fetch", "robots/fetch/fetch_description/robots/fetch.urdf", 7},
        Shipped{"stretch", "robots/stretch/SE3/stretch_description_SE3_eoa_wrist_dw3_tool_sg3.urdf",
                8},
        Shipped{"spot", "robots/galactic_URDF/spot_arm/urdf/spot_arm.urdf", 7}),
    [](const auto& shipped) { return shipped.param.name; });

constexpr const char* kPublished = "galactic/data/replicacad_composite.collection.json";
constexpr const char* kPublishedFetch = "robots/galactic_URDF/opt_fetch/robots/fetch.urdf";
/// A turn of 5 degrees is published as 0.0873.
constexpr double kPublishedDigits = 1e-4;

TEST(TheFetchRecipe, IsThePublishedOne) {
  if (!hasAsset(kPublished) || !hasAsset(kPublishedFetch)) {
    GTEST_SKIP() << "no asset " << kPublished;
  }
  const auto ours = bake::readRobotRecipe(test::sourceFolder() / "packs/robots/fetch.toml");
  const auto collection = bake::readCollection(assetsFolder() / kPublished);
  bake::RobotImportOptions options;
  options.allow_missing = true;
  const auto robot = bake::importRobot(assetsFolder() / kPublishedFetch, options);
  ASSERT_TRUE(ours.has_value() && collection.has_value() && robot.has_value());
  const auto published = bake::recipeFromCollection(*collection, *robot);
  ASSERT_TRUE(published.has_value()) << published.error().message;
  const bake::RobotRecipe& theirs = published->recipe;
  EXPECT_EQ(ours->end_effector.link.name, theirs.end_effector.link.name);
  EXPECT_EQ(ours->end_effector.grasp_point, theirs.end_effector.grasp_point);
  EXPECT_EQ(ours->end_effector.grasp_radius, theirs.end_effector.grasp_radius);
  EXPECT_NEAR(ours->base.turn_step, theirs.base.turn_step, kPublishedDigits);
  EXPECT_EQ(ours->base.forward_step, theirs.base.forward_step);
  ASSERT_EQ(ours->joints.size(), theirs.joints.size());
  for (std::size_t i = 0; i < theirs.joints.size(); ++i) {
    EXPECT_EQ(ours->joints[i].joint.name, theirs.joints[i].joint.name);
    EXPECT_EQ(ours->joints[i].step, theirs.joints[i].step);
  }
  ASSERT_TRUE(ours->camera && theirs.camera);
  EXPECT_EQ(ours->camera->link.name, theirs.camera->link.name);
  for (std::size_t i = 0; i < 12; ++i) {
    EXPECT_NEAR(ours->camera->link_from_camera[i], theirs.camera->link_from_camera[i], 1e-12);
  }
}

}  // namespace
}  // namespace galactic::test::shipped_recipes_test
