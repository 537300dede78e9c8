// A recipe beside the robot that it is for.
#include <gmock/gmock.h>

#include <ostream>

#include "bake/recipe/recipe_helpers.h"

namespace galactic::test::check_recipe_test {
namespace {

struct Misfit {
  const char* name;
  std::string text;
  const char* where;
  const char* message;
};

std::ostream& operator<<(std::ostream& out, const Misfit& misfit) { return out << misfit.name; }

std::string with(const std::string& more) { return kLeastRecipe + more; }

std::string joint(const std::string& name, const std::string& more = "") {
  return with("[[joints]]\nname = \"" + name + "\"\nstep = 0.1\n" + more);
}

std::vector<Misfit> misfits() {
  return {
      {"EndEffector",
       "name = \"r\"\n[end_effector]\nlink = \"hnad\"\n[base]\nfootprint_radius = 0.3\n",
       "r.toml:3", "the robot 'small' has no link 'hnad'; did you mean 'hand'?"},
      {"Camera", with("[camera]\nlink = \"eye\"\nvertical_fov_degrees = 60\n"), "r.toml:7",
       "the robot 'small' has no link 'eye'; known are 'base', 'arm', 'hand', 'finger', 'camera', "
       "'lock'"},
      {"Laser", with("[laser]\nlink = \"eye\"\nfov_degrees = 60\nrange = 9\n"), "r.toml:7",
       "the robot 'small' has no link 'eye'; known are 'base', 'arm', 'hand', 'finger', 'camera', "
       "'lock'"},
      {"Joint", joint("wirst"), "r.toml:7",
       "the robot 'small' has no joint 'wirst'; did you mean 'wrist'?"},
      {"FixedJoint", joint("mount"), "r.toml:7",
       "joint 'mount' is fixed, planar or floating and has no position to set; known are "
       "'shoulder', 'wrist', 'locked'"},
      {"MimickingJoint", joint("grip"), "r.toml:7",
       "joint 'grip' mimics 'wrist' and cannot be set by itself; name that one"},
      {"LockedJoint", joint("locked"), "r.toml:7",
       "joint 'locked' cannot move: both its limits are 0"},
      {"JointRangeBeyondLimits", joint("shoulder", "max = 2.5\n"), "r.toml:7",
       "max = 2.5 of joint 'shoulder' is outside its limits -1 to 2"},
      {"StartOfUnknownJoint", with("[start_pose]\nshouldr = 1\n"), "r.toml:7",
       "the robot 'small' has no joint 'shouldr'; did you mean 'shoulder'?"},
      {"StartAboveLimit", with("[start_pose]\nshoulder = 3\n"), "r.toml:7",
       "joint 'shoulder' starts at 3, above its limit 2"},
      {"StartBelowNarrowedRange", joint("shoulder", "min = 0.5\n[start_pose]\nshoulder = 0\n"),
       "r.toml:11", "joint 'shoulder' starts at 0, below its limit 0.5"},
      {"LimitsOfUnknownJoint", with("[limits]\nshouldr = [0, 1]\n"), "r.toml:7",
       "the robot 'small' has no joint 'shouldr'; did you mean 'shoulder'?"},
      {"LimitsOfAContinuousJoint", with("[limits]\nwrist = [0, 1]\n"), "r.toml:7",
       "joint 'wrist' is continuous and has no limits; narrow what actions do with min and max of "
       "its [[joints]]"},
      {"LimitsThatLockAControlledJoint", joint("shoulder", "[limits]\nshoulder = [1, 1]\n"),
       "r.toml:7", "joint 'shoulder' cannot move: both its limits are 1"},
      {"MimicOfUnknownJoint", with("[mimic]\nlocked = { joint = \"wirst\" }\n"), "r.toml:7",
       "the robot 'small' has no joint 'wirst' that turns or slides; did you mean 'wrist'?"},
      {"UnknownJointThatMimics", with("[mimic.loked]\njoint = \"wrist\"\n"), "r.toml:6",
       "the robot 'small' has no joint 'loked' that turns or slides; did you mean 'locked'?"},
      {"FixedJointThatMimics", with("[mimic.mount]\njoint = \"wrist\"\n"), "r.toml:6",
       "the robot 'small' has no joint 'mount' that turns or slides; known are 'shoulder', "
       "'wrist', 'grip', 'locked'"},
      {"MimicsInACircle",
       with("[mimic]\nshoulder = { joint = \"grip\" }\nwrist = { joint = \"shoulder\" }\n"),
       "r.toml: joint 'shoulder'",
       "it mimics itself in a circle of joints; one of them must move freely"},
      {"ControlledJointThatMimics", joint("shoulder", "[mimic.shoulder]\njoint = \"wrist\"\n"),
       "r.toml:7", "joint 'shoulder' mimics 'wrist' and cannot be set by itself; name that one"},
      {"StartBeyondTheRecipesLimits",
       with("[limits]\nshoulder = [0, 1]\n[start_pose]\nshoulder = 1.5\n"), "r.toml:9",
       "joint 'shoulder' starts at 1.5, above its limit 1"},
      {"SpheresOfUnknownLink", with("[spheres.links.arms]\nskip = true\n"), "r.toml:6",
       "the robot 'small' has no link 'arms'; did you mean 'arm'?"},
      {"RootMerged", with("[spheres.links.base]\nmerge_with_parent = true\n"), "r.toml:6",
       "link 'base' is the root and has no parent to merge with"},
      {"PairOfUnknownLink", with("[self_collision]\nignore = [[\"arm\", \"hnd\"]]\n"), "r.toml:7",
       "the robot 'small' has no link 'hnd'; did you mean 'hand'?"},
      {"PairOfOneLink", with("[self_collision]\nignore = [[\"arm\", \"arm\"]]\n"), "r.toml:7",
       "link 'arm' is paired with itself; name two links"},
  };
}

class RecipeMisfits : public testing::TestWithParam<Misfit> {};

TEST_P(RecipeMisfits, AreNamedWithTheirLine) {
  const ScratchFolder folder;
  const auto recipe = readText(folder, GetParam().text);
  ASSERT_TRUE(recipe.has_value()) << recipe.error().message;
  const auto checked = bake::checkRecipe(*recipe, smallRobot());
  ASSERT_FALSE(checked.has_value());
  EXPECT_EQ(checked.error().code, ErrorCode::kInvalidInput);
  EXPECT_EQ(std::filesystem::path(checked.error().where).filename(), GetParam().where);
  EXPECT_EQ(checked.error().message, GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(Texts, RecipeMisfits, testing::ValuesIn(misfits()),
                         [](const auto& misfit) { return misfit.param.name; });

TEST(RecipesThatFit, PassTheCheck) {
  const ScratchFolder folder;
  const auto recipe =
      readText(folder, joint("shoulder",
                             "min = -1\nmax = 1.5\n[[joints]]\nname = \"wrist\"\nstep = 0.1\n"
                             "[start_pose]\nshoulder = 1.5\nwrist = 100\n"
                             "[spheres.links.hand]\nmerge_with_parent = true\n"
                             "[self_collision]\nignore = [[\"arm\", \"camera\"]]\n"
                             "[camera]\nlink = \"camera\"\nvertical_fov_degrees = 60\n"));
  ASSERT_TRUE(recipe.has_value()) << recipe.error().message;
  const auto checked = bake::checkRecipe(*recipe, smallRobot());
  EXPECT_TRUE(checked.has_value()) << checked.error().message;
}

TEST(RecipesThatFit, MayWidenLimitsAndFreeLockedJoints) {
  const ScratchFolder folder;
  const auto recipe = readText(folder, joint("locked",
                                             "[limits]\nlocked = [-0.1, 0.3]\nshoulder = [-3, 3]\n"
                                             "[start_pose]\nlocked = 0.2\nshoulder = -2.5\n"));
  ASSERT_TRUE(recipe.has_value()) << recipe.error().message;
  const auto checked = bake::checkRecipe(*recipe, smallRobot());
  EXPECT_TRUE(checked.has_value()) << checked.error().message;
  const bake::SourceLink& arm = smallRobot().links[1];
  EXPECT_EQ(bake::jointLimits(arm, &*recipe)->lower, -3);
  EXPECT_EQ(bake::jointLimits(arm, nullptr)->lower, -1);
}

TEST(RecipesThatFit, MayCoupleJoints) {
  const ScratchFolder folder;
  const auto recipe = readText(
      folder, with("[mimic]\nwrist = { joint = \"shoulder\", multiplier = -2, offset = 0.5 }\n"));
  ASSERT_TRUE(recipe.has_value()) << recipe.error().message;
  bake::SourceRobot robot = smallRobot();
  const auto coupled = bake::coupleJoints(*recipe, robot);
  ASSERT_TRUE(coupled.has_value()) << coupled.error().message;
  // The finger followed the wrist in the URDF: now both follow the shoulder.
  for (const std::size_t link : {std::size_t{2}, std::size_t{3}}) {
    ASSERT_TRUE(robot.links[link].mimic.has_value());
    EXPECT_EQ(robot.links[link].mimic->link, 1U);
    EXPECT_EQ(robot.links[link].mimic->multiplier, -2);
    EXPECT_EQ(robot.links[link].mimic->offset, 0.5);
  }
}

TEST(RecipesThatFit, NeedARobotWithLinks) {
  const ScratchFolder folder;
  const auto recipe = readText(folder, kLeastRecipe);
  ASSERT_TRUE(recipe.has_value());
  EXPECT_FALSE(bake::checkRecipe(*recipe, bake::SourceRobot{}).has_value());
}

}  // namespace
}  // namespace galactic::test::check_recipe_test
