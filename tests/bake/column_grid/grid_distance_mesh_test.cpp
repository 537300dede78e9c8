// Distances in baked grids against those to the triangles: off by no more than cells account for.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "column_grid/grid_distance.h"
#include "galactic/bake/column_engines.h"
#include "galactic/bake/columns.h"
#include "support/asset_mesh.h"
#include "support/oracles/distance_oracle.h"
#include "support/oracles/encoded_grid_view.h"
#include "support/scene_meshes.h"

namespace galactic::bake::grid_distance_mesh_test {
namespace {

constexpr std::uint32_t kSeed = 20261201;
constexpr float kSpacing = 0.03F;
constexpr float kMost = 0.15F;
/// Codes of heights, contactMargin() and rounding.
constexpr double kTolerance = 2e-4;

/// The least and the most by which distances in a grid are greater than those to the mesh, at free
/// places within the mesh's bounds.
struct Errors {
  double least = 0;
  double most = 0;
  int near = 0;
  int asked = 0;
  /// Distances whose sign is not what a query says, of all places.
  int contradicting = 0;
};

/// How far a place is from where a grid ends.
double toEdge(const GridFrame& frame, const Vec3& p) {
  const auto end = [&](float min, std::uint32_t columns) {
    return min + static_cast<float>(columns) * frame.spacing;
  };
  return static_cast<double>(std::min({p.x - frame.min_x, end(frame.min_x, frame.columns_x) - p.x,
                                       p.z - frame.min_z, end(frame.min_z, frame.columns_z) - p.z,
                                       p.y - frame.heights.lo, frame.heights.hi - p.y}));
}

Errors errorsOf(const TriangleMesh& mesh, const test::DistanceOracle& oracle, float radius,
                Coverage coverage) {
  constexpr int kPlaces = 4000;
  const GridFrame frame = makeGridFrame(mesh.bounds, radius, kSpacing).value();
  // All that is free, in rooms or not: where the grid says no, there is a triangle.
  const EncodedGrid grid = encodeGrid(exactColumns(mesh, frame, coverage, 2).columns);
  const ColumnGrid view = test::viewOf(grid);
  const detail::GridDistance distances(view);
  std::mt19937 random(kSeed);
  const auto between = [&](float lo, float hi) {
    return std::uniform_real_distribution<float>(lo, hi)(random);
  };
  Errors errors;
  for (int n = 0; n < kPlaces; ++n) {
    const Vec3 place{between(mesh.bounds.min.x, mesh.bounds.max.x),
                     between(mesh.bounds.min.y, mesh.bounds.max.y),
                     between(mesh.bounds.min.z, mesh.bounds.max.z)};
    const auto ask = [&](detail::Directions directions) {
      return distances.at(place, kMost, directions).distance;
    };
    const bool is_free = view.clearance(place) == Clearance::kFree;
    for (const auto directions : {detail::Directions::kAll, detail::Directions::kLevel}) {
      errors.contradicting += std::signbit(ask(directions)) == is_free ? 1 : 0;
    }
    if (!is_free) continue;
    const auto found = static_cast<double>(ask(detail::Directions::kAll));
    const double to_mesh = oracle.distance(test::toPoint(place)) - static_cast<double>(radius);
    const double real = std::min({to_mesh, toEdge(frame, place), static_cast<double>(kMost)});
    errors.least = std::min(errors.least, found - real);
    errors.most = std::max(errors.most, found - real);
    errors.near += real < static_cast<double>(kMost) ? 1 : 0;
    ++errors.asked;
  }
  return errors;
}

void expectErrorsWithinCells(const TriangleMesh& mesh) {
  constexpr double kDiagonal = static_cast<double>(kSpacing) * 1.4142136;
  const test::DistanceOracle oracle(mesh, 0.28);
  for (const float radius : {0.05F, 0.12F}) {
    const Errors column = errorsOf(mesh, oracle, radius, Coverage::kColumn);
    EXPECT_GT(column.least, -kDiagonal / 2 - kTolerance) << radius;
    EXPECT_LT(column.most, kDiagonal / 2 + kTolerance) << radius;
    // The bounds are not far from what happens.
    EXPECT_LT(column.least, -kDiagonal / 4) << radius;
    EXPECT_GT(column.most, kDiagonal / 4) << radius;
    const Errors cell = errorsOf(mesh, oracle, radius, Coverage::kCell);
    EXPECT_GT(cell.least, -kDiagonal - kTolerance) << radius;
    EXPECT_LT(cell.most, kTolerance) << radius;
    for (const Errors& errors : {column, cell}) {
      EXPECT_EQ(errors.contradicting, 0);
      EXPECT_GT(errors.near, errors.asked / 10);
      EXPECT_LT(errors.near, errors.asked * 9 / 10);
    }
  }
}

TEST(DistancesInABakedGrid, AreOffByHalfACellAtMost) {
  expectErrorsWithinCells(test::furnishedRoom(kSeed));
}

TEST(DistancesInABakedGrid, AreOffByHalfACellAtMostInAnApartment) {
  if (!test::hasAsset(test::kApartmentStage)) {
    GTEST_SKIP() << test::kApartmentStage << " is not on this machine";
  }
  const auto mesh = test::loadAsset(test::kApartmentStage);
  ASSERT_TRUE(mesh) << mesh.error().message;
  expectErrorsWithinCells(*mesh);
}

}  // namespace
}  // namespace galactic::bake::grid_distance_mesh_test
