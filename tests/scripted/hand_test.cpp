// Inverse kinematics against forward kinematics.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <random>

#include "scripted/inverse_kinematics.h"
#include "scripted/reach_table.h"
#include "scripted_world.h"

namespace galactic::test::hand_test {
namespace {

using scripted::Arm;
using scripted::HandGoal;
using scripted::Joints;
using scripted::ReachTable;
using scripted::ReachView;

/// The grip by the library's forward kinematics alone.
Pose gripOf(const Robot& robot, const Joints& joints) {
  std::vector<Pose> links(robot.links().size());
  forwardKinematics(robot.links(), {}, joints, links);
  return links[robot.endEffector()->link] * Pose{robot.endEffector()->grasp_point, {}};
}

float lengthOf(const Vec3& v) { return std::sqrt(dot(v, v)); }

class PorterArm : public testing::Test {
 protected:
  PorterArm()
      : robot_(MemoryPack::opened(Robot::from(pack_->pack()))),
        start_(robot_.startPositions().begin(), robot_.startPositions().end()) {}

  // Once for all tests: it takes seconds.
  static void SetUpTestSuite() { pack_ = std::make_unique<MemoryPack>(bakeSampleRobot()); }
  static void TearDownTestSuite() { pack_.reset(); }

  /// Evenly within the limits.
  Joints draw() {
    Joints joints = start_;
    for (const ControlledJoint& joint : robot_.controlledJoints()) {
      constexpr float kHalfTurn = 3.1415926F;
      std::uniform_real_distribution<float> position(std::max(joint.lower, -kHalfTurn),
                                                     std::min(joint.upper, kHalfTurn));
      joints[joint.position] = position(random_);
    }
    return joints;
  }

  Robot robot_;
  Joints start_;
  std::mt19937 random_{11};

 private:
  static inline std::unique_ptr<MemoryPack> pack_;
};

TEST_F(PorterArm, ReachesWhatForwardKinematicsReachesAndNothingElse) {
  Arm arm(robot_);
  const ReachTable table(arm, start_, 20000);
  const Vec3 point{0.02F, -0.01F, 0.03F};
  const Vec3 direction{0, 0.6F, 0.8F};
  const ReachView view(table, point, direction);
  const scripted::InverseKinematicsOptions options;
  int asked = 0;
  int solved = 0;
  int reachable = 0;
  constexpr int kCases = 150;
  for (int n = 0; n < kCases; ++n) {
    const Pose wanted = gripOf(robot_, draw());
    HandGoal goal{.point = point,
                  .direction = direction,
                  .place = wanted * point,
                  .toward = rotate(wanted.rotation, direction)};
    const bool is_far = n % 2 == 1;
    if (is_far) goal.place = goal.place + Vec3{2.5F, 0, 0};
    std::array<std::uint32_t, 3> seeds{};
    const std::size_t count = view.nearest(goal, is_far ? 10.0F : 0.3F, seeds);
    ++asked;
    reachable += is_far ? 0 : 1;
    for (std::size_t seed = 0; seed < count; ++seed) {
      const auto joints = solveHand(arm, goal, table.joints(arm, seeds[seed], start_), options);
      if (!joints) continue;
      ++solved;
      EXPECT_FALSE(is_far);
      const Pose grip = gripOf(robot_, *joints);
      EXPECT_LE(lengthOf(grip * point - goal.place), options.tolerance * 1.01F);
      const float turn = lengthOf(rotate(grip.rotation, direction) - goal.toward);
      EXPECT_LE(turn, 2 * std::sin(options.direction_tolerance / 2) * 1.01F);
      for (const ControlledJoint& joint : robot_.controlledJoints()) {
        EXPECT_GE((*joints)[joint.position], joint.lower);
        EXPECT_LE((*joints)[joint.position], joint.upper);
      }
      break;
    }
  }
  // Self-touching poses are drawn here but are no seeds, and seeds may end in a local minimum.
  EXPECT_GT(solved, reachable * 8 / 10);
  EXPECT_GT(solved, asked / 10);
  EXPECT_LT(solved, asked * 9 / 10);
}

TEST_F(PorterArm, HasTheJacobianOfItsForwardKinematics) {
  Arm arm(robot_);
  constexpr float kMove = 1e-3F;
  // Second order of the move, and rounding divided by it.
  constexpr float kTolerance = 2e-3F;
  for (int n = 0; n < 20; ++n) {
    const Joints joints = draw();
    const auto links = arm.placeLinks(joints);
    const Vec3 origin = arm.gripOf(links).translation;
    std::vector<Arm::Column> columns(arm.joints().size());
    arm.columns(links, columns);
    for (std::size_t joint = 0; joint < columns.size(); ++joint) {
      Joints before = joints;
      Joints after = joints;
      before[arm.joints()[joint].position] -= kMove;
      after[arm.joints()[joint].position] += kMove;
      const Vec3 measured =
          (gripOf(robot_, after).translation - gripOf(robot_, before).translation) * (0.5F / kMove);
      const Vec3 computed =
          cross(columns[joint].turn, origin - columns[joint].origin) + columns[joint].slide;
      EXPECT_LT(lengthOf(measured - computed), kTolerance) << "joint " << joint;
    }
  }
}

TEST_F(PorterArm, ReachesAheadAndNeedsNoTurnOfTheBase) {
  Arm arm(robot_);
  EXPECT_EQ(ReachTable(arm, start_, 20000).bearing(), 0);
  int most = 0;
  for (int n = 0; n < 20; ++n) {
    most = std::max(most, handFreedoms(arm, draw(), scripted::Movers::kArm));
  }
  EXPECT_EQ(most, 5);
  for (std::uint32_t joint = 0; joint < arm.joints().size(); ++joint) {
    EXPECT_EQ(arm.joints()[joint].leader, joint);
  }
}

TEST_F(PorterArm, GoesTheShorterWayRoundInContinuousJoints) {
  Arm arm(robot_);
  Joints from = start_;
  Joints to = start_;
  std::size_t continuous = 0;
  for (std::size_t joint = 0; joint < arm.joints().size(); ++joint) {
    if (!arm.joints()[joint].wraps) continue;
    ++continuous;
    from[arm.joints()[joint].position] = 3.0F;
    to[arm.joints()[joint].position] = -3.0F;
    EXPECT_NEAR(arm.difference(joint, from, to), 0.2831853F, 1e-5F);
  }
  EXPECT_EQ(continuous, 3U);
  EXPECT_NEAR(arm.distance(from, to), 0.2831853F, 1e-5F);
}

TEST(ArmOfLinksThatOverlap, TouchesItselfOnlyWhereItDidNotAtTheStart) {
  // The base's sphere reaches the upper arm's in every position, as those of neighbors do.
  RobotPackFields fields = stickRobot();
  fields.spheres[0].center = {0, 0.7F, 0};
  fields.spheres[1].center = {0.1F, 0, 0};
  fields.spheres[2].center = {0.25F, 0, 0};
  const MemoryPack pack(buildPack(fields), "stick");
  const Robot robot = MemoryPack::opened(Robot::from(pack.pack()));
  Arm arm(robot);
  Joints joints(robot.startPositions().begin(), robot.startPositions().end());
  EXPECT_FALSE(arm.touchesItself(arm.placeLinks(joints)));
  // Folded further, the forearm meets the upper arm.
  joints = {0, 0, 3.0F};
  EXPECT_TRUE(arm.touchesItself(arm.placeLinks(joints)));
}

}  // namespace
}  // namespace galactic::test::hand_test
