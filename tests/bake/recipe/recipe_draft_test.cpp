// Drafts of recipes are read back, fit their robots, and bake.
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "bake/recipe/recipe_helpers.h"
#include "bake/robot/tiny_robots.h"
#include "galactic/bake/robot_baker.h"
#include "galactic/bake/urdf_import.h"
#include "support/assets.h"
#include "support/source_folder.h"

namespace galactic::test::recipe_draft_test {
namespace {

using bake::JointLimits;
using bake::RobotRecipe;
using bake::SourceRobot;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

/// The draft of a robot, read back; it fits.
RobotRecipe draftOf(const SourceRobot& robot) {
  const ScratchFolder folder;
  const std::string text = bake::draftRobotRecipe(robot);
  const auto recipe = readText(folder, text);
  EXPECT_TRUE(recipe.has_value()) << recipe.error().text() << "\n" << text;
  if (!recipe) return {};
  const auto fits = bake::checkRecipe(*recipe, robot);
  EXPECT_TRUE(fits.has_value()) << fits.error().text() << "\n" << text;
  return *recipe;
}

/// Bakes without the fit of spheres, which takes its time and sees nothing of a recipe but numbers.
Result<bake::BakedRobot> bakeQuickly(const SourceRobot& robot, const RobotRecipe* recipe) {
  bake::RobotBakeOptions options;
  options.hand_spheres =
      bake::HandSpheres{.links = {{robot.links.front().name, {{{0, 0, 0}, 0.05}}}}, .warnings = {}};
  return bake::bakeRobot(robot, recipe, options);
}

std::vector<std::string> namesOf(const std::vector<bake::RecipeJoint>& joints) {
  std::vector<std::string> names;
  for (const bake::RecipeJoint& joint : joints) names.push_back(joint.joint.name);
  return names;
}

/// As simulators know mobile manipulators: a base on rails from a virtual world, an arm with a
/// gripper whose second finger follows the first, a wheel, a camera; limits are missing.
SourceRobot railedArm() {
  const JointFields rail{.type = JointType::kPrismatic, .limits = JointLimits{-1, 1}};
  const JointFields hinge{.type = JointType::kRevolute, .limits = JointLimits{0.5, 2}};
  SourceRobot robot =
      RobotMaker("railed")
          .link("world")
          .link("base", 0, rail)
          .box({0.6, 0.2, 0.4}, shifted(0, -0.3, 0))
          .link("wheel", 1, {.type = JointType::kContinuous})
          .link("shoulder", 1, hinge)
          .box({0.1, 0.8, 0.1}, shifted(0, 0.4, 0))
          .link("elbow", 3,
                {.type = JointType::kContinuous, .parent_from_joint = shifted(0, 0.8, 0)})
          .link("locked", 4, {.type = JointType::kRevolute, .limits = JointLimits{1, 1}})
          .link("lift", 5, rail)
          .link("Gripper_Link", 6)
          .link("finger", 7, rail)
          .mimic(6, 1, 0)
          .link("head_camera_optical_frame", 1, {.type = JointType::kContinuous})
          .link("base_laser", 1)
          .robot();
  robot.links[1].limits_are_assumed = true;
  robot.links[6].limits_are_assumed = true;
  return robot;
}

TEST(RecipeDraft, FindsWhatGraspsSeesAndMoves) {
  const RobotRecipe recipe = draftOf(railedArm());
  EXPECT_EQ(recipe.name, "railed");
  EXPECT_EQ(recipe.end_effector.link.name, "Gripper_Link");
  EXPECT_THAT(namesOf(recipe.joints), ElementsAre("shoulder_joint", "elbow_joint", "lift_joint"))
      << "neither rails of the base, nor wheels, nor what cannot move";
  ASSERT_TRUE(recipe.camera.has_value());
  EXPECT_EQ(recipe.camera->link.name, "head_camera_optical_frame");
  EXPECT_FALSE(recipe.laser.has_value()) << "only a comment";
  const auto* circle = std::get_if<bake::FootprintCircle>(&recipe.base.footprint);
  ASSERT_NE(circle, nullptr);
  EXPECT_NEAR(circle->radius, std::hypot(0.3, 0.2), 1e-3) << "the base box, not the arm";
  EXPECT_NEAR(recipe.base.root_height, 0.4, 1e-3) << "the lowest point touches the ground";
  ASSERT_EQ(recipe.limits.size(), 2U);
  EXPECT_EQ(recipe.limits[0].joint.name, "base_joint");
  ASSERT_EQ(recipe.start_pose.size(), 3U);
  for (const bake::RecipeStart& start : recipe.start_pose) {
    EXPECT_EQ(start.position, start.joint.name == "shoulder_joint" ? 0.5 : 0);
  }
}

TEST(RecipeDraft, TakesTheLongestChainWhereNoNameHelps) {
  const JointFields turning{.type = JointType::kContinuous};
  const SourceRobot robot = RobotMaker()
                                .link("a")
                                .box({0.1, 0.1, 0.1})
                                .link("b", 0, turning)
                                .link("c", 0, turning)
                                .link("d", 2, turning)
                                .robot();
  const RobotRecipe recipe = draftOf(robot);
  EXPECT_EQ(recipe.end_effector.link.name, "d");
  EXPECT_THAT(namesOf(recipe.joints), ElementsAre("c_joint", "d_joint"));
  EXPECT_FALSE(recipe.camera.has_value());
}

/// A base with a head, a left arm with a hand of two fingers, a right arm and a wheel.
SourceRobot twoArms(const std::string& left_finger, const std::string& right_finger) {
  const JointFields hinge{.type = JointType::kRevolute, .limits = JointLimits{-1, 1}};
  const JointFields slide{.type = JointType::kPrismatic,
                          .parent_from_joint = shifted(0, 0, 0.2),
                          .limits = JointLimits{0, 0.04}};
  return RobotMaker("two arms")
      .link("base")
      .box({0.6, 0.2, 0.4})
      .link("left_arm", 0, hinge)
      .box({2, 0.1, 0.1})
      .link("palm", 1, hinge)
      .box({0.1, 0.1, 0.1})
      .link(left_finger, 2, slide)
      .box({0.02, 0.1, 0.02})
      .link(right_finger, 2, slide)
      .mimic(3, 1, 0)
      .link("palm_camera", 2)
      .link("right_arm", 0, hinge)
      .link("wheel", 0, {.type = JointType::kContinuous})
      .link("head", 0, hinge)
      .link("head_camera", 8)
      .robot();
}

TEST(RecipeDraft, GraspsWithTheHandAndNotWithAFinger) {
  for (const auto& [left, right] :
       {std::pair{"left_finger", "right_finger"}, {"gripper_jaw_1", "gripper_jaw_2"}}) {
    const RobotRecipe recipe = draftOf(twoArms(left, right));
    EXPECT_EQ(recipe.end_effector.link.name, "palm");
    EXPECT_THAT(namesOf(recipe.joints), ElementsAre("left_arm_joint", "palm_joint"))
        << "no action opens the hand";
  }
}

TEST(RecipeDraft, PrefersACameraThatTheHandDoesNotCarry) {
  const SourceRobot robot = twoArms("left_finger", "right_finger");
  EXPECT_EQ(draftOf(robot).camera->link.name, "head_camera");
  SourceRobot headless = robot;
  headless.links.pop_back();
  EXPECT_EQ(draftOf(headless).camera->link.name, "palm_camera");
}

TEST(RecipeDraft, LeavesTheArmOutOfTheFootprint) {
  const RobotRecipe recipe = draftOf(twoArms("left_finger", "right_finger"));
  const auto* circle = std::get_if<bake::FootprintCircle>(&recipe.base.footprint);
  ASSERT_NE(circle, nullptr);
  EXPECT_NEAR(circle->radius, std::hypot(0.3, 0.2), 1e-3) << "the arm is as low, and 1 m long";
}

TEST(RecipeDraft, StartsAllThatStaysWhereItIsPut) {
  const RobotRecipe recipe = draftOf(twoArms("left_finger", "right_finger"));
  std::vector<std::string> names;
  for (const bake::RecipeStart& start : recipe.start_pose) names.push_back(start.joint.name);
  EXPECT_THAT(names, UnorderedElementsAre("left_arm_joint", "palm_joint", "left_finger_joint",
                                          "right_arm_joint", "head_joint"))
      << "neither wheels nor the finger that follows";
}

TEST(RecipeDraft, GraspsInFrontOfAllThatMovesWithTheHand) {
  const SourceRobot robot =
      RobotMaker()
          .link("base")
          .box({0.2, 0.2, 0.2})
          .link("flange", 0,
                {.type = JointType::kContinuous, .parent_from_joint = shifted(0, 0, 0.5)})
          .box({0.3, 0.3, 0.1}, shifted(0, 0, 0.05))
          .link("tool", 1)
          .link("cover", 2)
          .box({0.1, 0.1, 0.1}, shifted(0, 0, 0.1))
          .robot();
  const RobotRecipe recipe = draftOf(robot);
  EXPECT_EQ(recipe.end_effector.link.name, "tool");
  // The cover ends at 0.15 m; spheres may stick out by 0.04 m, and what grasps is one of 0.015 m.
  EXPECT_NEAR(recipe.end_effector.grasp_point[0], 0, 1e-6);
  EXPECT_NEAR(recipe.end_effector.grasp_point[1], 0, 1e-6);
  EXPECT_NEAR(recipe.end_effector.grasp_point[2], 0.205, 1e-6);
}

TEST(RecipeDraft, GraspsAtTheLinkWhereThatIsInFrontOfTheBody) {
  const auto draftWith = [](const bake::Affine& hand_from_grasp) {
    return draftOf(RobotMaker()
                       .link("base")
                       .link("hand", 0, {.type = JointType::kContinuous})
                       .box({0.1, 0.1, 0.1}, shifted(0, 0.05, 0))
                       .link("grasp", 1, {.parent_from_joint = hand_from_grasp})
                       .robot());
  };
  EXPECT_THAT(draftWith(shifted(0, 0.2, 0)).end_effector.grasp_point, ElementsAre(0, 0, 0));
  EXPECT_THAT(draftWith(kNoChange).end_effector.grasp_point, ElementsAre(0, 0, 0))
      << "nothing says where the front is";
}

TEST(RecipeDraft, OfARobotThatCannotMoveHasNoJoints) {
  const RobotRecipe recipe = draftOf(RobotMaker().link("block").box({1, 1, 1}).robot());
  EXPECT_EQ(recipe.end_effector.link.name, "block");
  EXPECT_THAT(recipe.joints, IsEmpty());
  EXPECT_THAT(draftOf(RobotMaker("").link("point").robot()).name, "robot");
}

TEST(RecipeDraft, QuotesStrangeNames) {
  SourceRobot robot = RobotMaker("a \"b\" \\ c\n# d")
                          .link("x.y")
                          .box({1, 1, 1})
                          .link("gripper = \"\x1b[2J\"", 0, {.type = JointType::kContinuous})
                          .robot();
  robot.links[1].joint_name = "[j]\t.k\n=\"";
  const RobotRecipe recipe = draftOf(robot);
  EXPECT_EQ(recipe.name, robot.name);
  EXPECT_EQ(recipe.end_effector.link.name, robot.links[1].name);
  EXPECT_THAT(namesOf(recipe.joints), ElementsAre(robot.links[1].joint_name));
  EXPECT_EQ(bake::draftRobotRecipe(robot).find('\x1b'), std::string::npos);
}

/// Every URDF below the shared assets and of the project itself.
std::vector<std::filesystem::path> knownUrdfs() {
  std::vector<std::filesystem::path> urdfs;
  for (const std::filesystem::path& root : {assetsFolder(), sourceFolder() / "packs"}) {
    std::error_code missing;
    for (auto at = std::filesystem::recursive_directory_iterator(root, missing);
         at != std::filesystem::recursive_directory_iterator(); at.increment(missing)) {
      if (at->path().extension() == ".urdf") urdfs.push_back(at->path());
    }
  }
  std::sort(urdfs.begin(), urdfs.end());
  return urdfs;
}

TEST(RecipeDraft, BakesForEveryUrdfThatBakesWithoutOne) {
  bake::UrdfImportOptions options;
  options.allow_missing = true;
  int baked = 0;
  for (const std::filesystem::path& urdf : knownUrdfs()) {
    const auto robot = bake::importUrdf(urdf, options);
    if (!robot) continue;
    const RobotRecipe recipe = draftOf(*robot);
    const auto with_draft = bakeQuickly(*robot, &recipe);
    baked += with_draft ? 1 : 0;
    if (with_draft || !bakeQuickly(*robot, nullptr)) continue;
    ADD_FAILURE() << urdf << ": " << with_draft.error().message;
  }
  EXPECT_GE(baked, 2) << "the sample's robot and the golden arm, at least";
}

}  // namespace
}  // namespace galactic::test::recipe_draft_test
