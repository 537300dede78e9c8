// Coverage::kCell: a nearest-column query on the stored grid is never falsely free.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "galactic/bake/column_engines.h"
#include "galactic/bake/columns.h"
#include "support/asset_mesh.h"
#include "support/oracles/distance_oracle.h"
#include "support/oracles/encoded_grid_view.h"
#include "support/scene_meshes.h"

namespace galactic::bake::cell_coverage_test {
namespace {

constexpr std::uint32_t kSeed = 20250309;
constexpr float kRadii[] = {0.015F, 0.05F, 0.12F};
constexpr double kReach = 0.13;

/// How queries at random places were answered.
struct Answers {
  int asked = 0;
  int free = 0;
  int falsely_free = 0;
  double deepest = 0;
};

EncodedGrid bakeRoom(const TriangleMesh& mesh, float radius, Coverage coverage) {
  const GridFrame frame = makeGridFrame(mesh.bounds, radius, 0.03F).value();
  const Columns columns = exactColumns(mesh, frame, coverage, 2).columns;
  return encodeGrid(chooseFreeSpace(columns).value().columns);
}

/// Draws sphere centers: half of them anywhere in a box, half where errors would be: on the
/// border or at the corner of a cell, close to the end of one of its spans.
class CenterSource {
 public:
  /// Within `bounds` and their surroundings.
  CenterSource(const EncodedGrid& grid, const Bounds& bounds, std::uint32_t seed)
      : frame_(grid.frame), view_(test::viewOf(grid)), bounds_(bounds), random_(seed) {}

  Vec3 next() {
    if (random_() % 2 == 0) return anywhere();
    const Vec3 place = anywhere();
    const auto i = cellAt(place.x, frame_.min_x, frame_.columns_x);
    const auto k = cellAt(place.z, frame_.min_z, frame_.columns_z);
    std::array<Span, 8> spans;
    const std::size_t count = std::min(view_.spans(i, k, spans), spans.size());
    if (count == 0) return place;
    const Span& span = spans[random_() % count];
    const float end = random_() % 2 == 0 ? span.lo : span.hi;
    return {static_cast<float>(frame_.centerX(i) + offset()), end + number(-2e-4F, 2e-4F),
            static_cast<float>(frame_.centerZ(k) + offset())};
  }

 private:
  float number(float lo, float hi) {
    return std::uniform_real_distribution<float>(lo, hi)(random_);
  }

  Vec3 anywhere() {
    return {number(bounds_.min.x - kMargin, bounds_.max.x + kMargin),
            number(bounds_.min.y - kMargin, bounds_.max.y + kMargin),
            number(bounds_.min.z - kMargin, bounds_.max.z + kMargin)};
  }

  [[nodiscard]] std::uint32_t cellAt(float at, float min, std::uint32_t count) const {
    const double cell =
        (static_cast<double>(at) - static_cast<double>(min)) / static_cast<double>(frame_.spacing);
    return static_cast<std::uint32_t>(std::clamp(cell, 0.0, static_cast<double>(count - 1)));
  }

  /// From the middle of a cell to a place in it, most often the border.
  double offset() {
    const double half = static_cast<double>(frame_.spacing) / 2;
    switch (random_() % 3) {
      case 0:
        return half;
      case 1:
        return -half;
      default:
        return static_cast<double>(number(-1, 1)) * half;
    }
  }

  static constexpr float kMargin = 0.1F;

  GridFrame frame_;
  ColumnGrid view_;
  Bounds bounds_;
  std::mt19937 random_;
};

Answers ask(const EncodedGrid& grid, const test::DistanceOracle& oracle, int count,
            std::uint32_t seed, const Bounds& bounds) {
  const ColumnGrid view = test::viewOf(grid);
  const auto radius = static_cast<double>(grid.frame.radius);
  CenterSource source(grid, bounds, seed);
  Answers answers;
  for (; answers.asked < count; ++answers.asked) {
    const Vec3 center = source.next();
    if (view.clearance(center) != Clearance::kFree) continue;
    ++answers.free;
    const double depth = radius - oracle.distance(test::toPoint(center));
    if (depth <= 0) continue;
    ++answers.falsely_free;
    answers.deepest = std::max(answers.deepest, depth);
  }
  return answers;
}

/// Demands no falsely free answer, and that both answers occur.
void expectNeverFalselyFree(const TriangleMesh& mesh, int count, std::uint32_t seed) {
  const test::DistanceOracle oracle(mesh, kReach);
  for (const float radius : kRadii) {
    SCOPED_TRACE(testing::Message() << "seed " << seed << ", radius " << radius);
    const Answers answers =
        ask(bakeRoom(mesh, radius, Coverage::kCell), oracle, count, seed, mesh.bounds);
    EXPECT_EQ(answers.falsely_free, 0) << "deepest " << answers.deepest << " m";
    EXPECT_GT(answers.free, answers.asked / 10);
    EXPECT_LT(answers.free, answers.asked * 9 / 10);
  }
}

TEST(CellCoverage, IsNeverFalselyFreeInAFurnishedRoom) {
  for (std::uint32_t scene = 0; scene < 4; ++scene) {
    expectNeverFalselyFree(test::furnishedRoom(kSeed + scene), 150000, kSeed + scene);
  }
}

TEST(CellCoverage, IsNeverFalselyFreeFarFromTheOrigin) {
  expectNeverFalselyFree(test::furnishedRoom(kSeed, {300, -20, -350}), 150000, kSeed);
}

/// Which cell a center falls in is decided in floats, whose error grows with the size of the grid:
/// on a steep ramp a cell's free heights are soon wrong for a center beside it.
TEST(CellCoverage, IsNeverFalselyFreeOnASteepRampInAVeryWideScene) {
  const TriangleMesh ramp =
      test::MeshBuilder()
          .quad({Vec3{290, 0, 0}, {290, 0, 1}, {290.2F, 1.6F, 1}, {290.2F, 1.6F, 0}})
          .build();
  const TriangleMesh mesh =
      test::MeshBuilder()
          .quad({Vec3{290, 0, 0}, {290, 0, 1}, {290.2F, 1.6F, 1}, {290.2F, 1.6F, 0}})
          .box({-290, 0, 0}, {-289, 1, 1})
          .build();
  const test::DistanceOracle oracle(ramp, kReach);
  for (const float radius : kRadii) {
    const GridFrame frame = makeGridFrame(mesh.bounds, radius, 0.03F).value();
    const EncodedGrid grid = encodeGrid(exactColumns(mesh, frame, Coverage::kCell, 2).columns);
    const Answers answers = ask(grid, oracle, 200000, kSeed, ramp.bounds);
    EXPECT_EQ(answers.falsely_free, 0) << "deepest " << answers.deepest << " m";
    EXPECT_GT(answers.free, answers.asked / 10);
    EXPECT_LT(answers.free, answers.asked * 9 / 10);
  }
}

TEST(CellCoverage, IsNeverFalselyFreeAmongAwkwardTriangles) {
  for (std::uint32_t scene = 0; scene < 6; ++scene) {
    const TriangleMesh mesh = test::awkwardTriangles(kSeed + scene, 24);
    expectNeverFalselyFree(mesh, 50000, kSeed + scene);
  }
}

TEST(CellCoverage, IsNeverFalselyFreeOnTheApartmentStage) {
  if (!test::hasAsset(test::kApartmentStage)) {
    GTEST_SKIP() << test::kApartmentStage << " is not on this machine";
  }
  const auto mesh = test::loadAsset(test::kApartmentStage);
  ASSERT_TRUE(mesh) << mesh.error().message;
  expectNeverFalselyFree(*mesh, 500000, kSeed);
}

TEST(CellCoverage, IsNeverFalselyFreeInTheScannedRoom) {
  if (!test::hasAsset(test::kScannedRoom)) {
    GTEST_SKIP() << test::kScannedRoom << " is not on this machine";
  }
  const auto mesh = test::loadAsset(test::kScannedRoom);
  ASSERT_TRUE(mesh) << mesh.error().message;
  expectNeverFalselyFree(*mesh, 100000, kSeed);
}

/// The questions are hard enough: the other coverage fails them.
TEST(CellCoverage, IsNeededForThat) {
  const TriangleMesh mesh = test::furnishedRoom(kSeed);
  const test::DistanceOracle oracle(mesh, kReach);
  const Answers answers =
      ask(bakeRoom(mesh, 0.05F, Coverage::kColumn), oracle, 100000, kSeed, mesh.bounds);
  EXPECT_GT(answers.falsely_free, answers.asked / 100);
  EXPECT_GT(answers.deepest, 5e-3);
}

/// Every span over a cell lies inside one over its column, and what it gives away is no more than
/// the cell's size and the surface's slope explain: nothing over level ground.
TEST(CellCoverage, IsNoFreerThanTheColumnAndAsFreeOverLevelGround) {
  const TriangleMesh mesh = test::MeshBuilder().box({-1, -0.5F, -1}, {1, 0, 1}).build();
  const GridFrame frame = makeGridFrame(mesh.bounds, 0.05F, 0.03F).value();
  const Columns lines = exactColumns(mesh, frame).columns;
  const Columns cells = exactColumns(mesh, frame, Coverage::kCell).columns;
  int level = 0;
  for (std::uint32_t k = 0; k < frame.columns_z; ++k) {
    for (std::uint32_t i = 0; i < frame.columns_x; ++i) {
      const auto over_cell = cells.column(cells.index(i, k));
      const auto on_line = lines.column(lines.index(i, k));
      for (const Span& span : over_cell) {
        EXPECT_TRUE(std::any_of(on_line.begin(), on_line.end(), [&](const Span& outer) {
          return outer.lo <= span.lo && span.hi <= outer.hi;
        }));
      }
      if (std::max(std::abs(frame.centerX(i)), std::abs(frame.centerZ(k))) > 0.9) continue;
      ++level;
      ASSERT_EQ(over_cell.size(), 3U);
      EXPECT_NEAR(static_cast<double>(over_cell[2].lo), 0.05, 2.1e-5);
      EXPECT_NEAR(static_cast<double>(over_cell[1].hi), -0.05, 2.1e-5);
    }
  }
  EXPECT_GT(level, 3000);
}

}  // namespace
}  // namespace galactic::bake::cell_coverage_test
