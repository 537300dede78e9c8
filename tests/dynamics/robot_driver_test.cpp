// Actions in the dynamics world: walls, edges, and what the hand can reach.
#include "dynamics/episodes/robot_driver.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "dynamics/made_robot.h"
#include "support/test_meshes.h"

namespace galactic::test::robot_driver_test {
namespace {

using dynamics::ArmDrive;
using dynamics::DrivenStep;
using dynamics::DynamicsWorld;
using dynamics::PlacedObject;
using dynamics::RobotDriver;

using Actions = std::array<float, kSmallHomeActions>;

/// Nothing moves, and the hand stays as it is: empty.
Actions still() { return {}; }

Actions with(SmallHomeAction action, float value) {
  Actions actions = still();
  actions[action] = value;
  return actions;
}

constexpr float kWall = 1.5F;

/// A floor with a wall across +X at kWall, and a table of 0.7 m from x = 0.3 to 0.6.
bake::TriangleMesh roomWithTable() {
  MeshBuilder mesh;
  mesh.floor({-3, 0, -3}, {3, 0, 3}, 0).box({kWall, -0.1F, -3}, {kWall + 0.1F, 2, 3});
  mesh.box({0.3F, 0.66F, 1.7F}, {0.6F, 0.7F, 2.3F});
  return mesh.build();
}

/// The small home's robot in the room.
class Room {
 public:
  explicit Room(ArmDrive arm, std::vector<PlacedObject> objects = {},
                const Pose& start = {{0, 0.1F, 0}, {}},
                dynamics::BaseDrive base = dynamics::BaseDrive::kKinematic)
      : robot_(smallHomeRobot()),
        kit_(*robot_, smallHomeParts()),
        world_(dynamics::makeSceneShape(roomWithTable()), objects, {.arm = arm, .base = base}) {
    world_.addRobot(kit_.setup(start));
    driver_.emplace(*robot_, world_, SimulationOptions{});
  }

  DrivenStep step(const Actions& actions) { return driver_->step(actions); }
  [[nodiscard]] const DynamicsWorld& world() const { return world_; }
  [[nodiscard]] const RobotDriver& driver() const { return *driver_; }
  [[nodiscard]] const Robot& robot() const { return *robot_; }

 private:
  MadeRobot robot_;
  RobotKit kit_;
  DynamicsWorld world_;
  std::optional<RobotDriver> driver_;
};

PlacedObject can(const Vec3& at) {
  return {dynamics::makeObjectShape({.hulls = {boxPoints({}, {0.03F, 0.05F, 0.03F})}, .mass = 0.3}),
          {at, {}}};
}

TEST(ADrivenBase, GoesAsFarAsItsActionsSay) {
  Room room(ArmDrive::kMotors);
  for (int n = 0; n < 5; ++n) room.step(with(kForward, 1));
  EXPECT_NEAR(room.world().worldFromRoot().translation.x, 0.5, 1e-4);
  EXPECT_NEAR(room.world().worldFromRoot().translation.y, 0.1, 1e-4);
  // Clockwise seen from above: ahead becomes towards +Z.
  for (int n = 0; n < 4; ++n) room.step(with(kTurn, 1));
  const Vec3 ahead = rotate(room.world().worldFromRoot().rotation, {1, 0, 0});
  EXPECT_NEAR(std::atan2(ahead.z, ahead.x), 4 * room.robot().base()->turn_step, 1e-4);
}

TEST(ADrivenBase, GoesToItsLeftWhereItDrivesSideways) {
  RobotPackFields fields = smallHomeRobot();
  fields.base->sideways_step = 0.06F;
  const MadeRobot robot(fields);
  const RobotKit kit(*robot, smallHomeParts());
  const ActionLayout layout = ActionLayout::of(*robot);
  for (const auto drive : {dynamics::BaseDrive::kKinematic, dynamics::BaseDrive::kVelocity}) {
    DynamicsWorld world(dynamics::makeSceneShape(roomWithTable()), {}, {.base = drive});
    world.addRobot(kit.setup({{0, 0.1F, 0}, rotationOfYaw(0.5F)}));
    RobotDriver driver(*robot, world, SimulationOptions{});
    std::vector<float> actions(layout.count());
    actions[layout.sideways()] = 1;
    for (int n = 0; n < 5; ++n) driver.step(actions);
    // What speeds lag behind they make good.
    actions[layout.sideways()] = 0;
    for (int n = 0; n < 20; ++n) driver.step(actions);
    const Pose root = world.worldFromRoot();
    EXPECT_NEAR(root.translation.x, -0.3F * std::sin(0.5F), 1e-4);
    EXPECT_NEAR(root.translation.z, -0.3F * std::cos(0.5F), 1e-4);
    EXPECT_FALSE(world.held());
  }
}

TEST(ADrivenBase, StopsAtAWall) {
  Room room(ArmDrive::kKinematic);
  bool was_refused = false;
  for (int n = 0; n < 30; ++n) was_refused |= room.step(with(kForward, 1)).base_refused;
  // The base ends 0.2 m ahead of the root; it is pushed out of the wall or stays in front of it.
  const float front = room.world().worldFromRoot().translation.x + 0.2F;
  EXPECT_GT(front, kWall - 0.1F);
  EXPECT_LE(front, kWall + dynamics::kTolerance + 1e-3F);
}

TEST(ADrivenBase, DrivesOverARugAndNotThroughAStep) {
  const auto drivesTo = [](float height) {
    const MadeRobot robot(smallHomeRobot());
    const RobotKit kit(*robot, smallHomeParts());
    MeshBuilder mesh;
    mesh.floor({-3, 0, -3}, {3, 0, 3}, 0).box({0.5F, 0, -2}, {2.5F, height, 2});
    DynamicsWorld world(dynamics::makeSceneShape(mesh.build()), {}, {});
    world.addRobot(kit.setup({{0, 0.1F, 0}, {}}));
    RobotDriver driver(*robot, world, SimulationOptions{});
    for (int n = 0; n < 20; ++n) driver.step(with(kForward, 0.5F));
    return world.worldFromRoot().translation;
  };
  const Vec3 on_rug = drivesTo(0.02F);
  EXPECT_NEAR(on_rug.x, 1, 1e-3);
  EXPECT_NEAR(on_rug.y, 0.12, 1e-3);
  EXPECT_LT(drivesTo(0.15F).x, 0.35F);
}

TEST(ADrivenBase, DoesNotLeaveTheFloor) {
  Room room(ArmDrive::kMotors, {}, {{-2.5F, 0.1F, 0}, {}});
  bool was_refused = false;
  for (int n = 0; n < 10; ++n) was_refused |= room.step(with(kForward, -1)).base_refused;
  EXPECT_TRUE(was_refused);
  EXPECT_GE(room.world().worldFromRoot().translation.x, -3.0F);
  EXPECT_NEAR(room.world().worldFromRoot().translation.y, 0.1, 1e-4);
}

/// How far a base has gone after `substeps` that asks for one unit of length in each from the first
/// on, when each takes away 30 % of the difference in speed: the sum of 1 - 0.7^k.
double responseAfter(int substeps) { return substeps - 0.7 / 0.3 * (1 - std::pow(0.7, substeps)); }

TEST(ABaseWithSpeeds, TakesAwayThirtyPercentOfTheDifferenceInEachSubstep) {
  Room room(ArmDrive::kMotors, {}, {{-1, 0.1F, -1}, {}}, dynamics::BaseDrive::kVelocity);
  const auto x = [&] { return static_cast<double>(room.world().worldFromRoot().translation.x); };
  const auto way = static_cast<double>(room.robot().base()->forward_step) / 4;
  constexpr double kRounding = 1e-5;
  for (int n = 1; n <= 5; ++n) {
    room.step(with(kForward, 1));
    EXPECT_NEAR(x() + 1, way * responseAfter(4 * n), kRounding) << n;
  }
  // What it lagged behind it makes good when nothing is asked for any more.
  for (int n = 0; n < 20; ++n) room.step(still());
  EXPECT_NEAR(x() + 1, 5 * 4 * way, kRounding);
  // Turns respond alike, clockwise seen from above.
  const auto turn = static_cast<double>(room.robot().base()->turn_step) / 4;
  room.step(with(kTurn, 1));
  room.step(with(kTurn, 1));
  const Vec3 ahead = rotate(room.world().worldFromRoot().rotation, {1, 0, 0});
  EXPECT_NEAR(std::atan2(ahead.z, ahead.x), turn * responseAfter(8), kRounding);
}

TEST(ABaseWithSpeeds, HasNoneAfterItWasRefused) {
  Room room(ArmDrive::kMotors, {}, {{-2.9F, 0.1F, 0}, {}}, dynamics::BaseDrive::kVelocity);
  const auto x = [&] { return static_cast<double>(room.world().worldFromRoot().translation.x); };
  // Over the edge of the floor, which is refused.
  bool was_refused = false;
  for (int n = 0; n < 5; ++n) was_refused |= room.step(with(kForward, -1)).base_refused;
  ASSERT_TRUE(was_refused);
  const double before = x();
  room.step(with(kForward, 1));
  const auto way = static_cast<double>(room.robot().base()->forward_step) / 4;
  EXPECT_NEAR(x() - before, way * responseAfter(4), 1e-5);
}

TEST(AMotorArm, StopsAtAWallWhereAKinematicOneDoesNot) {
  std::array<float, 2> reached{};
  for (const ArmDrive arm : {ArmDrive::kMotors, ArmDrive::kKinematic}) {
    Room room(arm, {}, {{1.0F, 0.1F, 0}, {}});
    for (int n = 0; n < 20; ++n) room.step(with(kArm, 1));
    reached[static_cast<std::size_t>(arm)] = room.driver().worldFromGrip().translation.x;
  }
  const auto& [motors, kinematic] = reached;
  // The grip is 3 cm ahead of the hand's box.
  EXPECT_LT(motors, kWall + 0.05F);
  EXPECT_GT(kinematic, kWall + 0.3F);
}

TEST(AKinematicArm, MovesAsForwardKinematicsSays) {
  Room room(ArmDrive::kKinematic);
  std::vector<float> positions(room.robot().startPositions().begin(),
                               room.robot().startPositions().end());
  Pose root{{0, 0.1F, 0}, {}};
  for (int n = 0; n < 20; ++n) {
    Actions actions = with(kForward, n % 3 == 0 ? 0.5F : -0.2F);
    actions[kShoulder] = 0.7F;
    actions[kLift] = 0.3F;
    room.step(actions);
    positions[kShoulder] += 0.07F;
    positions[kLift] = std::min(positions[kLift] + 0.015F, 0.8F);
    root.translation.x += n % 3 == 0 ? 0.05F : -0.02F;
    const Vec3 expected = dynamics::gripOf(room.robot(), root, positions).translation;
    const Vec3 miss = room.driver().worldFromGrip().translation - expected;
    ASSERT_LT(std::sqrt(dot(miss, miss)), 1e-4F) << n;
  }
}

/// With all joints where they start the grip is 0.37 m ahead and 0.75 m above the floor.
constexpr Vec3 kGrip{0.37F, 0.75F, 0};

TEST(AHand, GraspsWhatItsSphereTouchesAndCarriesIt) {
  for (const ArmDrive arm : {ArmDrive::kMotors, ArmDrive::kKinematic}) {
    // Beside the grip by less than the sphere's radius; it begins to fall before it is held.
    Room room(arm, {can(kGrip + Vec3{0.03F, -0.02F, 0})});
    const DrivenStep step = room.step(with(kHand, 1));
    ASSERT_EQ(step.grasped, 0U);
    for (int n = 0; n < 10; ++n) {
      Actions actions = with(kHand, 1);
      actions[kForward] = -0.5F;
      room.step(actions);
    }
    const Vec3 away =
        room.world().objectPose(0).translation - room.driver().worldFromGrip().translation;
    EXPECT_LT(std::sqrt(dot(away, away)), 0.06F) << static_cast<int>(arm);
    EXPECT_EQ(room.world().held(), 0U);
  }
}

TEST(AHand, DoesNotGraspWhatIsOutOfReach) {
  Room room(ArmDrive::kMotors, {can({0.37F, 0.05F, 0}), can({0.55F, 0.05F, 0.5F})});
  for (int n = 0; n < 5; ++n) EXPECT_FALSE(room.step(with(kHand, 1)).grasped);
  EXPECT_FALSE(room.world().held());
}

TEST(AHand, ThatLetsGoOverAnEdgeDropsTheObject) {
  for (const ArmDrive arm : {ArmDrive::kMotors, ArmDrive::kKinematic}) {
    Room room(arm, {can(kGrip + Vec3{0.02F, 0, 0})});
    ASSERT_EQ(room.step(with(kHand, 1)).grasped, 0U);
    const float before = room.world().objectPose(0).translation.y;
    EXPECT_EQ(room.step(with(kHand, 0)).released, 0U);
    for (int n = 0; n < 60; ++n) room.step(still());
    EXPECT_GT(before, 0.65F);
    EXPECT_LT(room.world().objectPose(0).translation.y, 0.1F) << static_cast<int>(arm);
  }
}

TEST(AHand, ThatLetsGoOverATablePutsTheObjectOnIt) {
  // At the table, which begins at z = 1.7, the grip is 5 cm over the top.
  Room room(ArmDrive::kMotors, {can(kGrip + Vec3{0.04F, 0.01F, 2.0F})}, {{0, 0.1F, 2.0F}, {}});
  ASSERT_EQ(room.step(with(kHand, 1)).grasped, 0U);
  room.step(with(kHand, 0));
  for (int n = 0; n < 60; ++n) room.step(still());
  EXPECT_NEAR(room.world().objectPose(0).translation.y, 0.75, 0.01);
}

TEST(AContactProbe, FindsTheLinkAndWhatItIsIn) {
  const MadeRobot robot(smallHomeRobot());
  const RobotKit kit(*robot, smallHomeParts());
  const std::vector<PlacedObject> objects{can({0.33F, 0.8F, 0})};
  const dynamics::ContactProbe probe(dynamics::makeSceneShape(roomWithTable()), objects,
                                     kit.setup({}));
  // The base in the wall by 5 cm.
  const auto in_wall = probe.contacts({{kWall - 0.15F, 0.1F, -1}, {}}, kit.positions, {});
  ASSERT_FALSE(in_wall.empty());
  EXPECT_EQ(in_wall.front().link, 0U);
  EXPECT_EQ(in_wall.front().object, -1);
  EXPECT_NEAR(in_wall.front().depth, 0.05, 2e-3);
  // The hand in the can.
  const auto in_can = probe.contacts({{0, 0.15F, 0}, {}}, kit.positions, {});
  ASSERT_EQ(in_can.size(), 1U);
  EXPECT_EQ(in_can.front().link, 4U);
  EXPECT_EQ(in_can.front().object, 0);
  EXPECT_TRUE(probe.contacts({{0, 0.15F, 0}, {}}, kit.positions, 0U).empty());
  EXPECT_TRUE(probe.contacts({{-1, 0.15F, 0}, {}}, kit.positions, {}).empty());
}

}  // namespace
}  // namespace galactic::test::robot_driver_test
