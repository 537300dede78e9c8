#include "galactic/robot.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/packs/object_pack_builder.h"
#include "support/packs/robot_pack_builder.h"

namespace galactic::test::robot_test {
namespace {

TEST(Robot, ShowsTheTreeThatThePackHolds) {
  const RobotPackFields fields = smallRobotPack();
  const AlignedBytes bytes = buildPack(fields);
  const Result<PackFile> pack = PackFile::view(bytes.bytes(), "helper.pack");
  ASSERT_TRUE(pack.has_value()) << pack.error().message;
  const Result<Robot> robot = Robot::from(*pack);
  ASSERT_TRUE(robot.has_value()) << robot.error().message;
  EXPECT_EQ(robot->name(), "helper");
  EXPECT_EQ(robot->radii()[0], 0.015F);
  ASSERT_EQ(robot->links().size(), fields.links.size());
  for (std::size_t n = 0; n < fields.links.size(); ++n) {
    const LinkFrame& made = fields.links[n];
    const LinkFrame& link = robot->links()[n];
    EXPECT_EQ(link.parent_from_joint, made.parent_from_joint);
    EXPECT_EQ(link.axis, made.axis);
    EXPECT_EQ(link.parent, made.parent);
    EXPECT_EQ(link.position, made.position);
    EXPECT_EQ(link.multiplier, made.multiplier);
    EXPECT_EQ(link.offset, made.offset);
    EXPECT_EQ(link.type, made.type);
    EXPECT_EQ(robot->linkName(n), fields.link_names[n]);
    EXPECT_EQ(robot->jointName(n), fields.joint_names[n]);
    EXPECT_EQ(robot->findLink(fields.link_names[n]), n);
    // The root hangs on no joint.
    EXPECT_EQ(robot->findJoint(fields.joint_names[n]), n == 0 ? std::nullopt : std::optional(n));
  }
  EXPECT_EQ(robot->findLink("nobody"), std::nullopt);
  EXPECT_EQ(robot->findJoint("nobody"), std::nullopt);
  ASSERT_EQ(robot->positionCount(), fields.limits.size());
  EXPECT_EQ(robot->limits()[1].lower, -1);
  EXPECT_EQ(robot->limits()[1].upper, 2);
  EXPECT_EQ(std::vector(robot->startPositions().begin(), robot->startPositions().end()),
            fields.start_positions);
}

TEST(Robot, ShowsTheSpheresOfEachGroupAndOnlyThePairsToTest) {
  const RobotPackFields fields = smallRobotPack();
  const AlignedBytes bytes = buildPack(fields);
  const Result<PackFile> pack = PackFile::view(bytes.bytes(), "helper.pack");
  ASSERT_TRUE(pack.has_value());
  const Result<Robot> robot = Robot::from(*pack);
  ASSERT_TRUE(robot.has_value());
  EXPECT_EQ(std::vector(robot->spheres().begin(), robot->spheres().end()), fields.spheres);
  ASSERT_EQ(robot->groups().size(), fields.groups.size());
  for (std::size_t n = 0; n < fields.groups.size(); ++n) {
    EXPECT_EQ(robot->groups()[n].link, fields.groups[n].link);
    EXPECT_EQ(robot->groups()[n].spheres.size(), fields.groups[n].sphere_count);
    EXPECT_EQ(robot->groups()[n].spheres.data(),
              robot->spheres().data() + fields.groups[n].first_sphere);
    EXPECT_TRUE(std::ranges::equal(robot->groups()[n].links, fields.groups[n].links));
  }
  ASSERT_EQ(robot->groupPairs().size(), 3U);
  EXPECT_EQ(robot->groupPairs()[1].kind, PairKind::kNever);
  EXPECT_EQ(robot->groupPairs()[2].kind, PairKind::kAdjacent);
  ASSERT_EQ(robot->testedPairs().size(), 1U);
  EXPECT_EQ(robot->testedPairs()[0].first, 0);
  EXPECT_EQ(robot->testedPairs()[0].second, 2);
}

TEST(Robot, ShowsWhatTheRecipeAdded) {
  const AlignedBytes bytes = buildPack(smallRobotPack());
  const Result<PackFile> pack = PackFile::view(bytes.bytes(), "helper.pack");
  ASSERT_TRUE(pack.has_value());
  const Result<Robot> robot = Robot::from(*pack);
  ASSERT_TRUE(robot.has_value());
  ASSERT_EQ(robot->controlledJoints().size(), 2U);
  EXPECT_EQ(robot->controlledJoints()[0].position, 1U);
  EXPECT_EQ(robot->controlledJoints()[0].step, 0.2F);
  EXPECT_EQ(robot->controlledJoints()[0].lower, -0.5F);
  EXPECT_EQ(robot->controlledJoints()[0].upper, 1.5F);
  ASSERT_TRUE(robot->endEffector().has_value());
  EXPECT_EQ(robot->endEffector()->link, 3U);
  EXPECT_EQ(robot->endEffector()->grasp_point, (Vec3{0.1F, 0, 0}));
  EXPECT_EQ(robot->endEffector()->grasp_radius, 0.015F);
  ASSERT_TRUE(robot->camera().has_value());
  EXPECT_EQ(robot->camera()->link, 1U);
  EXPECT_EQ(robot->camera()->link_from_camera, (Pose{{0, 0.2F, 0}, {0, 0, 0, 1}}));
  EXPECT_EQ(robot->camera()->vertical_fov, 1);
  ASSERT_TRUE(robot->laser().has_value());
  EXPECT_EQ(robot->laser()->link, 0U);
  EXPECT_EQ(robot->laser()->link_from_laser, (Pose{{0.1F, 0.2F, 0}, {0, 0, 0, 1}}));
  EXPECT_EQ(robot->laser()->field_of_view, 4);
  EXPECT_EQ(robot->laser()->least_range, 0.05F);
  EXPECT_EQ(robot->laser()->range, 8);
  EXPECT_EQ(robot->laser()->noise, 0.01F);
  ASSERT_TRUE(robot->base().has_value());
  EXPECT_EQ(robot->base()->forward_step, 0.1F);
  EXPECT_EQ(robot->base()->turn_step, 0.05F);
  EXPECT_EQ(robot->base()->root_height, 0.25F);
  EXPECT_EQ(robot->base()->footprint_min, (Vec3{-0.3F, 0, -0.2F}));
  EXPECT_EQ(robot->base()->footprint_max, (Vec3{0.3F, 0, 0.2F}));
  EXPECT_EQ(robot->base()->footprint_radius, 0);
}

TEST(Robot, IsWithoutHandSensorsAndBaseWhereNoRecipeGaveThem) {
  RobotPackFields fields = smallRobotPack();
  fields.end_effector.reset();
  fields.camera.reset();
  fields.base.reset();
  fields.laser.reset();
  fields.controlled_joints.clear();
  const AlignedBytes bytes = buildPack(fields);
  const Result<PackFile> pack = PackFile::view(bytes.bytes(), "helper.pack");
  ASSERT_TRUE(pack.has_value());
  const Result<Robot> robot = Robot::from(*pack);
  ASSERT_TRUE(robot.has_value());
  EXPECT_FALSE(robot->endEffector().has_value());
  EXPECT_FALSE(robot->camera().has_value());
  EXPECT_FALSE(robot->base().has_value());
  EXPECT_FALSE(robot->laser().has_value());
  EXPECT_TRUE(robot->controlledJoints().empty());
}

TEST(Robot, RefusesAPackOfAnotherKind) {
  const AlignedBytes bytes = buildPack(smallObjects());
  const Result<PackFile> pack = PackFile::view(bytes.bytes(), "objects.pack");
  ASSERT_TRUE(pack.has_value());
  const Result<Robot> robot = Robot::from(*pack);
  ASSERT_FALSE(robot.has_value());
  EXPECT_EQ(robot.error().code, ErrorCode::kInvalidInput);
  EXPECT_EQ(robot.error().where, "objects.pack");
  EXPECT_EQ(robot.error().message,
            "is a pack of kind OBJS, expected a robot (RBOT); give the pack of a robot");
}

}  // namespace
}  // namespace galactic::test::robot_test
