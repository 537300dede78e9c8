// Each thing that can be wrong with a URDF has a message of its own.
#include <gmock/gmock.h>

#include <ostream>

#include "bake/robot_description/robot_texts.h"

namespace galactic::test::faults_test {
namespace {

struct Fault {
  const char* name;
  std::string text;
  const char* where;
  const char* message;
  ErrorCode code = ErrorCode::kInvalidInput;
};

std::ostream& operator<<(std::ostream& out, const Fault& fault) { return out << fault.name; }

const std::string kTwoLinks = "<link name=\"a\"/><link name=\"b\"/>";

std::string limitText(const char* lower, const char* upper) {
  return fmt::format("<limit lower=\"{}\" upper=\"{}\" effort=\"1\" velocity=\"1\"/>", lower,
                     upper);
}

std::string withJoint(std::string_view type, std::string_view inside) {
  return robotText(kTwoLinks + jointText("j", type, "a,b", inside));
}

std::vector<Fault> syntaxFaults() {
  return {
      {"Empty", "", "r.urdf", "the file is empty; generate it again"},
      {"Blank", " \n ", "r.urdf", "the file is empty; generate it again"},
      {"NoXml", "robot", "r.urdf",
       "it is not well-formed XML: Error document empty; repair or generate it again"},
      {"UnclosedElement", "<robot name=\"r\">\n<link name=\"a\"/>", "r.urdf",
       "it is not well-formed XML: Error reading Element value; repair or generate it again"},
      {"OtherRoot", "<sdf version=\"1.7\"/>", "r.urdf",
       "its outermost element is <sdf>, expected <robot> (URDF) or <mujoco> (MJCF)"},
      {"ZeroBytes", std::string("<robot\0", 7), "r.urdf",
       "it has NUL bytes, so it is no XML text; is it a URDF or an MJCF?"},
      {"NoRobotName", "<robot><link name=\"a\"/></robot>", "r.urdf",
       "the URDF parser refuses it: No name given for the robot"},
      {"Xacro", "<robot name=\"r\">\n<xacro:macro name=\"m\"/><link name=\"a\"/></robot>",
       "r.urdf:2",
       "it is a xacro file, with <xacro:macro>; expand it with the xacro tool and give the result",
       ErrorCode::kUnsupported},
      {"XacroInALink",
       robotText("\n<link name=\"a\"/>\n<link name=\"b\">\n<visual>\n<xacro:box size=\"1\"/>"
                 "</visual></link>\n<xacro:arm/>"),
       "r.urdf:5",
       "it is a xacro file, with <xacro:box>; expand it with the xacro tool and give the result",
       ErrorCode::kUnsupported},
      {"LinkWithoutName", robotText("<link/>"), "r.urdf",
       "the URDF parser refuses it: No name given for the link"},
      {"JointWithoutName",
       robotText(kTwoLinks +
                 "<joint type=\"fixed\"><parent link=\"a\"/><child link=\"b\"/></joint>"),
       "r.urdf", "the URDF parser refuses it: unnamed joint found"},
  };
}

std::vector<Fault> treeFaults() {
  return {
      {"NoLinks", robotText(""), "r.urdf",
       "the URDF parser refuses it: No link elements found in urdf file"},
      {"DuplicateLink", robotText("<link name=\"a\"/><link name=\"a\"/>"), "r.urdf",
       "the URDF parser refuses it: link 'a' is not unique"},
      {"DuplicateJoint",
       robotText(kTwoLinks + "<link name=\"c\"/>" + jointText("j", "fixed", "a,b") +
                 jointText("j", "fixed", "a,c")),
       "r.urdf", "the URDF parser refuses it: joint 'j' is not unique"},
      {"TwoRoots", robotText(kTwoLinks), "r.urdf",
       "the URDF parser refuses it: Failed to find root link: Two root links found: [a] and [b]"},
      {"NoRoot",
       robotText(kTwoLinks + jointText("j", "fixed", "a,b") + jointText("k", "fixed", "b,a")),
       "r.urdf",
       "the URDF parser refuses it: Failed to find root link: No root link found. The robot xml is "
       "not a valid tree"},
      {"LoopApartFromTheRoot",
       robotText(kTwoLinks + "<link name=\"root\"/>" + jointText("j", "fixed", "a,b") +
                 jointText("k", "fixed", "b,a")),
       "r.urdf",
       "links 'a', 'b' hang in a loop of joints, apart from the root 'root'; a robot is one tree"},
      {"TwoParents",
       robotText(kTwoLinks + "<link name=\"c\"/>" + jointText("j", "fixed", "a,b") +
                 jointText("k", "fixed", "a,c") + jointText("l", "fixed", "b,c")),
       "r.urdf: link 'c'",
       "two joints have it as their child, 'k' and 'l'; a robot is a tree: remove one"},
      {"LinkJoinedToItself",
       robotText("<link name=\"root\"/><link name=\"a\"/>" + jointText("j", "fixed", "a,a")),
       "r.urdf: joint 'j'", "it joins link 'a' to itself; a joint needs two links"},
      {"UnknownParent", robotText(kTwoLinks + jointText("j", "fixed", "x,b")), "r.urdf",
       "the URDF parser refuses it: Failed to build tree: parent link [x] of joint [j] not found.  "
       "This is not valid according to the URDF spec. Every link you refer to from a joint needs "
       "to be explicitly defined in the robot description. To fix this problem you can either "
       "remove this joint [j] from your urdf file, or add \"<link name=\"x\" />\" to your urdf "
       "file"},
      {"WorldAsAChild", robotText(kTwoLinks + jointText("j", "fixed", "a,world")), "r.urdf",
       "the URDF parser refuses it: Failed to build tree: child link [world] of joint [j] not "
       "found"},
      {"UnknownChild", robotText(kTwoLinks + jointText("j", "fixed", "a,x")), "r.urdf",
       "the URDF parser refuses it: Failed to build tree: child link [x] of joint [j] not found"},
      {"NoParent",
       robotText(kTwoLinks + "<joint name=\"j\" type=\"fixed\"><child link=\"b\"/></joint>"),
       "r.urdf",
       "the URDF parser refuses it: Failed to build tree: Joint [j] is missing a parent and/or "
       "child link specification"},
  };
}

std::vector<Fault> jointFaults() {
  return {
      {"UnknownType", withJoint("hinge", ""), "r.urdf",
       "the URDF parser refuses it: Joint [j] has no known type [hinge]"},
      {"NoType",
       robotText(kTwoLinks + "<joint name=\"j\"><parent link=\"a\"/><child link=\"b\"/></joint>"),
       "r.urdf",
       "the URDF parser refuses it: joint [j] has no type, check to see if it's a reference"},
      {"LowerAboveUpper", withJoint("revolute", limitText("1", "-1")), "r.urdf: joint 'j'",
       "its lower limit 1 is above its upper limit -1; swap or correct them"},
      {"LimitNotANumber", withJoint("revolute", limitText("nan", "1")), "r.urdf",
       "the URDF parser refuses it: lower value (nan) is not a valid float; Could not parse limit "
       "element for joint [j]"},
      {"LimitInfinite", withJoint("revolute", limitText("0", "inf")), "r.urdf",
       "the URDF parser refuses it: upper value (inf) is not a valid float; Could not parse limit "
       "element for joint [j]"},
      {"LimitOutOfRange", withJoint("revolute", limitText("0", "1e999")), "r.urdf",
       "the URDF parser refuses it: upper value (1e999) is not a valid float; Could not parse "
       "limit element for joint [j]"},
      {"AxisZero", withJoint("continuous", "<axis xyz=\"0 0 0\"/>"), "r.urdf: joint 'j'",
       "its axis (0 0 0) has no direction; give a unit vector"},
      {"AxisOfTwoNumbers", withJoint("continuous", "<axis xyz=\"0 1\"/>"), "r.urdf",
       "the URDF parser refuses it: Malformed axis element for joint [j]: Parser found 2 elements "
       "but 3 expected while parsing vector [0 1]"},
      {"AxisNotANumber", withJoint("continuous", "<axis xyz=\"0 nan 1\"/>"), "r.urdf",
       "the URDF parser refuses it: Malformed axis element for joint [j]: Unable to parse "
       "component [nan] to a double (while parsing a vector value)"},
      {"OriginNotANumber", withJoint("fixed", "<origin xyz=\"0 0 far\"/>"), "r.urdf",
       "the URDF parser refuses it: Unable to parse component [far] to a double (while parsing a "
       "vector value); Malformed parent origin element for joint [j]"},
      {"OriginFarAway", withJoint("fixed", "<origin xyz=\"0 0 1000\"/>"), "r.urdf: joint 'j'",
       "its origin is 1000 m away, at most 800 m are possible; is the unit meters?"},
      {"MimicOfUnknown", withJoint("continuous", "<mimic joint=\"k\"/>"), "r.urdf: joint 'j'",
       "it mimics joint 'k', which does not exist; correct the name"},
      {"MimicOfItself", withJoint("continuous", "<mimic joint=\"j\"/>"), "r.urdf: joint 'j'",
       "it mimics itself in a circle of joints; one of them must move freely"},
      {"MimicInACircle",
       robotText(kTwoLinks + "<link name=\"c\"/>" +
                 jointText("j", "continuous", "a,b", "<mimic joint=\"k\"/>") +
                 jointText("k", "continuous", "b,c", "<mimic joint=\"j\"/>")),
       "r.urdf: joint 'j'", "it mimics itself in a circle of joints; one of them must move freely"},
      {"MimicOfFixed",
       robotText(kTwoLinks + "<link name=\"c\"/>" +
                 jointText("j", "continuous", "a,b", "<mimic joint=\"k\"/>") +
                 jointText("k", "fixed", "b,c")),
       "r.urdf: joint 'j'",
       "it mimics 'k', and 'k' is a joint without a single position (fixed, planar or floating); "
       "remove the <mimic>"},
      {"MimicOverflow",
       robotText(kTwoLinks + "<link name=\"c\"/><link name=\"d\"/>" +
                 jointText("j", "continuous", "a,b", "<mimic joint=\"k\" multiplier=\"1e200\"/>") +
                 jointText("k", "continuous", "b,c", "<mimic joint=\"l\" multiplier=\"1e200\"/>") +
                 jointText("l", "continuous", "c,d")),
       "r.urdf: joint 'j'",
       "the multiplier inf or offset 0 of its <mimic> is not finite or over 1000; correct it"},
      {"MimicMultiplierNotANumber",
       withJoint("continuous", "<mimic joint=\"j\" multiplier=\"twice\"/>"), "r.urdf",
       "the URDF parser refuses it: multiplier value (twice) is not a valid float; Could not parse "
       "mimic element for joint  [j]"},
  };
}

std::vector<Fault> geometryFaults() {
  return {
      {"NoGeometry", robotText("<link name=\"a\"><collision/></link>"), "r.urdf",
       "the URDF parser refuses it: Could not parse collision element for Link [a]"},
      {"UnknownShape", robotText(linkText("a", "<cone radius=\"1\" length=\"1\"/>")), "r.urdf",
       "the URDF parser refuses it: Unknown geometry type 'cone'; Could not parse collision "
       "element for Link [a]"},
      {"BoxWithoutSize", robotText(linkText("a", "<box/>")), "r.urdf",
       "the URDF parser refuses it: Box shape has no size attribute; Could not parse collision "
       "element for Link [a]"},
      {"BoxOfTwoNumbers", robotText(linkText("a", "<box size=\"1 2\"/>")), "r.urdf",
       "the URDF parser refuses it: Parser found 2 elements but 3 expected while parsing vector [1 "
       "2]; Could not parse collision element for Link [a]"},
      {"NegativeBox", robotText(linkText("a", "<box size=\"1 -2 3\"/>")),
       "r.urdf: link 'a' collision 1", "a box of size 1 -2 3: negative; correct it"},
      {"NegativeSphere", robotText(linkText("a", "<sphere radius=\"-1\"/>")),
       "r.urdf: link 'a' collision 1", "a sphere of radius -1: negative; correct it"},
      {"HugeCylinder", robotText(linkText("a", "<cylinder radius=\"1\" length=\"5000\"/>")),
       "r.urdf: link 'a' collision 1",
       "a cylinder of radius and length 1 5000: at most 800 m are possible; is the unit meters?"},
      {"SphereNotANumber", robotText(linkText("a", "<sphere radius=\"nan\"/>")), "r.urdf",
       "the URDF parser refuses it: radius [nan] is not a valid float; Could not parse collision "
       "element for Link [a]"},
      {"FarAwayShape",
       robotText("<link name=\"a\"><collision><origin xyz=\"0 900 0\"/><geometry><sphere "
                 "radius=\"1\"/></geometry></collision></link>"),
       "r.urdf: link 'a' collision 1",
       "its origin is 900 m away, at most 800 m are possible; is the unit meters?"},
      {"MeshWithoutName", robotText(linkText("a", "<mesh/>")), "r.urdf",
       "the URDF parser refuses it: Mesh must contain a filename attribute; Could not parse "
       "collision element for Link [a]"},
      {"MeshWithEmptyName", robotText(linkText("a", "<mesh filename=\"\"/>")), "r.urdf: link 'a'",
       "it lost all its collision geometry: link 'a' collision 1: mesh '' is missing; looked for a "
       "file name, which is empty; name the package's folder (`package` NAME=DIR), put the file "
       "there, or give `allow-missing`"},
      {"MeshFlattened", robotText(linkText("a", "<mesh filename=\"m.stl\" scale=\"1 0 1\"/>")),
       "r.urdf: link 'a' collision 1", "a mesh with scale 1 0 1: a scale of 0 flattens it"},
      {"MeshMissing", robotText(linkText("a", "<mesh filename=\"m.stl\"/>")), "r.urdf: link 'a'",
       "it lost all its collision geometry: link 'a' collision 1: mesh 'm.stl' is missing; looked "
       "for m.stl (from the robot's folder); name the package's folder (`package` NAME=DIR), put "
       "the file there, or give `allow-missing`"},
      {"MeshOfUnknownPackage",
       robotText(linkText("a", "<mesh filename=\"package://no_such_package/m.stl\"/>")),
       "r.urdf: link 'a'",
       "it lost all its collision geometry: link 'a' collision 1: mesh "
       "'package://no_such_package/m.stl' is missing; looked for a folder 'no_such_package' or a "
       "package.xml of that name in the search path and above the robot's file; name the package's "
       "folder "
       "(`package` NAME=DIR), put the file there, or give `allow-missing`"},
  };
}

class UrdfFaults : public testing::TestWithParam<Fault> {};

TEST_P(UrdfFaults, HaveAMessageOfTheirOwn) {
  const ScratchFolder folder;
  testing::internal::CaptureStderr();
  const auto robot = importText(folder, GetParam().text);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  ASSERT_FALSE(robot.has_value());
  EXPECT_EQ(placeIn(folder, robot.error()), GetParam().where);
  EXPECT_EQ(robot.error().message, GetParam().message);
  EXPECT_EQ(robot.error().code, GetParam().code);
}

std::string nameOf(const testing::TestParamInfo<Fault>& fault) { return fault.param.name; }

INSTANTIATE_TEST_SUITE_P(OfSyntax, UrdfFaults, testing::ValuesIn(syntaxFaults()), nameOf);
INSTANTIATE_TEST_SUITE_P(OfTheTree, UrdfFaults, testing::ValuesIn(treeFaults()), nameOf);
INSTANTIATE_TEST_SUITE_P(OfJoints, UrdfFaults, testing::ValuesIn(jointFaults()), nameOf);
INSTANTIATE_TEST_SUITE_P(OfGeometry, UrdfFaults, testing::ValuesIn(geometryFaults()), nameOf);

TEST(UrdfElements, ThatNobodyReadsMayBeIncomplete) {
  const ScratchFolder folder;
  for (const char* unread :
       {"<dynamics/>", "<dynamics stiffness=\"1\"/>", "<dynamics damping=\"much\"/>",
        "<safety_controller soft_lower_limit=\"0\" soft_upper_limit=\"1\"/>",
        "<calibration rising=\"up\"/>", "<limit effort=\"much\" velocity=\"\"/>",
        "<dynamics damping=\"1\"/><dynamics/>"}) {
    SCOPED_TRACE(unread);
    const auto robot = importText(folder, withJoint("revolute", unread));
    ASSERT_TRUE(robot.has_value()) << robot.error().message;
    EXPECT_THAT(robot->warnings, testing::IsEmpty());
  }
}

TEST(UrdfInertials, MatterToThoseWhoReadThem) {
  const ScratchFolder folder;
  struct Case {
    const char* inertial;
    const char* message;
  };
  for (const auto& [inertial, message] :
       {Case{"<mass value=\"1\"/>",
             "the URDF parser refuses it: Inertial element must have inertia element; Could not "
             "parse inertial element for Link [a]"},
        Case{"<mass value=\"heavy\"/>",
             "the URDF parser refuses it: Inertial: mass [heavy] is not a float; Could not parse "
             "inertial element for Link [a]"},
        Case{"<mass value=\"1\"/><inertia ixx=\"1\" iyy=\"1\" izz=\"1\"/>",
             "the URDF parser refuses it: Inertial: inertia element missing ixy attribute; Could "
             "not parse inertial element for Link [a]"}}) {
    SCOPED_TRACE(inertial);
    const std::string text =
        robotText(fmt::format("<link name=\"a\"><inertial>{}</inertial></link>", inertial));
    const auto robot = importText(folder, text);
    ASSERT_TRUE(robot.has_value()) << robot.error().message;
    const auto inertials = bake::readInertials(folder.path() / "robots/r.urdf");
    ASSERT_FALSE(inertials.has_value());
    EXPECT_EQ(inertials.error().message, message);
  }
  (void)importText(folder, robotText("<link name=\"a\"><inertial><mass value=\" 2\t\"/><inertia "
                                     "ixx=\" 1 \" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" "
                                     "izz=\"1\"/></inertial></link>"));
  const auto inertials = bake::readInertials(folder.path() / "robots/r.urdf");
  ASSERT_TRUE(inertials.has_value()) << inertials.error().message;
  ASSERT_EQ(inertials->size(), 1U);
  EXPECT_EQ(inertials->front().mass, 2);
}

TEST(UrdfFiles, ThatAreMissingAreAnIoError) {
  const ScratchFolder folder;
  const auto robot = bake::importRobot(folder.path() / "absent.urdf");
  ASSERT_FALSE(robot.has_value());
  EXPECT_EQ(robot.error().code, ErrorCode::kIo);
  EXPECT_THAT(robot.error().where, testing::EndsWith("absent.urdf"));
}

TEST(UrdfFiles, ThatAreFoldersAreAnIoError) {
  const ScratchFolder folder;
  const auto robot = bake::importRobot(folder.path());
  ASSERT_FALSE(robot.has_value());
  EXPECT_EQ(robot.error().code, ErrorCode::kIo);
  EXPECT_EQ(robot.error().message,
            "it is a folder; give the path of a robot's file (URDF or MJCF)");
}

TEST(UrdfFiles, BeyondTheLimitAreRefusedUnread) {
  const ScratchFolder folder;
  const auto path = folder.write("big.urdf", robotText("<link name=\"a\"/>"));
  std::filesystem::resize_file(path, bake::kMaxRobotFileBytes + 1);
  const auto robot = bake::importRobot(path);
  ASSERT_FALSE(robot.has_value());
  EXPECT_EQ(robot.error().code, ErrorCode::kInvalidInput);
  EXPECT_EQ(robot.error().message,
            "it has 67108865 bytes, at most 67108864 are read; is it a URDF or an MJCF?");
}

TEST(UrdfFiles, ThatNestDeeperThanAnyStackAreRefusedUnread) {
  const ScratchFolder folder;
  std::string text = "<robot name=\"r\"><link name=\"a\"/>";
  for (int i = 0; i < 1'000'000; ++i) text += "<x>";
  const auto robot = importText(folder, text);
  ASSERT_FALSE(robot.has_value());
  EXPECT_EQ(robot.error().code, ErrorCode::kInvalidInput);
  EXPECT_EQ(robot.error().message,
            "its elements are nested more than 100 deep; is it a URDF or an MJCF?");
}

TEST(UrdfFiles, WithEntityBombsAreRefused) {
  const ScratchFolder folder;
  std::string text = "<?xml version=\"1.0\"?><!DOCTYPE robot [<!ENTITY a \"aaaaaaaaaa\">";
  for (char c = 'b'; c <= 'z'; ++c) {
    const std::string inner = fmt::format("&{};", static_cast<char>(c - 1));
    text += fmt::format("<!ENTITY {} \"{}{}{}{}{}{}{}{}{}{}\">", c, inner, inner, inner, inner,
                        inner, inner, inner, inner, inner, inner);
  }
  text += "]><robot name=\"r\"><link name=\"&z;\"/></robot>";
  const auto robot = importText(folder, text);
  ASSERT_FALSE(robot.has_value());
  EXPECT_EQ(robot.error().message,
            "its outermost element is missing, expected <robot> (URDF) or <mujoco> (MJCF)");
}

TEST(UrdfOptions, RefuseUpAxesThatAreNeitherYNorZ) {
  const ScratchFolder folder;
  bake::RobotImportOptions options;
  options.up = bake::UpAxis::kX;
  const auto robot = importText(folder, robotText("<link name=\"a\"/>"), options);
  ASSERT_FALSE(robot.has_value());
  EXPECT_EQ(robot.error().code, ErrorCode::kUnsupported);
}

}  // namespace
}  // namespace galactic::test::faults_test
