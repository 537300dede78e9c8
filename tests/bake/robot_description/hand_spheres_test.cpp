// Spheres made by hand or by other tools.
#include "robot_description/hand_spheres.h"

#include <gmock/gmock.h>

#include "bake/robot_description/robot_texts.h"

namespace galactic::test::hand_spheres_test {
namespace {

using bake::HandSphere;
using bake::LinkSpheres;
using testing::ElementsAre;

std::string sphereElement(std::string_view xyz, double radius) {
  return fmt::format(
      "<collision><origin xyz=\"{}\"/><geometry><sphere radius=\"{}\"/></geometry></collision>",
      xyz, radius);
}

TEST(SpherizedUrdfs, GiveTheSpheresOfEachLinkYUp) {
  const ScratchFolder folder;
  const auto path = folder.write(
      "s.urdf",
      robotText("<link name=\"a\">" + sphereElement("1 2 3", 0.5) + sphereElement("0 0 0", 0.015) +
                "<collision><geometry><box size=\"1 1 1\"/></geometry></collision></link>"
                "<link name=\"b\"/>" +
                jointText("j", "fixed", "a,b")));
  const auto spheres = bake::readSpherizedRobot(path);
  ASSERT_TRUE(spheres.has_value()) << spheres.error().message;
  const LinkSpheres expected{"a", {{{1, 3, -2}, 0.5}, {{0, 0, 0}, 0.015}}};
  EXPECT_THAT(spheres->links, ElementsAre(expected));
  EXPECT_THAT(spheres->warnings,
              ElementsAre("link 'a': 1 collision elements are no spheres: left out"));
}

TEST(SpherizedUrdfs, WithoutSpheresOrWithBrokenOnesAreErrors) {
  const ScratchFolder folder;
  const auto none =
      bake::readSpherizedRobot(folder.write("n.urdf", robotText("<link name=\"a\"/>")));
  ASSERT_FALSE(none.has_value());
  EXPECT_EQ(none.error().message,
            "no link has a <sphere> collision element; is it the spherized file?");
  const auto flat = bake::readSpherizedRobot(folder.write(
      "f.urdf", robotText("<link name=\"a\">" + sphereElement("0 0 0", 0) + "</link>")));
  ASSERT_FALSE(flat.has_value());
  EXPECT_THAT(flat.error().where, testing::EndsWith("f.urdf: link 'a'"));
  EXPECT_EQ(flat.error().message,
            "a sphere at (0 0 0) of radius 0: expected a finite center and a positive radius, in "
            "meters");
}

TEST(SrdfSpheres, AreReadYUpWithoutMoveItsEmptyLinks) {
  const ScratchFolder folder;
  const auto path = folder.write("r.srdf", R"(<?xml version="1.0"?><robot name="r">
    <group name="arm"/>
    <link_sphere_approximation link="a">
      <sphere center="1.0 2.0 3.0" radius="0.5"/><sphere center="0 0	+0.25" radius="1e-2"/>
    </link_sphere_approximation>
    <link_sphere_approximation link="b"><sphere center="0 0 0" radius="0"/>
    </link_sphere_approximation></robot>)");
  const auto spheres = bake::readSrdfSpheres(path);
  ASSERT_TRUE(spheres.has_value()) << spheres.error().message;
  const LinkSpheres expected{"a", {{{1, 3, -2}, 0.5}, {{0, 0.25, 0}, 0.01}}};
  EXPECT_THAT(spheres->links, ElementsAre(expected));
}

TEST(SrdfSpheres, ThatAreBrokenNameTheirLine) {
  const ScratchFolder folder;
  const auto error = [&](std::string_view element) {
    const auto read = bake::readSrdfSpheres(
        folder.write("r.srdf", "<robot name=\"r\">\n" + std::string(element) + "</robot>"));
    return read ? Error{} : read.error();
  };
  const Error unnamed = error("<link_sphere_approximation/>");
  EXPECT_THAT(unnamed.where, testing::EndsWith("r.srdf:2"));
  EXPECT_EQ(unnamed.message, "<link_sphere_approximation> has no attribute 'link'; name the link");
  for (const char* sphere :
       {"<sphere radius=\"1\"/>", "<sphere center=\"0 0 0\"/>",
        "<sphere center=\"0 0\" radius=\"1\"/>", "<sphere center=\"0 0 x\" radius=\"1\"/>"}) {
    SCOPED_TRACE(sphere);
    const Error broken = error(fmt::format(
        "<link_sphere_approximation link=\"a\">{}</link_sphere_approximation>", sphere));
    EXPECT_EQ(broken.message, "a <sphere> of link 'a' needs center=\"x y z\" and radius=\"r\"");
  }
  for (const char* sphere :
       {"<sphere center=\"0 0 nan\" radius=\"1\"/>", "<sphere center=\"0 0 0\" radius=\"-1\"/>",
        "<sphere center=\"0 0 1e9\" radius=\"1\"/>", "<sphere center=\"0 0 0\" radius=\"inf\"/>"}) {
    SCOPED_TRACE(sphere);
    const Error broken = error(fmt::format(
        "<link_sphere_approximation link=\"a\">{}</link_sphere_approximation>", sphere));
    EXPECT_THAT(broken.message,
                testing::HasSubstr("expected a finite center and a positive radius"));
  }
}

}  // namespace
}  // namespace galactic::test::hand_spheres_test
