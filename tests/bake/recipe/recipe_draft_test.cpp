// Drafts of recipes are read back, fit their robots, and bake.
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "bake/recipe/recipe_helpers.h"
#include "bake/robot/tiny_robots.h"
#include "galactic/bake/robot_baker.h"
#include "galactic/bake/robot_import.h"
#include "support/assets.h"
#include "support/build_paths.h"

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

TEST(RecipeDraft, TakesWhatTheFileCallsACameraBeforeNames) {
  SourceRobot robot = twoArms("left_finger", "right_finger");
  bake::SourceLink& eye = robot.links[robot.links.size() - 2];
  ASSERT_EQ(eye.name, "head");
  eye.is_camera = true;
  EXPECT_EQ(draftOf(robot).camera->link.name, "head");
  // Its axes are no optical frame's, whatever it is called.
  eye.name = "optical_eye";
  const RobotRecipe recipe = draftOf(robot);
  EXPECT_EQ(recipe.camera->link.name, "optical_eye");
  eye.name = "eye";
  EXPECT_EQ(draftOf(robot).camera->link_from_camera, recipe.camera->link_from_camera);
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

/// A lift that carries the stages of a telescope, with a hand at their end.
SourceRobot telescope(const std::vector<JointFields>& stages) {
  RobotMaker maker("telescope");
  maker.link("base").box({0.6, 0.2, 0.4});
  maker.link("lift", 0, {.type = JointType::kPrismatic, .limits = JointLimits{0, 1.1}});
  for (std::size_t n = 0; n < stages.size(); ++n) {
    maker.link("stage" + std::to_string(n), static_cast<int>(n) + 1, stages[n]);
  }
  return maker.link("hand", static_cast<int>(stages.size()) + 1).robot();
}

JointFields stage(JointLimits limits, const std::array<double, 3>& axis = {0, 0, 1}) {
  return {.type = JointType::kPrismatic, .axis = axis, .limits = limits};
}

TEST(RecipeDraft, MovesTheStagesOfATelescopeByOneAction) {
  const SourceRobot robot =
      telescope({stage({0, 0.13}), stage({0, 0.13}), stage({0, 0.13}), stage({0, 0.13})});
  const RobotRecipe recipe = draftOf(robot);
  EXPECT_THAT(namesOf(recipe.joints), ElementsAre("lift_joint", "stage0_joint"));
  EXPECT_NEAR(recipe.joints[1].step, 0.05 / 4, 1e-9) << "the hand moves four times as far";
  ASSERT_EQ(recipe.mimics.size(), 3U);
  for (const bake::RecipeMimic& mimic : recipe.mimics) {
    EXPECT_EQ(mimic.leader.name, "stage0_joint");
    EXPECT_EQ(mimic.multiplier, 1);
  }
  EXPECT_EQ(recipe.start_pose.size(), 2U) << "followers start nowhere of their own";
  const auto baked = bakeQuickly(robot, &recipe);
  ASSERT_TRUE(baked.has_value()) << baked.error().text();
  EXPECT_EQ(baked->controlled_joints.size(), 2U);
  EXPECT_EQ(baked->kinematics.limits.size(), 2U) << "a lift and one value for all stages";
  EXPECT_EQ(baked->kinematics.links[5].position, baked->kinematics.links[2].position);
}

TEST(RecipeDraft, CouplesNoJointsThatOnlyLookLikeATelescope) {
  const std::vector<std::string> both{"lift_joint", "stage0_joint", "stage1_joint"};
  for (const JointFields& second :
       {stage({0, 0.2}), stage({0, 0.13}, {1, 0, 0}), stage({0, 0.13}, {0, 0, -1})}) {
    const RobotRecipe recipe = draftOf(telescope({stage({0, 0.13}), second}));
    EXPECT_EQ(namesOf(recipe.joints), both);
    EXPECT_THAT(recipe.mimics, IsEmpty());
  }
}

TEST(RecipeDraft, LeavesJointsWithLimitsThatStandForNoneToPeople) {
  SourceRobot robot = telescope({stage({0, 0.13})});
  robot.links[1].joint_type = JointType::kRevolute;
  robot.links[1].limits = JointLimits{-1e6, 1e6};
  EXPECT_THAT(namesOf(draftOf(robot).joints), ElementsAre("stage0_joint"));
  EXPECT_THAT(bake::draftRobotRecipe(robot),
              HasSubstr("# 'lift_joint' leads to 'hand', too, but its limits of -1e+06 to 1e+06 "
                        "stand for none: no\n"));
}

TEST(RecipeDraft, ListsFingersWhoseLimitsLetThemMoveNowhere) {
  SourceRobot robot = telescope({stage({0, 0.13})});
  RobotMaker fingers;
  fingers.link("base").link("finger", 0,
                            {.type = JointType::kRevolute, .limits = JointLimits{0, 0}});
  robot.links.push_back(fingers.robot().links.back());
  robot.links.back().parent = 3;
  const std::string text = bake::draftRobotRecipe(robot);
  EXPECT_THAT(text, HasSubstr("# \"finger_joint\" = [0, 0.5]\n"));
  EXPECT_THAT(text, HasSubstr("# \"finger_joint\" = 0.25   # with limits in [limits]\n"));
  // As comments they change nothing; without the signs they open the hand.
  EXPECT_THAT(draftOf(robot).limits, IsEmpty());
  std::string opened = text;
  for (auto at = opened.find("# \"finger"); at != std::string::npos;
       at = opened.find("# \"finger")) {
    opened.erase(at, 2);
  }
  const ScratchFolder folder;
  const auto recipe = readText(folder, opened);
  ASSERT_TRUE(recipe.has_value()) << recipe.error().text();
  const auto baked = bakeQuickly(robot, &*recipe);
  ASSERT_TRUE(baked.has_value()) << baked.error().text();
  EXPECT_EQ(baked->kinematics.start_positions.back(), 0.25F);
  EXPECT_THAT(baked->warnings, testing::Each(testing::Not(HasSubstr("cannot move"))));
}

TEST(RecipeDraft, TurnsACameraThatLiesOnItsSideUpright) {
  // Turned about the forward axis: by how much, and the roll that turns it back.
  const double right = std::numbers::pi / 2;
  for (const auto& [turn, roll] :
       {std::pair{0.0, 0}, {0.3, 0}, {right, -90}, {-right, 90}, {2 * right, 180}}) {
    for (const char* name : {"camera", "camera_optical"}) {
      // An optical frame has its Z axis, up in the runtime's frame, along the view.
      const double c = std::cos(turn);
      const double s = std::sin(turn);
      const bake::Affine looking{1, 0, 0, 0, 0, c, -s, 1, 0, s, c, 0};
      // Columns: where X, Y and Z of the link's frame are. Its Y is the view, its Z is up.
      const bake::Affine optical{0, 1, 0, 0, -s, 0, c, 1, c, 0, s, 0};
      const bool is_optical = std::string(name) == "camera_optical";
      const SourceRobot robot =
          RobotMaker()
              .link("base")
              .box({1, 1, 1})
              .link(name, 0, {.parent_from_joint = is_optical ? optical : looking})
              .robot();
      const RobotRecipe recipe = draftOf(robot);
      ASSERT_TRUE(recipe.camera.has_value());
      // The camera's Y axis is up in the image.
      const bake::Affine& mount = recipe.camera->link_from_camera;
      const bake::Affine& link = robot.links[1].parent_from_joint;
      const double up = link[4] * mount[1] + link[5] * mount[5] + link[6] * mount[9];
      const double forward = link[0] * mount[0] + link[1] * mount[4] + link[2] * mount[8];
      EXPECT_NEAR(up, std::abs(turn) == 0.3 ? std::cos(0.3) : 1, 1e-6) << name << " by " << turn;
      EXPECT_NEAR(forward, 1, 1e-6) << name << " by " << turn;
      EXPECT_EQ(bake::draftRobotRecipe(robot).find("At the start pose its image would") ==
                    std::string::npos,
                roll == 0);
    }
  }
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
  bake::RobotImportOptions options;
  options.allow_missing = true;
  int baked = 0;
  for (const std::filesystem::path& urdf : knownUrdfs()) {
    const auto robot = bake::importRobot(urdf, options);
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
