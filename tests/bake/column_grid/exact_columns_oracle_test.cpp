// The exact engine against brute force in double precision, on random and furnished scenes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "galactic/bake/column_engines.h"
#include "oracle_comparison.h"
#include "support/scene_meshes.h"
#include "support/test_meshes.h"

namespace galactic::bake::exact_columns_oracle_test {
namespace {

using test::ColumnOracle;
using test::Comparison;

constexpr std::uint32_t kSeed = 20250307;
constexpr float kSpacing = 0.03F;
constexpr float kRadii[] = {0.015F, 0.05F, 0.12F};
constexpr double kReach = 0.13;

/// Adds up the comparisons of one test, and judges their sums.
class Tally {
 public:
  void add(const Comparison& found) {
    EXPECT_EQ(found.offence, "");
    columns_ += found.columns;
    touching_ += found.touching;
    ties_ += found.ties;
    spans_ += found.spans;
    steep_ends_ += found.steep_ends;
    greatest_error_ = std::max(greatest_error_, found.greatest_error);
  }

  /// Both kinds of columns occur, and hardly any is excused.
  void judge() const {
    testing::Test::RecordProperty("columns", columns_);
    testing::Test::RecordProperty("ties", ties_);
    testing::Test::RecordProperty("steep_ends", steep_ends_);
    testing::Test::RecordProperty("greatest_error_nm", static_cast<int>(greatest_error_ * 1e9));
    EXPECT_GT(touching_, columns_ / 10);
    EXPECT_GT(spans_, columns_);
    EXPECT_LT(ties_, columns_ / 100);
    EXPECT_LT(steep_ends_, spans_ / 1000 + 1);
  }

  [[nodiscard]] int columns() const { return columns_; }
  [[nodiscard]] int touching() const { return touching_; }

 private:
  int columns_ = 0;
  int touching_ = 0;
  int ties_ = 0;
  int spans_ = 0;
  int steep_ends_ = 0;
  double greatest_error_ = 0;
};

void compareAll(const TriangleMesh& mesh, float radius, Tally& tally) {
  const GridFrame frame = makeGridFrame(mesh.bounds, radius, kSpacing).value();
  const ColumnOracle oracle(mesh, kReach);
  tally.add(compareWithOracle(oracle, exactColumns(mesh, frame).columns));
}

TEST(ExactColumnsAgainstBruteForce, AgreeOnRandomTriangles) {
  RecordProperty("seed", static_cast<int>(kSeed));
  Tally tally;
  for (std::uint32_t scene = 0; scene < 12; ++scene) {
    for (const float radius : kRadii) {
      SCOPED_TRACE(testing::Message() << "seed " << kSeed + scene << ", radius " << radius);
      const Bounds bounds{{-1, 0, -1}, {1, 2, 1}};
      const TriangleMesh mesh = test::MeshBuilder().soup(kSeed + scene, 60, bounds, 0.2F).build();
      compareAll(mesh, radius, tally);
    }
  }
  tally.judge();
  EXPECT_LT(tally.touching(), tally.columns() * 95 / 100);
}

TEST(ExactColumnsAgainstBruteForce, AgreeOnAwkwardTriangles) {
  RecordProperty("seed", static_cast<int>(kSeed));
  Tally tally;
  for (std::uint32_t scene = 0; scene < 40; ++scene) {
    for (const float radius : kRadii) {
      SCOPED_TRACE(testing::Message() << "seed " << kSeed + scene << ", radius " << radius);
      compareAll(test::awkwardTriangles(kSeed + scene, 24), radius, tally);
    }
  }
  tally.judge();
}

TEST(ExactColumnsAgainstBruteForce, AgreeInAFurnishedRoom) {
  Tally tally;
  for (const float radius : kRadii) {
    SCOPED_TRACE(testing::Message() << "radius " << radius);
    compareAll(test::furnishedRoom(kSeed), radius, tally);
  }
  tally.judge();
}

/// 700 m from the origin the positions are multiples of 0.06 mm; the grid is exact for them still.
TEST(ExactColumnsAgainstBruteForce, AgreeFarFromTheOrigin) {
  Tally tally;
  for (const float radius : kRadii) {
    SCOPED_TRACE(testing::Message() << "radius " << radius);
    compareAll(test::furnishedRoom(kSeed, {-700, -2, 650}), radius, tally);
    compareAll(test::awkwardTriangles(kSeed, 24, {650, 3, -700}), radius, tally);
  }
  tally.judge();
}

/// What floats lose grows with the size of a triangle.
TEST(ExactColumnsAgainstBruteForce, AgreeOnTrianglesAsLongAsAStreet) {
  Tally tally;
  for (const float a : {20.0F, 60.0F, 120.0F}) {
    SCOPED_TRACE(testing::Message() << 2 * a << " m");
    TriangleMesh mesh;
    mesh.vertices = {{-a, -a / 2, 0}, {a, a / 2, 0.3F}, {0.9F * a, a / 2, -0.4F},
                     {-a, -a / 3, 1}, {a, 0, 1.2F},     {0.8F * a, a / 5, 9}};
    mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
    mesh.bounds = {{-a, -a / 2, -0.4F}, {a, a / 2, 9}};
    const GridFrame frame = makeGridFrame(mesh.bounds, 0.12F, 0.2F).value();
    tally.add(compareWithOracle(ColumnOracle(mesh, kReach), exactColumns(mesh, frame).columns));
  }
  tally.judge();
}

/// Distances sampled along a column, with nothing of the closed form: the heights where a sphere of
/// `radius` begins or ceases to touch, by bisection between samples that differ.
class SampledColumn {
 public:
  SampledColumn(const ColumnOracle& oracle, double x, double z) : oracle_(oracle), x_(x), z_(z) {}

  [[nodiscard]] bool isFree(double height, double radius) const {
    return oracle_.distance({x_, height, z_}) > radius;
  }

  /// The height between `a` and `b`, one free and one not, where that changes.
  [[nodiscard]] double changeBetween(double a, double b, double radius) const {
    const bool free_at_a = isFree(a, radius);
    for (int step = 0; step < 50; ++step) {
      const double middle = 0.5 * (a + b);
      (isFree(middle, radius) == free_at_a ? a : b) = middle;
    }
    return 0.5 * (a + b);
  }

 private:
  const ColumnOracle& oracle_;
  double x_;
  double z_;
};

struct Sampled {
  int free = 0;
  int blocked = 0;
  int ends = 0;
};

/// Samples a column every 5 mm, leaving out heights near a tie, and finds the ends between.
void compareSampled(const SampledColumn& line, const GridFrame& frame, std::span<const Span> spans,
                    Sampled& sampled) {
  constexpr double kStep = 0.005;
  const auto radius = static_cast<double>(frame.radius);
  const auto bottom = static_cast<double>(frame.heights.lo);
  const auto top = static_cast<double>(frame.heights.hi);
  const auto samples = static_cast<int>((top - bottom) / kStep);
  double last = 0;
  bool last_free = false;
  bool has_last = false;
  for (int sample = 0; sample < samples; ++sample) {
    const double y = bottom + (sample + 0.5) * kStep;
    const bool free = line.isFree(y, radius + test::kTieTolerance);
    if (free != line.isFree(y, radius - test::kTieTolerance)) {
      has_last = false;
      continue;
    }
    ++(free ? sampled.free : sampled.blocked);
    const bool found = std::any_of(spans.begin(), spans.end(), [&](const Span& span) {
      return y >= static_cast<double>(span.lo) && y <= static_cast<double>(span.hi);
    });
    ASSERT_EQ(found, free) << "height " << y;
    if (has_last && free != last_free) {
      const double near = line.changeBetween(last, y, radius - test::kTieTolerance);
      const double far = line.changeBetween(last, y, radius + test::kTieTolerance);
      const auto [lo, hi] = std::minmax(near, far);
      // A slit between the two samples may hide ends; then one of them is still here.
      const bool has_end =
          std::any_of(spans.begin(), spans.end(), [&, lo = lo, hi = hi](const Span& span) {
            const auto end = static_cast<double>(free ? span.lo : span.hi);
            return end >= lo - test::kEndTolerance && end <= hi + test::kEndTolerance;
          });
      ASSERT_TRUE(has_end) << "between " << last << " and " << y;
      ++sampled.ends;
    }
    last = y;
    last_free = free;
    has_last = true;
  }
}

TEST(ExactColumnsAgainstSampledDistance, AgreeInAFurnishedRoom) {
  const TriangleMesh mesh = test::furnishedRoom(kSeed + 1);
  const ColumnOracle oracle(mesh, kReach);
  Sampled sampled;
  for (const float radius : kRadii) {
    const GridFrame frame = makeGridFrame(mesh.bounds, radius, kSpacing).value();
    const Columns columns = exactColumns(mesh, frame).columns;
    for (std::uint32_t at = 3; at < frame.columnCount(); at += 97) {
      const std::uint32_t i = at % frame.columns_x;
      const std::uint32_t k = at / frame.columns_x;
      const SampledColumn line(oracle, frame.centerX(i), frame.centerZ(k));
      compareSampled(line, frame, columns.column(at), sampled);
      ASSERT_FALSE(HasFatalFailure()) << "radius " << radius << ", column " << i << ", " << k;
    }
  }
  EXPECT_GT(sampled.free, (sampled.free + sampled.blocked) / 10);
  EXPECT_GT(sampled.blocked, (sampled.free + sampled.blocked) / 10);
  EXPECT_GT(sampled.ends, 300);
}

void expectSameColumns(const Columns& found, const Columns& expected) {
  ASSERT_EQ(found.first, expected.first);
  ASSERT_EQ(found.spans.size(), expected.spans.size());
  EXPECT_EQ(
      std::memcmp(found.spans.data(), expected.spans.data(), expected.spans.size() * sizeof(Span)),
      0);
}

TEST(ExactColumns, HaveTheSameBytesForAnyNumberOfJobs) {
  const TriangleMesh mesh = test::furnishedRoom(kSeed + 2);
  for (const Coverage coverage : {Coverage::kColumn, Coverage::kCell}) {
    const GridFrame frame = makeGridFrame(mesh.bounds, 0.05F, kSpacing).value();
    const ExactColumns once = exactColumns(mesh, frame, coverage, 1);
    for (const unsigned threads : {0U, 2U, 3U, 7U, 1000U}) {
      SCOPED_TRACE(testing::Message() << threads << " threads");
      const ExactColumns again = exactColumns(mesh, frame, coverage, threads);
      expectSameColumns(again.columns, once.columns);
      EXPECT_EQ(again.merged_gaps, once.merged_gaps);
    }
  }
}

/// A column's spans do not depend on which strip it is in: moving the frame by some rows moves the
/// borders of the strips.
TEST(ExactColumns, AreTheSameWhereverTheBordersOfTheStripsLie) {
  const TriangleMesh mesh = test::furnishedRoom(kSeed + 3);
  // Powers of two, so that both frames have exactly the same columns.
  constexpr float kExactSpacing = 0.03125F;
  GridFrame whole = makeGridFrame(mesh.bounds, 0.0625F, kExactSpacing).value();
  whole.min_x = -0.25F;
  whole.min_z = -0.25F;
  const Columns expected = exactColumns(mesh, whole).columns;
  for (const std::uint32_t shift : {1U, 7U, 31U, 33U}) {
    GridFrame part = whole;
    part.min_z = whole.min_z + kExactSpacing * static_cast<float>(shift);
    part.columns_z = whole.columns_z - shift;
    const Columns found = exactColumns(mesh, part).columns;
    for (std::uint32_t k = 0; k < part.columns_z; ++k) {
      for (std::uint32_t i = 0; i < part.columns_x; ++i) {
        const auto here = found.column(found.index(i, k));
        const auto there = expected.column(expected.index(i, k + shift));
        ASSERT_TRUE(std::equal(here.begin(), here.end(), there.begin(), there.end()))
            << "shift " << shift << ", column " << i << ", " << k;
      }
    }
  }
}

TEST(ExactColumns, CountTheGapsThatTheyClose) {
  const Vec3 min{0, 0, 0};
  const Vec3 max{1, 0, 1};
  constexpr float kRadius = 0.0625F;
  // Two sheets two radii and 5 micrometers apart: less than the merge tolerance.
  const TriangleMesh mesh =
      test::MeshBuilder().floor(min, max, 0).floor(min, max, 2 * kRadius + 5e-6F).build();
  const GridFrame frame = makeGridFrame(mesh.bounds, kRadius, kSpacing).value();
  const ExactColumns found = exactColumns(mesh, frame);
  std::uint64_t over_both = 0;
  for (std::size_t at = 0; at < frame.columnCount(); ++at) {
    const double x = frame.centerX(static_cast<std::uint32_t>(at % frame.columns_x));
    const double z = frame.centerZ(static_cast<std::uint32_t>(at / frame.columns_x));
    // Beyond the sheets' border the gap opens.
    if (!(x > 0 && x < 1 && z > 0 && z < 1)) continue;
    EXPECT_EQ(found.columns.column(at).size(), 2U);
    ++over_both;
  }
  EXPECT_EQ(found.merged_gaps, over_both);
  EXPECT_GT(over_both, 900U);
}

}  // namespace
}  // namespace galactic::bake::exact_columns_oracle_test
