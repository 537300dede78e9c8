// SRDF and URDF texts, word by word; the round trip through the importer is in
// robot_round_trip_test.cpp.
#include "pack_tool/export/robot_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "galactic/kinematics.h"
#include "pack_tool/asset_packs.h"
#include "support/packs/robot_pack_builder.h"

namespace galactic::pack_tool::robot_text_test {
namespace {

using test::AlignedBytes;
using test::RobotPackFields;
using test::ToyPack;
using test::ToyRobot;
using testing::HasSubstr;
using testing::Not;

TEST(SrdfText, HasTheSpheresOfEachLinkZUp) {
  const ToyPack pack{ToyRobot{.name = "<&\"arm\">"}};
  EXPECT_EQ(srdfText(*Robot::from(*pack)), R"(<?xml version="1.0"?>
<robot name="&lt;&amp;&quot;arm&quot;&gt;">
  <link_sphere_approximation link="base">
    <sphere center="0 0 0.2" radius="0.25"/>
    <sphere center="0.125 0.25 0.5" radius="0.05"/>
  </link_sphere_approximation>
  <link_sphere_approximation link="upper">
    <sphere center="0.25 0 0" radius="0.05"/>
  </link_sphere_approximation>
  <link_sphere_approximation link="slide">
    <sphere center="0 0 0" radius="0.05"/>
  </link_sphere_approximation>
  <link_sphere_approximation link="finger">
    <sphere center="0 0 0" radius="0"/>
  </link_sphere_approximation>
  <link_sphere_approximation link="head">
    <sphere center="0 0 0" radius="0"/>
  </link_sphere_approximation>
  <disable_collisions link1="base" link2="upper" reason="Adjacent"/>
  <disable_collisions link1="base" link2="head" reason="Adjacent"/>
  <disable_collisions link1="upper" link2="slide" reason="Adjacent"/>
  <disable_collisions link1="upper" link2="head" reason="Adjacent"/>
  <disable_collisions link1="slide" link2="finger" reason="Adjacent"/>
</robot>
)");
}

TEST(SrdfText, SaysWhichLinksAreNotTestedAgainstEachOtherAndWhy) {
  RobotPackFields fields = test::smallRobotPack();
  // Base with lid, arm and hand: groups 0, 2 and 3.
  const auto text_for = [&](PairKind base_and_arm, PairKind base_and_hand) {
    fields.group_pairs = {{0, 2, static_cast<std::uint8_t>(base_and_arm)},
                          {0, 3, static_cast<std::uint8_t>(base_and_hand)},
                          {2, 3, static_cast<std::uint8_t>(PairKind::kAdjacent)}};
    const AlignedBytes bytes = test::buildPack(fields);
    const PackFile pack = orThrow(PackFile::view(bytes.bytes(), "helper"));
    return srdfText(orThrow(Robot::from(pack)));
  };
  const auto line = [](const std::string& links, const std::string& reason) {
    return HasSubstr("  <disable_collisions " + links + " reason=\"" + reason + "\"/>\n");
  };
  const std::string base_arm = R"(link1="base" link2="arm")";
  const std::string arm_lid = R"(link1="arm" link2="lid")";
  const std::string base_hand = R"(link1="base" link2="hand")";
  const std::string hand_lid = R"(link1="hand" link2="lid")";
  std::string text = text_for(PairKind::kIgnored, PairKind::kNever);
  for (const std::string& links : {base_arm, arm_lid}) EXPECT_THAT(text, line(links, "User"));
  for (const std::string& links : {base_hand, hand_lid}) EXPECT_THAT(text, line(links, "Never"));
  EXPECT_THAT(text, line(R"(link1="base" link2="lid")", "Adjacent"));
  EXPECT_THAT(text, line(R"(link1="arm" link2="hand")", "Adjacent"));
  text = text_for(PairKind::kTested, PairKind::kAlways);
  for (const std::string& links : {base_arm, arm_lid}) EXPECT_THAT(text, Not(HasSubstr(links)));
  for (const std::string& links : {base_hand, hand_lid}) EXPECT_THAT(text, line(links, "Always"));
  // Now they touch at the start.
  std::vector<Pose> links(fields.links.size());
  forwardKinematics(fields.links, {}, fields.start_positions, links);
  fields.spheres[0].center = inverse(links[0]) * (links[2] * fields.spheres[2].center);
  text = text_for(PairKind::kTested, PairKind::kAlways);
  for (const std::string& two : {base_arm, arm_lid}) EXPECT_THAT(text, line(two, "Default"));
}

TEST(UrdfText, HasJointsLimitsMimicsAndSpheres) {
  const ToyPack pack{ToyRobot{}};
  const std::string text = spherizedUrdfText(*Robot::from(*pack));
  EXPECT_THAT(text, HasSubstr("  <link name=\"head\"/>\n"));
  EXPECT_THAT(text, HasSubstr("<origin xyz=\"0.125 0.25 0.5\" rpy=\"0 0 0\"/>\n"
                              "      <geometry><sphere radius=\"0.05\"/></geometry>"));
  EXPECT_THAT(text, HasSubstr("  <joint name=\"lift\" type=\"revolute\">\n"
                              "    <parent link=\"base\"/>\n    <child link=\"upper\"/>\n"
                              "    <origin xyz=\"0 -0.25 1\" rpy=\""));
  EXPECT_THAT(text, HasSubstr("    <axis xyz=\"0 -1 0\"/>\n"
                              "    <limit lower=\"-1\" upper=\"2\" effort=\"0\" velocity=\"0\"/>"));
  // Minus a half of -1 to 2, and an eighth.
  EXPECT_THAT(text, HasSubstr("<limit lower=\"-0.875\" upper=\"0.625\" effort=\"0\""));
  EXPECT_THAT(text, HasSubstr("<mimic joint=\"lift\" multiplier=\"-0.5\" offset=\"0.125\"/>"));
  EXPECT_THAT(text, HasSubstr("<joint name=\"neck\" type=\"fixed\">"));
}

TEST(UrdfText, MakesARevoluteJointWithoutLimitsContinuous) {
  const ToyPack pack{ToyRobot{}};
  const std::string text = spherizedUrdfText(*Robot::from(*pack));
  EXPECT_THAT(text, Not(HasSubstr("continuous")));
  // The slide has none, and no other type to become.
  EXPECT_THAT(text, HasSubstr("<limit lower=\"-3.4028235e+38\" upper=\"3.4028235e+38\""));
}

}  // namespace
}  // namespace galactic::pack_tool::robot_text_test
