// Robots written as URDF and SRDF and read again by the importers of the bake.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <random>

#include "galactic/bake/packs.h"
#include "galactic/bake/robot_baker.h"
#include "galactic/bake/robot_import.h"
#include "pack_tool/asset_packs.h"
#include "pack_tool/export/robot_text.h"
#include "robot_description/hand_spheres.h"
#include "support/homes/sample_world.h"
#include "support/scratch_folder.h"

namespace galactic::pack_tool::robot_round_trip_test {
namespace {

using test::ScratchFolder;
using test::ToyPack;
using test::ToyRobot;

constexpr unsigned kSeed = 20230612;
/// Poses of a robot of two meters, through quaternions and angles in floats.
constexpr float kPoseTolerance = 1e-5F;

Robot robotOf(const ToyPack& pack) { return *Robot::from(*pack); }

/// The robot as the bake makes it of its own export.
bake::BakedRobot bakedAgain(const ScratchFolder& folder, const Robot& robot) {
  const auto path = folder.write("again.urdf", spherizedUrdfText(robot));
  const auto source = bake::importRobot(path);
  const auto spheres = bake::readSpherizedRobot(path);
  EXPECT_TRUE(source.has_value()) << source.error().message;
  EXPECT_TRUE(spheres.has_value()) << spheres.error().message;
  bake::RobotBakeOptions options;
  options.radii = {robot.radii().begin(), robot.radii().end()};
  options.hand_spheres = *spheres;
  auto baked = bake::bakeRobot(*source, nullptr, options);
  EXPECT_TRUE(baked.has_value()) << baked.error().message;
  return std::move(*baked);
}

/// Where the links are, by name.
std::map<std::string, Pose> posesOf(std::span<const LinkFrame> links,
                                    const std::vector<std::string>& names,
                                    const std::vector<float>& positions) {
  std::vector<Pose> world_from_link(links.size());
  forwardKinematics(links, {}, positions, world_from_link);
  std::map<std::string, Pose> poses;
  for (std::size_t n = 0; n < names.size(); ++n) poses[names[n]] = world_from_link[n];
  return poses;
}

void expectSameMotion(const Robot& robot, const bake::BakedRobot& again, std::mt19937& random) {
  std::vector<std::string> names;
  for (std::size_t n = 0; n < robot.links().size(); ++n) names.emplace_back(robot.linkName(n));
  ASSERT_EQ(again.kinematics.limits.size(), 2U);
  for (int pose = 0; pose < 20; ++pose) {
    const auto unit = [&random] { return static_cast<float>(random() % 1001) / 1000; };
    const std::vector<float> positions{-1 + 3 * unit(), -1 + 2 * unit()};
    const auto before = posesOf(robot.links(), names, positions);
    const auto after = posesOf(again.kinematics.links, again.link_names, positions);
    ASSERT_EQ(after.size(), before.size());
    for (const auto& [name, was] : before) {
      // A point off the origin sees the rotation too.
      const Vec3 away = after.at(name) * Vec3{1, 1, 1} - was * Vec3{1, 1, 1};
      EXPECT_LT(std::sqrt(dot(away, away)), kPoseTolerance) << "seed " << kSeed << " " << name;
    }
  }
}

TEST(ExportedUrdf, MovesAsThePackDoesWhateverTheRotations) {
  std::mt19937 random(kSeed);
  const auto number = [&random] { return (static_cast<float>(random() % 2001) - 1000) / 1000; };
  const float half = std::sqrt(0.5F);
  // First at the poles, where roll and yaw are one: a quarter turn about the runtime's Z.
  std::vector<Quat> rotations{{0, 0, half, half},
                              {0, 0, -half, half},
                              {0.5F, 0.5F, 0.5F, 0.5F},
                              {0.5F, -0.5F, -0.5F, 0.5F}};
  while (rotations.size() < 12) {
    const std::array<float, 4> q{number(), number(), number(), number()};
    const float length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (length < 0.1F) continue;
    rotations.emplace_back(q[0] / length, q[1] / length, q[2] / length, q[3] / length);
  }
  for (const Quat& rotation : rotations) {
    const ScratchFolder folder;
    const ToyPack pack{ToyRobot{.upper_rotation = rotation}};
    const Robot robot = robotOf(pack);
    expectSameMotion(robot, bakedAgain(folder, robot), random);
  }
}

/// A body with two hinges, one of them beside its origin, whose zero is not where the text places
/// it, and fingers that follow each other.
constexpr const char* kMjcf = R"(<mujoco model="m"><compiler angle="radian"/><worldbody>
<body name="base"><freejoint/><geom type="box" size=".2 .2 .1"/>
<body name="arm" pos="0 0 .3" euler=".3 .2 .1">
<joint name="pan" axis="0 0 1" pos=".1 0 0" ref=".4" range="-1 2"/>
<joint name="tilt" axis="0 1 1" pos="0 .1 0" range="-1 1"/><geom type="capsule" size=".05 .2"/>
<body name="left" pos=".3 .05 0"><joint name="l" type="slide" axis="0 1 0" range="0 .05"/>
<geom type="box" size=".05 .01 .02"/></body>
<body name="right" pos=".3 -.05 0"><joint name="r" type="slide" axis="0 -1 0" range="0 .05"/>
<geom type="box" size=".05 .01 .02"/></body></body></body></worldbody>
<equality><joint joint1="r" joint2="l"/></equality></mujoco>)";

TEST(ExportedUrdf, OfARobotThatWasAnMjcfMovesAsItDoes) {
  const ScratchFolder folder;
  const auto source = bake::importRobot(folder.write("m.xml", kMjcf));
  ASSERT_TRUE(source.has_value()) << source.error().text();
  bake::RobotBakeOptions options;
  options.radii = {0.02F, 0.1F};
  const auto baked = bake::bakeRobot(*source, nullptr, options);
  ASSERT_TRUE(baked.has_value()) << baked.error().text();
  const test::MemoryPack pack(
      PackKind::kRobot,
      test::MemoryPack::opened(bake::encodeRobotPack(*baked, test::testProvenance("m.xml"))), "m");
  const Robot robot = *Robot::from(pack.pack());
  const bake::BakedRobot again = bakedAgain(folder, robot);
  ASSERT_EQ(again.kinematics.limits.size(), 3U);
  std::vector<std::string> names;
  for (std::size_t n = 0; n < robot.links().size(); ++n) names.emplace_back(robot.linkName(n));
  for (const std::vector<float>& positions :
       {std::vector<float>{0, 0, 0}, {0.4F, 0, 0.02F}, {-0.7F, 0.9F, 0.05F}}) {
    const auto before = posesOf(robot.links(), names, positions);
    const auto after = posesOf(again.kinematics.links, again.link_names, positions);
    ASSERT_EQ(after.size(), before.size());
    for (const auto& [name, was] : before) {
      const Vec3 away = after.at(name) * Vec3{1, 1, 1} - was * Vec3{1, 1, 1};
      EXPECT_LT(std::sqrt(dot(away, away)), kPoseTolerance) << name;
    }
  }
}

TEST(ExportedUrdf, BringsBackTheSpheresAndLimits) {
  const ScratchFolder folder;
  const ToyPack pack{ToyRobot{}};
  const Robot robot = robotOf(pack);
  const bake::BakedRobot again = bakedAgain(folder, robot);
  ASSERT_EQ(again.groups.size(), robot.groups().size());
  for (std::size_t n = 0; n < again.groups.size(); ++n) {
    const auto& spheres = again.groups[n].spheres.spheres;
    EXPECT_TRUE(std::ranges::equal(spheres, robot.groups()[n].spheres)) << "group " << n;
  }
  EXPECT_EQ(again.kinematics.limits[0].lower, -1);
  EXPECT_EQ(again.kinematics.limits[0].upper, 2);
}

TEST(ExportedSrdf, BringsBackTheSpheres) {
  const ScratchFolder folder;
  const ToyPack pack{ToyRobot{}};
  const auto spheres = bake::readSrdfSpheres(folder.write("r.srdf", srdfText(robotOf(pack))));
  ASSERT_TRUE(spheres.has_value()) << spheres.error().message;
  ASSERT_EQ(spheres->links.size(), 3U);
  EXPECT_EQ(spheres->links[0].link, "base");
  ASSERT_EQ(spheres->links[0].spheres.size(), 2U);
  const bake::HandSphere& sphere = spheres->links[0].spheres[1];
  EXPECT_EQ(sphere.center, (std::array<double, 3>{0.125, 0.5, -0.25}));
  EXPECT_EQ(sphere.radius, 0.05);
}

}  // namespace
}  // namespace galactic::pack_tool::robot_round_trip_test
