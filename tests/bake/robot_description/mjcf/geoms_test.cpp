// Shapes of an MJCF: sizes, which are seen and which collide, looks, meshes and defaults.
#include <gmock/gmock.h>

#include <array>
#include <numbers>
#include <variant>

#include "bake/robot_description/link_points.h"
#include "bake/robot_description/mjcf/mjcf_texts.h"
#include "support/mesh_files.h"

namespace galactic::test::mjcf::geoms_test {
namespace {

using bake::BoxShape;
using bake::CylinderShape;
using bake::SphereShape;
using testing::Contains;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pointwise;
using testing::SizeIs;

constexpr double kRounding = 1e-12;

/// A body with a joint below the root, and these shapes in it.
std::string withGeoms(std::string_view geoms, std::string_view sections = "") {
  return mjcfText(
      fmt::format("<body name='a'><body name='b'><joint name='j'/>{}</body></body>", geoms),
      sections);
}

bake::SourceLink linkWith(const ScratchFolder& folder, std::string_view geoms,
                          std::string_view sections = "") {
  const auto robot = mjcfRobot(folder, withGeoms(geoms, sections));
  return robot.links.empty() ? bake::SourceLink{} : robot.links.back();
}

TEST(MjcfGeoms, HaveHalfSizesThatAreWholeOnesHere) {
  const ScratchFolder folder;
  const auto link = linkWith(folder,
                             "<geom type='box' size='.1 .2 .3' pos='+1 2 3'/>"
                             "<geom type='cylinder' size='.1 .2'/><geom size='.1'/>");
  ASSERT_EQ(link.collisions.size(), 3U);
  EXPECT_THAT(std::get<BoxShape>(link.collisions[0].geometry).size, ElementsAre(0.2, 0.6, 0.4));
  EXPECT_EQ(link.collisions[0].link_from_shape,
            (bake::Affine{1, 0, 0, 1, 0, 1, 0, 3, 0, 0, 1, -2}));
  EXPECT_EQ(std::get<CylinderShape>(link.collisions[1].geometry).radius, 0.1);
  EXPECT_EQ(std::get<CylinderShape>(link.collisions[1].geometry).length, 0.4);
  EXPECT_EQ(std::get<SphereShape>(link.collisions[2].geometry).radius, 0.1);
}

TEST(MjcfGeoms, ThatAreCapsulesAreACylinderBetweenTwoSpheres) {
  const ScratchFolder folder;
  const auto link =
      linkWith(folder, "<geom type='capsule' size='.05 .2' pos='1 0 0' zaxis='1 0 0'/>");
  ASSERT_EQ(link.collisions.size(), 3U);
  EXPECT_EQ(std::get<CylinderShape>(link.collisions[0].geometry).length, 0.4);
  EXPECT_THAT(pointIn(link.collisions[0].link_from_shape, {0, 0.2, 0}),
              Pointwise(DoubleNear(kRounding), Point3{1.2, 0, 0}));
  EXPECT_THAT(pointIn(link.collisions[1].link_from_shape, {0, 0, 0}),
              Pointwise(DoubleNear(kRounding), Point3{0.8, 0, 0}));
  EXPECT_THAT(pointIn(link.collisions[2].link_from_shape, {0, 0, 0}),
              Pointwise(DoubleNear(kRounding), Point3{1.2, 0, 0}));
}

TEST(MjcfGeoms, ThatAreEllipsoidsAreExact) {
  const ScratchFolder folder;
  const auto link = linkWith(folder, "<geom type='ellipsoid' size='.1 .2 .4' pos='1 0 0'/>");
  const bake::LinkShape& shape = link.collisions.at(0);
  const double radius = std::get<SphereShape>(shape.geometry).radius;
  // X stays, Y becomes -Z, Z becomes Y.
  EXPECT_THAT(pointIn(shape.link_from_shape, {radius, 0, 0}),
              Pointwise(DoubleNear(kRounding), Point3{1.1, 0, 0}));
  EXPECT_THAT(pointIn(shape.link_from_shape, {0, radius, 0}),
              Pointwise(DoubleNear(kRounding), Point3{1, 0.4, 0}));
  EXPECT_THAT(pointIn(shape.link_from_shape, {0, 0, radius}),
              Pointwise(DoubleNear(kRounding), Point3{1, 0, 0.2}));
}

TEST(MjcfGeoms, BetweenTwoPointsLieBetweenThem) {
  const ScratchFolder folder;
  const auto link = linkWith(folder,
                             "<geom type='cylinder' size='.1' fromto='0 0 0 0 2 0'/>"
                             "<geom type='box' size='.1' fromto='0 0 1 0 0 3'/>");
  ASSERT_EQ(link.collisions.size(), 2U);
  const bake::LinkShape& rod = link.collisions[0];
  EXPECT_EQ(std::get<CylinderShape>(rod.geometry).length, 2);
  EXPECT_THAT(pointIn(rod.link_from_shape, {0, 0, 0}),
              Pointwise(DoubleNear(kRounding), Point3{0, 0, -1}));
  // Its axis, Y here, lies along the Y of the file, which is -Z.
  EXPECT_NEAR(std::abs(pointIn(rod.link_from_shape, {0, 1, 0})[2] + 1), 1, kRounding);
  EXPECT_THAT(std::get<BoxShape>(link.collisions[1].geometry).size,
              Pointwise(DoubleNear(kRounding), Point3{0.2, 2, 0.2}));
  EXPECT_NEAR(link.collisions[1].link_from_shape[7], 2, kRounding);
}

TEST(MjcfGeoms, BetweenTwoPointsHaveTheirZFromTheSecondToTheFirst) {
  const ScratchFolder folder;
  const auto link = linkWith(folder,
                             "<geom type='box' size='.1' fromto='3 2 4 1 1 2'/>"
                             "<geom type='box' size='.1 .1 1.5' pos='2 1.5 3' zaxis='2 1 2'/>");
  ASSERT_EQ(link.collisions.size(), 2U);
  // Its sides are turned about its axis otherwise if that points the other way.
  EXPECT_THAT(link.collisions[0].link_from_shape,
              Pointwise(DoubleNear(kRounding), link.collisions[1].link_from_shape));
}

TEST(MjcfGeoms, TakeFromTheirClassWhatTheyDoNotSay) {
  const ScratchFolder folder;
  constexpr const char* kDefaults =
      "<default><geom type='box' size='1 1 1'/>"
      "<default class='part'><geom size='.2 .2 .2' euler='0 0 90'/>"
      "<default class='small'><geom size='.1 .1 .1'/></default></default></default>";
  const auto robot = mjcfRobot(
      folder,
      mjcfText("<body name='a'><geom/><body name='b' childclass='part'><joint name='j'/><geom/>"
               "<geom class='small'/><geom class='small' quat='1 0 0 0'/>"
               "<frame childclass='small'><geom/></frame>"
               "<body name='c'><joint name='k'/><geom/></body></body></body>",
               kDefaults));
  ASSERT_EQ(robot.links.size(), 3U);
  const auto side = [&](std::size_t link, std::size_t shape) {
    return std::get<BoxShape>(robot.links[link].collisions.at(shape).geometry).size[0];
  };
  EXPECT_EQ(side(0, 0), 2);
  EXPECT_EQ(side(1, 0), 0.4);
  EXPECT_EQ(side(1, 1), 0.2);
  EXPECT_EQ(side(1, 3), 0.2);
  EXPECT_EQ(side(2, 0), 0.4);
  // Its own orientation replaces that of the class, however that one is stated.
  EXPECT_NEAR(robot.links[1].collisions[1].link_from_shape[0], 0, kRounding);
  EXPECT_EQ(robot.links[1].collisions[2].link_from_shape[0], 1);
}

TEST(MjcfGeoms, MayNameTheClassOfAllDefaults) {
  const ScratchFolder folder;
  const auto link = linkWith(folder, "<geom class='main'/>",
                             "<default class='main'><geom type='box' size='1 1 1'/></default>");
  EXPECT_THAT(link.collisions, SizeIs(1));
}

constexpr const char* kSeen = "<geom contype='0' conaffinity='0' group='2' size='.1' {}/>";

TEST(MjcfGeoms, ThatDoNotCollideAreSeenAndTheOthersOnlyWithoutThem) {
  const ScratchFolder folder;
  const auto robot = mjcfRobot(
      folder,
      mjcfText(
          "<body name='a'><geom contype='0' conaffinity='0' size='.1'/>"
          "<geom type='box' size='.1 .1 .1'/>"
          "<body name='b'><joint name='i'/><geom type='box' size='.1 .1 .1' conaffinity='0'/>"
          "<body name='c'><joint name='j'/><geom type='box' size='.1 .1 .1' contype='0' group='3'/>"
          "</body></body></body>"));
  ASSERT_EQ(robot.links.size(), 3U);
  ASSERT_THAT(robot.links[0].visuals, SizeIs(1));
  EXPECT_TRUE(std::holds_alternative<SphereShape>(robot.links[0].visuals[0].geometry));
  ASSERT_THAT(robot.links[0].collisions, SizeIs(1));
  EXPECT_TRUE(std::holds_alternative<BoxShape>(robot.links[0].collisions[0].geometry));
  EXPECT_THAT(robot.links[1].visuals, SizeIs(1));
  EXPECT_THAT(robot.links[1].collisions, SizeIs(1));
  // Hidden in MuJoCo's viewer, and there is something else to see.
  EXPECT_THAT(robot.links[2].visuals, IsEmpty());
  EXPECT_THAT(robot.links[2].collisions, SizeIs(1));
}

TEST(MjcfGeoms, ThatAreHiddenAreSeenWhereNothingElseIs) {
  const ScratchFolder folder;
  const auto link = linkWith(folder, "<geom size='.1' group='3'/>");
  EXPECT_THAT(link.visuals, SizeIs(1));
}

TEST(MjcfGeoms, ThatAreSeenThroughAreNotSeen) {
  const ScratchFolder folder;
  const auto link =
      linkWith(folder, fmt::format(kSeen, "rgba='0 0 0 0'") + fmt::format(kSeen, "rgba='1 0 0 1'"));
  ASSERT_THAT(link.visuals, SizeIs(1));
  EXPECT_EQ((*link.visuals[0].color)[0], 1);
}

TEST(MjcfGeoms, HaveTheColorOfTheirMaterialUnlessTheyStateOne) {
  const ScratchFolder folder;
  constexpr const char* kAssets =
      "<default><material rgba='0 0 1 1'/></default>"
      "<asset><material name='blue'/><material name='green' rgba='0 1 0 0.5'/></asset>";
  const auto link = linkWith(folder,
                             fmt::format(kSeen, "") + fmt::format(kSeen, "material='blue'") +
                                 fmt::format(kSeen, "material='green'") +
                                 fmt::format(kSeen, "material='green' rgba='1 0 0 1'") +
                                 // What no geom states.
                                 fmt::format(kSeen, "material='green' rgba='.5 .5 .5 1'"),
                             kAssets);
  ASSERT_THAT(link.visuals, SizeIs(5));
  EXPECT_FALSE(link.visuals[0].color.has_value());
  EXPECT_THAT(*link.visuals[1].color, ElementsAre(0, 0, 1, 1));
  EXPECT_THAT(*link.visuals[2].color, ElementsAre(0, 1, 0, 0.5));
  EXPECT_THAT(*link.visuals[3].color, ElementsAre(1, 0, 0, 1));
  EXPECT_THAT(*link.visuals[4].color, ElementsAre(0, 1, 0, 0.5));
  EXPECT_TRUE(link.visuals[1].hides_looks);
}

TEST(MjcfGeoms, OfPlanesAndFieldsAreLeftOutWithAWarning) {
  const ScratchFolder folder;
  const auto robot = mjcfRobot(
      folder, withGeoms("<geom type='plane' size='1 1 1'/><geom type='hfield' hfield='h'/>"
                        "<geom size='.1'/>"));
  EXPECT_THAT(robot.links.back().collisions, SizeIs(1));
  EXPECT_THAT(robot.warnings,
              ElementsAre("a <geom> of type plane is left out: no robot consists of it",
                          "a <geom> of type hfield is left out: no robot consists of it"));
}

TEST(MjcfGeoms, OfTheWorldItselfAreNoPartOfTheRobot) {
  const ScratchFolder folder;
  const auto robot = mjcfRobot(folder, mjcfText("<light pos='0 0 3'/><camera name='c'/>"
                                                "<geom type='plane' size='1 1 1'/>"
                                                "<body name='ball' mocap='true'><geom size='1'/>"
                                                "</body><body name='a'><geom size='.1'/></body>"));
  EXPECT_THAT(robot.links, SizeIs(1));
  EXPECT_THAT(robot.warnings,
              ElementsAre("1 <geom> of the <worldbody> itself is no part of the robot"));
}

/// The uneven box spans (0.5, 0.25, 1) to (1.5, 2.25, 4) in its file.
const Point3 kLow{0.5, 1, -2.25};
const Point3 kHigh{1.5, 4, -0.25};

TEST(MjcfMeshes, AreFoundInTheirFolderByTheNameOfTheirFile) {
  const ScratchFolder folder;
  (void)folder.write("robots/parts/box.obj", objFile(unevenBox()));
  for (const char* compiler : {"<compiler meshdir='parts'/>", "<compiler assetdir='parts/'/>",
                               "<compiler meshdir='parts' strippath='true'/>"}) {
    const std::string_view file = std::string_view(compiler).find("strip") == std::string_view::npos
                                      ? "box.obj"
                                      : "/far/away/box.obj";
    const auto robot = mjcfRobot(
        folder, withGeoms("<geom type='mesh' mesh='box' pos='1 0 0'/>",
                          fmt::format("{}<asset><mesh file='{}'/></asset>", compiler, file)));
    ASSERT_THAT(robot.links.back().collisions, SizeIs(1)) << compiler;
    const auto mesh = meshInLink(robot, robot.links.back().collisions[0]);
    expectBounds(mesh.bounds, {kLow[0] + 1, kLow[1], kLow[2]}, {kHigh[0] + 1, kHigh[1], kHigh[2]});
    EXPECT_NEAR(signedVolume(mesh), 6, 1e-4);
    EXPECT_THAT(robot.resolutions, ElementsAre("parts/box.obj: parts/box.obj (relative to the "
                                               "robot's file)"));
  }
}

TEST(MjcfMeshes, HaveImagesInTheFolderOfAllAssets) {
  const ScratchFolder folder;
  (void)folder.write("robots/parts/box.obj", objFile(unevenBox()));
  (void)folder.write("robots/parts/wood.png", "no image yet");
  const auto robot =
      mjcfRobot(folder, withGeoms("<geom type='mesh' mesh='box' material='wooden'/>",
                                  "<compiler assetdir='parts'/><asset><mesh file='box.obj'/>"
                                  "<texture type='2d' file='wood.png'/>"
                                  "<material name='wooden' texture='wood'/></asset>"));
  ASSERT_THAT(robot.links.back().visuals, SizeIs(1));
  EXPECT_EQ(robot.links.back().visuals[0].texture, "parts/wood.png");
}

TEST(MjcfMeshes, HaveTheImageOfTheLayerThatIsTheirColor) {
  const ScratchFolder folder;
  (void)folder.write("robots/box.obj", objFile(unevenBox()));
  (void)folder.write("robots/wood.png", "no image yet");
  (void)folder.write("robots/bumps.png", "no image yet");
  const auto robot = mjcfRobot(
      folder, withGeoms("<geom type='mesh' mesh='box' material='wooden'/>",
                        "<asset><mesh file='box.obj'/><texture type='2d' file='wood.png'/>"
                        "<texture type='2d' file='bumps.png'/><material name='wooden'>"
                        "<layer texture='bumps' role='normal'/><layer texture='wood' role='rgb'/>"
                        "<layer texture='bumps' role='roughness'/></material></asset>"));
  ASSERT_THAT(robot.links.back().visuals, SizeIs(1));
  EXPECT_EQ(robot.links.back().visuals[0].texture, "wood.png");
}

TEST(MjcfMeshes, AreMovedTurnedBackAndScaled) {
  const ScratchFolder folder;
  (void)folder.write("robots/box.obj", objFile(unevenBox()));
  const auto bounds = [&](std::string_view attributes) {
    const auto robot = mjcfRobot(
        folder,
        withGeoms("<geom type='mesh' mesh='m'/>",
                  fmt::format("<asset><mesh name='m' file='box.obj' {}/></asset>", attributes)));
    return meshInLink(robot, robot.links.back().collisions.at(0)).bounds;
  };
  expectBounds(bounds("scale='2 1 .5'"), {1, 0.5, -2.25}, {3, 2, -0.25});
  expectBounds(bounds("scale='2 2 2' refpos='.5 .25 1'"), {0, 0, -4}, {2, 6, 0});
  // A quarter turn about Z taken back: X and Y of the file become -Y and X.
  expectBounds(bounds("refquat='1 0 0 1' scale='2 1 1'"), {0.5, 1, 0.5}, {4.5, 4, 1.5});
  // One about X: Y and Z of the file become -Z and Y.
  expectBounds(bounds("refquat='1 1 0 0'"), {0.5, -2.25, -4}, {1.5, -0.25, -1});
  expectBounds(bounds("scale='-1 1 1'"), {-1.5, 1, -2.25}, {-0.5, 4, -0.25});
}

TEST(MjcfMeshes, MayStandInTheFileItself) {
  const ScratchFolder folder;
  constexpr const char* kPoints = "vertex='0 0 0  1 0 0  0 2 0  0 0 3'";
  const auto whole = mjcfRobot(
      folder, withGeoms("<geom type='mesh' mesh='m'/>",
                        fmt::format("<asset><mesh name='m' {} face='0 2 1 0 1 3 0 3 2 1 2 3'/>"
                                    "</asset>",
                                    kPoints)));
  const auto mesh = meshInLink(whole, whole.links.back().collisions.at(0));
  expectBounds(mesh.bounds, {0, 0, -2}, {1, 3, 0});
  EXPECT_NEAR(signedVolume(mesh), 1, 1e-6);
  ASSERT_EQ(whole.meshes.at(0).read.files.size(), 1U);
  EXPECT_EQ(whole.meshes.at(0).read.files[0].name, "r.xml");
  // Without triangles it is the hull of the points.
  const auto points =
      mjcfRobot(folder, withGeoms("<geom type='mesh' mesh='m'/>",
                                  fmt::format("<asset><mesh name='m' {}/></asset>", kPoints)));
  EXPECT_NEAR(signedVolume(meshInLink(points, points.links.back().collisions.at(0))), 1, 1e-6);
}

TEST(MjcfMeshes, MayStandInTheFileInMillimeters) {
  const ScratchFolder folder;
  const auto robot = mjcfRobot(
      folder, withGeoms("<geom type='mesh' mesh='m'/>",
                        "<asset><mesh name='m' vertex='0 0 0  2000 0 0  0 1000 0  0 0 500' "
                        "scale='.001 .001 .001'/></asset>"));
  expectBounds(meshInLink(robot, robot.links.back().collisions.at(0)).bounds, {0, 0, -1},
               {2, 0.5F, 0});
}

TEST(MjcfMeshes, StandForPrimitivesThatWouldBeFittedToThem) {
  const ScratchFolder folder;
  (void)folder.write("robots/box.obj", objFile(unevenBox()));
  const auto robot = mjcfRobot(folder, withGeoms("<geom type='capsule' mesh='box'/>",
                                                 "<asset><mesh file='box.obj'/></asset>"));
  EXPECT_TRUE(
      std::holds_alternative<bake::MeshShape>(robot.links.back().collisions.at(0).geometry));
  EXPECT_THAT(robot.warnings,
              Contains("a capsule is to be fitted to the mesh 'box'; the mesh itself counts"));
}

TEST(MjcfMeshes, HaveTheImageOfTheirMaterial) {
  const ScratchFolder folder;
  (void)folder.write("robots/box.obj", objFile(unevenBox()));
  (void)folder.write("robots/images/wood.png", "no image yet");
  constexpr const char* kSections =
      "<compiler texturedir='images'/><asset><mesh file='box.obj'/>"
      "<material name='wooden' texture='wood' rgba='1 0 0 1'/>"
      "<material name='lost' texture='gone'/><texture type='2d' file='wood.png'/>"
      "<texture name='gone' type='2d' file='gone.png'/>"
      "<texture name='made' type='2d' builtin='checker'/><material name='flat' texture='made'/>"
      "</asset>";
  const auto robot = mjcfRobot(folder, withGeoms("<geom type='mesh' mesh='box' material='wooden'/>"
                                                 "<geom type='mesh' mesh='box' material='lost'/>"
                                                 "<geom type='mesh' mesh='box' material='flat'/>",
                                                 kSections));
  const bake::SourceLink& link = robot.links.back();
  ASSERT_THAT(link.visuals, SizeIs(3));
  EXPECT_EQ(link.visuals[0].texture, "images/wood.png");
  EXPECT_EQ(link.visuals[1].texture, "");
  EXPECT_EQ(link.visuals[2].texture, "");
  EXPECT_EQ(link.collisions[0].texture, "");
  EXPECT_THAT(robot.warnings,
              Contains("link 'b' visual 2: the texture 'images/gone.png' of its material is "
                       "missing; looked for images/gone.png (from the robot's folder); its color "
                       "is drawn"));
  const auto is_image = [](const bake::SourceFile& file) { return file.name == "images/wood.png"; };
  EXPECT_TRUE(std::ranges::any_of(robot.read.files, is_image));
}

TEST(MjcfMeshes, WhoseLooksAreHiddenMayLackTheirMaterials) {
  const ScratchFolder folder;
  (void)folder.write("robots/box.obj", objFile(unevenBox(), "mtllib lost.mtl\nusemtl wood\n"));
  constexpr const char* kAssets = "<asset><mesh file='box.obj'/></asset>";
  const auto colored = mjcfRobot(
      folder, withGeoms("<geom type='mesh' mesh='box' contype='0' conaffinity='0' rgba='1 0 0 1'/>"
                        "<geom type='mesh' mesh='box'/>",
                        kAssets));
  EXPECT_THAT(colored.warnings, IsEmpty());
  const auto plain = mjcfRobot(
      folder, withGeoms("<geom type='mesh' mesh='box' contype='0' conaffinity='0'/>", kAssets));
  EXPECT_THAT(plain.warnings, Contains(testing::HasSubstr("lost.mtl")));
}

TEST(MjcfFiles, HaveTheContentOfThoseThatTheyInclude) {
  const ScratchFolder folder;
  (void)folder.write("robots/parts/arm.xml",
                     "<mujoco><body name='b'><joint name='j' class='d'/>"
                     "<include file='hand.xml'/></body></mujoco>");
  (void)folder.write("robots/parts/hand.xml", "<mujocoinclude><geom size='.1'/></mujocoinclude>");
  (void)folder.write("robots/defaults.xml",
                     "<mujocoinclude><default><default class='d'><joint axis='1 0 0'/></default>"
                     "</default></mujocoinclude>");
  const auto robot =
      mjcfRobot(folder,
                "<mujoco model='whole'><include file='defaults.xml'/><worldbody><body name='a'>"
                "<include file='parts/arm.xml'/></body></worldbody></mujoco>");
  EXPECT_EQ(robot.name, "whole");
  ASSERT_THAT(robot.links, SizeIs(2));
  EXPECT_THAT(robot.links[1].axis, ElementsAre(1, 0, 0));
  EXPECT_THAT(robot.links[1].collisions, SizeIs(1));
  std::vector<std::string> files;
  for (const bake::SourceFile& file : robot.read.files) files.push_back(file.name);
  EXPECT_THAT(files, testing::UnorderedElementsAre("r.xml", "defaults.xml", "parts/arm.xml",
                                                   "parts/hand.xml"));
}

}  // namespace
}  // namespace galactic::test::mjcf::geoms_test
