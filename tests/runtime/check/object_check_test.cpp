// One wrong value per field of an object pack whose hash is right: each has its own message.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "galactic/object_set.h"
#include "galactic/pack.h"
#include "runtime/check/pack_damage.h"
#include "runtime/check/pack_offence.h"
#include "support/packs/object_pack_builder.h"

namespace galactic::test::object_check_test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr double kNanDouble = std::numeric_limits<double>::quiet_NaN();

using Offence = PackOffence<ObjectPackFields>;

/// An offence of the first object.
Offence inObject(const std::string& field, const std::string& message,
                 std::function<void(ObjectFields&)> change) {
  return {"objects.objects[0]." + field, message,
          [change = std::move(change)](ObjectPackFields& f) { change(f.objects[0]); }};
}

void refuse(const std::vector<Offence>& offences) { expectRefused(smallObjects(), offences); }

TEST(ObjectCheck, AcceptsTheObjectsThatTheOffencesBelowStartFrom) {
  const AlignedBytes bytes = buildPack(smallObjects());
  const Result<PackFile> pack = PackFile::view(bytes.bytes(), "made.pack");
  ASSERT_TRUE(pack.has_value()) << pack.error().text();
}

TEST(ObjectCheck, RefusesWrongValuesOfTheSet) {
  refuse({
      {"objects.radii", "has 0 elements, expected 1 to 8",
       [](ObjectPackFields& f) { f.radii.clear(); }},
      {"objects.radii", "has 9 elements, expected 1 to 8",
       [](ObjectPackFields& f) { f.radii.assign(9, 1); }},
      {"objects.radii[0]", "is nan m after 0 m, expected ascending radii of up to 800 m",
       [](ObjectPackFields& f) { f.radii[0] = kNan; }},
      {"objects.radii[0]", "is 0 m after 0 m, expected ascending radii of up to 800 m",
       [](ObjectPackFields& f) { f.radii[0] = 0; }},
      {"objects.radii[1]", "is 0.015 m after 0.015 m, expected ascending radii of up to 800 m",
       [](ObjectPackFields& f) { f.radii[1] = f.radii[0]; }},
      {"objects.radii[1]", "is inf m after 0.015 m, expected ascending radii of up to 800 m",
       [](ObjectPackFields& f) { f.radii[1] = kInfinity; }},
      {"objects.objects", "is empty, expected at least one object",
       [](ObjectPackFields& f) { f.objects.clear(); }},
      {"objects.objects[1].name", "does not come after its predecessor's, expected ascending names",
       [](ObjectPackFields& f) { f.objects[1].name = "bowl"; }},
      {"objects.objects[1].name", "does not come after its predecessor's, expected ascending names",
       [](ObjectPackFields& f) { f.objects[0].name = "nut"; }},
  });
}

TEST(ObjectCheck, RefusesWrongBoxes) {
  const std::string rigid =
      "is missing or not a rigid transform, expected up to 800 m and a unit quaternion";
  const std::string lengths = "are missing or not lengths, expected more than 0 and up to 800 m";
  const std::string volumes = "are missing or not finite, expected volumes of 0 or more";
  refuse({
      inObject("name", "is empty, expected the object's name",
               [](ObjectFields& o) { o.name.clear(); }),
      inObject("box_pose", rigid, [](ObjectFields& o) { o.box_pose.reset(); }),
      inObject("box_pose", rigid, [](ObjectFields& o) { o.box_pose->translation.y = kNan; }),
      inObject("box_pose", rigid, [](ObjectFields& o) { o.box_pose->rotation.w = 0.9F; }),
      inObject("box_pose", rigid, [](ObjectFields& o) { o.box_pose->rotation.x = kNan; }),
      inObject("box_half_extents", lengths, [](ObjectFields& o) { o.box_half_extents.reset(); }),
      inObject("box_half_extents", lengths, [](ObjectFields& o) { o.box_half_extents->y = 0; }),
      inObject("box_half_extents", lengths, [](ObjectFields& o) { o.box_half_extents->z = -1; }),
      inObject("box_half_extents", lengths,
               [](ObjectFields& o) { o.box_half_extents->x = kInfinity; }),
      inObject("box_fit", "is 3, expected a value up to 2", [](ObjectFields& o) { o.box_fit = 3; }),
      inObject("box_statistics", volumes, [](ObjectFields& o) { o.box_statistics.reset(); }),
      inObject("box_statistics", volumes, [](ObjectFields& o) { o.box_statistics->volume = -1; }),
      inObject("box_statistics", volumes,
               [](ObjectFields& o) { o.box_statistics->axis_aligned = kNanDouble; }),
      inObject("box_statistics", volumes,
               [](ObjectFields& o) { o.box_statistics->pca = kNanDouble; }),
  });
}

TEST(ObjectCheck, RefusesWrongSpheres) {
  const std::string order =
      "comes before its predecessor, expected descending radii, then ascending centers";
  refuse({
      inObject("spheres", "is empty, expected at least one sphere",
               [](ObjectFields& o) { o.spheres.clear(); }),
      inObject("spheres[1].center", "is farther than 800 m or not finite, expected coordinates",
               [](ObjectFields& o) { o.spheres[1].center.z = kNan; }),
      inObject("spheres[0].radius_index", "is 2, expected less than the number of radii 2",
               [](ObjectFields& o) { o.spheres[0].radius_index = 2; }),
      inObject("spheres[3].radius_index", "is 4294967295, expected less than the number of radii 2",
               [](ObjectFields& o) { o.spheres[3].radius_index = 0xffffffff; }),
      inObject("spheres[1]", order, [](ObjectFields& o) { o.spheres[0].radius_index = 0; }),
      inObject("spheres[2]", order, [](ObjectFields& o) { o.spheres[2].center.x = -0.06F; }),
      inObject("spheres[3]", order, [](ObjectFields& o) { o.spheres[3].center.y = 0.04F; }),
      inObject("spheres[2]", order, [](ObjectFields& o) { o.spheres[2].radius_index = 1; }),
  });
}

TEST(ObjectCheck, RefusesWrongSphereStatistics) {
  const auto in = [](const std::string& field, const std::string& message, auto change) {
    return inObject("sphere_statistics." + field, message,
                    [=](ObjectFields& o) { change(o.statistics); });
  };
  using Fields = SphereStatisticsFields;
  const std::string number = ", expected a finite number of 0 or more";
  const std::string length = " m, expected a finite length of 0 or more";
  refuse({
      in("eps", "is nan" + number, [](Fields& s) { s.eps = kNan; }),
      in("tau", "is -1" + number, [](Fields& s) { s.tau = -1; }),
      in("gap.mean", "is missing, expected the lengths measured", [](Fields& s) { s.gap.reset(); }),
      in("gap.mean", "is -1" + length, [](Fields& s) { s.gap->mean = -1; }),
      in("gap.max", "is nan" + length, [](Fields& s) { s.gap->max = kNanDouble; }),
      in("gap.p95", "is 0.005 m, expected 0 to the maximum of 0.004 m",
         [](Fields& s) { s.gap->p95 = 0.005; }),
      in("protrusion.mean", "is missing, expected the lengths measured",
         [](Fields& s) { s.protrusion.reset(); }),
      in("protrusion.p95", "is nan m, expected 0 to the maximum of 0.004 m",
         [](Fields& s) { s.protrusion->p95 = kNanDouble; }),
      in("volume_ratio", "is -1" + number, [](Fields& s) { s.volume_ratio = -1; }),
      in("guaranteed_gap", "is nan" + number, [](Fields& s) { s.guaranteed_gap = kNanDouble; }),
      in("guaranteed_protrusion", "is inf" + number,
         [](Fields& s) { s.guaranteed_protrusion = std::numeric_limits<double>::infinity(); }),
  });
}

TEST(ObjectCheck, RefusesWrongHullPlanes) {
  const auto in = [](const std::string& field, const std::string& message, auto change) {
    return inObject(field, message, [=](ObjectFields& o) {
      o.hull_planes.emplace(2, HullPlane{{0, 1, 0}, 0.2F});
      change(*o.hull_planes);
    });
  };
  using Planes = std::vector<HullPlane>;
  refuse({
      in("hull_planes", "has 129 planes, expected up to 128",
         [](Planes& p) { p.resize(129, p.front()); }),
      in("hull_planes[1].normal", "is not of unit length, expected a direction",
         [](Planes& p) { p[1].normal.x = 0.5F; }),
      in("hull_planes[0].normal", "is not of unit length, expected a direction",
         [](Planes& p) { p[0].normal.y = kNan; }),
      in("hull_planes[1].offset", "is nan m, expected up to 1386 m",
         [](Planes& p) { p[1].offset = kNan; }),
      in("hull_planes[1].offset", "is -1387 m, expected up to 1386 m",
         [](Planes& p) { p[1].offset = -1387; }),
  });
}

TEST(ObjectCheck, RefusesWrongStablePoses) {
  refuse({
      inObject("stable_poses", "is empty, expected at least one pose",
               [](ObjectFields& o) { o.stable_poses.clear(); }),
      inObject("stable_poses[1].rotation", "is not a unit quaternion, expected a rotation",
               [](ObjectFields& o) { o.stable_poses[1].rotation.x = 0.5F; }),
      inObject("stable_poses[0].height", "is nan m, expected up to 1386 m",
               [](ObjectFields& o) { o.stable_poses[0].height = kNan; }),
      inObject("stable_poses[0].likelihood", "is 1.5, expected 0 to 1: the likeliest first",
               [](ObjectFields& o) { o.stable_poses[0].likelihood = 1.5F; }),
      inObject("stable_poses[0].likelihood", "is nan, expected 0 to 1: the likeliest first",
               [](ObjectFields& o) { o.stable_poses[0].likelihood = kNan; }),
      inObject("stable_poses[1].likelihood", "is 0.8, expected 0 to 0.75: the likeliest first",
               [](ObjectFields& o) { o.stable_poses[1].likelihood = 0.8F; }),
      inObject("stable_poses[1].likelihood", "is -1, expected 0 to 0.75: the likeliest first",
               [](ObjectFields& o) { o.stable_poses[1].likelihood = -1; }),
  });
}

TEST(ObjectCheck, RefusesWrongBoundsAndCounts) {
  refuse({
      inObject("bounds", "are missing, expected the mesh's bounds",
               [](ObjectFields& o) { o.bounds.reset(); }),
      inObject("bounds", "reach farther than 800 m or are not finite, expected coordinates",
               [](ObjectFields& o) { o.bounds->max.y = kInfinity; }),
      inObject("bounds", "have a minimum (-0.1, 1, -0.1) above the maximum (0.1, 0.2, 0.1)",
               [](ObjectFields& o) { o.bounds->min.y = 1; }),
      inObject("import_statistics.format", "is empty, expected a format's name",
               [](ObjectFields& o) { o.format.clear(); }),
      inObject("import_statistics.triangles_read",
               "is 0, expected at least the 1 degenerate and 0 duplicate triangles dropped",
               [](ObjectFields& o) { o.triangles_read = 0; }),
      inObject("import_statistics.triangles", "is 6, expected the 5 that remain of those read",
               [](ObjectFields& o) { o.triangles = 6; }),
  });
}

TEST(ObjectCheck, RefusesWrongSurfaces) {
  refuse({
      inObject("surface.positions[2]", "is farther than 800 m or not finite, expected coordinates",
               [](ObjectFields& o) { o.surface.positions[2].x = kNan; }),
      inObject("surface.triangles", "has 11 elements, expected three per triangle",
               [](ObjectFields& o) { o.surface.triangles.pop_back(); }),
      inObject("surface.triangles[4]", "is not the index of one of the 4 positions",
               [](ObjectFields& o) { o.surface.triangles[4] = 4; }),
      inObject("surface.triangles[11]", "is not the index of one of the 4 positions",
               [](ObjectFields& o) { o.surface.triangles[11] = 0xffffffff; }),
      inObject("surface.colors", "has 3 elements, expected none or 4, one per position",
               [](ObjectFields& o) { o.surface.colors.pop_back(); }),
  });
}

TEST(DamagedObjectPack, IsRefusedAtEachLengthOfATruncation) {
  expectEachTruncationRefused(buildPack(smallObjects()));
}

TEST(DamagedObjectPack, IsRefusedWithBytesTooMany) {
  expectBytesTooManyRefused(buildPack(smallObjects()));
}

TEST(DamagedObjectPack, IsRefusedAfterEachFlipOfASingleBit) {
  expectEachBitFlipRefused(buildPack(smallObjects()));
}

/// Reads everything that the views show; a sanitizer sees a read outside the pack.
void readEverything(const PackFile& pack) {
  const Result<ObjectSet> set = ObjectSet::from(pack);
  ASSERT_TRUE(set.has_value());
  ASSERT_FALSE(set->objects().empty());
  for (const ObjectModel& object : set->objects()) {
    ASSERT_FALSE(object.name.empty());
    ASSERT_EQ(set->find(object.name), static_cast<std::size_t>(&object - set->objects().data()));
    ASSERT_FALSE(object.spheres.empty());
    for (const SetSphere& sphere : object.spheres) {
      ASSERT_GT(set->radii()[sphere.radius_index], 0);
      for (const float coordinate : {sphere.center.x, sphere.center.y, sphere.center.z}) {
        ASSERT_TRUE(std::isfinite(coordinate));
      }
    }
    float share = 0;
    for (const StablePose& pose : object.stable_poses) share += pose.likelihood;
    ASSERT_GE(share, 0);
    ASSERT_GT(object.box.half_extents.x, 0);
  }
}

TEST(DamagedObjectPack, WithARecomputedHashIsRefusedOrSafeToReadAfterEachFlip) {
  expectFlipsWithARightHashRefusedOrUsable(buildPack(smallObjects()), PackKind::kObjects,
                                           readEverything);
}

}  // namespace
}  // namespace galactic::test::object_check_test
