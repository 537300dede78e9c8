#include "distance/triangle_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "column_grid/triangle_interval.h"
#include "galactic/bake/triangle_mesh.h"
#include "support/oracles/triangle_corners.h"
#include "support/random_points.h"
#include "support/test_meshes.h"

namespace galactic::bake::triangle_tree_test {
namespace {

using test::MeshBuilder;

constexpr std::uint32_t kSeed = 20250402;

std::vector<Facet> facetsOf(const TriangleMesh& mesh) {
  std::vector<Facet> facets;
  for (const Triangle& t : mesh.triangles) facets.push_back(cornersOf(mesh, t));
  return facets;
}

double bruteForce(const TriangleMesh& mesh, const Vec3d& p) {
  double least = HUGE_VAL;
  for (const test::Corners& corners : test::allCorners(mesh)) {
    least = std::min(least, squaredDistance({p.x, p.y, p.z}, corners));
  }
  return std::sqrt(least);
}

TEST(TriangleTree, FindsTheNearestPointOfASoup) {
  MeshBuilder builder;
  const TriangleMesh mesh = builder.soup(kSeed, 300, {{-1, -1, -1}, {1, 1, 1}}, 0.3F).build();
  const TriangleTree tree(facetsOf(mesh));
  int within = 0;
  for (const Vec3d& p : test::randomPoints(kSeed, mesh.bounds, 0.2F, 400)) {
    const double truth = bruteForce(mesh, p);
    const NearestPoint found = tree.nearest(p);
    EXPECT_NEAR(std::sqrt(found.squared), truth, 1e-7);
    EXPECT_NEAR(norm(found.point - p), truth, 1e-7);
    const NearestPoint limited = tree.nearest(p, {.squared_limit = 0.01});
    EXPECT_EQ(limited.facet != kNoFacet, truth < 0.1);
    within += truth < 0.1 ? 1 : 0;
  }
  EXPECT_GT(within, 40) << "seed " << kSeed;
  EXPECT_LT(within, 360) << "seed " << kSeed;
}

/// Facets that no plane parts, and facets each of which is half as far as the one before, so that
/// planes part off one at a time.
TEST(TriangleTree, FindsTheNearestOfFacetsThatAreHardToPart) {
  std::vector<Facet> facets(100, Facet{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}});
  float at = 1e6F;
  for (int n = 0; n < 120; ++n, at /= 2) {
    facets.push_back({Vec3{at, 0, 5}, Vec3{at, 0, 6}, Vec3{at, 1, 5}});
  }
  const TriangleTree tree(facets);
  for (const Vec3d p : {Vec3d{0.2, 0.2, 1}, Vec3d{3e5, 0, 5}, Vec3d{-1, 0, 5.2}, Vec3d{9, 9, 9}}) {
    double nearest = HUGE_VAL;
    for (const Facet& facet : facets) {
      nearest = std::min(nearest, squaredNorm(nearestOnFacet(p, facet) - p));
    }
    EXPECT_DOUBLE_EQ(tree.nearest(p).squared, nearest);
  }
}

/// Along one of the axes nothing parts them.
TEST(TriangleTree, FindsTheNearestOfFacetsInOnePlane) {
  MeshBuilder builder;
  for (float x = -1; x < 1; x += 0.125F) {
    for (float z = -1; z < 1; z += 0.25F) builder.floor({x, 0, z}, {x + 0.1F, 0, z + 0.2F}, 2);
  }
  const TriangleMesh mesh = builder.build();
  const TriangleTree tree(facetsOf(mesh));
  for (const Vec3d& p : test::randomPoints(kSeed, mesh.bounds, 0.5F, 200)) {
    EXPECT_NEAR(std::sqrt(tree.nearest(p).squared), bruteForce(mesh, p), 1e-7);
  }
}

TEST(TriangleTree, OfNothingFindsNothing) {
  EXPECT_EQ(TriangleTree({}).nearest({0, 0, 0}).facet, kNoFacet);
}

}  // namespace
}  // namespace galactic::bake::triangle_tree_test
