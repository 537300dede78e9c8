// What a dry run finds missing before anything is baked.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string_view>
#include <utility>
#include <vector>

#include "galactic/bake/build.h"
#include "support/scratch_folder.h"

namespace galactic::test::find_missing_test {
namespace {

/// What a robot of this text lacks.
std::vector<bake::LeftOut> missingOf(std::string_view text) {
  const ScratchFolder folder;
  bake::WorldPlan plan;
  bake::PackJob robot;
  robot.name = "robot.pack";
  robot.job = bake::RobotJob{.input = folder.write("r.xml", text)};
  plan.assets.push_back(std::move(robot));
  bake::BakeLibraries libraries;
  return findMissing(plan, 1, libraries);
}

TEST(MissingFiles, AreNoneOfARobotWhoseMeshStandsInItsFile) {
  EXPECT_THAT(missingOf("<mujoco><asset><mesh name='m' vertex='0 0 0 1 0 0 0 1 0 0 0 1'/></asset>"
                        "<worldbody><body name='b'><geom type='mesh' mesh='m'/></body></worldbody>"
                        "</mujoco>"),
              testing::IsEmpty());
}

TEST(MissingFiles, AreTheMeshesThatARobotNames) {
  const auto missing = missingOf(
      "<mujoco><asset><mesh file='m.stl'/></asset><worldbody><body name='b'>"
      "<geom type='mesh' mesh='m'/></body></worldbody></mujoco>");
  ASSERT_EQ(missing.size(), 1U);
  EXPECT_EQ(missing[0].name, "robot.pack");
  EXPECT_THAT(missing[0].reasons, testing::ElementsAre(testing::HasSubstr("mesh 'm.stl'")));
}

}  // namespace
}  // namespace galactic::test::find_missing_test
