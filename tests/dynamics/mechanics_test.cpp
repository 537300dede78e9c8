// The dynamics world against what mechanics says of simple cases.
#include <gtest/gtest.h>

#include <cmath>

#include "dynamics/made_robot.h"
#include "galactic/bake/robot_import.h"
#include "support/scratch_folder.h"
#include "support/test_meshes.h"

namespace galactic::test::mechanics_test {
namespace {

using dynamics::ArmDrive;
using dynamics::DynamicsWorld;
using dynamics::ObjectSource;
using dynamics::PlacedObject;
using dynamics::WorldOptions;

constexpr double kGravity = 9.81;
constexpr double kControlStep = 4.0 / 120;

std::shared_ptr<const dynamics::SceneShape> flatFloor() {
  return dynamics::makeSceneShape(MeshBuilder().floor({-5, 0, -5}, {5, 0, 5}, 0).build());
}

PlacedObject boxAt(const Pose& pose, const Vec3& half = {0.05F, 0.05F, 0.05F}) {
  return {dynamics::makeObjectShape({.hulls = {boxPoints({}, half)}, .mass = 0.5}), pose};
}

TEST(AFallingObject, FollowsGravity) {
  const std::vector<PlacedObject> objects{boxAt({{0, 3, 0}, {}})};
  DynamicsWorld world(flatFloor(), objects, {});
  constexpr int kSteps = 15;
  for (int n = 0; n < kSteps; ++n) world.step();
  const double t = kSteps * kControlStep;
  // Semi-implicit Euler is ahead by g t h / 2.
  const double expected = 3 - kGravity * t * t / 2 - kGravity * t / 240;
  EXPECT_NEAR(world.objectPose(0).translation.y, expected, 1e-3);
  EXPECT_NEAR(world.objectVelocity(0).y, -kGravity * t, 1e-3);
}

TEST(AFallingObject, ComesToRestOnTheFloor) {
  const std::vector<PlacedObject> objects{boxAt({{0, 0.5F, 0}, {}})};
  DynamicsWorld world(flatFloor(), objects, {});
  for (int n = 0; n < 60; ++n) world.step();
  // Bullet lets contacts overlap by some tenths of a millimeter.
  EXPECT_NEAR(world.objectPose(0).translation.y, 0.05, 1e-3);
  EXPECT_NEAR(world.objectVelocity(0).y, 0, 1e-2);
}

TEST(ASleepingObject, StaysUntilSomethingComesNear) {
  const std::vector<PlacedObject> objects{boxAt({{0, 0.5F, 0}, {}}), boxAt({{1, 0.5F, 0}, {}}),
                                          boxAt({{1, 1.0F, 0}, {}})};
  DynamicsWorld world(flatFloor(), objects, {});
  world.sleep(0);
  world.sleep(1);
  for (int n = 0; n < 60; ++n) world.step();
  EXPECT_EQ(world.objectPose(0).translation.y, 0.5F) << "nothing is near it";
  EXPECT_LT(world.objectPose(1).translation.y, 0.16F) << "the third fell on it";
}

TEST(AHullOfHugeCoordinates, IsMadeThoughTheirSumsOverflow) {
  // In the direction that is looked at first, among others.
  constexpr float kHuge = 1.69e38F;
  const dynamics::HullPoints points = boxPoints({kHuge, -kHuge, kHuge}, {kHuge, kHuge, kHuge});
  EXPECT_NE(dynamics::makeObjectShape({.hulls = {points}, .mass = 0.5}), nullptr);
}

TEST(ABallOfManyCorners, KeepsItsSize) {
  dynamics::HullPoints points;
  for (int n = 0; n < 5000; ++n) {
    const double y = 1 - (2 * n + 1) / 5000.0;
    const double around = std::sqrt(1 - y * y);
    points.push_back({static_cast<float>(0.1 * around * std::cos(2.4 * n)),
                      static_cast<float>(0.1 * y),
                      static_cast<float>(0.1 * around * std::sin(2.4 * n))});
  }
  const std::vector<PlacedObject> objects{
      {dynamics::makeObjectShape({.hulls = {points}, .mass = 0.5}), {{0, 0.105F, 0}, {}}}};
  DynamicsWorld world(flatFloor(), objects, {});
  for (int n = 0; n < 60; ++n) world.step();
  // Half a millimeter by its corners, and what contacts overlap by.
  EXPECT_NEAR(world.objectPose(0).translation.y, 0.1, 1e-3);
  // Its surface is as far as it should be in every direction that is asked for.
  const Vec3 middle = world.objectPose(0).translation;
  int found = 0;
  int asked = 0;
  for (const double angle : {0.3, 1.1, 2.0, 3.3, 4.4, 5.9}) {
    for (const double far : {0.1085, 0.1115}) {
      const Vec3 at = middle + Vec3{static_cast<float>(far * std::cos(angle)), 0,
                                    static_cast<float>(far * std::sin(angle))};
      const bool is_touched = world.objectWithin(at, 0.01F).has_value();
      EXPECT_EQ(is_touched, far < 0.11) << angle;
      found += is_touched ? 1 : 0;
      ++asked;
    }
  }
  EXPECT_EQ(2 * found, asked);
}

/// A box on a plane that falls towards +X by `slope`; how far it slides in a second.
double slideOn(double slope, double friction) {
  const auto tangent = static_cast<float>(std::tan(slope));
  MeshBuilder plane;
  plane.quad({Vec3{-5, 5 * tangent, -5},
              {-5, 5 * tangent, 5},
              {5, -5 * tangent, 5},
              {5, -5 * tangent, -5}});
  const auto half_angle = static_cast<float>(-slope / 2);
  const Quat tilt{0, 0, std::sin(half_angle), std::cos(half_angle)};
  const Vec3 above = rotate(tilt, {0, 0.05F, 0});
  const std::vector<PlacedObject> objects{boxAt({above, tilt}, {0.1F, 0.05F, 0.1F})};
  // The product of both surfaces counts.
  DynamicsWorld world(dynamics::makeSceneShape(plane.build()), objects,
                      {.friction = std::sqrt(friction)});
  for (int n = 0; n < 30; ++n) world.step();
  const Vec3 way = world.objectPose(0).translation - above;
  return std::sqrt(static_cast<double>(dot(way, way)));
}

TEST(ABoxOnASlope, StaysWhereFrictionHoldsIt) {
  // tan 20 degrees is 0.364.
  EXPECT_LT(slideOn(0.349, 0.5), 5e-3);
}

TEST(ABoxOnASlope, SlidesAsFarAsMechanicsSays) {
  const double slope = 0.524;
  const double friction = 0.3;
  const double acceleration = kGravity * (std::sin(slope) - friction * std::cos(slope));
  const double expected = acceleration / 2;
  EXPECT_NEAR(slideOn(slope, friction), expected, 0.05 * expected);
}

/// A base and an arm of 0.4 m that hangs from it and swings about Z; far above the floor.
RobotPackFields pendulumFields() {
  RobotPackFields fields = smallHomeRobot();
  fields.links.resize(2);
  fields.links[1].type = JointType::kRevolute;
  fields.links[1].parent_from_joint = {{0, 0, 0.5F}, {}};
  fields.links[1].axis = {0, 0, 1};
  fields.link_names = {"base", "arm"};
  fields.joint_names = {"", "swing"};
  fields.limits = {{-3, 3}};
  fields.start_positions = {0.1F};
  fields.spheres.resize(2);
  fields.groups = {{0, {0}, 0, 1, SphereStatisticsFields{}},
                   {1, {1}, 1, 1, SphereStatisticsFields{}}};
  fields.controlled_joints = {{0, 0.1F, -3, 3}};
  fields.end_effector->link = 1;
  return fields;
}

constexpr double kArmMass = 2;
/// Of the pendulum's center of mass from its axis, meters.
constexpr double kArmLength = 0.2;

dynamics::RobotParts pendulumParts() {
  dynamics::RobotParts parts;
  parts.body_of_link = {0, 1};
  parts.links = {boxPart(20, {}, {0.1F, 0.1F, 0.1F}),
                 boxPart(kArmMass, {0, -static_cast<float>(kArmLength), 0}, {0.03F, 0.2F, 0.05F})};
  return parts;
}

constexpr Pose kAbove{{0, 2, 0}, {}};

/// How long the pendulum takes to swing there and back; 0.1 rad at first. Seconds.
double periodOf(const MadeRobot& robot, const dynamics::RobotParts& parts) {
  const RobotKit kit(*robot, parts);
  DynamicsWorld world(flatFloor(), {}, {.most_impulse = 0});
  world.addRobot(kit.setup(kAbove));
  // When it passes the middle for the second time in the same direction, by interpolation.
  std::vector<double> crossings;
  double before = static_cast<double>(world.positions()[0]);
  for (int n = 1; crossings.size() < 5 && n < 600; ++n) {
    world.step();
    const double now = static_cast<double>(world.positions()[0]);
    if (before > 0 && now <= 0) crossings.push_back((n - now / (now - before)) * kControlStep);
    before = now;
  }
  EXPECT_EQ(crossings.size(), 5U);
  return crossings.size() == 5 ? (crossings[4] - crossings[0]) / 4 : 0;
}

/// What mechanics says of it.
double expectedPeriod(double about_center, double mass, double length) {
  const double about_axis = about_center + mass * length * length;
  constexpr double kAmplitude = 0.1;
  return 2 * std::numbers::pi * std::sqrt(about_axis / (mass * kGravity * length)) *
         (1 + kAmplitude * kAmplitude / 16);
}

TEST(APendulum, SwingsWithThePeriodOfItsInertia) {
  const double about_center = kArmMass / 12 * (0.06 * 0.06 + 0.4 * 0.4);
  const double period = expectedPeriod(about_center, kArmMass, kArmLength);
  EXPECT_NEAR(periodOf(MadeRobot(pendulumFields()), pendulumParts()), period, 0.01 * period);
}

TEST(APendulum, SwingsWithThePeriodOfItsUrdfsInertia) {
  // Z up: the joint turns about -Y, which is Z of the pack. The frame of the moments is turned by
  // half a radian about X.
  constexpr const char* kUrdf =
      R"(<robot name="r"><link name="base"><inertial><mass value="20"/><inertia ixx="1" iyy="1")"
      R"( izz="1" ixy="0" ixz="0" iyz="0"/></inertial><collision><geometry><box size="0.2 0.2 0.2"/>)"
      R"(</geometry></collision></link><link name="arm"><inertial><origin xyz="0 0 -0.1")"
      R"( rpy="0.5 0 0"/><mass value="2"/><inertia ixx="0.03" iyy="0.02" izz="0.04" ixy="0" ixz="0")"
      R"( iyz="0.008"/></inertial><collision><origin xyz="0 0 -0.1"/><geometry>)"
      R"(<box size="0.05 0.05 0.2"/></geometry></collision></link><joint name="swing")"
      R"( type="revolute"><parent link="base"/><child link="arm"/><origin xyz="0 -0.5 0"/>)"
      R"(<axis xyz="0 -1 0"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint></robot>)";
  const ScratchFolder folder;
  const auto path = folder.write("pendulum.urdf", kUrdf);
  const MadeRobot robot(pendulumFields());
  const dynamics::RobotSource source{"pendulum.urdf", bake::importRobot(path).value(),
                                     bake::readInertials(path).value()};
  const dynamics::RobotParts parts = dynamics::robotParts(source, *robot).value();
  EXPECT_TRUE(parts.warnings.empty());
  const double c = std::cos(0.5);
  const double s = std::sin(0.5);
  const double about_center = c * c * 0.02 - 2 * c * s * 0.008 + s * s * 0.04;
  const double period = expectedPeriod(about_center, 2, 0.1);
  // Without the turn it would be 2.7 % longer.
  EXPECT_NEAR(periodOf(robot, parts), period, 0.01 * period);
}

TEST(APendulum, KeepsItsEnergy) {
  RobotPackFields fields = pendulumFields();
  fields.start_positions = {1.0F};
  const MadeRobot robot(fields);
  const RobotKit kit(*robot, pendulumParts());
  DynamicsWorld world(flatFloor(), {}, {.most_impulse = 0});
  world.addRobot(kit.setup(kAbove));
  const double lowest = kArmMass * kGravity * (2 - kArmLength);
  const double at_start = world.robotEnergy() - lowest;
  EXPECT_NEAR(at_start, kArmMass * kGravity * kArmLength * (1 - std::cos(1.0)), 1e-3);
  double least = at_start;
  double most = at_start;
  for (int n = 0; n < 150; ++n) {
    world.step();
    least = std::min(least, world.robotEnergy() - lowest);
    most = std::max(most, world.robotEnergy() - lowest);
  }
  // Semi-implicit Euler wobbles about the true energy and does not drift.
  EXPECT_GT(least, 0.9 * at_start);
  EXPECT_LT(most, 1.1 * at_start);
}

TEST(AMotor, BringsItsJointToTheTargetAndHoldsIt) {
  const MadeRobot robot(pendulumFields());
  const RobotKit kit(*robot, pendulumParts());
  DynamicsWorld world(flatFloor(), {}, {});
  world.addRobot(kit.setup(kAbove));
  const std::vector<float> target{0.4F};
  world.drive(kAbove, target);
  std::vector<double> errors{0.3};
  for (int n = 0; n < 30; ++n) {
    world.step();
    errors.push_back(std::abs(0.4 - static_cast<double>(world.positions()[0])));
  }
  // Each substep takes away 30 % of the error: after the eight of two steps 6 % are left. The
  // second term of the motor slows it down at first.
  EXPECT_LT(errors[1], 0.6 * errors[0]);
  EXPECT_LT(errors[4], 0.1 * errors[0]);
  // In a substep of h gravity adds 14 rad/s^2 h, and the motor takes away 30 % of the error / h.
  EXPECT_NEAR(errors.back(), 14.3 / (120 * 120) / 0.3, 2e-3);
}

TEST(AMotor, OfAJointThatFollowsAnotherIsNotTakenForIt) {
  RobotPackFields fields = pendulumFields();
  fields.links.push_back(fields.links[1]);
  fields.links[2].parent_from_joint.translation.z = -0.5F;
  fields.links[2].multiplier = -0.5F;
  fields.links[2].offset = 0.2F;
  fields.link_names.emplace_back("follower");
  fields.joint_names.emplace_back("follow");
  fields.spheres.push_back(fields.spheres.back());
  fields.groups.push_back({2, {2}, 2, 1, SphereStatisticsFields{}});
  const MadeRobot robot(fields);
  dynamics::RobotParts parts = pendulumParts();
  parts.body_of_link.push_back(2);
  parts.links.push_back(parts.links[1]);
  const RobotKit kit(*robot, parts);
  DynamicsWorld world(flatFloor(), {}, {});
  world.addRobot(kit.setup(kAbove));
  world.drive(kAbove, std::vector<float>{1});
  for (int n = 0; n < 30; ++n) world.step();
  EXPECT_NEAR(world.positions()[0], 1, 0.02);
}

TEST(AMotor, ThatIsTooWeakDoesNotHoldTheArm) {
  const MadeRobot robot(pendulumFields());
  const RobotKit kit(*robot, pendulumParts());
  // Of the 1.53 N m that gravity pulls with at 0.4 rad it gives 0.12.
  DynamicsWorld world(flatFloor(), {}, {.most_impulse = 0.001});
  world.addRobot(kit.setup(kAbove));
  world.drive(kAbove, std::vector<float>{1.5F});
  for (int n = 0; n < 60; ++n) world.step();
  EXPECT_LT(world.positions()[0], 0.5F);
}

TEST(AKinematicArm, IsWhereItIsAskedToBe) {
  const MadeRobot robot(pendulumFields());
  const RobotKit kit(*robot, pendulumParts());
  DynamicsWorld world(flatFloor(), {}, {.arm = ArmDrive::kKinematic});
  world.addRobot(kit.setup(kAbove));
  world.drive({{0.5F, 2, 0}, {}}, std::vector<float>{1.5F});
  world.step();
  EXPECT_EQ(world.positions()[0], 1.5F);
  EXPECT_EQ(world.worldFromRoot().translation.x, 0.5F);
}

TEST(AnArm, PushesAnObjectAside) {
  for (const ArmDrive drive : {ArmDrive::kMotors, ArmDrive::kKinematic}) {
    const MadeRobot robot(pendulumFields());
    const RobotKit kit(*robot, pendulumParts());
    // The arm hangs down to 0.1 m, beside it stands a box.
    const Pose low{{0, 0.5F, 0}, {}};
    const std::vector<PlacedObject> objects{
        boxAt({{0.2F, 0.15F, 0.5F}, {}}, {0.05F, 0.15F, 0.05F})};
    DynamicsWorld world(flatFloor(), objects, {.arm = drive});
    world.addRobot(kit.setup(low));
    for (float target = 0.1F; target < 1.2F; target += 0.1F) {
      world.drive(low, std::vector<float>{target});
      world.step();
    }
    EXPECT_GT(world.objectPose(0).translation.x, 0.3F) << static_cast<int>(drive);
  }
}

}  // namespace
}  // namespace galactic::test::mechanics_test
