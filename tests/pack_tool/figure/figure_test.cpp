// Robots and objects as figures: joint vectors, poses, layers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "galactic/position_names.h"
#include "pack_tool/asset_packs.h"
#include "pack_tool/figure/figures_of_pack.h"
#include "support/pack_tool_fixture.h"

namespace galactic::pack_tool::figure_test {
namespace {

using test::ToyObjects;
using test::ToyPack;
using test::ToyRobot;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

/// A few roundings of floats of about a meter.
constexpr float kRounding = 1e-6F;

Robot robotOf(const ToyPack& pack) { return *Robot::from(*pack); }

std::string jointError(const JointChoice& choice) {
  const ToyPack pack{ToyRobot{}};
  const auto positions = jointPositions(robotOf(pack), choice, "arm.pack");
  if (positions) return "";
  EXPECT_EQ(positions.error().where, "arm.pack");
  EXPECT_EQ(positions.error().code, ErrorCode::kInvalidInput);
  return positions.error().message;
}

TEST(JointPositions, BelongToTheJointThatTakesThemAsTheyAre) {
  const ToyPack pack{ToyRobot{}};
  EXPECT_THAT(positionOwners(robotOf(pack)), ElementsAre(1, 2));
  EXPECT_THAT(positionNames(robotOf(pack)), ElementsAre("lift", "reach"));
}

TEST(JointPositions, AreTheStartPoseOrZeroWhereNothingIsGiven) {
  const ToyPack pack{ToyRobot{}};
  const Robot robot = robotOf(pack);
  EXPECT_THAT(*jointPositions(robot, {}, ""), ElementsAre(0.5F, 0.25F));
  EXPECT_THAT(*jointPositions(robot, {.others = OtherJoints::kZero}, ""), ElementsAre(0, 0));
  EXPECT_THAT(*jointPositions(robot, {.values = {{"reach", -7}}}, ""), ElementsAre(0.5F, -7));
  EXPECT_THAT(*jointPositions(robot, {.values = {{"lift", 2}}, .others = OtherJoints::kZero}, ""),
              ElementsAre(2, 0));
}

TEST(JointPositions, SayWhyAJointCannotBeGiven) {
  EXPECT_EQ(jointError({.values = {{"elbow", 1}}}),
            "the robot has no joint \"elbow\"; it has lift, reach");
  EXPECT_EQ(jointError({.values = {{"neck", 1}}}), "joint \"neck\" does not move");
  EXPECT_EQ(jointError({.values = {{"grip", 1}}}), "joint \"grip\" follows lift; give that one");
  EXPECT_EQ(jointError({.values = {{"lift", 2.5F}}}),
            "joint \"lift\" cannot be at 2.5; its limits are -1 to 2");
}

TEST(RobotFigure, HasItsLinksWhereTheKinematicsPutThem) {
  const ToyPack pack{ToyRobot{}};
  const auto figures = figuresOf(*pack, {.joints = {.values = {{"lift", 0}, {"reach", 0.5F}}}});
  ASSERT_TRUE(figures.has_value()) << figures.error().message;
  ASSERT_THAT(*figures, SizeIs(1));
  const Figure& figure = figures->front();
  ASSERT_THAT(figure.parts, SizeIs(5));
  // The root stands half a meter above the ground; the upper link turns x to y.
  const Vec3 base = figure.parts[0].world_from_part.translation;
  const Vec3 slide = figure.parts[2].world_from_part.translation;
  EXPECT_EQ(base, (Vec3{0, 0.5F, 0}));
  EXPECT_NEAR(slide.x, 0, kRounding);
  EXPECT_NEAR(slide.y, 0.5F + 1 + 0.5F + 0.5F, kRounding);
  EXPECT_NEAR(slide.z, 0.25F, kRounding);
  ASSERT_TRUE(figure.grasp.has_value());
  EXPECT_NEAR(figure.grasp->center_in_world.y, slide.y + 0.125F, kRounding);
  ASSERT_TRUE(figure.camera.has_value());
  EXPECT_EQ(figure.camera->world_from_camera.translation, (Vec3{0.25F, 2.5F, 0}));
  EXPECT_THAT(figure.footprint, SizeIs(4));
}

TEST(RobotFigure, ShowsCollisionMeshesOnlyWhereThereIsNoVisualOne) {
  const ToyPack pack{ToyRobot{}};
  const auto figures = figuresOf(*pack, {});
  ASSERT_TRUE(figures.has_value());
  const auto& parts = figures->front().parts;
  EXPECT_THAT(parts[0].surface.colors, SizeIs(8));
  EXPECT_THAT(parts[1].surface.corners, SizeIs(36));
  EXPECT_THAT(parts[1].surface.colors, IsEmpty());
  EXPECT_TRUE(parts[2].surface.empty());
  EXPECT_THAT(figures->front().caption,
              HasSubstr("4 spheres (1+3) in 4 groups, gap up to 20.0 mm"));
}

TEST(RobotFigure, WithoutARecipeHasNoMarks) {
  const ToyPack pack{ToyRobot{.with_recipe = false}};
  const auto figures = figuresOf(*pack, {});
  ASSERT_TRUE(figures.has_value());
  EXPECT_FALSE(figures->front().grasp.has_value());
  EXPECT_FALSE(figures->front().camera.has_value());
  EXPECT_THAT(figures->front().footprint, IsEmpty());
}

TEST(ObjectFigures, HaveOnlyTheLayersThatWereAskedFor) {
  const ToyPack pack{ToyObjects{}};
  LayerSet boxes = LayerSet::none();
  boxes.add(FigureLayer::kBoxes);
  const auto figures = figuresOf(*pack, {.layers = boxes});
  ASSERT_TRUE(figures.has_value());
  ASSERT_THAT(*figures, SizeIs(2));
  const FigurePart& part = figures->front().parts.front();
  EXPECT_TRUE(part.surface.empty());
  EXPECT_THAT(part.spheres, IsEmpty());
  EXPECT_TRUE(part.box.has_value());
}

TEST(ObjectFigures, StandInARowOnTheGroundWithoutTouching) {
  const ToyPack pack{ToyObjects{}};
  auto figures = figuresOf(*pack, {});
  ASSERT_TRUE(figures.has_value());
  layOutInARow(*figures);
  const FigureBounds block = boundsOf((*figures)[0]);
  const FigureBounds die = boundsOf((*figures)[1]);
  EXPECT_NEAR(block.min.y, 0, kRounding);
  EXPECT_NEAR(die.min.y, 0, kRounding);
  EXPECT_LT(block.max.x, die.min.x);
}

TEST(Figures, RefuseOptionsOfTheOtherKind) {
  const ToyPack objects{ToyObjects{}};
  const ToyPack robot{ToyRobot{}};
  const auto joints = figuresOf(*objects, {.joints = {.values = {{"lift", 0}}}});
  ASSERT_FALSE(joints.has_value());
  EXPECT_THAT(joints.error().message, HasSubstr("holds objects, which have no joints"));
  const auto object = figuresOf(*robot, {.object = "block"});
  ASSERT_FALSE(object.has_value());
  EXPECT_THAT(object.error().message, HasSubstr("leave out --object"));
  const auto missing = figuresOf(*objects, {.object = "mug"});
  ASSERT_FALSE(missing.has_value());
  EXPECT_EQ(missing.error().message,
            "has no object \"mug\"; galactic-pack info lists its 2 objects");
  // And of scenes.
  const test::ScratchFolder folder;
  const auto path =
      folder.write("a.pack", test::asText(test::buildPack(test::kitchenScene()).bytes()));
  const auto scene = PackFile::open(path);
  ASSERT_TRUE(scene);
  const std::string only =
      "is a scene; --object, --joints and --all-zero are for objects and robots";
  EXPECT_EQ(figuresOf(*scene, {.object = "mug"}).error().message, only);
  EXPECT_EQ(figuresOf(*scene, {.joints = {.values = {{"lift", 0}}}}).error().message, only);
  EXPECT_EQ(figuresOf(*scene, {.joints = {.others = OtherJoints::kZero}}).error().message, only);
  LayerSet boxes = LayerSet::none();
  boxes.add(FigureLayer::kBoxes);
  EXPECT_EQ(figuresOf(*scene, {.layers = boxes}).error().message,
            "is a scene, which has neither spheres nor boxes to show; take --what mesh");
}

}  // namespace
}  // namespace galactic::pack_tool::figure_test
