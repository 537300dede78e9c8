// What an MJCF says of joints and links beside its bodies: which follow others, where they rest,
// and which may touch.
#include <gmock/gmock.h>

#include "bake/robot_description/mjcf/mjcf_texts.h"
#include "galactic/bake/robot_baker.h"
#include "galactic/bake/robot_recipe.h"

namespace galactic::test::mjcf::couplings_test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::Pair;

/// A chain of links l0 to l4 with joints j1 to j4, and these sections behind it.
std::string chainWith(std::string_view sections, std::string_view of_joints = "") {
  std::string text = "<body name='l0'><freejoint/>";
  for (int n = 1; n <= 4; ++n) {
    text += fmt::format("<body name='l{}'><joint name='j{}' range='-90 90' {}/>", n, n, of_joints);
  }
  return mjcfText(text + "</body></body></body></body></body>", sections);
}

/// Of joint `n`: what it follows, and how.
std::optional<bake::Mimic> mimicOf(const bake::SourceRobot& robot, std::size_t n) {
  return robot.links.at(n).mimic;
}

TEST(MjcfEqualities, LetAJointFollowAnother) {
  const ScratchFolder folder;
  const auto robot =
      mjcfRobot(folder, chainWith("<equality><joint joint1='j1' joint2='j2'/>"
                                  "<joint joint1='j3' joint2='j2' polycoef='0.5 -2 0 0 0'/>"
                                  "<joint joint1='j4' joint2='j2' active='false'/></equality>"));
  ASSERT_EQ(robot.links.size(), 5U);
  ASSERT_TRUE(mimicOf(robot, 1).has_value());
  EXPECT_EQ(mimicOf(robot, 1)->link, 2U);
  EXPECT_EQ(mimicOf(robot, 1)->multiplier, 1);
  EXPECT_EQ(mimicOf(robot, 1)->offset, 0);
  ASSERT_TRUE(mimicOf(robot, 3).has_value());
  EXPECT_EQ(mimicOf(robot, 3)->multiplier, -2);
  EXPECT_EQ(mimicOf(robot, 3)->offset, 0.5);
  EXPECT_FALSE(mimicOf(robot, 2).has_value());
  EXPECT_FALSE(mimicOf(robot, 4).has_value());
}

TEST(MjcfEqualities, CountFromTheReferences) {
  const ScratchFolder folder;
  const auto robot = mjcfRobot(
      folder, chainWith("<compiler angle='radian'/>"
                        "<equality><joint joint1='j1' joint2='j2' polycoef='0 3'/></equality>",
                        "ref='0.1'"));
  ASSERT_TRUE(mimicOf(robot, 1).has_value());
  EXPECT_EQ(mimicOf(robot, 1)->multiplier, 3);
  EXPECT_NEAR(mimicOf(robot, 1)->offset, 0.1 - 0.3, 1e-15);
}

TEST(MjcfEqualities, InAChainHaveOneLeader) {
  const ScratchFolder folder;
  const auto robot =
      mjcfRobot(folder, chainWith("<equality><joint joint1='j1' joint2='j2'/>"
                                  "<joint joint1='j2' joint2='j3'/><joint joint1='j3' joint2='j4'/>"
                                  "</equality>"));
  for (const std::size_t follower : {1U, 2U, 3U}) {
    ASSERT_TRUE(mimicOf(robot, follower).has_value());
    EXPECT_EQ(mimicOf(robot, follower)->link, 4U);
  }
}

TEST(MjcfEqualities, OfAJointThatFollowsAlreadyTurnRound) {
  const ScratchFolder folder;
  const auto robot = mjcfRobot(folder, chainWith("<equality><joint joint1='j1' joint2='j2'/>"
                                                 "<joint joint1='j1' joint2='j3' polycoef='1 2'/>"
                                                 "<joint joint1='j3' joint2='j2'/></equality>"));
  // j1 = 1 + 2 j3, so j3 = j1 / 2 - 1 / 2; and j1 follows j2.
  ASSERT_TRUE(mimicOf(robot, 3).has_value());
  EXPECT_EQ(mimicOf(robot, 3)->link, 2U);
  EXPECT_EQ(mimicOf(robot, 3)->multiplier, 0.5);
  EXPECT_EQ(mimicOf(robot, 3)->offset, -0.5);
  EXPECT_THAT(robot.warnings, Contains("an <equality> couples joints 'j3' and 'j2', which others "
                                       "couple already; it is not read"));
}

TEST(MjcfEqualities, ThatAreNoStraightLinesAreWarnedOf) {
  const ScratchFolder folder;
  const auto robot = mjcfRobot(
      folder, chainWith("<equality><joint joint1='j1' joint2='j2' polycoef='0 1 2 0 0'/>"
                        "<joint joint1='j3'/><connect body1='l1' body2='l3' anchor='0 0 0'/>"
                        "<weld body1='l1' body2='l3'/></equality>"));
  EXPECT_FALSE(mimicOf(robot, 1).has_value());
  EXPECT_THAT(
      robot.warnings,
      testing::IsSupersetOf(
          {"an <equality> lets joint 'j1' follow 'j2' along a curve, which is not read: 'j1' moves "
           "by itself",
           "an <equality> holds joint 'j3' at a position and is not read; [limits] of a recipe can "
           "hold it",
           "2 <connect> or <weld> of <equality> are not read: loops of bodies stay open, and what "
           "they would move stays where its joints are"}));
}

TEST(MjcfEqualities, AreCurvesWithAnyHigherCoefficient) {
  const ScratchFolder folder;
  for (const char* curve : {"0 1 2", "0 1 0 2", "0 1 0 0 2"}) {
    const auto robot = mjcfRobot(
        folder, chainWith(fmt::format(
                    "<equality><joint joint1='j1' joint2='j2' polycoef='{}'/></equality>", curve)));
    EXPECT_FALSE(mimicOf(robot, 1).has_value()) << curve;
    EXPECT_THAT(robot.warnings, Contains(testing::HasSubstr("along a curve"))) << curve;
  }
}

TEST(MjcfKeyframes, CalledHomeSayWhereJointsRest) {
  const ScratchFolder folder;
  const auto robot = mjcfRobot(
      folder, chainWith("<keyframe><key name='other' qpos='1'/>"
                        "<key name='home' qpos='0 0 1 1 0 0 0 .1 .2 .3 .4'/></keyframe>"));
  for (std::size_t n = 1; n <= 4; ++n) {
    ASSERT_TRUE(robot.links[n].rest.has_value());
    EXPECT_EQ(*robot.links[n].rest, static_cast<double>(n) / 10);
  }
}

/// A chain whose links all overlap.
bake::SourceRobot crowdedChain(const ScratchFolder& folder) {
  std::string text = chainWith(
      "<contact><exclude body1='l1' body2='l3'/></contact>"
      "<keyframe><key name='home' qpos='0 0 1 1 0 0 0 .1 .2 .3 9'/></keyframe>");
  for (std::size_t at = text.find("<joint"); at != std::string::npos;
       at = text.find("<joint", at + 30)) {
    text.insert(at, "<geom size='.2'/>");
  }
  return mjcfRobot(folder, text);
}

/// Spheres that are as large as the links.
bake::RobotBakeOptions quickOptions() {
  bake::RobotBakeOptions options;
  options.radii = {0.2F};
  return options;
}

TEST(MjcfKeyframes, CalledHomeAreWhereRobotsAndDraftsStart) {
  const ScratchFolder folder;
  const auto robot = crowdedChain(folder);
  const auto baked = bake::bakeRobot(robot, nullptr, quickOptions());
  ASSERT_TRUE(baked.has_value()) << baked.error().text();
  // The last is beyond its limit.
  EXPECT_THAT(baked->kinematics.start_positions,
              testing::Pointwise(testing::FloatNear(1e-6F), {0.1F, 0.2F, 0.3F, 1.5707963F}));
  const std::string draft = bake::draftRobotRecipe(robot);
  EXPECT_THAT(draft, testing::HasSubstr("\n\"j2\" = 0.2 "));
  EXPECT_THAT(draft, testing::HasSubstr("\n\"j4\" = 1.5707"));
}

TEST(MjcfContacts, ThatAreExcludedAreNotTested) {
  const ScratchFolder folder;
  const auto baked = bake::bakeRobot(crowdedChain(folder), nullptr, quickOptions());
  ASSERT_TRUE(baked.has_value()) << baked.error().text();
  const auto kindOf = [&](std::uint32_t first, std::uint32_t second) {
    for (const bake::BakedPair& pair : baked->pairs) {
      const bool is_it =
          baked->groups[pair.first].link == first && baked->groups[pair.second].link == second;
      if (is_it) return pair.kind;
    }
    ADD_FAILURE() << "no pair of " << first << " and " << second;
    return PairKind::kAdjacent;
  };
  EXPECT_EQ(kindOf(1, 3), PairKind::kIgnored);
  EXPECT_NE(kindOf(1, 4), PairKind::kIgnored);
}

TEST(MjcfContacts, ThatAreExcludedMayTouch) {
  const ScratchFolder folder;
  const auto robot = mjcfRobot(folder, chainWith("<contact><exclude body1='l1' body2='l3'/>"
                                                 "<exclude body1='l1' body2='world'/></contact>"));
  EXPECT_THAT(robot.may_touch, ElementsAre(Pair(1U, 3U)));
}

TEST(MjcfJoints, WithoutARangeAreUnlimitedAndBallJointsAreHeld) {
  const ScratchFolder folder;
  const auto robot =
      mjcfRobot(folder, mjcfText("<body name='a'><body name='b'><joint name='i'/>"
                                 "<body name='c'><joint name='ball' type='ball'/>"
                                 "<body name='d'><joint name='k' limited='false' range='-1 1'/>"
                                 "<body name='e'><joint name='s' type='slide'/></body>"
                                 "</body></body></body></body>"));
  ASSERT_EQ(robot.links.size(), 5U);
  EXPECT_EQ(robot.links[1].joint_type, JointType::kContinuous);
  EXPECT_EQ(robot.links[2].joint_type, JointType::kFixed);
  EXPECT_EQ(robot.links[3].joint_type, JointType::kContinuous);
  EXPECT_EQ(robot.links[4].joint_type, JointType::kPrismatic);
  EXPECT_TRUE(robot.links[4].limits_are_assumed);
  EXPECT_THAT(robot.warnings, ElementsAre("joint 'ball' is a ball joint, which robots of packs do "
                                          "not have; it is held where it is"));
}

TEST(MjcfJoints, NeedToSayThatTheyAreLimitedWhereTheCompilerDoesNotTell) {
  const ScratchFolder folder;
  constexpr const char* kWorld =
      "<body name='a'><body name='b'><joint name='i' range='-1 1'/>"
      "<body name='c'><joint name='j' range='-1 1' limited='true'/></body></body></body>";
  const auto robot = mjcfRobot(folder, mjcfText(kWorld, "<compiler autolimits='false'/>"));
  EXPECT_EQ(robot.links[1].joint_type, JointType::kContinuous);
  EXPECT_EQ(robot.links[2].joint_type, JointType::kRevolute);
}

TEST(MjcfNames, AreMadeWhereTheyAreAbsent) {
  const ScratchFolder folder;
  const auto robot =
      mjcfRobot(folder,
                "<mujoco><worldbody><body><body><joint/><joint axis='1 0 0'/></body>"
                "<body name='body_2_joint'><joint name='body_2_joint'/></body></body></worldbody>"
                "</mujoco>");
  EXPECT_EQ(robot.name, "MuJoCo Model");
  std::vector<std::string> links;
  std::vector<std::string> joints;
  for (const bake::SourceLink& link : robot.links) {
    links.push_back(link.name);
    joints.push_back(link.joint_name);
  }
  EXPECT_THAT(links, ElementsAre("body_1", "body_2_body_2_joint_", "body_2", "body_2_joint"));
  EXPECT_THAT(joints, ElementsAre("", "body_2_joint_", "body_2_joint__", "body_2_joint"));
}

}  // namespace
}  // namespace galactic::test::mjcf::couplings_test
