// Meshes as scans and exporters leave them: nothing may be left uncovered, whatever they are.
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "galactic/bake/sphere_set.h"
#include "sphere_set/shapes.h"

namespace galactic::bake::broken_meshes_test {
namespace {

using test::KnownSolid;
using test::MeshBuilder;

constexpr std::uint32_t kSeed = 20250404;

/// The largest gap over random points of the mesh.
double largestGap(const TriangleMesh& mesh, const SphereSet& set, const std::vector<float>& radii) {
  double largest = 0;
  for (const Point& p : test::randomSurfacePoints(mesh, kSeed, 5000)) {
    largest = std::max(largest, test::gapOf(p, set.spheres, radii));
  }
  return largest;
}

/// The cylinder of these tests, after `damage` was done to it.
TriangleMesh damaged(const std::function<void(TriangleMesh&)>& damage) {
  TriangleMesh mesh = test::cylinder(0.05, 0.2).mesh;
  damage(mesh);
  return mesh;
}

TEST(SphereSetOfABrokenMesh, IsThatOfTheWholeOne) {
  const SphereSetOptions options;
  const auto whole = fitSphereSet(test::cylinder(0.05, 0.2).mesh, options);
  ASSERT_TRUE(whole);
  const auto flipped = damaged([](TriangleMesh& mesh) {
    for (std::size_t t = 0; t < mesh.triangles.size(); t += 2) {
      std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
    }
  });
  const auto with_holes = damaged([](TriangleMesh& mesh) {
    std::vector<Triangle> kept;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      if (t % 61 != 7) kept.push_back(mesh.triangles[t]);
    }
    mesh.triangles = kept;
  });
  const auto with_shells = damaged([](TriangleMesh& mesh) {
    for (const double share : {0.9, 0.5}) {
      const TriangleMesh inner = test::cylinder(0.05 * share, 0.2 * share).mesh;
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      mesh.vertices.insert(mesh.vertices.end(), inner.vertices.begin(), inner.vertices.end());
      for (const Triangle& t : inner.triangles) {
        mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
      }
    }
  });
  for (const auto& [name, mesh] : {std::pair<std::string, TriangleMesh>{"flipped", flipped},
                                   {"holes", with_holes},
                                   {"shells", with_shells}}) {
    SCOPED_TRACE(name);
    const auto set = fitSphereSet(mesh, options);
    ASSERT_TRUE(set) << set.error().message;
    EXPECT_LE(set->spheres.size(), whole->spheres.size() + 1);
    EXPECT_LE(largestGap(test::cylinder(0.05, 0.2).mesh, *set, options.radii),
              set->guaranteed_gap + 0.001);
    EXPECT_EQ(set->quality.thin_points, 0U);
  }
}

/// What has no inside at all.
TEST(SphereSetOfASheet, LeavesNothingUncovered) {
  MeshBuilder sheet;
  sheet.floor({0, 0, 0}, {0.12F, 0, 0.1F}, 0);
  MeshBuilder triangle;
  triangle.triangle({0, 0, 0}, {0.1F, 0, 0}, {0, 0.02F, 0.1F});
  MeshBuilder needle;
  needle.triangle({0, 0, 0}, {0.3F, 0.0001F, 0}, {0.3F, 0, 0});
  MeshBuilder open_box;
  open_box.floor({0, 0, 0}, {0.12F, 0, 0.1F}, 0)
      .quad({Vec3{0, 0, 0}, {0.12F, 0, 0}, {0.12F, 0.08F, 0}, {0, 0.08F, 0}});
  MeshBuilder soup;
  soup.soup(kSeed, 20, {{0, 0, 0}, {0.1F, 0.1F, 0.1F}}, 0.05F);
  for (const auto& [name, builder] :
       {std::pair{"sheet", sheet}, std::pair{"triangle", triangle}, std::pair{"needle", needle},
        std::pair{"open box", open_box}, std::pair{"soup", soup}}) {
    const TriangleMesh mesh = builder.build();
    for (const bool with_support : {false, true}) {
      SCOPED_TRACE(testing::Message() << name << (with_support ? " on a plane" : ""));
      SphereSetOptions options;
      if (with_support) options.support = HalfSpace{{0, 1, 0}, mesh.bounds.min.y};
      const auto set = fitSphereSet(mesh, options);
      ASSERT_TRUE(set) << set.error().message;
      EXPECT_LE(largestGap(mesh, *set, options.radii),
                name == std::string("soup") ? 0.03 : set->guaranteed_gap);
      // Lifted onto the plane a sphere sticks out by its diameter; the search's slack adds.
      EXPECT_LE(set->guaranteed_protrusion, with_support ? 0.032 : 0.020);
    }
  }
}

TEST(SphereSetOfThinParts, CoversThemWhateverTau) {
  // A pan: a disc 3 mm thick with a handle of 4 mm.
  MeshBuilder builder;
  builder.box({-0.05F, 0, -0.05F}, {0.05F, 0.003F, 0.05F});
  builder.box({0.05F, 0, -0.002F}, {0.2F, 0.004F, 0.002F});
  const TriangleMesh mesh = builder.build();
  SphereSetOptions options;
  options.eps = 0.01F;
  for (const float tau : {0.0F, 0.005F, 0.01F}) {
    SCOPED_TRACE(tau);
    options.tau = tau;
    const auto set = fitSphereSet(mesh, options);
    ASSERT_TRUE(set);
    EXPECT_LE(largestGap(mesh, *set, options.radii), set->guaranteed_gap);
    EXPECT_LE(set->guaranteed_gap, 0.0125);
    EXPECT_GT(set->quality.thin_points, 0U);
    EXPECT_LE(set->guaranteed_protrusion, 0.017);
    EXPECT_FALSE(set->meets_tolerances);
  }
}

TEST(SphereSetOfATinyObject, IsOneSphere) {
  for (const double size : {0.002, 0.0002}) {
    SCOPED_TRACE(size);
    const auto set = fitSphereSet(test::box(size, size, size).mesh, {});
    ASSERT_TRUE(set);
    EXPECT_EQ(set->spheres.size(), 1U);
    EXPECT_LT(set->quality.gap.max, 0.015);
  }
}

TEST(SphereSetOfALargeObject, IsBoundedInWorkAndSaysWhatItMisses) {
  MeshBuilder builder;
  builder.box({0, 0, 0}, {9, 0.5F, 0.5F});
  const TriangleMesh mesh = builder.build();
  SphereSetOptions options;
  options.eps = 0.1F;
  options.tau = 0.1F;
  const auto set = fitSphereSet(mesh, options);
  ASSERT_TRUE(set);
  EXPECT_LE(largestGap(mesh, *set, options.radii), set->guaranteed_gap);
  EXPECT_LE(set->guaranteed_gap, 0.15);
}

TEST(SphereSetOfAnObject, FarFromItsOriginIsAsGood) {
  MeshBuilder builder;
  builder.box({300, 20, -400}, {300.1F, 20.06F, -399.8F});
  const TriangleMesh mesh = builder.build();
  const auto set = fitSphereSet(mesh, {});
  ASSERT_TRUE(set);
  EXPECT_LE(largestGap(mesh, *set, SphereSetOptions{}.radii), set->guaranteed_gap);
}

}  // namespace
}  // namespace galactic::bake::broken_meshes_test
