// Meshes, primitives and colors of links; what happens to geometry that is missing.
#include <gmock/gmock.h>

#include <array>

#include "bake/robot_description/link_points.h"
#include "bake/robot_description/robot_texts.h"
#include "support/mesh_files.h"

namespace galactic::test::geometry_test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::string meshLink(std::string_view name, std::string_view file, std::string_view more = "") {
  return linkText(name, fmt::format("<mesh filename=\"{}\" {}/>", file, more));
}

/// The uneven box spans (0.5, 0.25, 1) to (1.5, 2.25, 4) in its file.
const Point3 kLow{0.5, 1, -2.25};
const Point3 kHigh{1.5, 4, -0.25};
constexpr double kBoxVolume = 6;
/// Volumes of boxes a few meters large from float coordinates.
constexpr double kVolumeRounding = 1e-4;

TEST(UrdfMeshes, CountAsTheyStandInTheFileWhateverItsUpAxis) {
  const std::array<std::pair<const char*, std::string>, 7> files{{
      {"box.stl", stlBinaryFile(unevenBox())},
      {"box.obj", objFile(unevenBox())},
      {"box.ply", plyAsciiFile(unevenBox())},
      {"box.glb", glbFile(unevenBox())},
      {"z_up.dae", daeFile(unevenBox(), {.up_axis = "Z_UP", .meter = "1", .transform = ""})},
      {"y_up.dae", daeFile(unevenBox(), {.up_axis = "Y_UP", .meter = "1", .transform = ""})},
      {"unnamed.dae", daeFile(unevenBox(), {.up_axis = "", .meter = "", .transform = ""})},
  }};
  for (const auto& [name, content] : files) {
    SCOPED_TRACE(name);
    const ScratchFolder folder;
    (void)folder.write(fmt::format("robots/{}", name), content);
    const auto robot = importText(folder, robotText(meshLink("a", name)));
    ASSERT_TRUE(robot.has_value()) << robot.error().message;
    const auto mesh = meshInLink(*robot, robot->links[0].collisions.at(0));
    expectBounds(mesh.bounds, kLow, kHigh);
    EXPECT_NEAR(signedVolume(mesh), kBoxVolume, kVolumeRounding);
  }
}

TEST(UrdfMeshes, KeepTheUnitAndTheNodesOfColladaFiles) {
  const ScratchFolder folder;
  (void)folder.write("robots/mm.dae",
                     daeFile(unevenBox(), {.up_axis = "Z_UP",
                                           .meter = "0.001",
                                           .transform = "<translate>1000 0 0</translate>"}));
  const auto robot = importText(folder, robotText(meshLink("a", "mm.dae")));
  ASSERT_TRUE(robot.has_value()) << robot.error().message;
  const auto mesh = meshInLink(*robot, robot->links[0].collisions.at(0));
  expectBounds(mesh.bounds, {1.0005, 0.001, -0.00225}, {1.0015, 0.004, -0.00025});
}

TEST(UrdfMeshes, AreScaledAlongTheAxesOfTheUrdfAndPlaced) {
  const ScratchFolder folder;
  (void)folder.write("robots/box.stl", stlBinaryFile(unevenBox()));
  const auto robot = importText(
      folder, robotText("<link name=\"a\"><collision><origin xyz=\"10 20 30\"/><geometry><mesh "
                        "filename=\"box.stl\" scale=\"1 2 0.5\"/></geometry></collision></link>"));
  ASSERT_TRUE(robot.has_value()) << robot.error().message;
  const auto mesh = meshInLink(*robot, robot->links[0].collisions.at(0));
  expectBounds(mesh.bounds, {10.5, 30.5, -24.5}, {11.5, 32, -20.5}, 1e-5);
}

TEST(UrdfMeshes, WithNegativeScaleAreMirroredAndKeepTheirOutsideOut) {
  const ScratchFolder folder;
  (void)folder.write("robots/box.stl", stlBinaryFile(unevenBox()));
  const auto robot = importText(folder, robotText(meshLink("a", "box.stl", "scale=\"1 -1 1\"")));
  ASSERT_TRUE(robot.has_value()) << robot.error().message;
  const auto mesh = meshInLink(*robot, robot->links[0].collisions.at(0));
  expectBounds(mesh.bounds, {0.5, 1, 0.25}, {1.5, 4, 2.25});
  EXPECT_NEAR(signedVolume(mesh), kBoxVolume, kVolumeRounding);
}

TEST(UrdfMeshes, AreLoadedOncePerFile) {
  const ScratchFolder folder;
  (void)folder.write("robots/box.stl", stlBinaryFile(unevenBox()));
  const auto robot = importText(
      folder, robotText(meshLink("a", "box.stl") + meshLink("b", "./box.stl", "scale=\"2 2 2\"") +
                        jointText("j", "fixed", "a,b")));
  ASSERT_TRUE(robot.has_value()) << robot.error().message;
  EXPECT_EQ(robot->meshes.size(), 1U);
  ASSERT_EQ(robot->read.files.size(), 2U);
  EXPECT_EQ(robot->read.files[0].name, "r.urdf");
  EXPECT_EQ(robot->read.files[1].name, "box.stl");
  for (const bake::SourceFile& file : robot->read.files) EXPECT_NE(file.hash_low, 0U);
}

TEST(UrdfMeshes, OfDoubtfulSizeDrawAQuestionAboutTheUnit) {
  const ScratchFolder folder;
  (void)folder.write("robots/box.stl", stlBinaryFile(unevenBox()));
  const auto robot =
      importText(folder, robotText(meshLink("a", "box.stl", "scale=\"1000 1000 1000\"") +
                                   meshLink("b", "box.stl", "scale=\"0.0001 0.0001 0.0001\"") +
                                   meshLink("c", "box.stl") + jointText("j", "fixed", "a,b") +
                                   jointText("k", "fixed", "a,c")));
  ASSERT_TRUE(robot.has_value()) << robot.error().message;
  EXPECT_THAT(robot->warnings,
              ElementsAre("link 'a' collision 1: mesh 'box.stl' is 3e+03 m large: is its unit the "
                          "meter? Correct the scale of the <mesh>",
                          "link 'b' collision 1: mesh 'box.stl' is 0.0003 m large: is its unit the "
                          "meter? Correct the scale of the <mesh>"));
}

constexpr const char* kBoxCollision =
    "<collision><geometry><box size=\"1 1 1\"/></geometry></collision>";
constexpr const char* kLostVisual =
    "<visual><geometry><mesh filename=\"lost.dae\"/></geometry></visual>";
constexpr const char* kLostCollision =
    "<collision><geometry><mesh filename=\"lost.stl\"/></geometry></collision>";
constexpr const char* kLostVisualWarning =
    "link 'a' visual 1: mesh 'lost.dae' is missing; looked for lost.dae (from the robot's folder)";
constexpr const char* kBoxVisual = "<visual><geometry><box size=\"1 1 1\"/></geometry></visual>";
constexpr const char* kLostCollisionWarning =
    "link 'a' collision 1: mesh 'lost.stl' is missing; looked for lost.stl (from the robot's "
    "folder)";

std::string linkWith(std::string_view inside) {
  return robotText(fmt::format("<link name=\"a\">{}</link>", inside));
}

TEST(UrdfMissingGeometry, OfAllVisualsSaysWhatIsDrawnInstead) {
  const ScratchFolder folder;
  const auto robot = importText(folder, linkWith(std::string(kBoxCollision) + kLostVisual));
  ASSERT_TRUE(robot.has_value());
  EXPECT_THAT(robot->warnings, ElementsAre(std::string(kLostVisualWarning) +
                                           "; the link's collision geometry is drawn instead"));
  EXPECT_EQ(robot->links[0].collisions.size(), 1U);
  EXPECT_THAT(robot->links[0].visuals, IsEmpty());
  EXPECT_TRUE(robot->links[0].visuals_are_lost);
}

TEST(UrdfMissingGeometry, OfSomeVisualsIsAWarning) {
  const ScratchFolder folder;
  const auto robot =
      importText(folder, linkWith(std::string(kBoxCollision) + kLostVisual + kBoxVisual));
  ASSERT_TRUE(robot.has_value());
  EXPECT_THAT(robot->warnings, ElementsAre(kLostVisualWarning));
  EXPECT_FALSE(robot->links[0].visuals_are_lost);
}

TEST(UrdfMissingGeometry, OfVisualsIsNoneWhereTheLinkHasNone) {
  const ScratchFolder folder;
  const auto robot = importText(folder, linkWith(kBoxCollision));
  ASSERT_TRUE(robot.has_value());
  EXPECT_THAT(robot->warnings, IsEmpty());
  EXPECT_FALSE(robot->links[0].visuals_are_lost);
}

TEST(UrdfMissingGeometry, OfSomeCollisionElementsIsAWarning) {
  const ScratchFolder folder;
  const auto robot = importText(folder, linkWith(std::string(kLostCollision) + kBoxCollision));
  ASSERT_TRUE(robot.has_value());
  EXPECT_THAT(robot->warnings, ElementsAre(kLostCollisionWarning));
  EXPECT_EQ(robot->links[0].collisions.size(), 1U);
}

TEST(UrdfMissingGeometry, OfAllCollisionElementsIsAnErrorUnlessAllowed) {
  const ScratchFolder folder;
  const std::string text = linkWith(std::string(kLostCollision) + kBoxVisual);
  const auto refused = importText(folder, text);
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(placeIn(folder, refused.error()), "r.urdf: link 'a'");
  EXPECT_THAT(refused.error().message, HasSubstr("it lost all its collision geometry"));
  bake::RobotImportOptions options;
  options.allow_missing = true;
  const auto allowed = importText(folder, text, options);
  ASSERT_TRUE(allowed.has_value());
  EXPECT_THAT(allowed->warnings,
              ElementsAre(kLostCollisionWarning,
                          "link 'a': it lost all its geometry and collides with nothing"));
}

TEST(UrdfMissingGeometry, OfALinkThatHasOnlyVisualsIsAnErrorUnlessAllowed) {
  const ScratchFolder folder;
  const auto refused = importText(folder, linkWith(kLostVisual));
  ASSERT_FALSE(refused.has_value());
  EXPECT_THAT(refused.error().message, HasSubstr("it lost all its visual geometry"));
  bake::RobotImportOptions options;
  options.allow_missing = true;
  const auto allowed = importText(folder, linkWith(kLostVisual), options);
  ASSERT_TRUE(allowed.has_value());
  EXPECT_THAT(allowed->warnings,
              ElementsAre(std::string(kLostVisualWarning) + "; the link is not drawn",
                          "link 'a': it lost all its geometry and collides with nothing"));
}

TEST(UrdfMissingGeometry, IncludesMeshesThatDoNotLoad) {
  const ScratchFolder folder;
  (void)folder.write("robots/lost.stl", "solid nothing\nendsolid\n");
  const auto robot = importText(folder, linkWith(std::string(kLostCollision) + kBoxCollision));
  ASSERT_TRUE(robot.has_value());
  ASSERT_EQ(robot->warnings.size(), 1U);
  EXPECT_THAT(robot->warnings[0],
              testing::StartsWith("link 'a' collision 1: mesh 'lost.stl' does not load: "));
  EXPECT_FALSE(robot->read.is_settled) << "it may lack another file";
  EXPECT_FALSE(importText(folder, linkWith(kLostCollision)).has_value());
}

TEST(DescribedGeometry, OfVisualsStandsInForCollisionElementsWithAWarning) {
  const ScratchFolder folder;
  const auto robot = importText(folder, linkWith(kBoxVisual));
  ASSERT_TRUE(robot.has_value());
  EXPECT_THAT(robot->warnings,
              ElementsAre("link 'a': it has no collision geometry; its visual geometry stands in "
                          "for it"));
}

TEST(DescribedGeometry, WithoutSizeIsLeftOutWithAWarning) {
  const ScratchFolder folder;
  const auto robot = importText(folder, robotText(linkText("a", "<sphere radius=\"0\"/>")));
  ASSERT_TRUE(robot.has_value());
  EXPECT_THAT(robot->warnings,
              ElementsAre("link 'a' collision 1: a sphere of radius with a size of 0 is left out"));
  EXPECT_THAT(robot->links[0].collisions, IsEmpty());
}

TEST(DescribedGeometry, OfACapsuleIsACylinderWithASphereAtEachEnd) {
  const ScratchFolder folder;
  const auto robot = importText(
      folder, robotText("<link name=\"a\"><visual><geometry><capsule radius=\"0.1\" "
                        "length=\"0.4\"/></geometry></visual><collision><origin xyz=\"1 2 3\" "
                        "rpy=\"0.3 0.7 -1.1\"/><geometry><capsule radius=\"0.1\" "
                        "length=\"0.4\"/></geometry></collision></link>"));
  ASSERT_TRUE(robot.has_value()) << robot.error().message;
  EXPECT_THAT(robot->warnings, IsEmpty());
  for (const auto& shapes : {robot->links[0].visuals, robot->links[0].collisions}) {
    ASSERT_EQ(shapes.size(), 3U);
    const auto& cylinder = std::get<bake::CylinderShape>(shapes[0].geometry);
    EXPECT_EQ(cylinder.radius, 0.1);
    EXPECT_EQ(cylinder.length, 0.4);
    for (const std::size_t n : {1U, 2U}) {
      EXPECT_EQ(std::get<bake::SphereShape>(shapes[n].geometry).radius, 0.1);
      // The cylinder's axis is Y of its frame: the second column.
      const bake::Affine& rod = shapes[0].link_from_shape;
      const double along = n == 1 ? -0.2 : 0.2;
      for (const std::size_t row : {0U, 4U, 8U}) {
        EXPECT_NEAR(shapes[n].link_from_shape[row + 3], rod[row + 3] + along * rod[row + 1], 1e-12);
      }
    }
  }
  const auto refused =
      importText(folder, robotText(linkText("a", "<capsule radius=\"0.1\" length=\"x\"/>")));
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().code, ErrorCode::kInvalidInput);
}

TEST(DescribedGeometry, MayHaveCommasTabsAndLineEndsBetweenNumbers) {
  const ScratchFolder folder;
  const auto robot = importText(folder, robotText(linkText("a", "<box size=\"1,\t2,\n3\"/>")));
  ASSERT_TRUE(robot.has_value()) << robot.error().message;
  EXPECT_THAT(std::get<bake::BoxShape>(robot->links[0].collisions.at(0).geometry).size,
              ElementsAre(1, 3, 2));
  ASSERT_EQ(robot->warnings.size(), 1U);
  EXPECT_THAT(robot->warnings[0], HasSubstr("has commas, which count as blanks"));
}

TEST(DescribedGeometry, WarnsOfCommasOnceForEachKindOfList) {
  const ScratchFolder folder;
  const auto robot =
      importText(folder, robotText(linkText("a", "<box size=\"1, 2, 3\"/>") +
                                   "\n<link name=\"b\"><collision><origin xyz=\"1,2,3\"/><geometry>"
                                   "<box size=\"4,5,6\"/></geometry></collision></link>" +
                                   "<joint name=\"j\" type=\"fixed\"><parent link=\"a\"/>"
                                   "<child link=\"b\"/></joint>"));
  ASSERT_TRUE(robot.has_value()) << robot.error().message;
  EXPECT_THAT(robot->warnings,
              ElementsAre("line 1: size=\"1, 2, 3\" has commas, which count as blanks (2 times in "
                          "the file)",
                          "line 2: xyz=\"1,2,3\" has commas, which count as blanks"));
}

std::string visual(std::string_view material) {
  return fmt::format("<visual><geometry><sphere radius=\"1\"/></geometry>{}</visual>", material);
}

TEST(UrdfColors, AreSrgbFromLocalAndGlobalMaterials) {
  const ScratchFolder folder;
  const auto robot = importText(
      folder,
      robotText("<material name=\"blue\"><color rgba=\"0 0 1 0.25\"/></material><link name=\"a\">" +
                std::string(kBoxCollision) + visual("<material name=\"blue\"/>") +
                visual("<material name=\"gray\"><color rgba=\"0.5 0.04 1 1\"/></material>") +
                visual("") + visual("<material name=\"unknown\"/>") + "</link>"));
  ASSERT_TRUE(robot.has_value()) << robot.error().message;
  const auto& visuals = robot->links[0].visuals;
  ASSERT_EQ(visuals.size(), 4U);
  EXPECT_EQ(visuals[0].color, (std::array<float, 4>{0, 0, 1, 0.25F}));
  ASSERT_TRUE(visuals[1].color.has_value());
  EXPECT_NEAR(visuals[1].color->at(0), 0.2140411F, 1e-6F);
  EXPECT_NEAR(visuals[1].color->at(1), 0.0030960F, 1e-6F);
  EXPECT_FALSE(visuals[2].color.has_value());
  EXPECT_FALSE(visuals[3].color.has_value());
}

TEST(UrdfColors, BeyondTheRangeAreBytesOrClamped) {
  const ScratchFolder folder;
  const auto colored = [](const char* rgba) {
    return visual(fmt::format("<material><color rgba=\"{}\"/></material>", rgba));
  };
  const auto robot =
      importText(folder, robotText("<link name=\"a\">" + std::string(kBoxCollision) +
                                   colored("255 0 0 255") + colored("0 255 0 1") +
                                   colored("0 0 1 255") + colored("1.5 -1 1 0.5") + "</link>"));
  ASSERT_TRUE(robot.has_value()) << robot.error().message;
  const auto& visuals = robot->links[0].visuals;
  ASSERT_EQ(visuals.size(), 4U);
  EXPECT_EQ(visuals[0].color, (std::array<float, 4>{1, 0, 0, 1}));
  EXPECT_EQ(visuals[1].color, (std::array<float, 4>{0, 1, 0, 1}));
  EXPECT_EQ(visuals[2].color, (std::array<float, 4>{0, 0, 1, 1}));
  EXPECT_EQ(visuals[3].color, (std::array<float, 4>{1, 0, 1, 0.5F}));
  EXPECT_THAT(robot->warnings,
              ElementsAre("line 1: rgba=\"255 0 0 255\" is not within 0 to 1; it counts as 1 0 0 1 "
                          "(4 times in the file)"));
}

TEST(UrdfColors, ThatAreNoneLeaveTheirMaterialWithout) {
  const ScratchFolder folder;
  for (const char* rgba : {"red", "1 0 0", "1 0 0 1 1", "nan 0 0 1", "inf 0 0 1", ""}) {
    SCOPED_TRACE(rgba);
    const std::string color = fmt::format("<color rgba=\"{}\"/>", rgba);
    const auto robot = importText(
        folder, robotText("<material name=\"m\">" + color + "</material><link name=\"a\">" +
                          std::string(kBoxCollision) + visual("<material name=\"m\"/>") +
                          visual("<material name=\"n\">" + color + "</material>") + "</link>"));
    ASSERT_TRUE(robot.has_value()) << robot.error().message;
    for (const bake::LinkShape& shape : robot->links[0].visuals) EXPECT_FALSE(shape.color);
    EXPECT_THAT(robot->warnings,
                Contains(fmt::format("line 1: rgba=\"{}\" is not four numbers from 0 to 1; the "
                                     "material has no color (2 times in the file)",
                                     rgba)));
    EXPECT_THAT(robot->warnings, Contains("link 'a' material 'm' undefined."));
  }
}

TEST(UrdfColors, AreReadOfMaterialsWithoutNames) {
  const ScratchFolder folder;
  const auto robot = importText(
      folder, robotText("<material><color rgba=\"0 0 0 1\"/></material>"
                        "<material><color rgba=\"0 0 0 1\"/></material><link name=\"a\">" +
                        std::string(kBoxCollision) +
                        visual("<material><color rgba=\"1 0 0 1\"/></material>") +
                        visual("<material><color rgba=\"0 1 0 1\"/></material>") +
                        visual("<material><color/></material>") + "</link>"));
  ASSERT_TRUE(robot.has_value()) << robot.error().message;
  EXPECT_THAT(robot->warnings, IsEmpty());
  const auto& visuals = robot->links[0].visuals;
  ASSERT_EQ(visuals.size(), 3U);
  EXPECT_EQ(visuals[0].color, (std::array<float, 4>{1, 0, 0, 1}));
  EXPECT_EQ(visuals[1].color, (std::array<float, 4>{0, 1, 0, 1}));
  EXPECT_FALSE(visuals[2].color.has_value());
}

TEST(DescribedGeometry, MayHaveBlanksAroundNumbers) {
  const ScratchFolder folder;
  const auto robot = importText(folder, robotText(linkText("a", "<sphere radius=\" 2\n\"/>")));
  ASSERT_TRUE(robot.has_value()) << robot.error().message;
  EXPECT_EQ(std::get<bake::SphereShape>(robot->links[0].collisions.at(0).geometry).radius, 2);
}

TEST(UrdfImport, GivesTheSameRobotEveryTime) {
  const ScratchFolder folder;
  (void)folder.write("robots/box.stl", stlBinaryFile(unevenBox()));
  const std::string text =
      robotText(meshLink("a", "box.stl") + meshLink("b", "box.stl", "scale=\"1 1 -2\"") +
                jointText("j", "continuous", "a,b", "<origin rpy=\"0.1 0.2 0.3\"/>"));
  const auto first = importText(folder, text);
  const auto second = importText(folder, text);
  ASSERT_TRUE(first.has_value() && second.has_value());
  EXPECT_EQ(first->warnings, second->warnings);
  EXPECT_EQ(first->resolutions, second->resolutions);
  for (std::size_t i = 0; i < first->links.size(); ++i) {
    EXPECT_EQ(first->links[i].parent_from_joint, second->links[i].parent_from_joint);
    EXPECT_EQ(first->links[i].collisions[0].link_from_shape,
              second->links[i].collisions[0].link_from_shape);
  }
  EXPECT_EQ(first->meshes[0].meshes[0].positions, second->meshes[0].meshes[0].positions);
}

}  // namespace
}  // namespace galactic::test::geometry_test
