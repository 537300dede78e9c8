// SRDF and URDF texts, word by word; the round trip through the importer is in
// robot_round_trip_test.cpp.
#include "pack_tool/export/robot_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pack_tool/asset_packs.h"

namespace galactic::pack_tool::robot_text_test {
namespace {

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
</robot>
)");
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
