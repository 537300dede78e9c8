// The frame of a grid, and the strips that triangles are sorted into.
#include "galactic/bake/columns.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <set>

#include "column_grid/column_at.h"
#include "column_grid/scatter/triangle_bins.h"
#include "layout/column_cell.h"
#include "support/test_meshes.h"

namespace galactic::bake::columns_test {
namespace {

constexpr std::uint32_t kSeed = 20250310;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr Bounds kRoom{{-1, 0, 2}, {3.01F, 2.5F, 5.01F}};

TEST(GridFrame, PadsTheSceneByTheRadiusAndOneCellInThePlane) {
  const GridFrame frame = makeGridFrame(kRoom, 0.12F, 0.03F).value();
  EXPECT_FLOAT_EQ(frame.min_x, -1.15F);
  EXPECT_FLOAT_EQ(frame.min_z, 1.85F);
  // 4.01 m and 3.01 m, and 15 cm to either side.
  EXPECT_EQ(frame.columns_x, 144U);
  EXPECT_EQ(frame.columns_z, 111U);
  EXPECT_EQ(frame.radius, 0.12F);
  EXPECT_EQ(frame.spacing, 0.03F);
}

TEST(GridFrame, PadsTheSceneByTheRadiusAndACentimeterInHeight) {
  const GridFrame frame = makeGridFrame(kRoom, 0.12F, 0.03F).value();
  EXPECT_FLOAT_EQ(frame.heights.lo, -0.13F);
  EXPECT_FLOAT_EQ(frame.heights.hi, 2.63F);
}

TEST(GridFrame, KeepsItsBorderColumnsOutOfReachOfTheScene) {
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<float> place(-500, 500);
  std::uniform_real_distribution<float> size(0, 20);
  std::uniform_real_distribution<float> length(0.005F, 0.3F);
  for (int round = 0; round < 2000; ++round) {
    const Vec3 min{place(random), place(random), place(random)};
    const Bounds bounds{min, {min.x + size(random), min.y + size(random), min.z + size(random)}};
    const float radius = length(random);
    const float spacing = std::min(2 * radius, length(random));
    const auto frame = makeGridFrame(bounds, radius, spacing);
    ASSERT_TRUE(frame) << "seed " << kSeed << ", round " << round;
    const auto r = static_cast<double>(radius);
    EXPECT_LT(frame->centerX(0), static_cast<double>(bounds.min.x) - r);
    EXPECT_LT(frame->centerZ(0), static_cast<double>(bounds.min.z) - r);
    EXPECT_GT(frame->centerX(frame->columns_x - 1), static_cast<double>(bounds.max.x) + r);
    EXPECT_GT(frame->centerZ(frame->columns_z - 1), static_cast<double>(bounds.max.z) + r);
    EXPECT_LT(static_cast<double>(frame->heights.lo), static_cast<double>(bounds.min.y) - r);
    EXPECT_GT(static_cast<double>(frame->heights.hi), static_cast<double>(bounds.max.y) + r);
  }
}

/// The error of a frame that must not be made.
Error errorOf(const Bounds& bounds, float radius, float spacing) {
  const auto frame = makeGridFrame(bounds, radius, spacing);
  EXPECT_FALSE(frame);
  return frame ? Error{} : frame.error();
}

TEST(GridFrame, RefusesARadiusUnderHalfTheSpacingAndSaysWhy) {
  const Error error = errorOf(kRoom, 0.01F, 0.03F);
  EXPECT_EQ(error.code, ErrorCode::kInvalidInput);
  EXPECT_EQ(error.where, "`radii`");
  EXPECT_EQ(error.message,
            "radius 0.01 m is under half the spacing of 0.03 m: neighboring columns could lie on "
            "both sides of a closed wall and the room would leak; use a spacing of at most 0.02 m");
}

TEST(GridFrame, AcceptsARadiusOfHalfTheSpacing) {
  EXPECT_TRUE(makeGridFrame(kRoom, 0.015F, 0.03F));
}

TEST(GridFrame, RefusesASpacingThatIsNoLength) {
  for (const float spacing : {0.0F, -0.03F, kNan, kInfinity}) {
    const Error error = errorOf(kRoom, 0.05F, spacing);
    EXPECT_EQ(error.code, ErrorCode::kInvalidInput);
    EXPECT_EQ(error.where, "`spacing`");
  }
  EXPECT_EQ(errorOf(kRoom, 0.05F, -0.5F).message, "is -0.5 m, expected at least 1e-05 m");
  EXPECT_EQ(errorOf(kRoom, 0.05F, 9e-6F).message, "is 9e-06 m, expected at least 1e-05 m");
}

TEST(GridFrame, RefusesARadiusThatIsNoLength) {
  for (const float radius : {0.0F, -0.05F, kNan, kInfinity}) {
    const Error error = errorOf(kRoom, radius, 0.03F);
    EXPECT_EQ(error.code, ErrorCode::kInvalidInput);
    EXPECT_EQ(error.where, "`radii`");
  }
}

TEST(GridFrame, RefusesMoreColumnsThanAGridMayHave) {
  const Bounds wide{{-400, 0, -300}, {400, 3, 300}};
  const Error error = errorOf(wide, 0.05F, 0.03F);
  EXPECT_EQ(error.code, ErrorCode::kInvalidInput);
  EXPECT_EQ(error.where, "`spacing`");
  EXPECT_EQ(error.message,
            "0.03 m over a scene of 800.2 x 600.2 m needs 533620038 columns, a grid has at most "
            "134217728; use a wider spacing, or check the scene's unit (`scale`)");
  EXPECT_TRUE(makeGridFrame(wide, 0.05F, 0.1F));
}

TEST(GridFrame, RefusesAbsurdBoundsWithoutOverflow) {
  const Bounds absurd{{-3e38F, 0, -3e38F}, {3e38F, 1, 3e38F}};
  EXPECT_EQ(errorOf(absurd, 0.05F, 0.03F).where, "`spacing`");
  EXPECT_EQ(errorOf({{kNan, 0, 0}, {1, 1, 1}}, 0.05F, 0.03F).where, "`spacing`");
  EXPECT_EQ(errorOf({{0, 0, 0}, {kInfinity, 1, 1}}, 0.05F, 0.03F).where, "`spacing`");
}

TEST(GridFrame, HasNoMoreCellsThanTheLayoutAllowsOnceTilesAreFilledUp) {
  // So narrow that filling up the last tiles makes a difference.
  const Bounds line{{-400, 0, 0}, {400, 1, 0}};
  int accepted = 0;
  constexpr int kSpacings = 200;
  for (int n = 0; n < kSpacings; ++n) {
    const float spacing = 2e-5F * (1 + 0.005F * static_cast<float>(n));
    const auto frame = makeGridFrame(line, spacing, spacing);
    if (!frame) continue;
    ++accepted;
    ASSERT_LE(cellCount(frame->columns_x, frame->columns_z), kMaxCells) << spacing;
  }
  EXPECT_GT(accepted, kSpacings / 10);
  EXPECT_LT(accepted, kSpacings * 9 / 10);
}

TEST(CentersWithin, LosesNoCenterAndAddsAtMostOneAtEitherEnd) {
  std::mt19937_64 random(kSeed);
  std::uniform_real_distribution<double> number(-2, 8);
  constexpr std::uint32_t kCount = 150;
  constexpr double kSpacing = 0.03;
  int empty = 0;
  constexpr int kRounds = 20000;
  for (int round = 0; round < kRounds; ++round) {
    double lo = number(random);
    double hi = number(random);
    if (round % 2 == 0) hi = lo + 0.001 * number(random);
    // Ends exactly on a center.
    if (round % 3 == 0) lo = (std::floor(lo / kSpacing) + 0.5) * kSpacing;
    if (round % 5 == 0) hi = (std::floor(hi / kSpacing) + 0.5) * kSpacing;
    const IndexRange range = centersWithin(lo, hi, kSpacing, kCount);
    std::uint32_t inside = 0;
    for (std::uint32_t i = 0; i < kCount; ++i) {
      const double center = (i + 0.5) * kSpacing;
      if (center < lo || center > hi) continue;
      ++inside;
      ASSERT_TRUE(i >= range.first && i < range.end) << lo << " to " << hi << ", center " << center;
    }
    ASSERT_LE(range.first, range.end);
    ASSERT_LE(range.end, kCount);
    ASSERT_LE(range.end - range.first, inside + 2) << lo << " to " << hi;
    empty += inside == 0 ? 1 : 0;
  }
  EXPECT_GT(empty, kRounds / 10);
  EXPECT_LT(empty, kRounds * 9 / 10);
}

TEST(TriangleBins, ListEachTriangleInEveryStripThatItsGrownFootprintReaches) {
  const Bounds bounds{{-1, 0, -2}, {1, 1, 2}};
  const TriangleMesh mesh = test::MeshBuilder().soup(kSeed, 500, bounds, 0.3F).build();
  int listed = 0;
  int all = 0;
  for (const float radius : {0.015F, 0.05F, 0.12F}) {
    const GridFrame frame = makeGridFrame(mesh.bounds, radius, 0.03F).value();
    for (const std::uint32_t rows_per_strip : {1U, 5U, 32U, 1000U}) {
      const TriangleBins bins(mesh, frame, rows_per_strip, static_cast<double>(radius));
      ASSERT_EQ(bins.stripCount(), (frame.columns_z + rows_per_strip - 1) / rows_per_strip);
      for (std::uint32_t strip = 0; strip < bins.stripCount(); ++strip) {
        const auto triangles = bins.triangles(strip);
        ASSERT_TRUE(std::is_sorted(triangles.begin(), triangles.end()));
        const std::set<std::uint32_t> found(triangles.begin(), triangles.end());
        ASSERT_EQ(found.size(), triangles.size()) << "a triangle is listed twice";
        const std::uint32_t end = std::min((strip + 1) * rows_per_strip, frame.columns_z);
        for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
          const Triangle& corners = mesh.triangles[t];
          const auto [lo, hi] =
              std::minmax({mesh.vertices[corners[0]].z, mesh.vertices[corners[1]].z,
                           mesh.vertices[corners[2]].z});
          bool reaches = false;
          for (std::uint32_t k = strip * rows_per_strip; k < end; ++k) {
            reaches = reaches ||
                      (frame.centerZ(k) >= static_cast<double>(lo) - static_cast<double>(radius) &&
                       frame.centerZ(k) <= static_cast<double>(hi) + static_cast<double>(radius));
          }
          ASSERT_TRUE(!reaches || found.contains(t)) << "strip " << strip << ", triangle " << t;
          ++all;
          listed += found.contains(t) ? 1 : 0;
        }
      }
    }
  }
  EXPECT_GT(listed, all / 10);
  EXPECT_LT(listed, all * 9 / 10);
}

TEST(ColumnAt, TellsCellsApartToTheLastBit) {
  Columns columns;
  columns.frame = {.radius = 0.05F,
                   .spacing = 0.03F,
                   .min_x = -3.1F,
                   .min_z = 1.7F,
                   .heights = {},
                   .columns_x = 300,
                   .columns_z = 200};
  const auto border = [](float min, std::uint32_t cell) {
    return static_cast<double>(min) + cell * static_cast<double>(0.03F);
  };
  const auto from = [](double at) {
    const auto rounded = static_cast<float>(at);
    return static_cast<double>(rounded) < at ? std::nextafter(rounded, 1e9F) : rounded;
  };
  for (std::uint32_t cell = 1; cell < 200; ++cell) {
    const Vec3 first{from(border(-3.1F, cell)), 0, from(border(1.7F, cell))};
    const Vec3 last{std::nextafter(first.x, -1e9F), 0, std::nextafter(first.z, -1e9F)};
    EXPECT_EQ(columnAt(columns, first), columns.index(cell, cell)) << "cell " << cell;
    EXPECT_EQ(columnAt(columns, last), columns.index(cell - 1, cell - 1)) << "cell " << cell;
  }
  EXPECT_EQ(columnAt(columns, {-3.11F, 0, 2}), std::nullopt);
  EXPECT_EQ(columnAt(columns, {0, 0, 7.75F}), std::nullopt);
}

}  // namespace
}  // namespace galactic::bake::columns_test
