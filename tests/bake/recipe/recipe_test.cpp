// What a recipe's text becomes.
#include <gmock/gmock.h>

#include <numbers>

#include "bake/recipe/recipe_helpers.h"
#include "support/text/nearest_name.h"

namespace galactic::test::recipe_test {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::Pointwise;

/// Sines and cosines of degrees.
constexpr double kRounding = 1e-12;
constexpr double kDegree = std::numbers::pi / 180;

TEST(RecipeTemplate, ReadsAsARecipeWithEveryKey) {
  const ScratchFolder folder;
  const auto recipe = bake::readRobotRecipe(folder.write("r.toml", bake::describeRobotRecipe()));
  ASSERT_TRUE(recipe.has_value()) << recipe.error().text();
  EXPECT_EQ(recipe->name, "fetch");
  EXPECT_EQ(recipe->end_effector.link.name, "gripper_link");
  ASSERT_TRUE(recipe->camera.has_value());
  EXPECT_TRUE(recipe->laser.has_value());
  EXPECT_EQ(recipe->joints.size(), 1U);
  EXPECT_EQ(recipe->limits.size(), 1U);
  EXPECT_EQ(recipe->start_pose.size(), 1U);
  EXPECT_EQ(recipe->spheres.links.size(), 1U);
  EXPECT_EQ(recipe->ignored_pairs.size(), 1U);
}

TEST(RecipeTemplate, ShowsWhatExcludesAnotherKeyAsAComment) {
  const ScratchFolder folder;
  const std::string text = bake::describeRobotRecipe();
  std::size_t alternatives = 0;
  for (const char* key :
       {"footprint_rectangle", "max_spheres", "skip", "merge_with_parent", "spheres"}) {
    SCOPED_TRACE(key);
    std::string changed = text;
    const std::size_t comment = changed.find("\n# " + std::string(key) + " = ");
    ASSERT_NE(comment, std::string::npos);
    changed.erase(comment + 1, 2);
    const auto recipe = bake::readRobotRecipe(folder.write("r.toml", changed));
    ASSERT_FALSE(recipe.has_value());
    EXPECT_THAT(recipe.error().message, testing::HasSubstr("keep one of")) << changed;
    ++alternatives;
  }
  EXPECT_EQ(alternatives, 5U);
}

TEST(RecipeTemplate, ShowsTheDefaults) {
  const ScratchFolder folder;
  const auto shown = bake::readRobotRecipe(folder.write("r.toml", bake::describeRobotRecipe()));
  const auto least = readText(folder, kLeastRecipe);
  ASSERT_TRUE(shown.has_value() && least.has_value());
  EXPECT_EQ(shown->spheres.eps, least->spheres.eps);
  EXPECT_EQ(shown->spheres.tau, least->spheres.tau);
  EXPECT_EQ(shown->spheres.max_spheres, least->spheres.max_spheres);
  EXPECT_EQ(shown->spheres.clip_height, least->spheres.clip_height);
  EXPECT_EQ(shown->end_effector.grasp_radius, least->end_effector.grasp_radius);
  EXPECT_EQ(shown->base.forward_step, least->base.forward_step);
  EXPECT_EQ(shown->base.root_height, least->base.root_height);
}

TEST(Recipes, OfTheLeastLengthTakeDefaults) {
  const ScratchFolder folder;
  const auto recipe = readText(folder, kLeastRecipe);
  ASSERT_TRUE(recipe.has_value()) << recipe.error().message;
  EXPECT_FALSE(recipe->camera.has_value());
  EXPECT_EQ(recipe->base.forward_step, 0.1);
  EXPECT_EQ(recipe->base.turn_step, 0.0873);
  EXPECT_EQ(recipe->base.sideways_step, 0);
  EXPECT_TRUE(recipe->joints.empty());
}

TEST(Recipes, AreConvertedFromTheFrameOfTheUrdf) {
  const ScratchFolder folder;
  const auto recipe = readText(folder, R"(name = "r"
[end_effector]
link = "hand"
grasp_point = [1, 2, 3]
[base]
footprint_rectangle = [-1, -2, 3, 4]
turn_step_degrees = 90
[camera]
link = "head"
position = [1, 2, 3]
rpy_degrees = [0, 30, 90]
vertical_fov_degrees = 60
[laser]
link = "base"
position = [1, 2, 3]
rpy_degrees = [0, 0, 90]
fov_degrees = 180
range = 6
min_range = 0.5
noise = 0.25
[spheres.links.hand]
spheres = [[1, 2, 3, 0.05]]
)");
  ASSERT_TRUE(recipe.has_value()) << recipe.error().message;
  EXPECT_THAT(recipe->end_effector.grasp_point, ElementsAre(1, 3, -2));
  const auto* footprint = std::get_if<bake::FootprintRectangle>(&recipe->base.footprint);
  ASSERT_NE(footprint, nullptr);
  EXPECT_EQ(footprint->min_x, -1);
  EXPECT_EQ(footprint->max_x, 3);
  EXPECT_EQ(footprint->min_z, -4);
  EXPECT_EQ(footprint->max_z, 2);
  EXPECT_NEAR(recipe->base.turn_step, 90 * kDegree, kRounding);
  ASSERT_TRUE(recipe->camera.has_value());
  EXPECT_NEAR(recipe->camera->vertical_fov, 60 * kDegree, kRounding);
  // Turned to the left, which is -Z, and down by 30 degrees.
  const bake::Affine& pose = recipe->camera->link_from_camera;
  EXPECT_THAT((std::array{pose[0], pose[4], pose[8]}),
              Pointwise(DoubleNear(kRounding), std::array{0.0, -0.5, -std::numbers::sqrt3 / 2}));
  EXPECT_THAT((std::array{pose[1], pose[5], pose[9]}),
              Pointwise(DoubleNear(kRounding), std::array{0.0, std::numbers::sqrt3 / 2, -0.5}));
  EXPECT_THAT((std::array{pose[3], pose[7], pose[11]}), ElementsAre(1, 3, -2));
  ASSERT_TRUE(recipe->laser.has_value());
  const bake::RecipeLaser& laser = *recipe->laser;
  EXPECT_NEAR(laser.field_of_view, 180 * kDegree, kRounding);
  EXPECT_EQ(laser.range, 6);
  EXPECT_EQ(laser.least_range, 0.5);
  EXPECT_EQ(laser.noise, 0.25);
  const bake::Affine& mount = laser.link_from_laser;
  EXPECT_THAT((std::array{mount[0], mount[4], mount[8]}),
              Pointwise(DoubleNear(kRounding), std::array{0.0, 0.0, -1.0}));
  EXPECT_THAT((std::array{mount[3], mount[7], mount[11]}), ElementsAre(1, 3, -2));
  EXPECT_EQ(recipe->spheres.links.at(0).spheres.at(0),
            (bake::HandSphere{.center = {1, 3, -2}, .radius = 0.05}));
}

TEST(Recipes, TurnACameraOnAnOpticalFrameToLookAlongItsZ) {
  const ScratchFolder folder;
  std::string text(kLeastRecipe);
  text += "[camera]\nlink = \"optical\"\nrpy_degrees = [90, -90, 0]\nvertical_fov_degrees = 60\n";
  const auto recipe = readText(folder, text);
  ASSERT_TRUE(recipe.has_value()) << recipe.error().message;
  const bake::Affine& pose = recipe->camera->link_from_camera;
  // An optical frame's Z (forward) is +Y here, its -Y (up in the image) is +Z.
  EXPECT_THAT((std::array{pose[0], pose[4], pose[8]}),
              Pointwise(DoubleNear(kRounding), std::array{0.0, 1.0, 0.0}));
  EXPECT_THAT((std::array{pose[1], pose[5], pose[9]}),
              Pointwise(DoubleNear(kRounding), std::array{0.0, 0.0, 1.0}));
}

TEST(Recipes, KeepTheOrderOfJointsAndTheirRanges) {
  const ScratchFolder folder;
  const auto recipe =
      readText(folder, std::string(kLeastRecipe) +
                           "[[joints]]\nname = \"z\"\nstep = 0.2\n"
                           "[[joints]]\nname = \"a\"\nstep = 1\nmin = -1\nmax = 2\n");
  ASSERT_TRUE(recipe.has_value()) << recipe.error().message;
  ASSERT_EQ(recipe->joints.size(), 2U);
  EXPECT_EQ(recipe->joints[0].joint.name, "z");
  EXPECT_EQ(recipe->joints[0].step, 0.2);
  EXPECT_FALSE(recipe->joints[0].min.has_value());
  EXPECT_EQ(recipe->joints[1].min, -1);
  EXPECT_EQ(recipe->joints[1].max, 2);
  EXPECT_THAT(recipe->joints[1].joint.where, testing::EndsWith("r.toml:10"));
}

TEST(Suggestions, NameTheNearestInTheOrderOfDistance) {
  const std::vector<std::string> known{"elbow_flex_link", "elbow_flix_lnk", "wrist_link"};
  EXPECT_EQ(suggestNames("elbow_flx_link", known),
            "did you mean 'elbow_flex_link' or 'elbow_flix_lnk'?");
  EXPECT_EQ(suggestNames("ELBOW_FLEX_LINK", known),
            "did you mean 'elbow_flex_link' or 'elbow_flix_lnk'?");
  EXPECT_EQ(suggestNames("camera", known),
            "known are 'elbow_flex_link', 'elbow_flix_lnk', 'wrist_link'");
  EXPECT_EQ(suggestNames("x", {}), "there are none");
}

}  // namespace
}  // namespace galactic::test::recipe_test
