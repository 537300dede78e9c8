// The tree of a robot as the runtime reads it: positions, mimics, limits and the start pose.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "bake/robot/tiny_robots.h"
#include "robot/robot_parts.h"

namespace galactic::test::flat_kinematics_test {
namespace {

using bake::FlatKinematics;
using bake::flattenKinematics;
using bake::JointLimits;
using testing::ElementsAre;

constexpr float kUnlimited = std::numeric_limits<float>::max();

TEST(FlatKinematics, GivesEachJointItsPositionsInTheOrderOfTheLinks) {
  const RobotMaker maker =
      RobotMaker()
          .link("base")
          .link("fixed", 0)
          .link("lift", 0, {.type = JointType::kPrismatic, .limits = JointLimits{0.25, 1}})
          .link("tray", 0, {.type = JointType::kPlanar})
          .link("wheel", 2, {.type = JointType::kContinuous})
          .link("ball", 2, {.type = JointType::kFloating})
          .link("arm", 2, {.type = JointType::kRevolute, .limits = JointLimits{-2, -0.5}});
  const FlatKinematics flat = flattenKinematics(maker.robot(), nullptr);
  std::vector<std::int32_t> positions;
  for (const LinkFrame& link : flat.links) positions.push_back(link.position);
  EXPECT_THAT(positions, ElementsAre(-1, -1, 0, 1, 4, 5, 12));
  ASSERT_EQ(flat.limits.size(), 13U);
  EXPECT_EQ(flat.limits[0].lower, 0.25F);
  EXPECT_EQ(flat.limits[0].upper, 1);
  for (std::size_t n = 1; n < 12; ++n) {
    EXPECT_EQ(flat.limits[n].lower, -kUnlimited);
    EXPECT_EQ(flat.limits[n].upper, kUnlimited);
  }
  // At 0, or at the limit nearest to it; the floating joint's quaternion is no rotation.
  EXPECT_THAT(flat.start_positions, ElementsAre(0.25F, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, -0.5F));
}

TEST(FlatKinematics, LetsMimicsReadThePositionOfTheirLeaderWhereverItStands) {
  RobotMaker maker;
  maker.link("base").link("follower", 0, {.type = JointType::kRevolute}).mimic(2, -2, 0.5);
  maker.link("leader", 0, {.type = JointType::kRevolute, .limits = JointLimits{-1, 1}});
  const FlatKinematics flat = flattenKinematics(maker.robot(), nullptr);
  ASSERT_EQ(flat.limits.size(), 1U);
  EXPECT_EQ(flat.links[1].position, 0);
  EXPECT_EQ(flat.links[2].position, 0);
  EXPECT_EQ(flat.links[1].multiplier, -2);
  EXPECT_EQ(flat.links[1].offset, 0.5F);
  EXPECT_EQ(flat.links[2].multiplier, 1);
  EXPECT_EQ(flat.links[2].offset, 0);
}

TEST(FlatKinematics, HoldsLimitsBeyondAllFloatsAtTheLargest) {
  const RobotMaker maker = RobotMaker().link("base").link(
      "arm", 0, {.type = JointType::kRevolute, .limits = JointLimits{-1e300, 1e40}});
  const FlatKinematics flat = flattenKinematics(maker.robot(), nullptr);
  EXPECT_EQ(flat.limits[0].lower, -kUnlimited);
  EXPECT_EQ(flat.limits[0].upper, kUnlimited);
  EXPECT_EQ(flat.start_positions[0], 0);
}

TEST(FlatKinematics, IgnoresLimitsOfPlanarAndFloatingJoints) {
  const RobotMaker maker = RobotMaker().link("base").link(
      "tray", 0, {.type = JointType::kPlanar, .limits = JointLimits{1, 2}});
  const FlatKinematics flat = flattenKinematics(maker.robot(), nullptr);
  for (const PositionLimits& limits : flat.limits) EXPECT_EQ(limits.upper, kUnlimited);
  EXPECT_THAT(flat.start_positions, ElementsAre(0, 0, 0));
}

bake::SourceRobot twoJoints() {
  return RobotMaker()
      .link("base")
      .link("a", 0, {.type = JointType::kRevolute, .limits = JointLimits{-1, 1}})
      .link("b", 0, {.type = JointType::kContinuous})
      .robot();
}

TEST(FlatKinematics, StartsWhereTheRecipeSays) {
  bake::RobotRecipe recipe = recipeFor("b");
  recipe.start_pose = {{{"b_joint", ""}, 3}, {{"a_joint", ""}, -0.5}};
  EXPECT_THAT(flattenKinematics(twoJoints(), &recipe).start_positions, ElementsAre(-0.5F, 3));
}

TEST(FlatKinematics, StartsInsideTheNarrowerLimitsOfTheRecipe) {
  bake::RobotRecipe recipe = recipeFor("b");
  recipe.joints = {{.joint = {"a_joint", ""}, .step = 0.1, .min = 0.25, .max = 0.75},
                   {.joint = {"b_joint", ""}, .step = 0.1, .min = {}, .max = -2}};
  EXPECT_THAT(flattenKinematics(twoJoints(), &recipe).start_positions, ElementsAre(0.25F, -2));
  recipe.start_pose = {{{"a_joint", ""}, 0.5}};
  EXPECT_THAT(flattenKinematics(twoJoints(), &recipe).start_positions, ElementsAre(0.5F, -2));
}

TEST(PoseOf, GivesTheUnitQuaternionWithPositiveRealPart) {
  // A third of a turn about (1, 1, 1), which takes X to Y and Y to Z, and its opposite.
  const Pose pose = bake::poseOf({0, 0, 1, 1, 1, 0, 0, 2, 0, 1, 0, 3});
  EXPECT_EQ(pose.translation, (Vec3{1, 2, 3}));
  for (const float part : {pose.rotation.x, pose.rotation.y, pose.rotation.z, pose.rotation.w}) {
    EXPECT_FLOAT_EQ(part, 0.5F);
  }
  const Pose back = bake::poseOf({0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0});
  EXPECT_FLOAT_EQ(back.rotation.w, 0.5F);
  EXPECT_FLOAT_EQ(back.rotation.x, -0.5F);
}

}  // namespace
}  // namespace galactic::test::flat_kinematics_test
