// Masses and shapes from a robot's file, and what stands in for them.
#include "dynamics/sources/robot_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "dynamics/made_robot.h"
#include "galactic/bake/robot_import.h"
#include "support/scratch_folder.h"

namespace galactic::test::robot_model_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// Two links, URDF frame (Z up); `inertial` is what the second one says.
dynamics::RobotSource sourceWith(const std::string& inertial) {
  const ScratchFolder folder;
  const std::string text =
      R"(<robot name="r"><link name="base"><inertial><origin xyz="0.1 0.2 0.3"/><mass value="20"/>)"
      R"(<inertia ixx="1" iyy="2" izz="2.5" ixy="0.1" ixz="0.2" iyz="0.3"/></inertial>)"
      R"(<collision><geometry><box size="0.4 0.4 0.2"/></geometry></collision></link>)"
      R"(<link name="arm">)" +
      inertial +
      R"(<collision><origin xyz="0.5 0 0"/><geometry><box size="1 0.1 0.2"/></geometry></collision>)"
      R"(</link><joint name="swing" type="continuous"><parent link="base"/><child link="arm"/>)"
      R"(<origin xyz="0 0 1"/><axis xyz="0 0 1"/></joint></robot>)";
  const auto path = folder.write("r.urdf", text);
  return {"r.urdf", bake::importRobot(path).value(), bake::readInertials(path).value()};
}

RobotPackFields packFields() {
  RobotPackFields fields = smallHomeRobot();
  fields.links.resize(2);
  fields.links[1].type = JointType::kContinuous;
  fields.links[1].parent_from_joint = {{0, 1, 0}, {}};
  fields.links[1].axis = {0, 1, 0};
  fields.link_names = {"base", "arm"};
  fields.joint_names = {"", "swing"};
  constexpr float kUnlimited = std::numeric_limits<float>::max();
  fields.limits = {{-kUnlimited, kUnlimited}};
  fields.start_positions = {0};
  fields.spheres.resize(2);
  fields.groups = {{0, {0}, 0, 1, SphereStatisticsFields{}},
                   {1, {1}, 1, 1, SphereStatisticsFields{}}};
  fields.controlled_joints = {{0, 0.1F, -kUnlimited, kUnlimited}};
  fields.end_effector->link = 1;
  return fields;
}

dynamics::RobotParts partsWith(const std::string& inertial) {
  const MadeRobot robot(packFields());
  return dynamics::robotParts(sourceWith(inertial), *robot).value();
}

TEST(AnInertial, IsTurnedToYUp) {
  const dynamics::RobotParts parts = partsWith(
      R"(<inertial><mass value="2"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>)");
  EXPECT_THAT(parts.warnings, ElementsAre());
  const dynamics::Inertia& base = *parts.links[0].inertia;
  EXPECT_EQ(base.mass, 20);
  // (x, y, z) becomes (x, z, -y).
  EXPECT_NEAR(base.center[0], 0.1, 1e-12);
  EXPECT_NEAR(base.center[1], 0.3, 1e-12);
  EXPECT_NEAR(base.center[2], -0.2, 1e-12);
  const std::array<double, 6> expected{1, 2.5, 2, 0.2, -0.1, -0.3};
  for (std::size_t n = 0; n < 6; ++n) EXPECT_NEAR(base.moments[n], expected[n], 1e-12) << n;
}

TEST(AnMjcf, GivesTheMassesThatItStatesAndThoseOfItsShapes) {
  const ScratchFolder folder;
  const auto path = folder.write(
      "r.xml",
      R"(<mujoco model="r"><worldbody><body name="base"><inertial pos="0.1 0.2 0.3" mass="20" )"
      R"(fullinertia="1 2 2.5 0.1 0.2 0.3"/><geom type="box" size="0.2 0.2 0.1"/>)"
      R"(<body name="arm" pos="0 0 1"><joint name="swing" axis="0 0 1"/>)"
      R"(<geom type="box" size="0.5 0.05 0.1" pos="0.5 0 0" density="300"/></body></body>)"
      R"(</worldbody></mujoco>)");
  const MadeRobot robot(packFields());
  const dynamics::RobotParts parts =
      dynamics::robotParts(
          {"r.xml", bake::importRobot(path).value(), bake::readInertials(path).value()}, *robot)
          .value();
  EXPECT_THAT(parts.warnings, ElementsAre());
  const dynamics::Inertia& base = *parts.links[0].inertia;
  EXPECT_EQ(base.mass, 20);
  const std::array<double, 6> expected{1, 2.5, 2, 0.2, -0.1, -0.3};
  for (std::size_t n = 0; n < 6; ++n) EXPECT_NEAR(base.moments[n], expected[n], 1e-12) << n;
  const dynamics::Inertia& arm = *parts.links[1].inertia;
  EXPECT_NEAR(arm.mass, 6, 1e-9);
  EXPECT_NEAR(arm.center[0], 0.5, 1e-9);
  EXPECT_NEAR(arm.moments[0], 0.5 * (0.04 + 0.01), 1e-9);
  EXPECT_NEAR(arm.moments[1], 0.5 * (1 + 0.01), 1e-9);
}

TEST(ALinkWithoutMass, GetsOneByItsShapeAndAWarning) {
  for (
      const char* inertial :
      {"",
       R"(<inertial><mass value="1e300"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>)",
       R"(<inertial><mass value="1.1e6"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>)",
       R"(<inertial><mass value="0.9e-6"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>)",
       R"(<inertial><mass value="0"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>)",
       R"(<inertial><mass value="-3"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>)"}) {
    const dynamics::RobotParts parts = partsWith(inertial);
    EXPECT_THAT(parts.warnings, ElementsAre(HasSubstr("link 'arm' has"))) << inertial;
    // 300 kg/m^3 of 1 x 0.2 x 0.1 m.
    const dynamics::Inertia& arm = *parts.links[1].inertia;
    EXPECT_NEAR(arm.mass, 6, 1e-5);
    EXPECT_NEAR(arm.center[0], 0.5, 1e-6);
    EXPECT_NEAR(arm.moments[0], 0.5 * (0.04 + 0.01), 1e-6);
    EXPECT_NEAR(arm.moments[1], 0.5 * (1 + 0.01), 1e-6);
  }
}

TEST(MomentsThatNoBodyHas, AreThoseOfTheBoxAroundTheShape) {
  for (const char* moments : {R"(ixx="1" iyy="1" izz="5" ixy="0" ixz="0" iyz="0")",
                              R"(ixx="0" iyy="0" izz="0" ixy="0" ixz="0" iyz="0")",
                              R"(ixx="-1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0")",
                              R"(ixx="1" iyy="1" izz="1" ixy="2" ixz="0" iyz="0")",
                              R"(ixx="1e-16" iyy="1e-16" izz="1e-16" ixy="0" ixz="0" iyz="0")",
                              R"(ixx="1e13" iyy="1e13" izz="1e13" ixy="0" ixz="0" iyz="0")",
                              R"(ixx="1e308" iyy="1e308" izz="1e308" ixy="1" ixz="0" iyz="0")"}) {
    const dynamics::RobotParts parts = partsWith(R"(<inertial><mass value="6"/><inertia )" +
                                                 std::string(moments) + "/></inertial>");
    EXPECT_THAT(parts.warnings,
                ElementsAre(HasSubstr("moments of inertia in 'r.urdf' that no body has")))
        << moments;
    EXPECT_NEAR(parts.links[1].inertia->moments[1], 0.5 * (1 + 0.01), 1e-6);
    EXPECT_EQ(parts.links[1].inertia->mass, 6);
  }
}

TEST(AMassThatNoBodyHas, IsNamedWithItsFileAndLink) {
  const dynamics::RobotParts parts = partsWith(
      R"(<inertial><mass value="1e300"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>)");
  EXPECT_THAT(
      parts.warnings,
      ElementsAre("link 'arm' has a mass of 1e+300 kg in 'r.urdf', expected 1e-06 to 1e+06; "
                  "6 kg count, by the box around its shape"));
}

TEST(AMassThatNoBodyHas, IsNotTakenByAFrameEither) {
  const auto warnings_of = [](double mass) {
    dynamics::RobotSource source = sourceWith("");
    source.robot.links[1].collisions.clear();
    source.inertials.push_back(
        {.link = "arm", .mass = mass, .center = {}, .moments = {1, 1, 1, 0, 0, 0}});
    const MadeRobot robot(packFields());
    const dynamics::RobotParts parts = dynamics::robotParts(source, *robot).value();
    EXPECT_EQ(parts.links[1].inertia->mass, 0.1) << mass;
    return parts.warnings;
  };
  const std::string moves = "link 'arm' moves and has neither mass nor shape; 0.1 kg count";
  EXPECT_THAT(warnings_of(0), ElementsAre(moves));
  EXPECT_THAT(warnings_of(1e30),
              ElementsAre("link 'arm' has a mass of 1e+30 kg in 'r.urdf', expected 1e-06 to 1e+06; "
                          "it has none now",
                          moves));
}

TEST(ACenterOfMassFarAway, IsThatOfTheBoxAroundTheShape) {
  for (const char* center : {"1e300 0 0", "0 -801 0"}) {
    const dynamics::RobotParts parts = partsWith(
        R"(<inertial><origin xyz=")" + std::string(center) +
        R"("/><mass value="6"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>)");
    EXPECT_THAT(
        parts.warnings,
        ElementsAre(HasSubstr("link 'arm' has a center of mass in 'r.urdf' that is farther")));
    const dynamics::Inertia& arm = *parts.links[1].inertia;
    EXPECT_NEAR(arm.center[0], 0.5, 1e-6);
    EXPECT_NEAR(arm.center[1], 0, 1e-6);
    EXPECT_EQ(arm.mass, 6);
    EXPECT_EQ(arm.moments[0], 1);
  }
}

TEST(ARobotWithAnotherLink, IsRefused) {
  RobotPackFields fields = packFields();
  fields.link_names[1] = "leg";
  const MadeRobot robot(fields);
  const auto parts = dynamics::robotParts(sourceWith(""), *robot);
  ASSERT_FALSE(parts);
  EXPECT_EQ(parts.error().code, ErrorCode::kInvalidInput);
  EXPECT_THAT(parts.error().message, HasSubstr("has no link 'leg'"));
}

TEST(LinksThatNoActionMoves, AreOneBodyWithTheirParent) {
  RobotPackFields fields = packFields();
  fields.controlled_joints.clear();
  const MadeRobot robot(fields);
  const dynamics::RobotParts parts =
      dynamics::robotParts(
          sourceWith(
              R"(<inertial><mass value="20"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>)"),
          *robot)
          .value();
  EXPECT_THAT(parts.body_of_link, ElementsAre(0, 0));
  const std::vector<float> quarter{static_cast<float>(std::numbers::pi / 2)};
  const auto bodies = dynamics::bodiesOf(parts, *robot, quarter);
  ASSERT_EQ(bodies.size(), 1U);
  EXPECT_EQ(bodies[0].inertia.mass, 40);
  // The middle of (0.1, 0.3, -0.2) and (0, 1, 0).
  EXPECT_NEAR(bodies[0].inertia.center[0], 0.05, 1e-6);
  EXPECT_NEAR(bodies[0].inertia.center[1], 0.65, 1e-6);
  EXPECT_NEAR(bodies[0].inertia.center[2], -0.1, 1e-6);
  // Own moments, and each 20 kg at half the way between them.
  EXPECT_NEAR(bodies[0].inertia.moments[0], 1 + 1 + 40 * (0.35 * 0.35 + 0.1 * 0.1), 1e-5);
}

}  // namespace
}  // namespace galactic::test::robot_model_test
