// Each thing that can be wrong with an MJCF has a message of its own.
#include <gmock/gmock.h>

#include <ostream>

#include "bake/robot_description/mjcf/mjcf_texts.h"

namespace galactic::test::mjcf::faults_test {
namespace {

struct Fault {
  const char* name;
  std::string text;
  const char* where;
  const char* message;
  ErrorCode code = ErrorCode::kInvalidInput;
};

std::ostream& operator<<(std::ostream& out, const Fault& fault) { return out << fault.name; }

/// A robot whose second body has this in it, on the second line of the file.
std::string withInside(std::string_view inside, std::string_view sections = "") {
  return mjcfText(
      fmt::format("<body name='a'><body name='b'><joint name='j'/>\n{}</body></body>", inside),
      sections);
}

std::vector<Fault> fileFaults() {
  return {
      {"Unclosed", "<mujoco>\n<worldbody>", "r.xml",
       "it is not well-formed XML: Error reading Element value; repair or generate it again"},
      {"APartOnly", "<mujocoinclude><body/></mujocoinclude>", "r.xml",
       "it is a part of an MJCF, <mujocoinclude>; give the file that includes it"},
      {"Sdf", "<?xml version='1.0'?><!-- a --><sdf version='1.7'/>", "r.xml",
       "its outermost element is <sdf>, expected <robot> (URDF) or <mujoco> (MJCF)"},
      {"NoBody", mjcfText("<geom type='plane' size='1 1 1'/>"), "r.xml",
       "its <worldbody> has no <body>, so there is no robot"},
      {"SeveralRobots",
       mjcfText("<body name='a'><freejoint/><body><joint/></body></body>"
                "<body name='b'><freejoint/><body><joint/></body></body>"),
       "r.xml",
       "its <worldbody> has 2 bodies that may be the robot, 'a', 'b'; give a file with one robot"},
      {"SeveralThings", mjcfText("<body name='a'/><body name='b'/>"), "r.xml",
       "its <worldbody> has 2 bodies that may be the robot, 'a', 'b'; give a file with one robot"},
      {"SameBodyTwice", mjcfText("<body name='a'><body name='a'/></body>"), "r.xml",
       "link 'a' is there twice; rename one"},
      {"GlobalCoordinates", mjcfText("<body/>", "<compiler coordinate='global'/>"), "r.xml:1",
       "<compiler> has coordinate=\"global\", which MuJoCo has given up, too; load the file in an "
       "older MuJoCo, save it, and give what it saved",
       ErrorCode::kUnsupported},
      {"Angle", mjcfText("<body/>", "<compiler angle='degrees'/>"), "r.xml:1",
       "<compiler> has angle=\"degrees\", expected one of radian, degree"},
      {"EulerSequence", mjcfText("<body/>", "<compiler eulerseq='xyw'/>"), "r.xml:1",
       "<compiler> has eulerseq=\"xyw\", expected three letters of x, y, z, X, Y, Z"},
      {"IncludeOfNothing", mjcfText("<body/>", "<include/>"), "r.xml:1",
       "<include> has no attribute 'file'; name the file"},
      {"IncludeOfMissing", mjcfText("<body/>", "<include file='gone.xml'/>"), "r.xml:1",
       "<include> names 'gone.xml', and there is no such file; put it beside the robot's file, or "
       "correct the name",
       ErrorCode::kIo},
      {"IncludeOfItself", mjcfText("<body/>", "<include file='r.xml'/>"), "r.xml:1",
       "<include> names 'r.xml', which is there already; a file is included once"},
      {"OtherModels", mjcfText("<body/>", "<asset><model file='m.xml'/></asset>"), "r.xml:1",
       "<model> brings in another model; save the whole one as one file, as MuJoCo does, and give "
       "that",
       ErrorCode::kUnsupported},
  };
}

std::vector<Fault> bodyFaults() {
  return {
      {"Replicate", withInside("<replicate count='3'><geom size='1'/></replicate>"), "r.xml:2",
       "<replicate> makes bodies that the file does not have; save the model from MuJoCo "
       "(mj_saveLastXML), which writes them out, and give that file",
       ErrorCode::kUnsupported},
      {"Composite", withInside("<composite type='cable'/>"), "r.xml:2",
       "<composite> makes bodies that the file does not have; save the model from MuJoCo "
       "(mj_saveLastXML), which writes them out, and give that file",
       ErrorCode::kUnsupported},
      {"PosOfTwo", withInside("<body pos='1 2'/>"), "r.xml:2",
       "<body> has pos=\"1 2\", expected three finite numbers"},
      {"PosOfWords", withInside("<body pos='1 2 up'/>"), "r.xml:2",
       "<body> has pos=\"1 2 up\", expected three finite numbers"},
      {"PosInfinite", withInside("<body pos='1 2 inf'/>"), "r.xml:2",
       "<body> has pos=\"1 2 inf\", expected three finite numbers"},
      {"PosWithCommas", withInside("<body pos='1,2,3'/>"), "r.xml:2",
       "<body> has pos=\"1,2,3\", expected three finite numbers"},
      {"QuatOfZeros", withInside("<body quat='0 0 0 0'/>"), "r.xml:2",
       "<body> has quat=\"0 0 0 0\", expected a direction, not zeros"},
      {"AxesThatAreOne", withInside("<body xyaxes='1 0 0 2 0 0'/>"), "r.xml:2",
       "<body> has xyaxes=\"1 0 0 2 0 0\", expected two directions that differ, each of three "
       "numbers"},
      {"TwoOrientations", withInside("<body quat='1 0 0 0' euler='0 0 0'/>"), "r.xml:2",
       "<body> has several orientations; keep one of quat, axisangle, euler, xyaxes, zaxis"},
      {"FarAway", withInside("<body pos='0 0 1000'/>"), "r.xml: joint 'body_3_fixed'",
       "its origin is 1000 m away, at most 800 m are possible; is the unit meters?"},
      {"JointOfTheWorld", mjcfText("<body name='a'/>\n<joint/>"), "r.xml:2",
       "<joint> is in no <body>; the world does not move: put it into one"},
      {"FreeJointWithin", withInside("<freejoint/>"), "r.xml:2",
       "body 'b' is in another and has a free joint, which only bodies of the world may have; "
       "remove it, or take the body out"},
      {"JointType", withInside("<joint type='revolute'/>"), "r.xml:2",
       "<joint> has type=\"revolute\", expected one of hinge, slide, ball, free"},
      {"AxisOfZeros", withInside("<joint name='k' axis='0 0 0'/>"), "r.xml: joint 'k'",
       "its axis (0 0 0) has no direction; give a unit vector"},
      {"RangeUpsideDown",
       withInside("<joint name='k' range='2 1' limited='true'/>", "<compiler angle='radian'/>"),
       "r.xml: joint 'k'", "its lower limit 2 is above its upper limit 1; swap or correct them"},
      {"Limited", withInside("<joint limited='yes'/>"), "r.xml:2",
       "<joint> has limited=\"yes\", expected one of false, true, auto"},
      {"EqualityOfUnknown",
       withInside("<body><joint name='arm'/></body>",
                  "<equality><joint joint1='j' joint2='arn'/></equality>"),
       "r.xml:1", "<joint> has joint2=\"arn\", expected the name of a joint; did you mean 'arm'?"},
      {"KeyOfOtherLength", withInside("", "<keyframe><key name='home' qpos='1 2'/></keyframe>"),
       "r.xml:1", "<key> has qpos=\"1 2\", expected a finite number"},
  };
}

std::vector<Fault> geomFaults() {
  return {
      {"ClassUnknown",
       withInside("<geom class='visul' size='1'/>", "<default><default class='visual'/></default>"),
       "r.xml:2", "<geom> is of class 'visul', which no <default> has; did you mean 'visual'?"},
      {"ClassWithoutName", withInside("", "<default><default/></default>"), "r.xml:1",
       "<default> in another has no attribute 'class'; name it"},
      {"GeomType", withInside("<geom type='cube'/>"), "r.xml:2",
       "<geom> has type=\"cube\", expected one of sphere, capsule, ellipsoid, cylinder, box, mesh, "
       "plane, hfield, sdf"},
      {"NoSize", withInside("<geom/>"), "r.xml:2",
       "<geom> has size=\"\", expected 1 positive number for a sphere"},
      {"TooFewSizes", withInside("<geom type='box' size='1 1'/>"), "r.xml:2",
       "<geom> has size=\"1 1\", expected 3 positive numbers for a box"},
      {"SizeOfZero", withInside("<geom type='capsule' size='1 0'/>"), "r.xml:2",
       "<geom> has size=\"1 0\", expected 2 positive numbers for a capsule"},
      {"EndsThatAreOne", withInside("<geom type='capsule' size='1' fromto='1 2 3 1 2 3'/>"),
       "r.xml:2", "<geom> has fromto=\"1 2 3 1 2 3\", expected two points that differ"},
      {"MeshUnnamed", withInside("<geom type='mesh'/>"), "r.xml:2",
       "<geom> is a mesh and names none; give it a 'mesh'"},
      {"MeshUnknown",
       withInside("<geom type='mesh' mesh='hnad'/>", "<asset><mesh file='hand.stl'/></asset>"),
       "r.xml:2", "<geom> names the mesh 'hnad', which no <asset> has; did you mean 'hand'?"},
      {"MeshTwice", withInside("", "<asset><mesh file='a/m.stl'/>\n<mesh file='b/m.obj'/></asset>"),
       "r.xml:2", "<mesh> 'm' is there twice; rename one"},
      {"MeshOfNothing", withInside("", "<asset><mesh name='m' builtin='cone'/></asset>"), "r.xml:1",
       "<mesh> 'm' has neither 'file' nor 'vertex'; meshes that MuJoCo makes are not read: save "
       "the "
       "mesh as a file",
       ErrorCode::kUnsupported},
      {"MeshOfNoFile",
       withInside("<geom type='mesh' mesh='a'/>",
                  "<asset><mesh name='a' file=''/>"
                  "<mesh name='m' vertex='0 0 0 1 0 0 0 1 0 0 0 1'/></asset>"),
       "r.xml:1", "<mesh> has file=\"\", expected the name of a file"},
      {"MeshFarAway",
       withInside("", "<asset>\n<mesh name='m' vertex='0 0 0 1e300 0 0 0 1 0 0 0 1'/></asset>"),
       "r.xml:2",
       "<mesh> 'm' has a point at 1e+300 along an axis, at most 800 m are possible; is the unit "
       "meters?"},
      {"MeshScaledFarAway",
       withInside("",
                  "<asset><mesh name='m' vertex='0 0 0 1 0 0 0 -1 0 0 0 1' scale='1 900 1'/>"
                  "</asset>"),
       "r.xml:1",
       "<mesh> 'm' has a point at -900 along an axis, at most 800 m are possible; is the unit "
       "meters?"},
      {"MeshCorners",
       withInside("",
                  "<asset><mesh name='m' vertex='0 0 0 1 0 0 0 1 0 0 0 1' face='0 1 4'/>"
                  "</asset>"),
       "r.xml:1", "<mesh> has face=\"0 1 4\", expected numbers of points, from 0 to 3"},
      {"MeshMissing",
       withInside("<geom type='mesh' mesh='m'/>", "<asset><mesh file='m.stl'/></asset>"),
       "r.xml: link 'b'",
       "it lost all its collision geometry: link 'b' collision 1: mesh 'm.stl' is missing; looked "
       "for m.stl (from the robot's folder); name the package's folder (`package` NAME=DIR), put "
       "the file there, or give `allow-missing`"},
      {"MaterialUnknown",
       withInside("<geom size='1' material='rde'/>", "<asset><material name='red'/></asset>"),
       "r.xml:2", "<geom> names the material 'rde', which no <asset> has; did you mean 'red'?"},
      {"Color", withInside("<geom size='1' rgba='1 0 0'/>"), "r.xml:2",
       "<geom> has rgba=\"1 0 0\", expected four finite numbers"},
      {"MassNegative", withInside("<geom size='1' mass='-1'/>"), "r.xml:2",
       "<geom> has mass=\"-1\", expected kilograms, not below 0"},
  };
}

class MjcfFaults : public testing::TestWithParam<Fault> {};

TEST_P(MjcfFaults, HaveTheirPlaceAndMessage) {
  const ScratchFolder folder;
  const auto robot = importMjcf(folder, GetParam().text);
  ASSERT_FALSE(robot.has_value());
  EXPECT_EQ(placeIn(folder, robot.error()), GetParam().where);
  EXPECT_EQ(robot.error().message, GetParam().message);
  EXPECT_EQ(robot.error().code, GetParam().code);
}

std::string nameOf(const testing::TestParamInfo<Fault>& info) { return info.param.name; }

INSTANTIATE_TEST_SUITE_P(OfTheFile, MjcfFaults, testing::ValuesIn(fileFaults()), nameOf);
INSTANTIATE_TEST_SUITE_P(OfBodies, MjcfFaults, testing::ValuesIn(bodyFaults()), nameOf);
INSTANTIATE_TEST_SUITE_P(OfShapes, MjcfFaults, testing::ValuesIn(geomFaults()), nameOf);

TEST(MjcfFaults, OfUnknownElementsInBodiesAreWarnings) {
  const ScratchFolder folder;
  const auto robot = mjcfRobot(
      folder, withInside("<goem size='1'/><site name='s'/><camera/><light/><geom size='.1'/>"));
  EXPECT_THAT(robot.warnings, testing::ElementsAre("an element <goem> in a body is not known, and "
                                                   "left out"));
}

TEST(MjcfFaults, OfFilesThatLeadOutNeedPermission) {
  const ScratchFolder folder;
  (void)folder.write("elsewhere/part.xml", "<mujoco><body name='a'/></mujoco>");
  const std::string text =
      "<mujoco><worldbody><include file='../../elsewhere/part.xml'/></worldbody></mujoco>";
  const auto path = folder.write("home/robots/r.xml", text);
  const auto refused = bake::importRobot(path);
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(
      refused.error().message,
      "<include> names '../../elsewhere/part.xml', which lies outside of the folder above the "
      "robot's file; move it, or give `allow-outside`");
  bake::RobotImportOptions options;
  options.allow_outside = true;
  EXPECT_TRUE(bake::importRobot(path, options).has_value());
}

TEST(MjcfFaults, OfIncludedFilesNameTheirFileAndLine) {
  const ScratchFolder folder;
  (void)folder.write("robots/part.xml", "<mujoco>\n\n<geom type='cube'/></mujoco>");
  const auto robot = importMjcf(folder, mjcfText("<body><include file='part.xml'/></body>"));
  ASSERT_FALSE(robot.has_value());
  EXPECT_EQ(placeIn(folder, robot.error()), "part.xml:3");
}

TEST(MjcfFaults, OfDeepInclusionsAreRefused) {
  const ScratchFolder folder;
  const auto nested = [](std::string_view inside) {
    std::string text = "<mujoco>";
    for (int n = 0; n < 60; ++n) text += "<body>";
    text += inside;
    for (int n = 0; n < 60; ++n) text += "</body>";
    return text + "</mujoco>";
  };
  (void)folder.write("robots/part.xml", nested(""));
  const auto robot = importMjcf(folder, mjcfText(nested("<include file='part.xml'/>")));
  ASSERT_FALSE(robot.has_value());
  EXPECT_EQ(robot.error().message,
            "with what is included, elements are nested more than 100 deep; "
            "is it an MJCF?");
}

/// What every element that is read has in it.
constexpr const char* kWhole =
    "<mujoco model='m'><compiler angle='radian' meshdir='parts'/>"
    "<default><geom size='.1 .1 .1'/><default class='c'><joint range='-1 1'/></default></default>"
    "<asset><mesh name='t' vertex='0 0 0 1 0 0 0 1 0 0 0 1'/><material name='r' rgba='1 0 0 1'/>"
    "</asset><worldbody><body name='a' pos='0 0 1'><freejoint/><geom type='box' material='r'/>"
    "<body name='b' childclass='c' euler='0 0 1'><joint name='j' pos='0 0 .1' ref='.1'/>"
    "<inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/><geom type='mesh' mesh='t'/>"
    "<frame pos='1 0 0'><body name='d'><joint name='k' type='slide' axis='1 0 0'/>"
    "<geom type='capsule' fromto='0 0 0 1 0 0'/></body></frame></body></body></worldbody>"
    "<equality><joint joint1='j' joint2='k' polycoef='0 1'/></equality>"
    "<contact><exclude body1='a' body2='d'/></contact>"
    "<keyframe><key name='home' qpos='0 0 1 1 0 0 0 0 0'/></keyframe></mujoco>";

TEST(MjcfFaults, OfEveryTruncationAreErrorsWithAPlace) {
  const ScratchFolder folder;
  const std::string whole = kWhole;
  ASSERT_TRUE(importMjcf(folder, whole).has_value());
  // Each costs a process.
  for (std::size_t size = 0; size < whole.size(); size += 7) {
    const auto robot = importMjcf(folder, whole.substr(0, size));
    ASSERT_FALSE(robot.has_value()) << size;
    EXPECT_THAT(robot.error().where, testing::HasSubstr("r.xml")) << size;
    EXPECT_FALSE(robot.error().message.empty());
  }
}

}  // namespace
}  // namespace galactic::test::mjcf::faults_test
