// From Z up to Y up, worked out by hand and against an independent conversion in double.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <random>

#include "bake/robot_description/link_points.h"
#include "bake/robot_description/robot_texts.h"

namespace galactic::test::frames_test {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::Pointwise;

/// Rounding of sines, cosines and a few products of numbers around 1.
constexpr double kRounding = 1e-12;

/// Forward is X in both frames; left is +Y in the URDF and -Z here; up is +Z there and +Y here.
constexpr const char* kTwoLinkArm = R"(<robot name="arm">
  <link name="base">
    <collision><origin xyz="1 2 3"/><geometry><box size="0.1 0.2 0.3"/></geometry></collision>
  </link>
  <link name="arm">
    <collision>
      <origin xyz="0 0 0.5" rpy="0 1.5707963267948966 0"/>
      <geometry><cylinder radius="0.05" length="0.4"/></geometry>
    </collision>
    <collision><origin xyz="0 0.25 0"/><geometry><sphere radius="0.1"/></geometry></collision>
  </link>
  <joint name="shoulder" type="revolute">
    <parent link="base"/><child link="arm"/>
    <origin xyz="0.1 0.2 0.3" rpy="0 0 1.5707963267948966"/>
    <axis xyz="0 0 1"/>
    <limit lower="-1" upper="2" effort="1" velocity="1"/>
  </joint>
</robot>)";

TEST(UrdfFrames, OfATwoLinkArmAreAsWorkedOutByHand) {
  const ScratchFolder folder;
  const auto robot = importText(folder, kTwoLinkArm);
  ASSERT_TRUE(robot.has_value()) << robot.error().message;
  EXPECT_EQ(robot->name, "arm");
  ASSERT_EQ(robot->links.size(), 2U);
  const bake::SourceLink& arm = robot->links[1];
  EXPECT_EQ(arm.parent, 0);
  EXPECT_EQ(arm.joint_name, "shoulder");
  EXPECT_EQ(arm.joint_type, JointType::kRevolute);
  EXPECT_THAT(arm.axis, ElementsAre(0, 1, 0));
  ASSERT_TRUE(arm.limits.has_value());
  EXPECT_EQ(arm.limits->lower, -1);
  EXPECT_EQ(arm.limits->upper, 2);
  // A quarter turn about the vertical: the arm's forward becomes the base's left, which is -Z.
  EXPECT_THAT(
      arm.parent_from_joint,
      Pointwise(DoubleNear(kRounding), bake::Affine{0, 0, 1, 0.1, 0, 1, 0, 0.3, -1, 0, 0, -0.2}));
}

TEST(UrdfFrames, OfPrimitivesAreAsWorkedOutByHand) {
  const ScratchFolder folder;
  const auto robot = importText(folder, kTwoLinkArm);
  ASSERT_TRUE(robot.has_value());
  const bake::LinkShape& box = robot->links[0].collisions.at(0);
  EXPECT_THAT(std::get<bake::BoxShape>(box.geometry).size, ElementsAre(0.1, 0.3, 0.2));
  EXPECT_EQ(box.link_from_shape, (bake::Affine{1, 0, 0, 1, 0, 1, 0, 3, 0, 0, 1, -2}));
  const bake::LinkShape& cylinder = robot->links[1].collisions.at(0);
  EXPECT_EQ(std::get<bake::CylinderShape>(cylinder.geometry).radius, 0.05);
  EXPECT_EQ(std::get<bake::CylinderShape>(cylinder.geometry).length, 0.4);
  // Pitched by a quarter turn, the cylinder's axis (its Y) points forward (X).
  EXPECT_THAT(pointIn(cylinder.link_from_shape, {0, 1, 0}),
              Pointwise(DoubleNear(kRounding), Point3{1, 0.5, 0}));
  const bake::LinkShape& sphere = robot->links[1].collisions.at(1);
  EXPECT_EQ(std::get<bake::SphereShape>(sphere.geometry).radius, 0.1);
  EXPECT_EQ(sphere.link_from_shape, (bake::Affine{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, -0.25}));
}

TEST(UrdfFrames, OfAYUpUrdfStayAsTheyAre) {
  const ScratchFolder folder;
  bake::RobotImportOptions options;
  options.up = bake::UpAxis::kY;
  const auto robot = importText(folder, kTwoLinkArm, options);
  ASSERT_TRUE(robot.has_value());
  EXPECT_THAT(robot->links[1].axis, ElementsAre(0, 0, 1));
  EXPECT_EQ(robot->links[1].parent_from_joint[11], 0.3);
  // The box keeps its sides along the same axes: its frame is turned, and the turn is undone.
  const bake::LinkShape& box = robot->links[0].collisions.at(0);
  const auto size = std::get<bake::BoxShape>(box.geometry).size;
  const Point3 center = pointIn(box.link_from_shape, {0, 0, 0});
  const Point3 corner = pointIn(box.link_from_shape, {size[0] / 2, size[1] / 2, size[2] / 2});
  EXPECT_THAT(center, ElementsAre(1, 2, 3));
  EXPECT_NEAR(std::abs(corner[0] - center[0]), 0.05, kRounding);
  EXPECT_NEAR(std::abs(corner[1] - center[1]), 0.10, kRounding);
  EXPECT_NEAR(std::abs(corner[2] - center[2]), 0.15, kRounding);
}

/// The rotation of roll, pitch and yaw, by three elementary rotations.
bake::Affine elementaryRotations(const Point3& rpy) {
  const auto rotation = [](std::size_t axis, double angle) {
    bake::Affine m{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    const std::size_t i = (axis + 1) % 3;
    const std::size_t j = (axis + 2) % 3;
    m[4 * i + i] = m[4 * j + j] = std::cos(angle);
    m[4 * j + i] = std::sin(angle);
    m[4 * i + j] = -std::sin(angle);
    return m;
  };
  return product(product(rotation(2, rpy[2]), rotation(1, rpy[1])), rotation(0, rpy[0]));
}

TEST(UrdfFrames, AgreeWithElementaryRotationsOnRandomJoints) {
  constexpr unsigned kSeed = 20;
  RecordProperty("seed", kSeed);
  std::mt19937 random(kSeed);
  const auto number = [&] {
    return 6.0 * (static_cast<double>(random()) / static_cast<double>(std::mt19937::max()) - 0.5);
  };
  const ScratchFolder folder;
  std::string text = "<link name=\"l0\"/>";
  std::vector<bake::Affine> frames;
  std::vector<Point3> axes;
  constexpr int kJoints = 100;
  for (int i = 1; i <= kJoints; ++i) {
    const Point3 xyz{number(), number(), number()};
    const Point3 rpy{number(), number(), number()};
    const Point3 axis{number(), number(), number()};
    text += fmt::format("<link name=\"l{}\"/>", i);
    text += jointText(
        fmt::format("j{}", i), "continuous", fmt::format("l{},l{}", i - 1, i),
        fmt::format("<origin xyz=\"{} {} {}\" rpy=\"{} {} {}\"/><axis xyz=\"{} {} "
                    "{}\"/>",
                    xyz[0], xyz[1], xyz[2], rpy[0], rpy[1], rpy[2], axis[0], axis[1], axis[2]));
    bake::Affine frame = elementaryRotations(rpy);
    for (std::size_t k = 0; k < 3; ++k) frame[4 * k + 3] = xyz[k];
    frames.push_back(frame);
    axes.push_back(axis);
  }
  const auto robot = importText(folder, robotText(text));
  ASSERT_TRUE(robot.has_value()) << robot.error().message;
  const auto y_up = [](const Point3& p) { return Point3{p[0], p[2], -p[1]}; };
  for (std::size_t i = 0; i < kJoints; ++i) {
    const bake::SourceLink& link = robot->links[i + 1];
    const Point3 p{number(), number(), number()};
    EXPECT_THAT(pointIn(link.parent_from_joint, y_up(p)),
                Pointwise(DoubleNear(kRounding), y_up(pointIn(frames[i], p))));
    const double length = std::hypot(axes[i][0], axes[i][1], axes[i][2]);
    const Point3 unit{axes[i][0] / length, axes[i][1] / length, axes[i][2] / length};
    EXPECT_THAT(link.axis, Pointwise(DoubleNear(kRounding), y_up(unit)));
  }
}

}  // namespace
}  // namespace galactic::test::frames_test
