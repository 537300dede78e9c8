// Planes for beams against all pairs of cells.
#include "sensors/scan_plane.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "scattered_grid.h"

namespace galactic::test::scan_plane_test {
namespace {

using sensors::ScanPlane;
using sensors::ScanPlaneView;

std::uint8_t byteAt(const ScanPlaneView& view, std::int64_t i, std::int64_t k) {
  return view.cells[(k + 1) * view.columns_x + i + 1];
}

/// Distance between the squares of two cells, in cells.
double gap(std::int64_t di, std::int64_t dk) {
  const auto beside = [](std::int64_t d) {
    return static_cast<double>(std::max<std::int64_t>(std::abs(d) - 1, 0));
  };
  return std::hypot(beside(di), beside(dk));
}

double nearestBlocked(const ScatteredGrid& grid, std::int64_t i, std::int64_t k) {
  double least = std::numeric_limits<double>::infinity();
  for (std::int64_t b = -1; b <= grid.columnsZ(); ++b) {
    for (std::int64_t a = -1; a <= grid.columnsX(); ++a) {
      if (grid.isBlocked(a, b)) least = std::min(least, gap(a - i, b - k));
    }
  }
  return least;
}

TEST(ScanPlane, PromisesTheDistanceToTheNearestBlockedCell) {
  int free = 0;
  int all = 0;
  for (std::uint32_t seed = 1; seed <= 12; ++seed) {
    const ScatteredGrid grid(seed, 20 + 3 * seed, 37);
    const ScanPlane plane(grid.view(), {kCutHeight, kCutHeight});
    const ScanPlaneView view = plane.view();
    for (std::int64_t k = 0; k < grid.columnsZ(); ++k) {
      for (std::int64_t i = 0; i < grid.columnsX(); ++i) {
        ++all;
        if (grid.isBlocked(i, k)) {
          ASSERT_EQ(byteAt(view, i, k), 0) << i << ", " << k;
          continue;
        }
        ++free;
        const double jumps =
            std::floor(nearestBlocked(grid, i, k) / static_cast<double>(sensors::kJump));
        ASSERT_EQ(byteAt(view, i, k), 1 + static_cast<int>(std::min(jumps, 254.0)))
            << "seed " << seed << " cell " << i << ", " << k;
      }
    }
  }
  EXPECT_GT(10 * free, all);
  EXPECT_LT(10 * free, 9 * all);
}

TEST(ScanPlane, IsBlockedAllAroundTheGrid) {
  const ScatteredGrid grid(3, 9, 5);
  const ScanPlane plane(grid.view(), {kCutHeight, kCutHeight});
  const ScanPlaneView view = plane.view();
  ASSERT_EQ(view.columns_x, 11);
  ASSERT_EQ(view.columns_z, 7);
  for (std::int64_t i = -1; i <= 9; ++i) {
    EXPECT_EQ(byteAt(view, i, -1), 0);
    EXPECT_EQ(byteAt(view, i, 5), 0);
  }
  for (std::int64_t k = -1; k <= 5; ++k) {
    EXPECT_EQ(byteAt(view, -1, k), 0);
    EXPECT_EQ(byteAt(view, 9, k), 0);
  }
  EXPECT_EQ(view.min_x, ScatteredGrid::kMinX - ScatteredGrid::kSpacing);
  EXPECT_EQ(view.min_z, ScatteredGrid::kMinZ - ScatteredGrid::kSpacing);
}

TEST(ScanPlane, DependsOnTheHeight) {
  const ScatteredGrid grid(5, 40, 40);
  const ScanPlane across(grid.view(), {kCutHeight, kCutHeight});
  EXPECT_LT(across.freeCells(), 1600U);
  EXPECT_GT(across.freeCells(), 160U);
  EXPECT_EQ(ScanPlane(grid.view(), {0.25F, 0.25F}).freeCells(), 1600U);
  EXPECT_EQ(ScanPlane(grid.view(), {1.75F, 1.75F}).freeCells(), 1600U);
  EXPECT_EQ(ScanPlane(grid.view(), {2.5F, 2.5F}).freeCells(), 0U);
}

TEST(ScanPlane, IsBlockedWhereAnyOfItsHeightsIs) {
  const ScatteredGrid grid(5, 40, 40);
  const std::size_t across = ScanPlane(grid.view(), {kCutHeight, kCutHeight}).freeCells();
  for (const Span& heights :
       {Span{0.25F, 1.75F}, Span{0.25F, kCutHeight}, Span{kCutHeight, 1.75F}}) {
    EXPECT_EQ(ScanPlane(grid.view(), heights).freeCells(), across);
  }
  EXPECT_EQ(ScanPlane(grid.view(), {0.25F, 0.3F}).freeCells(), 1600U);
  EXPECT_EQ(ScanPlane(grid.view(), {0.25F, 2.5F}).freeCells(), 0U);
}

TEST(ScanPlane, StopsPromisingWhereAByteEnds) {
  const ScatteredGrid grid(5, 400, 400);
  const ScanPlane plane(grid.view(), {0.25F, 0.25F});
  EXPECT_EQ(byteAt(plane.view(), 200, 200), 255);
}

}  // namespace
}  // namespace galactic::test::scan_plane_test
