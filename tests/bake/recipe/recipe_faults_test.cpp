// Each thing that can be wrong with a recipe has a message of its own, with its line.
#include <gmock/gmock.h>

#include <ostream>

#include "bake/recipe/recipe_helpers.h"

namespace galactic::test::recipe_faults_test {
namespace {

struct Fault {
  const char* name;
  std::string text;
  const char* where;
  const char* message;
};

std::ostream& operator<<(std::ostream& out, const Fault& fault) { return out << fault.name; }

/// Line 6 is the first of `more`.
std::string with(const std::string& more) { return kLeastRecipe + more; }

/// A key of 20,000 parts.
std::string deepKey() {
  std::string key = "a";
  for (int n = 1; n < 20'000; ++n) key += ".a";
  return key;
}

std::vector<Fault> faults() {
  return {
      {"NoToml", "name = = 1", "r.toml:1",
       "it is not TOML: Error while parsing value: could not determine value type"},
      {"DeepKey", "name = \"r\"\n" + deepKey() + " = 1\n", "r.toml:2",
       "it has a key of more than 32 parts; is it a recipe?"},
      {"DeepTable", "# a.b\n[" + deepKey() + "]\nx = 1\n", "r.toml:2",
       "it has a key of more than 32 parts; is it a recipe?"},
      {"DeepInlineTable", "a = { x = \"\"\"\n...\"\"\", " + deepKey() + " = 1 }\n", "r.toml:2",
       "it has a key of more than 32 parts; is it a recipe?"},
      {"Empty", "", "r.toml", "the key name is missing"},
      {"NoName", "[end_effector]\nlink = \"hand\"\n[base]\nfootprint_radius = 0.3\n", "r.toml",
       "the key name is missing"},
      {"NameOfOtherType", "name = 3\n", "r.toml:1", "name: expected a name in quotes"},
      {"NoEndEffector", "name = \"r\"\n[base]\nfootprint_radius = 0.3\n", "r.toml",
       "the table [end_effector] is missing"},
      {"NoEndEffectorLink", "name = \"r\"\n[end_effector]\n[base]\nfootprint_radius = 0.3\n",
       "r.toml:2", "the key end_effector.link is missing"},
      {"MisspeltRequiredKey",
       "name = \"r\"\n[end_effector]\nlnk = \"hand\"\n[base]\nfootprint_radius = 0.3\n", "r.toml:3",
       "the key end_effector.lnk is unknown; did you mean 'link'?"},
      {"NoBase", "name = \"r\"\n[end_effector]\nlink = \"hand\"\n", "r.toml",
       "the table [base] is missing"},
      {"NoFootprint", "name = \"r\"\n[end_effector]\nlink = \"hand\"\n[base]\n", "r.toml:4",
       "base has no footprint; give footprint_radius or footprint_rectangle"},
      {"TwoFootprints", with("footprint_rectangle = [0, 0, 1, 1]\n"), "r.toml:4",
       "base has both footprint_radius and footprint_rectangle; keep one of them"},
      {"FootprintInsideOut",
       "name = \"r\"\n[end_effector]\nlink = \"hand\"\n[base]\nfootprint_rectangle = [1, 0, 0, "
       "1]\n",
       "r.toml:4",
       "base.footprint_rectangle: expected [min x, min y, max x, max y] with each min below its "
       "max"},
      {"UnknownTable", with("[sphere]\neps = 0.1\n"), "r.toml:6",
       "the key sphere is unknown; did you mean 'spheres'?"},
      {"UnknownKey", with("foward_step = 0.1\n"), "r.toml:6",
       "the key base.foward_step is unknown; did you mean 'forward_step'?"},
      {"UnknownKeyFarFromAll",
       with("[camera]\nlink = \"head\"\nvertical_fov_degrees = 60\ncolor = 3\n"), "r.toml:9",
       "the key camera.color is unknown; known are 'link', 'position', 'rpy_degrees', "
       "'vertical_fov_degrees'"},
      {"TableOfOtherType", "name = \"r\"\nend_effector = 3\n", "r.toml:2",
       "end_effector: expected a table, [end_effector]"},
      {"NumberOfOtherType", with("forward_step = \"far\"\n"), "r.toml:6",
       "base.forward_step: expected a number"},
      {"NumberOutOfRange", with("forward_step = 20\n"), "r.toml:6",
       "base.forward_step: found 20, expected 0.001 to 1 m"},
      {"NumberNotFinite", with("forward_step = nan\n"), "r.toml:6",
       "base.forward_step: found nan, expected a finite number"},
      {"LimitsNotAPair", with("[limits]\nj = 1\n"), "r.toml:7",
       "limits.j: expected a list of 2 numbers"},
      {"LimitsReversed", with("[limits]\nj = [1, -1]\n"), "r.toml:7",
       "limits.j = [1, -1]: the lower limit comes first"},
      {"LimitsNotFinite", with("[limits]\nj = [0, inf]\n"), "r.toml:7",
       "limits.j[1]: found inf, expected a finite number"},
      {"GapTooWide", with("[spheres]\nmax_gap = 2\n"), "r.toml:7",
       "spheres.max_gap: found 2, expected 0.001 to 1 m"},
      {"GapAndCount", with("[spheres]\nmax_gap = 0.05\nmax_spheres = 9\n"), "r.toml:6",
       "spheres has both max_spheres and max_gap; keep one of them: a number of spheres, or the "
       "widest gap"},
      {"CountNotWhole", with("[spheres]\nmax_spheres = 1.5\n"), "r.toml:7",
       "spheres.max_spheres: expected a whole number"},
      {"CountNegative", with("[spheres]\nmax_spheres = -1\n"), "r.toml:7",
       "spheres.max_spheres: found -1, expected 1 to 10000"},
      {"VectorTooShort",
       with("[camera]\nlink = \"head\"\nvertical_fov_degrees = 60\nposition = [1, 2]\n"),
       "r.toml:9", "camera.position: expected a list of 3 numbers"},
      {"VectorOfText",
       with("[camera]\nlink = \"head\"\nvertical_fov_degrees = 60\nposition = [1, 2, \"x\"]\n"),
       "r.toml:9", "camera.position[2]: expected a number"},
      {"CameraWithoutFieldOfView", with("[camera]\nlink = \"head\"\n"), "r.toml:6",
       "the key camera.vertical_fov_degrees is missing"},
      {"FieldOfViewOutOfRange", with("[camera]\nlink = \"head\"\nvertical_fov_degrees = 180\n"),
       "r.toml:8", "camera.vertical_fov_degrees: found 180, expected 1 to 170 degrees"},
      {"LaserWithoutFieldOfView", with("[laser]\nlink = \"head\"\nrange = 5\n"), "r.toml:6",
       "the key laser.fov_degrees is missing"},
      {"LaserWithoutRange", with("[laser]\nlink = \"head\"\nfov_degrees = 360\n"), "r.toml:6",
       "the key laser.range is missing"},
      {"LaserBeyondAWholeTurn", with("[laser]\nlink = \"head\"\nfov_degrees = 361\nrange = 5\n"),
       "r.toml:8", "laser.fov_degrees: found 361, expected 0 to 360 degrees"},
      {"LaserRangeEmpty",
       with("[laser]\nlink = \"head\"\nfov_degrees = 9\nrange = 5\nmin_range = 5\n"), "r.toml:6",
       "laser.min_range must be below laser.range"},
      {"JointsNoList", with("[joints]\nname = \"a\"\n"), "r.toml:6", "joints: expected a list"},
      {"JointWithoutName", with("[[joints]]\nstep = 0.1\n"), "r.toml:6",
       "the key joints[0].name is missing"},
      {"JointWithoutStep", with("[[joints]]\nname = \"a\"\n"), "r.toml:6",
       "the key joints[0].step is missing"},
      {"JointStepZero", with("[[joints]]\nname = \"a\"\nstep = 0\n"), "r.toml:8",
       "joints[0].step: found 0, expected 0.0001 to 3.2 (radians or meters)"},
      {"JointRangeEmpty", with("[[joints]]\nname = \"a\"\nstep = 0.1\nmin = 1\nmax = 1\n"),
       "r.toml:6", "joints[0].min = 1 is not below joints[0].max = 1"},
      {"MimicOfNothing", with("[mimic.a]\nmultiplier = 2\n"), "r.toml:6",
       "the key mimic.a.joint is missing"},
      {"MimicNoTable", with("[mimic]\na = \"b\"\n"), "r.toml:7",
       "mimic.a: expected a table, [mimic.a]"},
      {"MimicTooFast", with("[mimic]\na = { joint = \"b\", multiplier = 1001 }\n"), "r.toml:7",
       "mimic.a.multiplier: found 1001, expected -1000 to 1000"},
      {"StartNotANumber", with("[start_pose]\na = \"up\"\n"), "r.toml:7",
       "start_pose.a: expected a number"},
      {"SkipNotTrueOrFalse", with("[spheres.links.a]\nskip = 1\n"), "r.toml:7",
       "spheres.links.a.skip: expected true or false"},
      {"SkipAndTolerance", with("[spheres.links.a]\nskip = true\neps = 0.1\n"), "r.toml:6",
       "spheres.links.a contradicts itself; keep one of: skip, merge_with_parent, spheres, or "
       "tolerances (eps, tau, max_spheres, clip_height)"},
      {"MergeAndSpheres",
       with("[spheres.links.a]\nmerge_with_parent = true\nspheres = [[0, 0, 0, 0.1]]\n"),
       "r.toml:6",
       "spheres.links.a contradicts itself; keep one of: skip, merge_with_parent, spheres, or "
       "tolerances (eps, tau, max_spheres, clip_height)"},
      {"SphereOfThreeNumbers", with("[spheres.links.a]\nspheres = [[0, 0, 0]]\n"), "r.toml:7",
       "spheres.links.a.spheres[0]: expected a list of 4 numbers"},
      {"SphereWithoutRadius", with("[spheres.links.a]\nspheres = [[0, 0, 0, 0]]\n"), "r.toml:7",
       "spheres.links.a.spheres[0] has the radius 0, expected 0.001 to 2 m"},
      {"NoSpheresAtAll", with("[spheres.links.a]\nspheres = []\n"), "r.toml:6",
       "spheres.links.a.spheres is empty; a link without spheres says skip = true"},
      {"LinkNoTable", with("[spheres.links]\na = 3\n"), "r.toml:7",
       "spheres.links.a: expected a table, [spheres.links.a]"},
      {"PairOfThree", with("[self_collision]\nignore = [[\"a\", \"b\", \"c\"]]\n"), "r.toml:7",
       "each entry of self_collision.ignore: expected a pair of links, [\"a\", \"b\"]"},
      {"PairOfNumbers", with("[self_collision]\nignore = [[1, 2]]\n"), "r.toml:7",
       "each entry of self_collision.ignore: expected a name in quotes"},
      {"Date", with("forward_step = 2020-01-01\n"), "r.toml:6",
       "base.forward_step: expected a number"},
  };
}

class RecipeFaults : public testing::TestWithParam<Fault> {};

TEST_P(RecipeFaults, NameTheirLineAndWhatIsWanted) {
  const ScratchFolder folder;
  const auto recipe = readText(folder, GetParam().text);
  ASSERT_FALSE(recipe.has_value());
  EXPECT_EQ(recipe.error().code, ErrorCode::kInvalidInput);
  EXPECT_EQ(std::filesystem::path(recipe.error().where).filename(), GetParam().where);
  EXPECT_EQ(recipe.error().message, GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(Texts, RecipeFaults, testing::ValuesIn(faults()),
                         [](const auto& fault) { return fault.param.name; });

TEST(RecipeJoints, ThatAreListedTwiceNameBothLines) {
  const ScratchFolder folder;
  const std::string joint = "[[joints]]\nname = \"a\"\nstep = 0.1\n";
  const auto recipe = readText(folder, with(joint + joint));
  ASSERT_FALSE(recipe.has_value());
  EXPECT_THAT(recipe.error().where, testing::EndsWith("r.toml:9"));
  EXPECT_THAT(recipe.error().message, testing::StartsWith("joint 'a' is listed twice, see "));
  EXPECT_THAT(recipe.error().message, testing::EndsWith("r.toml:7"));
}

TEST(RecipeFiles, ThatAreMissingOrFoldersAreIoErrors) {
  const ScratchFolder folder;
  for (const auto& path : {folder.path() / "absent.toml", folder.path()}) {
    const auto recipe = bake::readRobotRecipe(path);
    ASSERT_FALSE(recipe.has_value());
    EXPECT_EQ(recipe.error().code, ErrorCode::kIo);
  }
}

TEST(RecipeFiles, BeyondOneMebibyteAreRefused) {
  const ScratchFolder folder;
  const auto recipe = readText(folder, with("# " + std::string(1U << 20U, 'x')));
  ASSERT_FALSE(recipe.has_value());
  EXPECT_THAT(recipe.error().message, testing::EndsWith("is it a recipe?"));
}

}  // namespace
}  // namespace galactic::test::recipe_faults_test
