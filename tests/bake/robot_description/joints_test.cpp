// Types of joints, limits, mimics and the order of links.
#include <gmock/gmock.h>

#include <numbers>

#include "bake/robot_description/robot_texts.h"

namespace galactic::test::joints_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

std::string links(std::string_view names) {
  std::string text;
  for (const char name : names) text += fmt::format("<link name=\"{}\"/>", name);
  return text;
}

constexpr const char* kLimit = "<limit lower=\"-0.5\" upper=\"1\" effort=\"1\" velocity=\"1\"/>";

TEST(UrdfJoints, OfEveryTypeAreRead) {
  const ScratchFolder folder;
  const auto robot =
      importText(folder, robotText(links("abcdefg") + jointText("fixed", "fixed", "a,b") +
                                   jointText("revolute", "revolute", "a,c", kLimit) +
                                   jointText("continuous", "continuous", "a,d") +
                                   jointText("prismatic", "prismatic", "a,e", kLimit) +
                                   jointText("planar", "planar", "a,f", "<axis xyz=\"0 0 1\"/>") +
                                   jointText("floating", "floating", "a,g")));
  ASSERT_TRUE(robot.has_value()) << robot.error().message;
  EXPECT_THAT(robot->warnings, IsEmpty());
  EXPECT_EQ(linkOf(*robot, "b").joint_type, JointType::kFixed);
  EXPECT_EQ(linkOf(*robot, "c").joint_type, JointType::kRevolute);
  EXPECT_EQ(linkOf(*robot, "d").joint_type, JointType::kContinuous);
  EXPECT_EQ(linkOf(*robot, "e").joint_type, JointType::kPrismatic);
  EXPECT_EQ(linkOf(*robot, "f").joint_type, JointType::kPlanar);
  EXPECT_EQ(linkOf(*robot, "g").joint_type, JointType::kFloating);
  for (const char* limited : {"c", "e"}) {
    ASSERT_TRUE(linkOf(*robot, limited).limits.has_value());
    EXPECT_EQ(linkOf(*robot, limited).limits->lower, -0.5);
    EXPECT_EQ(linkOf(*robot, limited).limits->upper, 1);
  }
  for (const char* unlimited : {"a", "b", "d", "f", "g"}) {
    EXPECT_FALSE(linkOf(*robot, unlimited).limits.has_value());
  }
  EXPECT_THAT(linkOf(*robot, "c").axis, ElementsAre(1, 0, 0)) << "the default of URDF";
  EXPECT_THAT(linkOf(*robot, "f").axis, ElementsAre(0, 1, 0));
}

TEST(UrdfJoints, WithLimitsThatAreAbsentTakeZero) {
  const ScratchFolder folder;
  const auto robot = importText(
      folder,
      robotText(links("ab") + jointText("j", "prismatic", "a,b",
                                        "<limit upper=\"1\" effort=\"1\" velocity=\"1\"/>")));
  ASSERT_TRUE(robot.has_value());
  EXPECT_EQ(robot->links[1].limits->lower, 0);
  EXPECT_EQ(robot->links[1].limits->upper, 1);
}

TEST(UrdfJoints, WithoutLimitsAssumeSome) {
  const ScratchFolder folder;
  const auto robot =
      importText(folder, robotText(links("abcde") + jointText("r", "revolute", "a,b") +
                                   jointText("p", "prismatic", "b,c", "<axis xyz=\"0 0 1\"/>") +
                                   jointText("q", "prismatic", "c,d", "<limit effort=\"1\"/>") +
                                   jointText("c", "continuous", "d,e", "<limit velocity=\"1\"/>")));
  ASSERT_TRUE(robot.has_value()) << robot.error().message;
  const auto limitsOf = [&](const char* link) { return *linkOf(*robot, link).limits; };
  EXPECT_EQ(limitsOf("b").lower, -std::numbers::pi);
  EXPECT_EQ(limitsOf("b").upper, std::numbers::pi);
  for (const char* prismatic : {"c", "d"}) {
    EXPECT_EQ(limitsOf(prismatic).lower, -1);
    EXPECT_EQ(limitsOf(prismatic).upper, 1);
  }
  for (const char* assumed : {"b", "c", "d"}) {
    EXPECT_TRUE(linkOf(*robot, assumed).limits_are_assumed) << assumed;
  }
  EXPECT_FALSE(linkOf(*robot, "e").limits.has_value());
  EXPECT_THAT(linkOf(*robot, "c").axis, ElementsAre(0, 1, 0)) << "the joint stays what it was";
}

TEST(UrdfJoints, MayHaveLimitsWithoutEffortAndVelocity) {
  const ScratchFolder folder;
  const auto robot =
      importText(folder, robotText(links("ab") + jointText("j", "revolute", "a,b",
                                                           "<limit lower=\" -1\" upper=\"2 \"/>")));
  ASSERT_TRUE(robot.has_value()) << robot.error().message;
  EXPECT_EQ(robot->links[1].limits->upper, 2);
  EXPECT_FALSE(robot->links[1].limits_are_assumed);
}

TEST(UrdfJoints, MayHangFromAWorldThatNobodyDeclares) {
  const ScratchFolder folder;
  // As simulators drive a base: along x and y, and about z.
  const auto robot = importText(
      folder, robotText(links("abc") + jointText("x", "prismatic", "world,a") +
                        jointText("y", "prismatic", "a,b") + jointText("z", "continuous", "b,c")));
  ASSERT_TRUE(robot.has_value()) << robot.error().message;
  ASSERT_EQ(robot->links.size(), 4U);
  EXPECT_EQ(robot->links.front().name, "world");
  EXPECT_THAT(robot->links.front().collisions, IsEmpty());
  EXPECT_THAT(robot->warnings,
              ElementsAre("joint 'x': it hangs from a link 'world', which the file does not "
                          "declare; it counts as an empty link"));
  const auto declared = importText(folder, robotText("<link name=\"world\"/>" + links("a") +
                                                     jointText("x", "fixed", "world,a")));
  ASSERT_TRUE(declared.has_value()) << declared.error().message;
  EXPECT_THAT(declared->warnings, IsEmpty());
}

TEST(UrdfJoints, ThatAreDoubtfulDrawWarnings) {
  const ScratchFolder folder;
  const auto robot = importText(
      folder,
      robotText(links("abd") +
                jointText("j", "continuous", "a,b",
                          "<axis xyz=\"0 3 4\"/><limit lower=\"-1\" upper=\"1\" effort=\"1\" "
                          "velocity=\"1\"/>") +
                jointText("l", "continuous", "a,d", "<axis xyz=\"0.707 0.707 0\"/>")));
  ASSERT_TRUE(robot.has_value());
  EXPECT_THAT(robot->warnings,
              ElementsAre("joint 'j': its axis (0 3 4) is not of unit length; only its direction "
                          "counts",
                          "joint 'j': it is continuous, so its limits -1 to 1 are not used"));
  EXPECT_THAT(robot->links[1].axis, ElementsAre(0, 0.8, -0.6));
  EXPECT_FALSE(robot->links[1].limits.has_value());
}

TEST(UrdfJoints, WithLimitsThatLookLikeDegreesDrawAWarning) {
  const ScratchFolder folder;
  const auto warnings = [&](const char* type, const char* lower, const char* upper) {
    const std::string limit =
        fmt::format(R"(<limit lower="{}" upper="{}" effort="1" velocity="1"/>)", lower, upper);
    return importText(folder, robotText(links("ab") + jointText("j", type, "a,b", limit)))
        .value()
        .warnings;
  };
  EXPECT_THAT(warnings("revolute", "-170", "60"),
              ElementsAre("joint 'j': its limits -170 to 60 are taken as radians, more than two "
                          "turns; if they are degrees, convert them"));
  EXPECT_THAT(warnings("revolute", "0", "90"), SizeIs(1));
  EXPECT_THAT(warnings("revolute", "-12.5", "12.5"), IsEmpty()) << "a wrist of many turns";
  EXPECT_THAT(warnings("revolute", "-1e6", "1e6"), IsEmpty()) << "no limits";
  EXPECT_THAT(warnings("prismatic", "0", "90"), IsEmpty());
}

TEST(UrdfJoints, OfFixedTypeNeedNoAxis) {
  const ScratchFolder folder;
  const auto robot = importText(
      folder, robotText(links("ab") + jointText("j", "fixed", "a,b", "<axis xyz=\"0 0 0\"/>")));
  ASSERT_TRUE(robot.has_value());
  EXPECT_THAT(robot->warnings, IsEmpty());
}

TEST(UrdfMimics, FollowAJoint) {
  const ScratchFolder folder;
  const auto robot = importText(
      folder, robotText(links("abc") + jointText("j", "continuous", "a,b") +
                        jointText("k", "continuous", "a,c",
                                  "<mimic joint=\"j\" multiplier=\"-2\" offset=\"0.5\"/>")));
  ASSERT_TRUE(robot.has_value());
  EXPECT_FALSE(robot->links[1].mimic.has_value());
  ASSERT_TRUE(robot->links[2].mimic.has_value());
  EXPECT_EQ(robot->links[2].mimic->link, 1U);
  EXPECT_EQ(robot->links[2].mimic->multiplier, -2);
  EXPECT_EQ(robot->links[2].mimic->offset, 0.5);
}

TEST(UrdfMimics, InAChainFollowItsFirstJoint) {
  const ScratchFolder folder;
  // c = 3 b + 1 and b = 2 a + 10, so c = 6 a + 31; the leader comes last in the text.
  const auto robot = importText(folder, robotText(links("rxyz") +
                                                  jointText("c", "continuous", "r,x",
                                                            "<mimic joint=\"b\" multiplier=\"3\" "
                                                            "offset=\"1\"/>") +
                                                  jointText("b", "continuous", "r,y",
                                                            "<mimic joint=\"a\" multiplier=\"2\" "
                                                            "offset=\"10\"/>") +
                                                  jointText("a", "continuous", "r,z")));
  ASSERT_TRUE(robot.has_value());
  const auto& mimic = linkOf(*robot, "x").mimic;
  ASSERT_TRUE(mimic.has_value());
  EXPECT_EQ(robot->links[mimic->link].joint_name, "a");
  EXPECT_EQ(mimic->multiplier, 6);
  EXPECT_EQ(mimic->offset, 31);
}

TEST(UrdfTrees, AreOrderedParentsFirstAndByTheTextsJoints) {
  const ScratchFolder folder;
  // Names and order of the text disagree on purpose.
  const auto robot =
      importText(folder, robotText(links("dcbae") + jointText("z", "fixed", "b,d") +
                                   jointText("y", "fixed", "e,c") + jointText("x", "fixed", "e,b") +
                                   jointText("w", "fixed", "b,a")));
  ASSERT_TRUE(robot.has_value());
  std::string order;
  std::vector<int> parents;
  for (const bake::SourceLink& link : robot->links) {
    order += link.name;
    parents.push_back(link.parent);
  }
  EXPECT_EQ(order, "ecbda");
  EXPECT_THAT(parents, ElementsAre(-1, 0, 0, 2, 2));
}

TEST(UrdfTrees, MayBeLongChains) {
  const ScratchFolder folder;
  constexpr int kLinks = 3000;
  std::string text = "<link name=\"l0\"/>";
  for (int i = 1; i < kLinks; ++i) {
    text += fmt::format("<link name=\"l{}\"/>", i) +
            jointText(fmt::format("j{}", i), "fixed", fmt::format("l{},l{}", i - 1, i));
  }
  const auto robot = importText(folder, robotText(text));
  ASSERT_TRUE(robot.has_value()) << robot.error().message;
  EXPECT_EQ(robot->links.size(), static_cast<std::size_t>(kLinks));
  EXPECT_EQ(robot->links.back().name, fmt::format("l{}", kLinks - 1));
}

TEST(UrdfTrees, OfOneLinkNeedNoJoint) {
  const ScratchFolder folder;
  const auto robot = importText(folder, robotText(links("a")));
  ASSERT_TRUE(robot.has_value());
  EXPECT_EQ(robot->links.size(), 1U);
  EXPECT_EQ(robot->links[0].parent, -1);
}

}  // namespace
}  // namespace galactic::test::joints_test
