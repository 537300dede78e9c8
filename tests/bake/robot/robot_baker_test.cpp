// Robots of a few boxes from import to pack: recipe, hand-made spheres, budgets, errors.
#include "galactic/bake/robot_baker.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "bake/robot/tiny_robots.h"
#include "galactic/bake/packs.h"
#include "galactic/robot.h"
#include "support/packs/pack_parts.h"

namespace galactic::test::robot_baker_test {
namespace {

using bake::BakedRobot;
using bake::bakeRobot;
using bake::HandSpheres;
using bake::JointLimits;
using bake::RobotBakeOptions;
using bake::RobotRecipe;
using bake::SourceRobot;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

/// A base of 10 cm, an arm that turns, a hand that slides on it, and a finger that follows.
SourceRobot smallArm() {
  return RobotMaker()
      .link("base")
      .box({0.1, 0.1, 0.1}, shifted(0, 0.05, 0))
      .link("arm", 0, {.type = JointType::kContinuous, .parent_from_joint = shifted(0, 0.15, 0)})
      .box({0.2, 0.06, 0.06}, shifted(0.1, 0, 0))
      .link("hand", 1,
            {.type = JointType::kPrismatic,
             .parent_from_joint = shifted(0.25, 0, 0),
             .axis = {1, 0, 0},
             .limits = JointLimits{0, 0.1}})
      .box({0.06, 0.06, 0.06})
      .link("finger", 2,
            {.type = JointType::kPrismatic,
             .parent_from_joint = shifted(0.05, 0, 0),
             .axis = {0, 0, 1}})
      .mimic(2, 0.5, 0)
      .robot();
}

/// One radius and wide tolerances: a fit takes a few hundredths of a second.
RobotBakeOptions coarse() {
  RobotBakeOptions options;
  options.radii = {0.04F};
  options.eps = 0.03F;
  options.tau = 0.05F;
  return options;
}

BakedRobot bakeWell(const SourceRobot& robot, const RobotRecipe* recipe,
                    const RobotBakeOptions& options, unsigned threads = 1) {
  auto baked = bakeRobot(robot, recipe, options, threads);
  if (baked) return std::move(*baked);
  ADD_FAILURE() << baked.error().text();
  return {};
}

RobotRecipe armRecipe() {
  RobotRecipe recipe = recipeFor("hand");
  recipe.name = "helper";
  recipe.end_effector.grasp_point = {0.03, 0.01, 0};
  recipe.end_effector.grasp_radius = 0.02;
  recipe.camera = bake::RecipeCamera{
      .link = {"base", ""}, .link_from_camera = shifted(0, 0.3, 0), .vertical_fov = 1.5};
  recipe.laser = bake::RecipeLaser{.link = {"base", ""},
                                   .link_from_laser = shifted(0.1, 0.2, 0),
                                   .field_of_view = 4,
                                   .least_range = 0.25,
                                   .range = 9,
                                   .noise = 0.125};
  recipe.base.footprint = bake::FootprintRectangle{-0.1, 0.2, -0.3, 0.4};
  recipe.base.forward_step = 0.25;
  recipe.base.turn_step = 0.125;
  recipe.base.sideways_step = 0.0625;
  recipe.base.root_height = 0.01;
  recipe.joints = {{.joint = {"hand_joint", ""}, .step = 0.02, .min = 0.025, .max = {}},
                   {.joint = {"arm_joint", ""}, .step = 0.5, .min = -1, .max = 2}};
  recipe.start_pose = {{{"arm_joint", ""}, 0.5}};
  return recipe;
}

TEST(RobotBaker, AppliesTheRecipe) {
  const RobotRecipe recipe = armRecipe();
  const BakedRobot robot = bakeWell(smallArm(), &recipe, coarse());
  EXPECT_EQ(robot.name, "helper");
  EXPECT_THAT(robot.link_names, ElementsAre("base", "arm", "hand", "finger"));
  EXPECT_THAT(robot.joint_names, ElementsAre("", "arm_joint", "hand_joint", "finger_joint"));
  EXPECT_THAT(robot.kinematics.start_positions, ElementsAre(0.5F, 0.025F));
  ASSERT_EQ(robot.controlled_joints.size(), 2U);
  EXPECT_EQ(robot.controlled_joints[0].position, 1U);
  EXPECT_EQ(robot.controlled_joints[0].step, 0.02F);
  EXPECT_EQ(robot.controlled_joints[0].lower, 0.025F);
  EXPECT_EQ(robot.controlled_joints[0].upper, 0.1F);
  EXPECT_EQ(robot.controlled_joints[1].position, 0U);
  EXPECT_EQ(robot.controlled_joints[1].lower, -1);
  EXPECT_EQ(robot.controlled_joints[1].upper, 2);
  ASSERT_TRUE(robot.end_effector.has_value());
  EXPECT_EQ(robot.end_effector->link, 2U);
  EXPECT_EQ(robot.end_effector->grasp_point, (Vec3{0.03F, 0.01F, 0}));
  EXPECT_EQ(robot.end_effector->grasp_radius, 0.02F);
  ASSERT_TRUE(robot.camera.has_value());
  EXPECT_EQ(robot.camera->link, 0U);
  EXPECT_EQ(robot.camera->link_from_camera, (Pose{{0, 0.3F, 0}, {}}));
  EXPECT_EQ(robot.camera->vertical_fov, 1.5F);
  ASSERT_TRUE(robot.laser.has_value());
  EXPECT_EQ(robot.laser->link, 0U);
  EXPECT_EQ(robot.laser->link_from_laser, (Pose{{0.1F, 0.2F, 0}, {}}));
  EXPECT_EQ(robot.laser->field_of_view, 4);
  ASSERT_TRUE(robot.base.has_value());
  EXPECT_EQ(robot.base->forward_step, 0.25F);
  EXPECT_EQ(robot.base->turn_step, 0.125F);
  EXPECT_EQ(robot.base->sideways_step, 0.0625F);
  EXPECT_EQ(robot.base->root_height, 0.01F);
  EXPECT_EQ(robot.base->footprint_min, (Vec3{-0.1F, 0, -0.3F}));
  EXPECT_EQ(robot.base->footprint_max, (Vec3{0.2F, 0, 0.4F}));
  EXPECT_EQ(robot.base->footprint_radius, 0);
}

TEST(RobotBaker, WarnsOfAGraspPointInsideOfWhatMovesWithTheHand) {
  RobotRecipe recipe = armRecipe();
  EXPECT_THAT(bakeWell(smallArm(), &recipe, coarse()).warnings,
              ElementsAre(HasSubstr("[end_effector] grasp_point: it is 0.0")));
  recipe.end_effector.grasp_point = {0.08, 0, 0};
  EXPECT_THAT(bakeWell(smallArm(), &recipe, coarse()).warnings, IsEmpty());
  // The frame of the spheres is the hand's: here, of what is fixed to it.
  SourceRobot robot = smallArm();
  robot.links[3].joint_type = JointType::kFixed;
  robot.links[3].mimic.reset();
  recipe.end_effector.link.name = "finger";
  recipe.end_effector.grasp_point = {-0.05, 0, 0};
  EXPECT_THAT(bakeWell(robot, &recipe, coarse()).warnings,
              ElementsAre(HasSubstr("of a sphere of 0.04 m that moves with link 'finger', where no "
                                    "object can be grasped; move it outside of the robot")));
  recipe.end_effector.grasp_point = {0.03, 0, 0};
  EXPECT_THAT(bakeWell(robot, &recipe, coarse()).warnings, IsEmpty());
}

TEST(RobotBaker, WarnsOfJointsThatCannotMoveUnlessTheRecipeFreesThem) {
  SourceRobot robot = smallArm();
  robot.links[1].joint_type = JointType::kRevolute;
  robot.links[1].limits = bake::JointLimits{0, 0};
  const std::string name = robot.links[1].joint_name;
  const auto warns = HasSubstr("joint '" + name + "': its limits are both 0, so it cannot move");
  EXPECT_THAT(bakeWell(robot, nullptr, coarse()).warnings, testing::Contains(warns));
  RobotRecipe recipe = recipeFor("hand");
  EXPECT_THAT(bakeWell(robot, &recipe, coarse()).warnings, testing::Contains(warns));
  recipe.limits = {{{name, "tiny.toml:9"}, {0, 0.6}}};
  EXPECT_THAT(bakeWell(robot, &recipe, coarse()).warnings, IsEmpty());
}

TEST(RobotBaker, WithoutARecipeHasNoHandCameraBaseOrActions) {
  const BakedRobot robot = bakeWell(smallArm(), nullptr, coarse());
  EXPECT_EQ(robot.name, "tiny");
  EXPECT_FALSE(robot.end_effector || robot.camera || robot.laser || robot.base);
  EXPECT_TRUE(robot.controlled_joints.empty());
}

TEST(RobotBaker, MakesACircularFootprintARectangleAroundIt) {
  const RobotRecipe recipe = recipeFor("hand");
  const BakedRobot robot = bakeWell(smallArm(), &recipe, coarse());
  EXPECT_EQ(robot.base->footprint_radius, 0.3F);
  EXPECT_EQ(robot.base->footprint_min, (Vec3{-0.3F, 0, -0.3F}));
  EXPECT_EQ(robot.base->footprint_max, (Vec3{0.3F, 0, 0.3F}));
}

/// The pack of a robot, opened with every check.
struct OpenedPack {
  AlignedBytes bytes;
  std::optional<PackFile> pack;
  std::optional<Robot> robot;
};

OpenedPack openPackOf(const BakedRobot& robot) {
  OpenedPack opened;
  bake::Provenance provenance;
  provenance.tool_version = "0.1.0";
  const auto payload = bake::encodeRobotPack(robot, provenance);
  EXPECT_TRUE(payload.has_value());
  opened.bytes = packFile(PackKind::kRobot, *payload);
  auto pack = PackFile::view(opened.bytes.bytes(), "tiny.pack");
  EXPECT_TRUE(pack.has_value()) << pack.error().text();
  if (!pack) return opened;
  opened.pack = std::move(*pack);
  auto view = Robot::from(*opened.pack);
  EXPECT_TRUE(view.has_value());
  if (view) opened.robot = std::move(*view);
  return opened;
}

TEST(RobotPack, OpensAndShowsWhatWasBaked) {
  const RobotRecipe recipe = armRecipe();
  const BakedRobot baked = bakeWell(smallArm(), &recipe, coarse());
  const OpenedPack opened = openPackOf(baked);
  ASSERT_TRUE(opened.robot.has_value());
  const Robot& robot = *opened.robot;
  EXPECT_EQ(robot.name(), "helper");
  ASSERT_EQ(robot.links().size(), 4U);
  EXPECT_EQ(robot.links()[3].position, 1);
  EXPECT_EQ(robot.links()[3].multiplier, 0.5F);
  ASSERT_EQ(robot.groups().size(), baked.groups.size());
  for (std::size_t n = 0; n < baked.groups.size(); ++n) {
    const auto& spheres = robot.groups()[n].spheres;
    EXPECT_EQ(std::vector(spheres.begin(), spheres.end()), baked.groups[n].spheres.spheres);
  }
  EXPECT_EQ(robot.controlledJoints().size(), 2U);
  EXPECT_EQ(robot.endEffector()->link, 2U);
  EXPECT_EQ(robot.camera()->vertical_fov, 1.5F);
  EXPECT_EQ(robot.laser()->link_from_laser, (Pose{{0.1F, 0.2F, 0}, {}}));
  EXPECT_EQ(robot.laser()->field_of_view, 4);
  EXPECT_EQ(robot.laser()->least_range, 0.25F);
  EXPECT_EQ(robot.laser()->range, 9);
  EXPECT_EQ(robot.laser()->noise, 0.125F);
  EXPECT_EQ(robot.base()->turn_step, 0.125F);
}

TEST(RobotPack, OfARobotThatCannotMoveOpens) {
  const SourceRobot robot = RobotMaker().link("post").box({0.05, 0.1, 0.05}).robot();
  const OpenedPack opened = openPackOf(bakeWell(robot, nullptr, coarse()));
  ASSERT_TRUE(opened.robot.has_value());
  EXPECT_EQ(opened.robot->positionCount(), 0U);
  EXPECT_TRUE(opened.robot->testedPairs().empty());
}

TEST(RobotPack, OpensWithLimitsBeyondAllFloats) {
  SourceRobot robot = smallArm();
  robot.links[2].limits = JointLimits{-1e300, 1e300};
  EXPECT_TRUE(openPackOf(bakeWell(robot, nullptr, coarse())).robot.has_value());
}

TEST(RobotPack, HasTheSameBytesForAnyNumberOfThreads) {
  const RobotRecipe recipe = armRecipe();
  const auto one = bake::encodeRobotPack(bakeWell(smallArm(), &recipe, coarse()), {});
  const auto three = bake::encodeRobotPack(bakeWell(smallArm(), &recipe, coarse(), 3), {});
  ASSERT_TRUE(one.has_value() && three.has_value());
  EXPECT_TRUE(*one == *three);
}

std::size_t spheresOf(const BakedRobot& robot) {
  std::size_t spheres = 0;
  for (const bake::BakedGroup& group : robot.groups) spheres += group.spheres.spheres.size();
  return spheres;
}

TEST(RobotBaker, KeepsToTheBudgetAndSaysWhenItCannot) {
  RobotBakeOptions options = coarse();
  options.eps = 0.02F;
  options.max_spheres = 0;
  const BakedRobot all = bakeWell(smallArm(), nullptr, options);
  options.max_spheres = static_cast<std::uint32_t>(spheresOf(all) - 1);
  const BakedRobot fewer = bakeWell(smallArm(), nullptr, options);
  EXPECT_LT(spheresOf(fewer), spheresOf(all));
  EXPECT_THAT(fewer.warnings, IsEmpty());
  options.max_spheres = 2;
  const BakedRobot too_few = bakeWell(smallArm(), nullptr, options);
  ASSERT_EQ(too_few.warnings.size(), 1U);
  EXPECT_THAT(too_few.warnings[0], HasSubstr("are the fewest that cover every group of links, 2 "
                                             "are allowed"));
  for (const bake::BakedGroup& group : too_few.groups) {
    EXPECT_EQ(group.spheres.spheres.empty(), group.link == 3) << "only the finger has no geometry";
  }
}

TEST(RobotBaker, WarnsOfAssumedLimitsUntilTheRecipeStatesThem) {
  SourceRobot robot = smallArm();
  robot.links[1].joint_type = JointType::kPrismatic;
  robot.links[1].limits = JointLimits{-1, 1};
  robot.links[1].limits_are_assumed = true;
  const std::string joint = robot.links[1].joint_name;
  RobotRecipe recipe = recipeFor("hand");
  const BakedRobot guessed = bakeWell(robot, &recipe, coarse());
  EXPECT_THAT(
      guessed.warnings,
      ElementsAre("joint '" + joint +
                  "': the robot's file states no limits for it; -1 to 1 m are assumed, [limits] of "
                  "the recipe may state others"));
  recipe.limits.push_back({{joint, ""}, {0.25, 0.5}});
  const BakedRobot stated = bakeWell(robot, &recipe, coarse());
  EXPECT_THAT(stated.warnings, IsEmpty());
  const auto position = static_cast<std::size_t>(stated.kinematics.links[1].position);
  EXPECT_EQ(stated.kinematics.limits[position].lower, 0.25F);
  EXPECT_EQ(stated.kinematics.limits[position].upper, 0.5F);
  EXPECT_EQ(stated.kinematics.start_positions[position], 0.25F);
}

TEST(RobotBaker, SpendsNoMoreThanTheUsualNumberOnALargeBody) {
  const SourceRobot robot = RobotMaker("cabinet").link("base").box({0.6, 0.6, 0.6}).robot();
  RobotBakeOptions options;
  options.radii = {0.015F, 0.05F, 0.12F};
  const BakedRobot baked = bakeWell(robot, nullptr, options);
  EXPECT_LE(spheresOf(baked), 100U);
  EXPECT_LE(baked.groups[0].spheres.quality.gap.max, bake::RecipeSpheres().max_gap);
}

TEST(RobotBaker, SpendsMoreThanTheUsualNumberWhereGapsWouldBeWide) {
  // Spheres made by hand use up most of the usual number: what is left would leave holes.
  const SourceRobot robot = RobotMaker("rod")
                                .link("base")
                                .box({0.1, 0.1, 0.1})
                                .link("rod", 0, {.type = JointType::kContinuous})
                                .box({0.6, 0.01, 0.01}, shifted(0, 0.5, 0))
                                .robot();
  RobotBakeOptions options;
  options.radii = {0.04F};
  RobotRecipe recipe = recipeFor("base");
  recipe.spheres.links.emplace_back().link = {"base", ""};
  recipe.spheres.links.back().spheres.assign(98, {{0, 0, 0}, 0.04});
  const auto widestGap = [](const BakedRobot& baked) {
    return baked.groups[1].spheres.quality.gap.max;
  };
  recipe.spheres.max_spheres = 100;
  const BakedRobot counted = bakeWell(robot, &recipe, options);
  EXPECT_LE(spheresOf(counted), 100U);
  EXPECT_GT(widestGap(counted), recipe.spheres.max_gap);
  recipe.spheres.max_spheres.reset();
  const BakedRobot judged = bakeWell(robot, &recipe, options);
  EXPECT_GT(spheresOf(judged), 100U);
  EXPECT_LE(widestGap(judged), recipe.spheres.max_gap);
  EXPECT_THAT(judged.warnings, IsEmpty());
}

HandSpheres spheresByHand() {
  return {.links = {{"hand", {{{0, 0, 0}, 0.04}}},
                    {"base", {{{0.01, 0.05, 0}, 0.02}, {{0, 0.05, 0}, 0.04}}},
                    {"hand", {{{0.01, 0, 0}, 0.04}}}},
          .warnings = {}};
}

TEST(HandSpheresOfARobot, AreTakenAsTheyAreAndTheOtherLinksGetNone) {
  RobotBakeOptions options = coarse();
  options.radii = {0.02F, 0.04F};
  options.hand_spheres = spheresByHand();
  const BakedRobot robot = bakeWell(smallArm(), nullptr, options);
  EXPECT_THAT(robot.warnings, IsEmpty());
  ASSERT_EQ(robot.groups.size(), 4U);
  // Radius descending.
  EXPECT_THAT(robot.groups[0].spheres.spheres,
              ElementsAre(SetSphere{{0, 0.05F, 0}, 1}, SetSphere{{0.01F, 0.05F, 0}, 0}));
  EXPECT_THAT(robot.groups[1].spheres.spheres, IsEmpty());
  EXPECT_THAT(robot.groups[2].spheres.spheres,
              ElementsAre(SetSphere{{0, 0, 0}, 1}, SetSphere{{0.01F, 0, 0}, 1}))
      << "both lists of one link count";
  for (const bake::BakedGroup& group : robot.groups) EXPECT_TRUE(group.authored);
  EXPECT_TRUE(robot.groups[0].measured);
  EXPECT_GT(robot.groups[0].spheres.quality.samples, 0U);
  EXPECT_TRUE(openPackOf(robot).robot.has_value());
}

TEST(HandSpheresOfARobot, TakeTheNearestRadiusWithAWarning) {
  RobotBakeOptions options = coarse();
  options.radii = {0.02F, 0.04F};
  options.hand_spheres = HandSpheres{.links = {{"hand", {{{0, 0, 0}, 0.0325}}}}, .warnings = {}};
  const BakedRobot robot = bakeWell(smallArm(), nullptr, options);
  EXPECT_THAT(robot.groups[2].spheres.spheres, ElementsAre(SetSphere{{0, 0, 0}, 1}));
  EXPECT_THAT(robot.warnings,
              ElementsAre("link 'hand': radii of hand-made spheres change by up to 7.5 mm to those "
                          "of the working set; choose `radii` that hold them"));
}

TEST(HandSpheresOfARobot, MayStandInTheRecipeForOneLink) {
  RobotRecipe recipe = recipeFor("hand");
  recipe.spheres.links.emplace_back().link = {"arm", ""};
  recipe.spheres.links.back().spheres = {{{0.1, 0, 0}, 0.04}};
  const BakedRobot robot = bakeWell(smallArm(), &recipe, coarse());
  EXPECT_THAT(robot.groups[1].spheres.spheres, ElementsAre(SetSphere{{0.1F, 0, 0}, 0}));
  EXPECT_TRUE(robot.groups[1].authored);
  EXPECT_FALSE(robot.groups[0].authored);
  EXPECT_FALSE(robot.groups[0].spheres.spheres.empty());
}

TEST(HandSpheresOfARobot, WithoutAnyGeometryAreEnough) {
  const SourceRobot robot = RobotMaker().link("post").robot();
  RobotBakeOptions options = coarse();
  options.hand_spheres = HandSpheres{.links = {{"post", {{{0, 0, 0}, 0.04}}}}, .warnings = {}};
  const BakedRobot baked = bakeWell(robot, nullptr, options);
  EXPECT_FALSE(baked.groups[0].measured);
  EXPECT_TRUE(openPackOf(baked).robot.has_value());
}

TEST(RobotBaker, SkipsAndMergesLinksAsTheRecipeSays) {
  RobotRecipe recipe = recipeFor("hand");
  recipe.spheres.links.resize(2);
  recipe.spheres.links[0].link = {"base", ""};
  recipe.spheres.links[0].skip = true;
  recipe.spheres.links[1].link = {"hand", ""};
  recipe.spheres.links[1].merge_with_parent = true;
  const BakedRobot robot = bakeWell(smallArm(), &recipe, coarse());
  ASSERT_EQ(robot.groups.size(), 3U);
  EXPECT_THAT(robot.groups[0].spheres.spheres, IsEmpty());
  EXPECT_FALSE(robot.groups[0].measured);
  EXPECT_THAT(robot.groups[1].links, ElementsAre(1, 2));
  // Arm and hand together reach from 0 to 28 cm.
  float farthest = 0;
  for (const SetSphere& sphere : robot.groups[1].spheres.spheres) {
    farthest = std::max(farthest, sphere.center.x + 0.04F);
  }
  EXPECT_GT(farthest, 0.25F);
}

TEST(RobotBaker, GivesALinkBelowTheClipHeightNoSpheresAndSaysSo) {
  const SourceRobot robot = RobotMaker()
                                .link("base")
                                .box({0.1, 0.1, 0.1}, shifted(0, 0.05, 0))
                                .link("skid", 0, {.type = JointType::kContinuous})
                                .box({0.08, 0.01, 0.08}, shifted(0, 0.005, 0))
                                .robot();
  for (const bool by_hand : {false, true}) {
    RobotBakeOptions options = coarse();
    if (by_hand) {
      options.hand_spheres =
          HandSpheres{.links = {{"base", {{{0, 0.06, 0}, 0.04}}}, {"skid", {{{0, 0, 0}, 0.04}}}},
                      .warnings = {}};
    }
    const BakedRobot baked = bakeWell(robot, nullptr, options);
    ASSERT_EQ(baked.groups.size(), 2U);
    EXPECT_EQ(baked.groups[1].spheres.spheres.empty(), !by_hand);
    EXPECT_FALSE(baked.groups[1].measured);
    EXPECT_TRUE(openPackOf(baked).robot.has_value());
    if (by_hand) continue;
    EXPECT_THAT(baked.warnings,
                ElementsAre("link 'skid': all of it is lower than the clip height at the start "
                            "pose, so it gets no spheres; lower clip_height in the recipe if it "
                            "needs some"));
  }
}

TEST(RobotBaker, GivesALinkThatHardlyReachesTheClipHeightNoSpheres) {
  // Wheels end anywhere, and in floats: 20.001 mm.
  constexpr double kRadius = 0.0100005;
  SourceRobot robot = RobotMaker()
                          .link("base")
                          .box({0.1, 0.1, 0.1}, shifted(0, 0.05, 0))
                          .link("ball", 0, {.type = JointType::kContinuous})
                          .robot();
  robot.links[1].collisions.push_back(
      {bake::SphereShape{kRadius}, shifted(0, kRadius, 0), std::nullopt});
  for (const std::uint32_t most : {0U, 20U}) {
    RobotBakeOptions options = coarse();
    options.max_spheres = most;
    const BakedRobot baked = bakeWell(robot, nullptr, options);
    ASSERT_EQ(baked.groups.size(), 2U);
    EXPECT_FALSE(baked.groups[0].spheres.spheres.empty());
    EXPECT_TRUE(baked.groups[1].spheres.spheres.empty());
    EXPECT_THAT(baked.warnings, ElementsAre(HasSubstr("link 'ball': all of it is lower")));
  }
}

TEST(RobotBaker, KeepsSpheresAboveTheClipHeight) {
  RobotRecipe recipe = recipeFor("hand");
  recipe.spheres.clip_height = 0.03;
  recipe.base.root_height = 0.01;
  const BakedRobot robot = bakeWell(smallArm(), &recipe, coarse());
  ASSERT_FALSE(robot.groups[0].spheres.spheres.empty());
  for (const SetSphere& sphere : robot.groups[0].spheres.spheres) {
    constexpr float kRounding = 1e-5F;
    EXPECT_GE(sphere.center.y - 0.04F, 0.02F - kRounding);
  }
}

TEST(RobotBaker, FitsVisualsWhereALinkHasNoCollisionGeometry) {
  SourceRobot robot = smallArm();
  std::swap(robot.links[2].collisions, robot.links[2].visuals);
  const BakedRobot baked = bakeWell(robot, nullptr, coarse());
  EXPECT_FALSE(baked.groups[2].spheres.spheres.empty());
  EXPECT_TRUE(baked.collision_surfaces[2].empty());
  EXPECT_FALSE(baked.visual_surfaces[2].empty());
}

/// A robot or options that cannot be baked, and what is said.
struct Refusal {
  std::function<void(SourceRobot&, RobotBakeOptions&)> change;
  std::string where;
  std::string message;
};

TEST(RobotBaker, ExplainsWhatItCannotBake) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<Refusal> refusals{
      {[](SourceRobot& r, RobotBakeOptions&) { r.name.clear(); }, "",
       "the robot has no name; give <robot> one, or the recipe"},
      {[](SourceRobot& r, RobotBakeOptions&) { r.links.clear(); }, "",
       "the robot has no links; give at least one"},
      {[](SourceRobot& r, RobotBakeOptions&) { r.links[2].name.clear(); }, "",
       "a link has an empty name, number 2 from the root on; name it"},
      {[](SourceRobot& r, RobotBakeOptions&) { r.links[1].joint_name.clear(); }, "link 'arm'",
       "the joint to its parent has an empty name; name it"},
      {[](SourceRobot& r, RobotBakeOptions&) {
         for (bake::SourceLink& link : r.links) link.collisions.clear();
       },
       "",
       "no link has geometry, so the robot would be without spheres; give its meshes with "
       "`package`, or spheres in a recipe"},
      {[](SourceRobot& r, RobotBakeOptions&) { r.links[1].collisions[0].link_from_shape[0] = 100; },
       "link 'arm': mesh", "its extents are 20 x 0.06 x 0.06 m"},
      {[](SourceRobot&, RobotBakeOptions& o) {
         o.radii = {0.05F, 0.02F};
       },
       "radii[1]", "0.02 m comes after 0.05 m; list each radius once, ascending"},
      {[](SourceRobot&, RobotBakeOptions& o) {
         o.radii.clear();
         o.hand_spheres = spheresByHand();
       },
       "radii", "0 radii were given; give 1 to 8, in meters, ascending"},
      {[=](SourceRobot&, RobotBakeOptions& o) { o.eps = nan; }, "eps",
       "a tolerance of nan m was given"},
      {[=](SourceRobot&, RobotBakeOptions& o) {
         o.tau = nan;
         o.hand_spheres = spheresByHand();
       },
       "tau", "a tolerance of nan m was given"},
      {[](SourceRobot&, RobotBakeOptions& o) {
         o.hand_spheres = HandSpheres{.links = {{"hnd", {{{0, 0, 0}, 0.04}}}}, .warnings = {}};
       },
       "",
       "hand-made spheres are given for the link 'hnd', which the robot 'tiny' does not have; did "
       "you mean 'hand'"},
  };
  for (const Refusal& refusal : refusals) {
    SCOPED_TRACE(refusal.message);
    SourceRobot robot = smallArm();
    RobotBakeOptions options = coarse();
    refusal.change(robot, options);
    const auto baked = bakeRobot(robot, nullptr, options);
    ASSERT_FALSE(baked.has_value());
    EXPECT_EQ(baked.error().where, refusal.where);
    EXPECT_THAT(baked.error().message, StartsWith(refusal.message));
  }
}

TEST(RobotBaker, ExplainsARecipeThatDoesNotFit) {
  RobotRecipe recipe = recipeFor("hnd");
  const auto baked = bakeRobot(smallArm(), &recipe, coarse());
  ASSERT_FALSE(baked.has_value());
  EXPECT_EQ(baked.error().where, "tiny.toml:2");
  EXPECT_THAT(baked.error().message, HasSubstr("no link 'hnd'"));
}

}  // namespace
}  // namespace galactic::test::robot_baker_test
