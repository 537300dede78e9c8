// One wrong value per field of a robot pack whose hash is right: each has its own message.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "galactic/kinematics.h"
#include "galactic/pack.h"
#include "galactic/robot.h"
#include "runtime/check/pack_damage.h"
#include "runtime/check/pack_offence.h"
#include "support/packs/robot_pack_builder.h"

namespace galactic::test::robot_check_test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

using Fields = RobotPackFields;
using Offence = PackOffence<RobotPackFields>;

void refuse(std::vector<Offence> offences) {
  for (Offence& offence : offences) offence.where = "robot." + offence.where;
  expectRefused(smallRobotPack(), offences);
}

TEST(RobotCheck, AcceptsTheRobotThatTheOffencesBelowStartFrom) {
  const AlignedBytes bytes = buildPack(smallRobotPack());
  const Result<PackFile> pack = PackFile::view(bytes.bytes(), "made.pack");
  ASSERT_TRUE(pack.has_value()) << pack.error().text();
}

TEST(RobotCheck, AcceptsARobotWithoutARecipe) {
  RobotPackFields fields = smallRobotPack();
  fields.end_effector.reset();
  fields.camera.reset();
  fields.base.reset();
  fields.controlled_joints.clear();
  const AlignedBytes bytes = buildPack(fields);
  EXPECT_TRUE(PackFile::view(bytes.bytes(), "made.pack").has_value());
}

TEST(RobotCheck, AcceptsASingleLinkThatCannotMove) {
  RobotPackFields fields = smallRobotPack();
  fields.links.resize(1);
  fields.link_names.resize(1);
  fields.joint_names.resize(1);
  fields.limits.clear();
  fields.start_positions.clear();
  fields.groups = {{0, {0}, 0, 4, std::nullopt}};
  fields.spheres = {{{0, 0, 0}, 1}, {{0, 0, 0}, 0}, {{0, 0, 1}, 0}, {{0, 1, 0}, 0}};
  fields.group_pairs.clear();
  fields.controlled_joints.clear();
  fields.end_effector->link = 0;
  fields.camera->link = 0;
  fields.surfaces.clear();
  const AlignedBytes bytes = buildPack(fields);
  const Result<PackFile> pack = PackFile::view(bytes.bytes(), "made.pack");
  EXPECT_TRUE(pack.has_value()) << pack.error().text();
}

TEST(RobotCheck, RefusesWrongNamesAndSizes) {
  const std::string per_link = " elements, expected 8, one per link";
  const std::string own = "is empty or a repeated name, expected each link's own";
  const std::string joint = "is empty or a repeated name, expected each joint's own";
  refuse({
      {"name", "is empty, expected the robot's name", [](Fields& r) { r.name.clear(); }},
      {"radii", "has 0 elements, expected 1 to 8", [](Fields& r) { r.radii.clear(); }},
      {"radii[1]", "is 0.01 m after 0.015 m, expected ascending radii of up to 800 m",
       [](Fields& r) { r.radii[1] = 0.01F; }},
      {"links", "has 0 links, expected 1 to 65535", [](Fields& r) { r.links.clear(); }},
      {"link_names", "has 7" + per_link, [](Fields& r) { r.link_names.pop_back(); }},
      {"joint_names", "has 9" + per_link, [](Fields& r) { r.joint_names.emplace_back("more"); }},
      {"start_positions", "has 12 elements, expected 13, one per position",
       [](Fields& r) { r.start_positions.pop_back(); }},
      {"link_names[2]", own, [](Fields& r) { r.link_names[2] = "base"; }},
      {"link_names[0]", own, [](Fields& r) { r.link_names[0].clear(); }},
      {"joint_names[0]", "is 'anchor', expected none: the root has no joint",
       [](Fields& r) { r.joint_names[0] = "anchor"; }},
      {"joint_names[3]", joint, [](Fields& r) { r.joint_names[3].clear(); }},
      {"joint_names[4]", joint, [](Fields& r) { r.joint_names[4] = "lift"; }},
  });
}

TEST(RobotCheck, RefusesWrongLinks) {
  const std::string parent = ", expected -1 for the first link and an earlier link for the others";
  const std::string rigid = "is not a rigid transform, expected up to 800 m and a unit quaternion";
  const std::string numbers = "or offset is not finite or too large, expected up to 1000 and 1000";
  const std::string axis = "has not length 1, expected a direction";
  refuse({
      {"links[0].parent", "is 0" + parent, [](Fields& r) { r.links[0].parent = 0; }},
      {"links[3].parent", "is 3" + parent, [](Fields& r) { r.links[3].parent = 3; }},
      {"links[3].parent", "is -1" + parent, [](Fields& r) { r.links[3].parent = -1; }},
      {"links[1].parent", "is 2147483647" + parent,
       [](Fields& r) { r.links[1].parent = std::numeric_limits<std::int32_t>::max(); }},
      {"links[1].parent_from_joint", rigid,
       [](Fields& r) { r.links[1].parent_from_joint.rotation.w = 0; }},
      {"links[1].parent_from_joint", rigid,
       [](Fields& r) { r.links[1].parent_from_joint.translation.x = kInfinity; }},
      {"links[7].type", "is 6, expected a value up to 5", [](Fields& r) { r.last_type = 6; }},
      {"links[4].multiplier", numbers, [](Fields& r) { r.links[4].multiplier = kNan; }},
      {"links[4].multiplier", numbers, [](Fields& r) { r.links[4].offset = kInfinity; }},
      {"links[4].multiplier", numbers, [](Fields& r) { r.links[4].multiplier = 3e38F; }},
      {"links[0].type", "is 1 at the root, expected 0: it has no joint",
       [](Fields& r) {
         r.links[0].type = JointType::kRevolute;
         r.links[0].position = 0;
       }},
      {"links[5].position", "is 0 at a fixed joint, expected -1",
       [](Fields& r) { r.links[5].position = 0; }},
      {"links[2].axis", axis,
       [](Fields& r) {
         r.links[2].axis = {0, 0, 0};
       }},
      {"links[2].axis", axis,
       [](Fields& r) {
         r.links[2].axis = {kNan, 0, 0};
       }},
      {"links[2].position", "is -1, expected 1 values among the 13 positions",
       [](Fields& r) { r.links[2].position = -1; }},
      {"links[3].position", "is 13, expected 1 values among the 13 positions",
       [](Fields& r) { r.links[3].position = 13; }},
      {"links[6].position", "is 11, expected 3 values among the 13 positions",
       [](Fields& r) { r.links[6].position = 11; }},
      {"links[7].position", "is 7, expected 7 values among the 13 positions",
       [](Fields& r) { r.links[7].position = 7; }},
  });
}

TEST(RobotCheck, RefusesWrongPositions) {
  refuse({
      {"limits[0]", "are nan to 0.5, expected finite ascending limits",
       [](Fields& r) { r.limits[0].lower = kNan; }},
      {"limits[2]", "are -inf to 0, expected finite ascending limits",
       [](Fields& r) {
         r.limits[2] = {-kInfinity, 0};
       }},
      {"limits[1]", "are -1 to -2, expected finite ascending limits",
       [](Fields& r) { r.limits[1].upper = -2; }},
      {"start_positions[0]", "is 0.75, expected 0 to 0.5",
       [](Fields& r) { r.start_positions[0] = 0.75F; }},
      {"start_positions[1]", "is nan, expected -1 to 2",
       [](Fields& r) { r.start_positions[1] = kNan; }},
  });
}

TEST(RobotCheck, RefusesWrongGroups) {
  const std::string range = ", expected 2 and at most 2";
  refuse({
      {"groups[0].links", "does not begin with link 0, expected the group's own link first",
       [](Fields& r) {
         r.groups[0].links = {5, 0};
       }},
      {"groups[1].links", "does not begin with link 1, expected the group's own link first",
       [](Fields& r) { r.groups[1].links.clear(); }},
      {"groups[1].links[1]", "is 5, expected one of 8 links that is in no other group",
       [](Fields& r) { r.groups[1].links.push_back(5); }},
      {"groups[0].links[1]", "is 8, expected one of 8 links that is in no other group",
       [](Fields& r) { r.groups[0].links[1] = 8; }},
      {"groups[0].links[2]", "is 5 after 6, expected ascending links",
       [](Fields& r) {
         r.groups[0].links = {0, 6, 5};
         r.groups.erase(r.groups.begin() + 5);
       }},
      {"groups[2].link", "does not ascend, expected ascending links",
       [](Fields& r) { std::swap(r.groups[2], r.groups[1]); }},
      {"groups[2].first_sphere", "and count are 1 and 1" + range,
       [](Fields& r) { r.groups[2].first_sphere = 1; }},
      {"groups[2].first_sphere", "and count are 2 and 4294967295" + range,
       [](Fields& r) { r.groups[2].sphere_count = 0xffffffff; }},
      {"groups[2].statistics.tau", "is nan, expected a finite number of 0 or more",
       [](Fields& r) { r.groups[2].statistics->tau = kNan; }},
      {"spheres[3].center", "is farther than 800 m or not finite, expected coordinates",
       [](Fields& r) { r.spheres[3].center.x = kNan; }},
      {"spheres[0].radius_index", "is 2, expected less than the number of radii 2",
       [](Fields& r) { r.spheres[0].radius_index = 2; }},
      {"spheres[1]",
       "comes before its predecessor, expected descending radii, then ascending centers",
       [](Fields& r) { std::swap(r.spheres[0], r.spheres[1]); }},
      {"spheres[1]",
       "comes before its predecessor, expected descending radii, then ascending centers",
       [](Fields& r) {
         r.spheres[1] = r.spheres[0];
         r.spheres[1].center.z -= 0.1F;
       }},
      {"spheres", "has 5 elements, expected the 4 that the groups name",
       [](Fields& r) { r.spheres.push_back(r.spheres.back()); }},
      {"groups", "name 7 links, expected all 8, each once",
       [](Fields& r) { r.groups[0].links.pop_back(); }},
  });
}

TEST(RobotCheck, RefusesWrongPairs) {
  refuse({
      {"group_pairs[0]", "is (2, 2), expected two ascending groups of 7",
       [](Fields& r) { r.group_pairs[0].first = 2; }},
      {"group_pairs[2]", "is (2, 7), expected two ascending groups of 7",
       [](Fields& r) { r.group_pairs[2].second = 7; }},
      {"group_pairs[1]", "does not ascend, expected each pair once",
       [](Fields& r) { r.group_pairs[1] = r.group_pairs[0]; }},
      {"group_pairs[1].kind", "is 5, expected a value up to 4",
       [](Fields& r) { r.group_pairs[1].kind = 5; }},
  });
}

TEST(RobotCheck, RefusesWrongControlledJoints) {
  refuse({
      {"controlled_joints[1].position", "is 13, expected one of 13 positions",
       [](Fields& r) { r.controlled_joints[1].position = 13; }},
      {"controlled_joints[1].position", "is 1 again, expected each position once",
       [](Fields& r) { r.controlled_joints[1] = r.controlled_joints[0]; }},
      {"controlled_joints[0].step", "is 0, expected a number above 0 and up to 1000",
       [](Fields& r) { r.controlled_joints[0].step = 0; }},
      {"controlled_joints[0].step", "is inf, expected a number above 0 and up to 1000",
       [](Fields& r) { r.controlled_joints[0].step = kInfinity; }},
      {"controlled_joints[0].lower", "and upper are -2 and 1.5, expected ascending, in -1 to 2",
       [](Fields& r) { r.controlled_joints[0].lower = -2; }},
      {"controlled_joints[0].lower", "and upper are -0.5 and 3, expected ascending, in -1 to 2",
       [](Fields& r) { r.controlled_joints[0].upper = 3; }},
      {"controlled_joints[0].lower", "and upper are 1 and 0.5, expected ascending, in -1 to 2",
       [](Fields& r) {
         r.controlled_joints[0].lower = 1;
         r.controlled_joints[0].upper = 0.5F;
       }},
      {"controlled_joints[0].lower", "and upper are nan and 1.5, expected ascending, in -1 to 2",
       [](Fields& r) { r.controlled_joints[0].lower = kNan; }},
  });
}

TEST(RobotCheck, RefusesWrongEndEffectorsAndCameras) {
  const std::string point = "is missing, farther than 800 m or not finite, expected coordinates";
  const std::string pose = "is missing or not a rigid transform, expected a pose";
  refuse({
      {"end_effector.link", "is 8, expected one of 8 links",
       [](Fields& r) { r.end_effector->link = 8; }},
      {"end_effector.grasp_point", point, [](Fields& r) { r.end_effector->grasp_point.reset(); }},
      {"end_effector.grasp_point", point,
       [](Fields& r) { r.end_effector->grasp_point->y = kInfinity; }},
      {"end_effector.grasp_point", point,
       [](Fields& r) { r.end_effector->grasp_point->y = 1e20F; }},
      {"end_effector.grasp_radius", "is 0 m, expected a length above 0 and up to 800 m",
       [](Fields& r) { r.end_effector->grasp_radius = 0; }},
      {"camera.link", "is 9, expected one of 8 links", [](Fields& r) { r.camera->link = 9; }},
      {"camera.link_from_camera", pose, [](Fields& r) { r.camera->link_from_camera.reset(); }},
      {"camera.link_from_camera", pose,
       [](Fields& r) { r.camera->link_from_camera->rotation.y = 1; }},
      {"camera.vertical_fov", "is 0 rad, expected 0.001 to 3.14",
       [](Fields& r) { r.camera->vertical_fov = 0; }},
      {"camera.vertical_fov", "is 3.5 rad, expected 0.001 to 3.14",
       [](Fields& r) { r.camera->vertical_fov = 3.5F; }},
      {"camera.vertical_fov", "is nan rad, expected 0.001 to 3.14",
       [](Fields& r) { r.camera->vertical_fov = kNan; }},
  });
}

TEST(RobotCheck, RefusesWrongLasers) {
  const std::string pose = "is missing or not a rigid transform, expected a pose";
  refuse({
      {"laser.link", "is 8, expected one of 8 links", [](Fields& r) { r.laser->link = 8; }},
      {"laser.link_from_laser", pose, [](Fields& r) { r.laser->link_from_laser.reset(); }},
      {"laser.link_from_laser", pose,
       [](Fields& r) { r.laser->link_from_laser->translation.x = kInfinity; }},
      {"laser.field_of_view", "is -1 rad, expected 0 to 2 pi",
       [](Fields& r) { r.laser->field_of_view = -1; }},
      {"laser.field_of_view", "is 6.5 rad, expected 0 to 2 pi",
       [](Fields& r) { r.laser->field_of_view = 6.5F; }},
      {"laser.field_of_view", "is nan rad, expected 0 to 2 pi",
       [](Fields& r) { r.laser->field_of_view = kNan; }},
      {"laser.range", "is 0 m, expected a length above 0 and up to 800 m",
       [](Fields& r) { r.laser->range = 0; }},
      {"laser.range", "is inf m, expected a length above 0 and up to 800 m",
       [](Fields& r) { r.laser->range = kInfinity; }},
      {"laser.least_range", "is -1 m, expected 0 to less than the range",
       [](Fields& r) { r.laser->least_range = -1; }},
      {"laser.least_range", "is 8 m, expected 0 to less than the range",
       [](Fields& r) { r.laser->least_range = 8; }},
      {"laser.noise", "is -1 m, expected 0 to 800 m", [](Fields& r) { r.laser->noise = -1; }},
      {"laser.noise", "is nan m, expected 0 to 800 m", [](Fields& r) { r.laser->noise = kNan; }},
  });
}

TEST(RobotCheck, RefusesWrongBases) {
  const std::string rectangle =
      "or footprint_max is missing, not finite or not ascending, expected a rectangle";
  refuse({
      {"base.forward_step", "or turn_step is 0 or 0.05, expected numbers above 0 and up to 800",
       [](Fields& r) { r.base->forward_step = 0; }},
      {"base.forward_step", "or turn_step is 0.1 or nan, expected numbers above 0 and up to 800",
       [](Fields& r) { r.base->turn_step = kNan; }},
      {"base.sideways_step", "is -0.1 m, expected 0 to 800 m",
       [](Fields& r) { r.base->sideways_step = -0.1F; }},
      {"base.sideways_step", "is nan m, expected 0 to 800 m",
       [](Fields& r) { r.base->sideways_step = kNan; }},
      {"base.sideways_step", "is inf m, expected 0 to 800 m",
       [](Fields& r) { r.base->sideways_step = kInfinity; }},
      {"base.root_height", "is inf m, expected up to 800 m",
       [](Fields& r) { r.base->root_height = kInfinity; }},
      {"base.footprint_min", rectangle, [](Fields& r) { r.base->footprint_min.reset(); }},
      {"base.footprint_min", rectangle, [](Fields& r) { r.base->footprint_max.reset(); }},
      {"base.footprint_min", rectangle, [](Fields& r) { r.base->footprint_min->z = 0.5F; }},
      {"base.footprint_min", rectangle, [](Fields& r) { r.base->footprint_max->x = kNan; }},
      {"base.footprint_radius", "is -1 m, expected 0 to 800 m",
       [](Fields& r) { r.base->footprint_radius = -1; }},
  });
}

TEST(RobotCheck, RefusesWrongSurfaces) {
  const std::string link = ", expected ascending links below 8";
  refuse({
      {"surfaces[2].link", "is 8" + link, [](Fields& r) { r.surfaces[2].link = 8; }},
      {"surfaces[1].link", "is 0" + link, [](Fields& r) { r.surfaces[1].link = 0; }},
      {"surfaces[0].collision.positions[3]",
       "is farther than 800 m or not finite, expected coordinates",
       [](Fields& r) { r.surfaces[0].collision->positions[3].y = kNan; }},
      {"surfaces[2].visual.triangles[0]", "is not the index of one of the 4 positions",
       [](Fields& r) { r.surfaces[2].visual->triangles[0] = 4; }},
  });
}

TEST(DamagedRobotPack, IsRefusedAtEachLengthOfATruncation) {
  expectEachTruncationRefused(buildPack(smallRobotPack()));
}

TEST(DamagedRobotPack, IsRefusedWithBytesTooMany) {
  expectBytesTooManyRefused(buildPack(smallRobotPack()));
}

TEST(DamagedRobotPack, IsRefusedAfterEachFlipOfASingleBit) {
  expectEachBitFlipRefused(buildPack(smallRobotPack()));
}

/// Reads what the views show and moves the robot; a sanitizer sees a read outside the pack.
void useRobot(const PackFile& pack) {
  const Result<Robot> robot = Robot::from(pack);
  ASSERT_TRUE(robot.has_value());
  std::vector<Pose> poses(robot->links().size());
  forwardKinematics(robot->links(), {}, robot->startPositions(), poses);
  for (std::size_t n = 0; n < poses.size(); ++n) {
    ASSERT_FALSE(robot->linkName(n).empty());
    ASSERT_EQ(robot->jointName(n).empty(), n == 0);
    ASSERT_EQ(robot->findLink(robot->linkName(n)), n);
    const Quat& q = poses[n].rotation;
    ASSERT_FALSE(std::isnan(q.x + q.y + q.z + q.w));
  }
  std::size_t spheres = 0;
  for (const SphereGroup& group : robot->groups()) {
    ASSERT_LT(group.link, poses.size());
    for (const SetSphere& sphere : group.spheres) {
      ASSERT_GT(robot->radii()[sphere.radius_index], 0);
    }
    spheres += group.spheres.size();
  }
  ASSERT_EQ(spheres, robot->spheres().size());
  for (const GroupPair& pair : robot->testedPairs()) {
    ASSERT_LT(pair.first, pair.second);
    ASSERT_LT(pair.second, robot->groups().size());
  }
  for (const ControlledJoint& joint : robot->controlledJoints()) {
    ASSERT_LT(joint.position, robot->positionCount());
  }
  ASSERT_TRUE(!robot->endEffector() || robot->endEffector()->link < poses.size());
  ASSERT_TRUE(!robot->camera() || robot->camera()->link < poses.size());
}

TEST(DamagedRobotPack, WithARecomputedHashIsRefusedOrSafeToUseAfterEachFlip) {
  expectFlipsWithARightHashRefusedOrUsable(buildPack(smallRobotPack()), PackKind::kRobot, useRobot);
}

}  // namespace
}  // namespace galactic::test::robot_check_test
