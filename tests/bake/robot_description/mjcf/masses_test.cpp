// What the links of an MJCF weigh: as stated, and by their shapes.
#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <numbers>

#include "bake/robot_description/mjcf/mjcf_texts.h"
#include "support/mesh_files.h"

namespace galactic::test::mjcf::masses_test {
namespace {

using bake::LinkInertial;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pointwise;
using testing::SizeIs;

constexpr double kRounding = 1e-9;
/// Of meshes, whose points are floats.
constexpr double kFloatRounding = 1e-5;

LinkInertial massWith(const ScratchFolder& folder, std::string_view inside,
                      std::string_view sections = "") {
  const auto masses =
      mjcfMasses(folder, mjcfText(fmt::format("<body name='a'>{}</body>", inside), sections));
  EXPECT_THAT(masses, SizeIs(1));
  return masses.empty() ? LinkInertial{} : masses.front();
}

TEST(MjcfMasses, AreAsStated) {
  const ScratchFolder folder;
  const auto diagonal = massWith(folder,
                                 "<geom size='1'/><inertial pos='1 2 3' quat='1 0 0 1' mass='5' "
                                 "diaginertia='1 2 4'/>");
  EXPECT_EQ(diagonal.link, "a");
  EXPECT_EQ(diagonal.mass, 5);
  EXPECT_THAT(diagonal.center, ElementsAre(1, 2, 3));
  // Turned by a quarter about Z: X and Y change places.
  EXPECT_THAT(diagonal.moments,
              Pointwise(DoubleNear(kRounding), std::array<double, 6>{2, 1, 4, 0, 0, 0}));
  const auto full =
      massWith(folder, "<inertial pos='0 0 0' mass='5' fullinertia='1 2 3 .1 .2 .3'/>");
  EXPECT_THAT(full.moments,
              Pointwise(DoubleNear(kRounding), std::array<double, 6>{1, 2, 3, 0.1, 0.2, 0.3}));
}

TEST(MjcfMasses, InFramesAreWhereTheFramesAre) {
  const ScratchFolder folder;
  const auto inertial = massWith(folder,
                                 "<frame pos='1 0 0' euler='0 0 90'>"
                                 "<inertial pos='2 0 0' mass='5' diaginertia='1 2 4'/></frame>");
  EXPECT_THAT(inertial.center, Pointwise(DoubleNear(kRounding), std::array<double, 3>{1, 2, 0}));
  EXPECT_THAT(inertial.moments,
              Pointwise(DoubleNear(kRounding), std::array<double, 6>{2, 1, 4, 0, 0, 0}));
}

struct Solid {
  const char* geom;
  double volume;
  /// Of mass 1, about the center.
  std::array<double, 3> moments;
};

TEST(MjcfMasses, OfPrimitivesAreThoseOfSolids) {
  const ScratchFolder folder;
  constexpr double kPi = std::numbers::pi;
  const std::array<Solid, 4> solids{{
      {"type='sphere' size='.5'", kPi / 6, {0.1, 0.1, 0.1}},
      {"type='box' size='.5 1 1.5'", 6, {13.0 / 12, 10.0 / 12, 5.0 / 12}},
      {"type='cylinder' size='.5 1'", kPi / 2, {0.0625 + 1.0 / 3, 0.0625 + 1.0 / 3, 0.125}},
      {"type='ellipsoid' size='.5 1 2'", 4 * kPi / 3, {1, 0.85, 0.25}},
  }};
  for (const Solid& solid : solids) {
    SCOPED_TRACE(solid.geom);
    const auto water = massWith(folder, fmt::format("<geom {} pos='1 0 0'/>", solid.geom));
    EXPECT_NEAR(water.mass, 1000 * solid.volume, 1000 * kRounding);
    const auto light = massWith(folder, fmt::format("<geom {} density='1'/>", solid.geom));
    EXPECT_NEAR(light.mass, solid.volume, kRounding);
    const auto one = massWith(folder, fmt::format("<geom {} pos='1 0 0' mass='1'/>", solid.geom));
    EXPECT_THAT(one.center, ElementsAre(1, 0, 0));
    EXPECT_THAT((std::array{one.moments[0], one.moments[1], one.moments[2]}),
                Pointwise(DoubleNear(kRounding), solid.moments));
  }
}

/// A capsule, by sums over thin discs.
std::array<double, 3> sumOfDiscs(double radius, double half) {
  constexpr int kDiscs = 400'000;
  const double step = 2 * (half + radius) / kDiscs;
  double volume = 0;
  double across = 0;
  double along = 0;
  for (int n = 0; n < kDiscs; ++n) {
    const double z = -half - radius + (n + 0.5) * step;
    const double beyond = std::max(std::abs(z) - half, 0.0);
    const double square = radius * radius - beyond * beyond;
    const double disc = std::numbers::pi * square * step;
    volume += disc;
    across += disc * (square / 4 + z * z);
    along += disc * square / 2;
  }
  return {volume, across / volume, along / volume};
}

TEST(MjcfMasses, OfCapsulesAreThoseOfManyDiscs) {
  const ScratchFolder folder;
  const auto [volume, across, along] = sumOfDiscs(0.2, 0.3);
  const auto capsule = massWith(folder, "<geom type='capsule' size='.2 .3' density='1'/>");
  EXPECT_NEAR(capsule.mass, volume, 1e-8);
  EXPECT_NEAR(capsule.moments[0] / capsule.mass, across, 1e-8);
  EXPECT_NEAR(capsule.moments[2] / capsule.mass, along, 1e-8);
}

TEST(MjcfMasses, OfMeshesAreThoseOfTheSameBox) {
  const ScratchFolder folder;
  (void)folder.write("robots/box.obj", objFile(unevenBox()));
  // The uneven box spans (0.5, 0.25, 1) to (1.5, 2.25, 4) in its file.
  for (const char* scale : {"1 1 1", "1 -1 1"}) {
    const double side = scale[2] == '-' ? -1 : 1;
    const auto mesh =
        massWith(folder, "<geom type='mesh' mesh='box' euler='30 40 50' pos='1 2 3'/>",
                 fmt::format("<asset><mesh file='box.obj' scale='{}'/></asset>", scale));
    const auto box =
        massWith(folder, fmt::format("<frame euler='30 40 50' pos='1 2 3'>"
                                     "<geom type='box' size='.5 1 1.5' pos='1 {} 2.5'/></frame>",
                                     1.25 * side));
    EXPECT_NEAR(mesh.mass, box.mass, box.mass * kFloatRounding);
    EXPECT_THAT(mesh.center, Pointwise(DoubleNear(kFloatRounding), box.center));
    EXPECT_THAT(mesh.moments, Pointwise(DoubleNear(box.mass * kFloatRounding * 4), box.moments));
  }
}

TEST(MjcfMasses, OfSeveralShapesAreTheirSum) {
  const ScratchFolder folder;
  // Two halves of a box.
  const auto halves = massWith(folder,
                               "<geom type='box' size='.5 1 .5' pos='-.5 0 0' density='7'/>"
                               "<geom type='box' size='.5 1 .5' pos='.5 0 0' mass='14'/>");
  const auto whole = massWith(folder, "<geom type='box' size='1 1 .5' density='7'/>");
  EXPECT_NEAR(halves.mass, whole.mass, kRounding);
  EXPECT_THAT(halves.center, Pointwise(DoubleNear(kRounding), whole.center));
  EXPECT_THAT(halves.moments, Pointwise(DoubleNear(kRounding), whole.moments));
}

TEST(MjcfMasses, ComeFromWhereTheCompilerSays) {
  const ScratchFolder folder;
  constexpr const char* kBody =
      "<inertial pos='0 0 0' mass='5' diaginertia='1 1 1'/>"
      "<geom type='box' size='.5 .5 .5' density='3'/>"
      "<geom type='box' size='.5 .5 .5' density='4' group='3'/>";
  EXPECT_EQ(massWith(folder, kBody).mass, 5);
  EXPECT_NEAR(massWith(folder, kBody, "<compiler inertiafromgeom='true'/>").mass, 7, kRounding);
  EXPECT_NEAR(
      massWith(folder, kBody, "<compiler inertiafromgeom='true' inertiagrouprange='3 3'/>").mass, 4,
      kRounding);
  EXPECT_NEAR(
      massWith(folder, kBody, "<compiler inertiafromgeom='true' inertiagrouprange='0 2'/>").mass, 3,
      kRounding);
  EXPECT_NEAR(massWith(folder, kBody, "<compiler settotalmass='10'/>").mass, 10, kRounding);
  EXPECT_NEAR(massWith(folder, kBody, "<compiler settotalmass='10'/>").moments[0], 2, kRounding);
  const auto none = mjcfMasses(folder, mjcfText("<body name='a'><geom size='1'/></body>",
                                                "<compiler inertiafromgeom='false'/>"));
  EXPECT_THAT(none, IsEmpty());
}

TEST(MjcfMasses, OfNothingAreNone) {
  const ScratchFolder folder;
  EXPECT_THAT(mjcfMasses(folder, mjcfText("<body name='a'><geom size='1' mass='0'/>"
                                          "<geom size='1' density='0'/></body>")),
              IsEmpty());
  // A mesh that is missing weighs nothing; the import tells of it.
  const std::string missing = mjcfText(
      "<body name='a'><geom type='mesh' mesh='m' mass='2'/><geom size='1' mass='3'/></body>",
      "<asset><mesh file='m.stl'/></asset>");
  EXPECT_EQ(mjcfMasses(folder, missing).at(0).mass, 3);
}

TEST(MjcfMasses, MayBeMalformedWhereNobodyAsksForThem) {
  const ScratchFolder folder;
  const std::string text =
      mjcfText("<body name='a'><geom size='1'/><inertial pos='0 0 0' mass='much'/></body>");
  EXPECT_TRUE(importMjcf(folder, text).has_value());
  const auto masses = bake::readInertials(folder.path() / "robots/r.xml");
  ASSERT_FALSE(masses.has_value());
  EXPECT_EQ(masses.error().message, "<inertial> has mass=\"much\", expected a finite number");
}

}  // namespace
}  // namespace galactic::test::mjcf::masses_test
