// galactic-bake --as robot as a user meets it.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/bake_folder.h"
#include "galactic/pack.h"
#include "galactic/robot.h"
#include "galactic/schema/pack_generated.h"
#include "support/mesh_files.h"

namespace galactic::robot_cli_test {
namespace {

using nlohmann::json;
using test::ProgramRun;
using test::Refusal;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

/// A post of 10 cm with an arm that turns, and a hand that slides along it.
constexpr const char* kArm = R"(<robot name="arm">
<link name="post"><collision><origin xyz="0 0 0.05"/>
  <geometry><box size="0.08 0.08 0.1"/></geometry></collision></link>
<link name="boom"><collision><origin xyz="0.1 0 0"/>
  <geometry><box size="0.2 0.06 0.06"/></geometry></collision></link>
<link name="hand"><collision><geometry><box size="0.06 0.06 0.06"/></geometry></collision></link>
<joint name="turn" type="continuous"><parent link="post"/><child link="boom"/>
  <origin xyz="0 0 0.15"/><axis xyz="0 0 1"/></joint>
<joint name="slide" type="prismatic"><parent link="boom"/><child link="hand"/>
  <origin xyz="0.25 0 0"/><limit lower="0" upper="0.1" effort="1" velocity="1"/></joint>
</robot>
)";

constexpr const char* kRecipe = R"(name = "helper"
[end_effector]
link = "hand"
grasp_point = [0.01, 0.02, 0.03]
[base]
footprint_radius = 0.3
[[joints]]
name = "turn"
step = 0.2
[start_pose]
slide = 0.05
)";

/// A robot of one link whose geometry is a mesh of a package.
std::string meshRobot(const std::string& uri) {
  return "<robot name=\"m\"><link name=\"a\"><collision><geometry><mesh filename=\"" + uri +
         "\" scale=\"0.03 0.03 0.03\"/></geometry></collision></link></robot>";
}

class RobotCli : public test::BakeFolder {
 protected:
  void SetUp() override {
    write("arm.urdf", kArm);
    write("arm.toml", kRecipe);
  }

  /// In few large spheres: a bake takes less than a second.
  [[nodiscard]] ProgramRun bake(std::vector<std::string> arguments) const {
    const std::vector<std::string> quick{"--radii", "0.04", "--eps", "0.03", "--tau", "0.05"};
    arguments.insert(arguments.end(), quick.begin(), quick.end());
    return run(std::move(arguments));
  }

  /// A pack and its robot, or a failure of the test.
  struct Opened {
    std::optional<PackFile> pack;
    std::optional<Robot> robot;
  };

  [[nodiscard]] Opened open(const std::string& name) const {
    Opened opened;
    auto pack = PackFile::open(path(name));
    EXPECT_TRUE(pack) << pack.error().text();
    if (!pack) return opened;
    opened.pack = std::move(*pack);
    auto robot = Robot::from(*opened.pack);
    EXPECT_TRUE(robot);
    if (robot) opened.robot = std::move(*robot);
    return opened;
  }
};

TEST_F(RobotCli, BakesAUrdfWithItsRecipe) {
  const ProgramRun baked = bake({"arm.urdf", "--recipe", "arm.toml"});
  EXPECT_EQ(baked.exit_code, 0) << baked.err;
  EXPECT_THAT(baked.out, AllOf(HasSubstr("arm.urdf -> arm.pack"),
                               HasSubstr("helper: 3 links, 2 joint positions, 1 controlled joint"),
                               HasSubstr("3 pairs of groups")));
  EXPECT_THAT(baked.err, IsEmpty());
  const Opened opened = open("arm.pack");
  ASSERT_TRUE(opened.robot);
  EXPECT_EQ(opened.robot->name(), "helper");
  EXPECT_EQ(opened.robot->endEffector()->link, *opened.robot->findLink("hand"));
  // The recipe writes Z up: (0.01, 0.02, 0.03) is (0.01, 0.03, -0.02) here.
  EXPECT_EQ(opened.robot->endEffector()->grasp_point, (Vec3{0.01F, 0.03F, -0.02F}));
  ASSERT_EQ(opened.robot->controlledJoints().size(), 1U);
  EXPECT_THAT(opened.robot->startPositions(), ElementsAre(0, 0.05F));
}

/// The same arm for MuJoCo, its hand in a file of its own.
constexpr const char* kArmMjcf = R"(<mujoco model="arm"><worldbody><body name="post">
<geom type="box" size="0.04 0.04 0.05" pos="0 0 0.05"/>
<body name="boom" pos="0 0 0.15"><joint name="turn" axis="0 0 1"/>
<geom type="box" size="0.1 0.03 0.03" pos="0.1 0 0"/><include file="hand.xml"/></body></body></worldbody>
<keyframe><key name="home" qpos="0.25 0.075"/></keyframe></mujoco>
)";
constexpr const char* kHandMjcf = R"(<mujocoinclude><body name="hand" pos="0.25 0 0">
<joint name="slide" type="slide" axis="1 0 0" range="0 0.1"/><geom type="box" size="0.03 0.03 0.03"/>
</body></mujocoinclude>)";

TEST_F(RobotCli, BakesAnMjcfWithTheSameRecipe) {
  write("arm.xml", kArmMjcf);
  write("hand.xml", kHandMjcf);
  const ProgramRun baked = bake({"arm.xml", "--recipe", "arm.toml"});
  EXPECT_EQ(baked.exit_code, 0) << baked.err;
  EXPECT_THAT(baked.out,
              AllOf(HasSubstr("arm.xml -> arm.pack"),
                    HasSubstr("helper: 3 links, 2 joint positions, 1 controlled joint")));
  EXPECT_THAT(baked.err, IsEmpty());
  const Opened opened = open("arm.pack");
  ASSERT_TRUE(opened.robot);
  // The recipe says where the hand starts, the file where the boom does.
  EXPECT_THAT(opened.robot->startPositions(), ElementsAre(0.25F, 0.05F));
  std::vector<std::string> names;
  for (const schema::SourceFile* file : *opened.pack->root().provenance()->sources()) {
    names.push_back(file->name()->str());
  }
  EXPECT_THAT(names, ElementsAre("arm.xml", "hand.xml", "arm.toml"));
  ASSERT_EQ(bake({"arm.urdf", "--recipe", "arm.toml", "-o", "urdf.pack"}).exit_code, 0);
  const Opened twin = open("urdf.pack");
  ASSERT_TRUE(twin.robot);
  ASSERT_EQ(twin.robot->groups().size(), opened.robot->groups().size());
  for (std::size_t n = 0; n < twin.robot->groups().size(); ++n) {
    EXPECT_TRUE(
        std::ranges::equal(twin.robot->groups()[n].spheres, opened.robot->groups()[n].spheres));
  }
}

TEST_F(RobotCli, DraftsARecipeOfAnMjcf) {
  write("arm.xml", kArmMjcf);
  write("hand.xml", kHandMjcf);
  const ProgramRun drafted = run({"arm.xml", "--print-recipe"});
  EXPECT_EQ(drafted.exit_code, 0) << drafted.err;
  EXPECT_THAT(drafted.out, AllOf(HasSubstr("link = \"hand\""), HasSubstr("\"slide\" = 0.075")));
  write("draft.toml", drafted.out);
  EXPECT_EQ(bake({"arm.xml", "--recipe", "draft.toml"}).exit_code, 0);
}

TEST_F(RobotCli, DraftsOneStepForTheStagesOfATelescopeThatAnMjcfCouples) {
  std::string text = "<mujoco><worldbody><body name=\"base\"><geom size=\"0.1\"/>";
  for (int stage = 1; stage <= 4; ++stage) {
    text += fmt::format(
        "<body name=\"stage{0}\" pos=\"0.1 0 0\"><joint name=\"slide{0}\" "
        "type=\"slide\" axis=\"1 0 0\" range=\"0 1\"/><geom size=\"0.03\"/>",
        stage);
  }
  text += "<body name=\"gripper\"><geom size=\"0.02\"/><camera name=\"camera\"/></body>";
  for (int stage = 0; stage <= 4; ++stage) text += "</body>";
  text +=
      "</worldbody><equality><joint joint1=\"slide1\" joint2=\"slide2\"/>"
      "<joint joint1=\"slide2\" joint2=\"slide3\"/>"
      "<joint joint1=\"slide3\" joint2=\"slide4\"/></equality></mujoco>";
  write("telescope.xml", text);
  const ProgramRun drafted = run({"telescope.xml", "--print-recipe"});
  EXPECT_EQ(drafted.exit_code, 0) << drafted.err;
  EXPECT_THAT(drafted.out,
              AllOf(HasSubstr("[[joints]]\nname = \"slide4\"\nstep = 0.0125"),
                    Not(HasSubstr("[mimic]")), HasSubstr("[camera]\nlink = \"camera\"")));
}

TEST_F(RobotCli, TellsWhatAnotherXmlFileIs) {
  write("world.xml", "<?xml version=\"1.0\"?><sdf version=\"1.9\"><world/></sdf>");
  const ProgramRun refused = run({"world.xml"});
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_THAT(refused.err, HasSubstr("its outermost element is <sdf>, expected <robot> (URDF) or "
                                     "<mujoco> (MJCF)"));
}

TEST_F(RobotCli, NamesEveryFileThatItReadInThePack) {
  write("hands/arm.srdf",
        "<robot name=\"arm\"><link_sphere_approximation link=\"boom\"><sphere center=\"0.1 0 0\" "
        "radius=\"0.04\"/></link_sphere_approximation></robot>");
  ASSERT_EQ(bake({"arm.urdf", "--recipe", "arm.toml", "--spheres", "hands/arm.srdf"}).exit_code, 0);
  const Opened opened = open("arm.pack");
  ASSERT_TRUE(opened.pack);
  std::vector<std::string> names;
  for (const schema::SourceFile* file : *opened.pack->root().provenance()->sources()) {
    names.push_back(file->name()->str());
    EXPECT_GT(file->bytes(), 0U);
  }
  EXPECT_THAT(names, ElementsAre("arm.urdf", "arm.toml", "arm.srdf"))
      << "no folders of this machine";
}

TEST_F(RobotCli, WritesTheSameBytesForAnyNumberOfJobsAndInAnyFolder) {
  ASSERT_EQ(bake({"arm.urdf", "--recipe", "arm.toml", "-o", "one.pack", "-j1"}).exit_code, 0);
  ASSERT_EQ(bake({"arm.urdf", "--recipe", "arm.toml", "-o", "three.pack", "-j3"}).exit_code, 0);
  write("else/arm.urdf", kArm);
  write("else/arm.toml", kRecipe);
  ASSERT_EQ(bake({"else/arm.urdf", "--recipe", "else/arm.toml", "-o", "else.pack"}).exit_code, 0);
  EXPECT_FALSE(content("one.pack").empty());
  EXPECT_TRUE(content("one.pack") == content("three.pack"));
  EXPECT_TRUE(content("one.pack") == content("else.pack"));
}

TEST_F(RobotCli, ReportsGroupsAndPairs) {
  const ProgramRun baked = bake({"arm.urdf", "--report", "report.json"});
  ASSERT_EQ(baked.exit_code, 0);
  EXPECT_THAT(baked.out, HasSubstr("no action moves it: --print-recipe"));
  const json robot = json::parse(content("report.json"))["baked"][0];
  EXPECT_EQ(robot["name"], "arm");
  EXPECT_EQ(robot["links"], 3);
  EXPECT_EQ(robot["joint_positions"], 2);
  EXPECT_EQ(robot["controlled_joints"], 0);
  ASSERT_EQ(robot["groups"].size(), 3U);
  EXPECT_EQ(robot["groups"][1]["link"], "boom");
  EXPECT_GT(robot["groups"][1]["spheres"]["count"], 0);
  ASSERT_EQ(robot["pairs"].size(), 3U);
  EXPECT_EQ(robot["pairs"][0]["kind"], "adjacent");
  EXPECT_EQ(robot["pairs"][1]["first"], "post");
  EXPECT_EQ(robot["pairs"][1]["second"], "hand");
  EXPECT_EQ(robot["pairs"][1]["kind"], "never");
  // Every stage has taken some time.
  for (const char* stage : {"import", "spheres", "self_collision", "render", "write", "all"}) {
    EXPECT_GT(robot["seconds"][stage], 0) << stage;
  }
}

TEST_F(RobotCli, PrintsARecipeThatItReads) {
  const ProgramRun printed = run({"--print-recipe"});
  EXPECT_EQ(printed.exit_code, 0);
  EXPECT_THAT(printed.out, AllOf(HasSubstr("[end_effector]"), HasSubstr("[[joints]]")));
  write("printed.toml", printed.out);
  // It is read without complaint; only its links are those of another robot.
  const ProgramRun baked = bake({"arm.urdf", "--recipe", "printed.toml"});
  EXPECT_EQ(baked.exit_code, 3);
  EXPECT_THAT(baked.err, AllOf(StartsWith("galactic-bake: printed.toml:"),
                               HasSubstr("the robot 'arm' has no link")));
}

TEST_F(RobotCli, DraftsARecipeThatBakes) {
  const ProgramRun printed = run({"arm.urdf", "--print-recipe"});
  EXPECT_EQ(printed.exit_code, 0) << printed.err;
  EXPECT_THAT(printed.out, AllOf(HasSubstr("link = \"hand\""), HasSubstr("Guess")));
  EXPECT_FALSE(has("arm.pack"));
  write("draft.toml", printed.out);
  const ProgramRun baked = bake({"arm.urdf", "--recipe", "draft.toml"});
  EXPECT_EQ(baked.exit_code, 0) << baked.err;
  const Opened opened = open("arm.pack");
  ASSERT_TRUE(opened.robot);
  EXPECT_EQ(opened.robot->endEffector()->link, *opened.robot->findLink("hand"));
}

/// Who waits for the meshes may begin with the recipe.
TEST_F(RobotCli, DraftsTheSameRecipeOfLinksAndJointsWhereMeshesAreMissing) {
  std::string robot = content("arm.urdf");
  const std::size_t end = robot.rfind("</robot>");
  ASSERT_NE(end, std::string::npos);
  robot.insert(end,
               "<link name=\"lid\"><visual><geometry><mesh filename=\"none.stl\"/></geometry>"
               "</visual></link><joint name=\"hinge\" type=\"fixed\"><parent link=\"hand\"/>"
               "<child link=\"lid\"/></joint>");
  write("lid.urdf", robot);
  const ProgramRun refused = bake({"lid.urdf", "--recipe", "arm.toml"});
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_THAT(refused.err, HasSubstr("put the file there, or give --allow-missing\n"));
  const ProgramRun printed = run({"lid.urdf", "--print-recipe"});
  EXPECT_EQ(printed.exit_code, 0) << printed.err;
  EXPECT_THAT(printed.out, HasSubstr("link = \"hand\""));
}

TEST_F(RobotCli, BakesARobotOfOtherSimulatorsWithWarnings) {
  std::string robot =
      "<robot name=\"cart\"><joint name=\"x\" type=\"prismatic\"><parent link=\"world\"/><child "
      "link=\"base\"/></joint><link name=\"base\"><collision><geometry><box size=\"0.2 0.2 "
      "0.2\"/></geometry></collision></link>";
  for (const char* arm : {"a", "b", "c", "d"}) {
    robot += fmt::format(
        "<link name=\"{0}\"/><joint name=\"j{0}\" type=\"revolute\"><parent link=\"base\"/><child "
        "link=\"{0}\"/></joint>",
        arm);
  }
  write("cart.urdf", robot + "</robot>");
  const ProgramRun baked = bake({"cart.urdf"});
  EXPECT_EQ(baked.exit_code, 0) << baked.err;
  EXPECT_THAT(
      baked.out,
      AllOf(HasSubstr("warning: joint 'x': it hangs from a link 'world'"),
            HasSubstr("warning: joint 'x': the robot's file states no limits for it; -1 to 1 m are "
                      "assumed"),
            HasSubstr(
                "warning: joint 'ja': the robot's file states no limits for it; -3.14 to 3.14 rad "
                "are assumed, [limits] of the recipe may state others (and 3 more of this "
                "kind; -v lists them)"),
            Not(HasSubstr("'jb'"))));
  EXPECT_THAT(bake({"cart.urdf", "-v"}).out, HasSubstr("'jd': the robot's file states no limits"));
}

TEST_F(RobotCli, TakesHandMadeSpheresAndWarnsOfOtherRadii) {
  write("arm.srdf",
        "<robot name=\"arm\"><link_sphere_approximation link=\"boom\"><sphere center=\"0.1 0 0\" "
        "radius=\"0.045\"/></link_sphere_approximation></robot>");
  const ProgramRun baked = bake({"arm.urdf", "--spheres", "arm.srdf"});
  EXPECT_EQ(baked.exit_code, 0) << baked.err;
  EXPECT_THAT(baked.out, AllOf(HasSubstr("by hand"),
                               HasSubstr("warning: link 'boom': radii of hand-made spheres change "
                                         "by up to 5.0 mm")));
  const Opened opened = open("arm.pack");
  ASSERT_TRUE(opened.robot);
  ASSERT_EQ(opened.robot->spheres().size(), 1U);
  EXPECT_EQ(opened.robot->spheres()[0].center, (Vec3{0.1F, 0, 0}));
}

TEST_F(RobotCli, FindsMeshesOfPackagesAndSaysWhere) {
  write("m.urdf", meshRobot("package://parts/brick.obj"));
  write("elsewhere/brick.obj", test::objFile(test::unevenBox()));
  const ProgramRun lost = bake({"m.urdf"});
  EXPECT_EQ(lost.exit_code, 3);
  EXPECT_THAT(lost.err,
              AllOf(StartsWith("galactic-bake: m.urdf: link 'a': "), HasSubstr("lost all its")));
  EXPECT_FALSE(has("m.pack"));
  const ProgramRun found = bake({"m.urdf", "--package", "parts=elsewhere", "-v"});
  EXPECT_EQ(found.exit_code, 0) << found.err;
  EXPECT_THAT(found.out, HasSubstr("elsewhere/brick.obj"));
  EXPECT_TRUE(has("m.pack"));
}

TEST_F(RobotCli, AllowsMissingMeshesOnlyWhenToldAndNeverARobotOfNothing) {
  std::string robot = meshRobot("package://parts/brick.obj");
  write("m.urdf", robot);
  const ProgramRun nothing = bake({"m.urdf", "--allow-missing"});
  EXPECT_EQ(nothing.exit_code, 3);
  EXPECT_THAT(nothing.err, HasSubstr("no link has geometry"));
  robot.insert(robot.find("</robot>"),
               "<link name=\"b\"><collision><geometry><box size=\"0.06 0.06 0.06\"/></geometry>"
               "</collision></link><joint name=\"j\" type=\"continuous\"><parent link=\"a\"/>"
               "<child link=\"b\"/></joint>");
  write("m.urdf", robot);
  EXPECT_EQ(bake({"m.urdf"}).exit_code, 3);
  const ProgramRun some = bake({"m.urdf", "--allow-missing"});
  EXPECT_EQ(some.exit_code, 0) << some.err;
  EXPECT_THAT(some.out, HasSubstr("warning: link 'a'"));
  const Opened opened = open("m.pack");
  ASSERT_TRUE(opened.robot);
  EXPECT_GT(opened.robot->spheres().size(), 0U);
}

TEST_F(RobotCli, ExplainsEveryRefusal) {
  write("typo.srdf",
        "<robot name=\"arm\"><link_sphere_approximation link=\"bom\"><sphere center=\"0 0 0\" "
        "radius=\"0.04\"/></link_sphere_approximation></robot>");
  write("typo.toml", std::string(kRecipe) + "[spheres]\neps_ = 1\n");
  write("nameless.urdf", "<robot name=\"\"><link name=\"a\"/></robot>");
  write("loop.urdf", "<robot name=\"l\"></robot>");
  const std::vector<Refusal> refusals{
      {{"arm.urdf", "--spacing", "0.04"},
       1,
       "--spacing: does not go with --as robot; leave it out"},
      {{"arm.urdf", "--scale", "0.001"}, 1, "--scale: does not go with --as robot; leave it out"},
      {{"arm.urdf", "--package", "parts"}, 1, "--package: is \"parts\", expected NAME=DIR"},
      {{"arm.urdf", "--package", "p=a", "--package", "p=b"}, 1, "--package: names p twice"},
      {{"arm.urdf", "--as", "scene", "--recipe", "arm.toml"},
       1,
       "--recipe: does not go with --as scene"},
      {{"arm.urdf", "arm.urdf", "--print-recipe"},
       1,
       "--print-recipe: drafts a recipe of one robot; give its file, or no input to see every key"},
      {{"--print-recipe", "arm.stl"}, 1, "--print-recipe: drafts a recipe of one robot"},
      {{"arm.urdf", "--print-recipe", "-o", "r.toml"},
       1,
       "--out: does not go with --print-recipe, which prints a recipe and bakes nothing; leave it "
       "out"},
      {{"missing.urdf", "--print-recipe"}, 2, "missing.urdf"},
      {{"missing.urdf"}, 2, "missing.urdf"},
      {{"arm.urdf", "--recipe", "missing.toml"}, 2, "missing.toml"},
      {{"arm.urdf", "--spheres", "missing.srdf"}, 2, "missing.srdf"},
      {{"arm.urdf", "--recipe", "typo.toml"}, 3, "typo.toml:"},
      {{"arm.urdf", "--spheres", "typo.srdf"},
       3,
       "arm.urdf: hand-made spheres are given for the link 'bom', which the robot 'arm' does not "
       "have; did you mean 'boom'?"},
      {{"arm.urdf", "--radii", "0.05,0.02"}, 1, "--radii: has 0.02 m after 0.05 m; list each"},
      {{"nameless.urdf"}, 3, "nameless.urdf: the robot has no name"},
      {{"loop.urdf"}, 3, "loop.urdf"},
      {{"arm.urdf", "--recipe", "arm.toml", "-o", "arm.toml"}, 3, "is also an input"},
      {{"arm.urdf", "-o", "arm.urdf"}, 3, "is also an input"},
  };
  for (const Refusal& refusal : refusals) {
    SCOPED_TRACE(testing::PrintToString(refusal.arguments));
    const ProgramRun once = run(refusal.arguments);
    EXPECT_EQ(once.exit_code, refusal.exit_code);
    EXPECT_THAT(once.err, HasSubstr(refusal.part));
    EXPECT_THAT(once.out, IsEmpty());
  }
  EXPECT_EQ(content("arm.toml"), kRecipe);
  EXPECT_EQ(content("arm.urdf"), kArm);
}

}  // namespace
}  // namespace galactic::robot_cli_test
