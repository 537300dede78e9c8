// Which links count as one rigid body.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bake/robot/tiny_robots.h"
#include "bake/robot_description/link_points.h"
#include "robot/robot_parts.h"

namespace galactic::test::rigid_groups_test {
namespace {

using bake::findRigidGroups;
using testing::ElementsAre;

/// Links 0 base, 1 lid (fixed), 2 arm (moves), 3 wrist (fixed to the arm), 4 hand (moves),
/// 5 horn (fixed to the lid), 6 finger (fixed to the hand).
bake::SourceRobot armRobot() {
  return RobotMaker()
      .link("base")
      .link("lid", 0, {.parent_from_joint = shifted(0, 0.2, 0)})
      .link("arm", 0, {.type = JointType::kRevolute, .parent_from_joint = shifted(0.1, 0, 0)})
      .link("wrist", 2, {.parent_from_joint = shifted(0.3, 0, 0)})
      .link("hand", 3, {.type = JointType::kContinuous, .parent_from_joint = shifted(0.1, 0, 0)})
      .link("horn", 1, {.parent_from_joint = shifted(0, 0.1, 0)})
      .link("finger", 4, {.parent_from_joint = shifted(0, 0, 0.05)})
      .robot();
}

TEST(RigidGroups, AreLinksJoinedByFixedJoints) {
  const auto groups = findRigidGroups(armRobot(), nullptr, std::vector(7, kNoChange));
  ASSERT_EQ(groups.size(), 3U);
  EXPECT_THAT(groups[0].links, ElementsAre(0, 1, 5));
  EXPECT_THAT(groups[1].links, ElementsAre(2, 3));
  EXPECT_THAT(groups[2].links, ElementsAre(4, 6));
  for (const bake::RigidGroup& group : groups) EXPECT_EQ(group.link, group.links.front());
  // Through two fixed joints.
  EXPECT_EQ(groups[0].group_from_link[2], shifted(0, 0.2 + 0.1, 0));
  EXPECT_EQ(groups[1].group_from_link[1], shifted(0.3, 0, 0));
  EXPECT_EQ(groups[2].group_from_link[0], kNoChange);
}

TEST(RigidGroups, TakeInMergedLinksAtTheirStartPose) {
  bake::RobotRecipe recipe = recipeFor("hand");
  recipe.spheres.links.emplace_back().link = {"hand", ""};
  recipe.spheres.links.back().merge_with_parent = true;
  std::vector<bake::Affine> start(7, kNoChange);
  // The hand starts a quarter turn about Y: X goes to -Z.
  start[4] = {0, 0, 1, 0, 0, 1, 0, 0, -1, 0, 0, 0};
  const auto groups = findRigidGroups(armRobot(), &recipe, start);
  ASSERT_EQ(groups.size(), 2U);
  EXPECT_THAT(groups[1].links, ElementsAre(2, 3, 4, 6));
  const Point3 tip = pointIn(groups[1].group_from_link[3], {0, 0, 0});
  // Wrist 0.3 and hand 0.1 along X; the finger's 0.05 along Z turned to X.
  EXPECT_NEAR(tip[0], 0.45, 1e-12);
  EXPECT_NEAR(tip[2], 0, 1e-12);
}

TEST(RigidGroups, OfASingleLinkIsOne) {
  const auto groups = findRigidGroups(RobotMaker().link("base").robot(), nullptr, {kNoChange});
  ASSERT_EQ(groups.size(), 1U);
  EXPECT_THAT(groups[0].links, ElementsAre(0));
}

TEST(RigidGroups, HoldEachLinkOnceOverManyRandomTrees) {
  std::uint32_t state = 1;
  const auto next = [&state](std::uint32_t below) {
    state = state * 1664525U + 1013904223U;
    return (state >> 8U) % below;
  };
  std::size_t joined = 0;
  std::size_t links = 0;
  for (int round = 0; round < 100; ++round) {
    RobotMaker maker;
    const std::uint32_t count = 1 + next(20);
    for (std::uint32_t n = 0; n < count; ++n) {
      const int parent = n == 0 ? -1 : static_cast<int>(next(n));
      maker.link(std::to_string(n), parent,
                 {.type = next(2) == 0 ? JointType::kFixed : JointType::kRevolute});
    }
    const auto groups = findRigidGroups(maker.robot(), nullptr, std::vector(count, kNoChange));
    std::vector<int> seen(count, 0);
    for (const bake::RigidGroup& group : groups) {
      EXPECT_TRUE(std::is_sorted(group.links.begin(), group.links.end()));
      for (const std::uint32_t link : group.links) {
        ++seen[link];
        const bake::SourceLink& source = maker.robot().links[link];
        if (link == group.link) continue;
        // Its parent is in the same group, over a fixed joint.
        EXPECT_EQ(source.joint_type, JointType::kFixed);
        EXPECT_TRUE(std::binary_search(group.links.begin(), group.links.end(),
                                       static_cast<std::uint32_t>(source.parent)));
        ++joined;
      }
    }
    EXPECT_EQ(seen, std::vector<int>(count, 1));
    links += count;
  }
  EXPECT_GT(joined, links / 10);
  EXPECT_LT(joined, links * 9 / 10);
}

}  // namespace
}  // namespace galactic::test::rigid_groups_test
