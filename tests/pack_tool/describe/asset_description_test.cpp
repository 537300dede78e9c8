// What info and diff tell about objects and robots.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>
#include <utility>

#include "pack_tool/asset_packs.h"
#include "pack_tool/describe/info_text.h"
#include "pack_tool/describe/pack_description.h"
#include "pack_tool/verbs/verbs.h"
#include "support/pack_tool_fixture.h"
#include "support/packs/robot_pack_builder.h"

namespace galactic::pack_tool::asset_description_test {
namespace {

using test::ToyObject;
using test::ToyObjects;
using test::ToyPack;
using test::ToyRobot;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

TEST(DescribeObjects, TellsBoxSpheresPosesAndMesh) {
  const ToyPack pack{ToyObjects{}};
  const Json json = describePack(*pack);
  const Json& block = json.at("object_set").at("objects").at(0);
  EXPECT_EQ(block.at("name"), "block");
  EXPECT_EQ(block.at("box").at("half_extents"), Json::parse("[0.05, 0.1, 0.03]"));
  EXPECT_EQ(block.at("box").at("rotation_wxyz"), Json::parse("[1.0, 0.0, 0.0, 0.0]"));
  EXPECT_EQ(block.at("spheres").at(0).at("radius"), 0.05);
  EXPECT_EQ(block.at("stable_poses").size(), 2U);
  EXPECT_EQ(block.at("sphere_quality").at("gap").at("max"), 0.012);
  EXPECT_EQ(block.at("surface").at("triangles"), 12);
}

TEST(DescribeRobot, TellsLinksPositionsGroupsAndTools) {
  const ToyPack pack{ToyRobot{}};
  const Json robot = describePack(*pack).at("robot");
  EXPECT_EQ(robot.at("links").at(3).at("position"), "lift");
  EXPECT_EQ(robot.at("links").at(3).at("multiplier"), -0.5);
  EXPECT_EQ(robot.at("positions").at(0), Json::parse(R"({"name": "lift", "lower": -1.0,
                                                        "upper": 2.0, "start": 0.5})"));
  EXPECT_TRUE(robot.at("positions").at(1).at("upper").is_null());
  EXPECT_EQ(robot.at("groups").at(0).at("links"), Json::parse(R"(["base", "head"])"));
  EXPECT_EQ(robot.at("group_pairs").at("tested"), Json::parse(R"([["base", "slide"]])"));
  EXPECT_EQ(robot.at("end_effector").at("link"), "slide");
  EXPECT_EQ(robot.at("camera").at("vertical_fov"), 1.0);
  EXPECT_EQ(robot.at("base").at("root_height"), 0.5);
  const Json& laser = robot.at("laser");
  EXPECT_EQ(laser.at("link"), "base");
  EXPECT_EQ(laser.at("link_from_laser").at("translation"), Json::parse("[0.25, 0.125, 0.0]"));
  EXPECT_EQ(laser.at("field_of_view"), 4.0);
  EXPECT_EQ(laser.at("least_range"), 0.0625);
  EXPECT_EQ(laser.at("range"), 8.0);
  EXPECT_EQ(laser.at("noise"), 0.015625);
}

TEST(InfoText, HasOneLinePerObject) {
  const ToyPack pack{ToyObjects{}};
  const std::string text = infoText(describePack(*pack));
  EXPECT_THAT(text, HasSubstr("  kind         OBJS, format version 1\n"));
  EXPECT_THAT(text, HasSubstr("  radii        0.05, 0.015 m\n  objects      2\n"));
  EXPECT_THAT(text, ContainsRegex("\n    block +100x200x60 +yaw +0.500 +2 +1\\+1 +3.0/6.0/12.0 +"
                                  "1.0/2.0/4.0 +yes +2 +0.75 +12\n"));
}

TEST(InfoText, ShowsARobotWithAndWithoutARecipe) {
  const ToyPack pack{ToyRobot{}};
  const std::string text = infoText(describePack(*pack));
  EXPECT_THAT(text, HasSubstr("  robot        arm\n"));
  EXPECT_THAT(text, ContainsRegex("\n    upper +base +lift +revolute +-1 +2 +0.5\n"));
  EXPECT_THAT(text, ContainsRegex("\n    slide +upper +reach +prismatic +- +- +0.25\n"));
  EXPECT_THAT(text, HasSubstr("-0.5 * lift + 0.125\n"));
  EXPECT_THAT(text, ContainsRegex("\n    base +2 +2 +1\\+1 +5.0/10.0/20.0"));
  EXPECT_THAT(text, HasSubstr("pairs        1 tested, 1 adjacent, 0 always, 1 never, 0 ignored\n"));
  EXPECT_THAT(text, HasSubstr("grasp        slide at (0.1250, 0.0000, 0.0000) m"));
  EXPECT_THAT(text, HasSubstr("laser        base at (0.2500, 0.1250, 0.0000) m, 229.2 degrees, "));

  const ToyPack bare{ToyRobot{.with_recipe = false}};
  const std::string short_text = infoText(describePack(*bare));
  EXPECT_THAT(short_text,
              HasSubstr("  grasp        none\n  camera       none\n  laser        none\n"
                        "  base         none\n"
                        "  controlled   none\n"));
}

struct Outcome {
  int exit_code = 0;
  std::string out;
  std::string err;
};

template <class ToyA, class ToyB>
Outcome diffOf(const ToyA& a, const ToyB& b, DiffOptions options = {}) {
  const test::ScratchFolder folder;
  options.a = folder.write("a.pack", test::asText(buildPack(a).bytes()));
  options.b = folder.write("b.pack", test::asText(buildPack(b).bytes()));
  std::ostringstream out;
  std::ostringstream err;
  const int exit_code = runDiff(options, Console{out, err});
  return {exit_code, out.str(), err.str()};
}

TEST(AssetDiff, CallsTheSamePacksIdentical) {
  EXPECT_EQ(diffOf(ToyObjects{}, ToyObjects{}).exit_code, kExitOk);
  EXPECT_EQ(diffOf(ToyRobot{}, ToyRobot{}).exit_code, kExitOk);
}

TEST(AssetDiff, TellsHowManySpheresMovedAndHowFar) {
  ToyObjects moved;
  moved.objects[0].spheres[1] = {{0, -0.06F, 0.25F}, 0};
  const Outcome outcome = diffOf(ToyObjects{}, moved);
  EXPECT_EQ(outcome.exit_code, kExitDiffers);
  EXPECT_THAT(outcome.out,
              HasSubstr("\n  objects.block.spheres: 2 (1+1) | 2 (1+1), 1 moved by up to 0.25 m\n"));
  EXPECT_THAT(outcome.out, Not(HasSubstr("die")));
  EXPECT_EQ(diffOf(ToyObjects{}, moved, {.tolerance = 0.25}).exit_code, kExitOk);

  ToyObjects more;
  more.objects[1].spheres.push_back({{1, 0, 0}, 0});
  EXPECT_THAT(diffOf(ToyObjects{}, more).out,
              HasSubstr("\n  objects.die.spheres: 2 (1+1) | 3 (1+2)\n"));
}

TEST(AssetDiff, NamesAnObjectThatOneSideLacksOnce) {
  ToyObjects fewer;
  fewer.objects.pop_back();
  const Outcome outcome = diffOf(ToyObjects{}, fewer);
  EXPECT_EQ(outcome.exit_code, kExitDiffers);
  EXPECT_THAT(outcome.out, HasSubstr("differ\ncontent (A | B)\n  objects.die: present | none\n"));
}

TEST(AssetDiff, TakesStatisticsAndMeshesForProvenance) {
  ToyObjects other;
  other.objects[0].gap = 0.014;
  other.objects[0].colored = true;
  const Outcome everything = diffOf(ToyObjects{}, other);
  EXPECT_EQ(everything.exit_code, kExitDiffers);
  EXPECT_THAT(everything.out, HasSubstr("objects.block.sphere_quality.gap.max: 0.012 | 0.014"));
  EXPECT_THAT(everything.out, HasSubstr("objects.block.surface.colored: false | true"));
  const Outcome content = diffOf(ToyObjects{}, other, {.scope = DiffScope::kContent});
  EXPECT_EQ(content.exit_code, kExitOk);
  EXPECT_THAT(content.out, HasSubstr("\nequal\n"));
}

TEST(AssetDiff, ComparesTheLimitsAndToolsOfRobots) {
  const Outcome limits = diffOf(ToyRobot{}, ToyRobot{.upper_limit = 1.5F});
  EXPECT_EQ(limits.exit_code, kExitDiffers);
  EXPECT_THAT(limits.out, HasSubstr("positions.lift.upper: 2.0 | 1.5"));
  EXPECT_THAT(limits.out, HasSubstr("controlled_joints.lift.upper: 2.0 | 1.5"));
  EXPECT_EQ(diffOf(ToyRobot{}, ToyRobot{.upper_limit = 1.5F}, {.tolerance = 0.5}).exit_code,
            kExitOk);
  const Outcome recipe = diffOf(ToyRobot{}, ToyRobot{.with_recipe = false});
  EXPECT_THAT(recipe.out, HasSubstr("end_effector.link: slide | none"));
}

TEST(AssetDiff, TellsThatActionsMoveTheJointsInAnotherOrder) {
  const test::RobotPackFields robot = test::smallRobotPack();
  ASSERT_GE(robot.controlled_joints.size(), 2U);
  test::RobotPackFields swapped = robot;
  std::swap(swapped.controlled_joints[0], swapped.controlled_joints[1]);
  const Outcome outcome = diffOf(robot, swapped, {.scope = DiffScope::kContent});
  EXPECT_EQ(outcome.exit_code, kExitDiffers);
  EXPECT_THAT(outcome.out, HasSubstr("differ\ncontent (A | B)\n  controlled_joints.order: "
                                     "elbow, lift | lift, elbow\n"));
}

TEST(AssetDiff, TellsThatPositionsStandInAnotherOrder) {
  const test::RobotPackFields robot = test::smallRobotPack();
  test::RobotPackFields swapped = robot;
  std::swap(swapped.limits[0], swapped.limits[1]);
  std::swap(swapped.start_positions[0], swapped.start_positions[1]);
  for (LinkFrame& link : swapped.links) {
    if (link.position == 0 || link.position == 1) link.position = 1 - link.position;
  }
  for (ControlledJoint& joint : swapped.controlled_joints) {
    if (joint.position < 2) joint.position = 1 - joint.position;
  }
  const Outcome outcome = diffOf(robot, swapped, {.scope = DiffScope::kContent});
  EXPECT_EQ(outcome.exit_code, kExitDiffers);
  EXPECT_THAT(outcome.out, HasSubstr("\n  positions.order: lift, elbow, wrist, "));
  EXPECT_THAT(outcome.out, Not(HasSubstr("controlled_joints.order")));
}

TEST(AssetDiff, RefusesPacksOfTwoKinds) {
  const Outcome outcome = diffOf(ToyObjects{}, ToyRobot{});
  EXPECT_EQ(outcome.exit_code, static_cast<int>(ErrorCode::kInvalidInput));
  EXPECT_THAT(outcome.err, HasSubstr("is a pack of kind RBOT and "));
  EXPECT_THAT(outcome.err, HasSubstr(" one of kind OBJS; give two of one kind"));
}

}  // namespace
}  // namespace galactic::pack_tool::asset_description_test
