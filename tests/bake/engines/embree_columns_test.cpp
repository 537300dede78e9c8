#include <gtest/gtest.h>

#include "bake/engines/engine_scenes.h"
#include "galactic/bake/column_engines.h"

namespace galactic::bake::embree_columns_test {
namespace {

using test::MeshBuilder;

constexpr std::uint32_t kSeed = 11;

/// Share of the frame's height that is free, over all columns.
double freeShare(const Columns& columns) {
  double free = 0;
  for (const Span& span : columns.spans) free += static_cast<double>(span.hi - span.lo);
  const Span heights = columns.frame.heights;
  return free / (static_cast<double>(heights.hi - heights.lo) *
                 static_cast<double>(columns.frame.columnCount()));
}

struct Soup {
  float radius;
  int triangles;
  /// Corner of the cube they fill: far from the origin, floats are coarse.
  Vec3 corner;
};

class EmbreeColumnsOnRandomTriangles : public testing::TestWithParam<Soup> {};

TEST_P(EmbreeColumnsOnRandomTriangles, EqualBruteForceOverAllTriangles) {
  RecordProperty("seed", static_cast<int>(kSeed));
  const auto& [radius, triangles, corner] = GetParam();
  const TriangleMesh mesh = test::randomSoup(kSeed, triangles, corner);
  const GridFrame frame = test::frameOver(mesh, radius, 0.03F);
  const Columns found = embreeColumns(mesh, frame, 2).value();
  const Columns expected = test::bruteForceColumns(mesh, frame);
  // Both clip the same formula: the tree may lose nothing, so even the last bit is equal.
  EXPECT_EQ(found.first, expected.first);
  EXPECT_EQ(found.spans, expected.spans);
  EXPECT_GT(freeShare(found), 0.1);
  EXPECT_LT(freeShare(found), 0.9);
}

INSTANTIATE_TEST_SUITE_P(RadiiAndPlaces, EmbreeColumnsOnRandomTriangles,
                         testing::Values(Soup{0.015F, 900, {0, 0, 0}},
                                         Soup{0.05F, 250, {-0.5F, -0.5F, -0.5F}},
                                         Soup{0.12F, 60, {0, 1, 0}},
                                         Soup{0.05F, 250, {612.3F, 40.7F, -701.9F}}));

TEST(EmbreeColumns, DoNotDependOnTheNumberOfThreads) {
  const TriangleMesh mesh = test::randomSoup(kSeed + 1, 400);
  const GridFrame frame = test::frameOver(mesh, 0.05F, 0.02F);
  const Columns one = embreeColumns(mesh, frame, 1).value();
  for (const unsigned threads : {2U, 3U, 8U}) {
    const Columns many = embreeColumns(mesh, frame, threads).value();
    EXPECT_EQ(many.first, one.first);
    EXPECT_EQ(many.spans, one.spans);
  }
}

TEST(EmbreeColumns, FindAGapOfOneMillimeterInsideASlab) {
  const TriangleMesh mesh = MeshBuilder()
                                .floor({-1, 0, -1}, {1, 0, 1}, 1.0F)
                                .floor({-1, 0, -1}, {1, 0, 1}, 0.995F)
                                .build();
  const GridFrame frame = test::frameAround(0.1F, 0.2F, 0.002F, {0.5F, 1.5F});
  const Columns found = embreeColumns(mesh, frame, 1).value();
  const auto spans = found.column(found.index(1, 1));
  ASSERT_EQ(spans.size(), 3U);
  EXPECT_NEAR(spans[1].lo, 0.997F, 1e-5F);
  EXPECT_NEAR(spans[1].hi, 0.998F, 1e-5F);
}

}  // namespace
}  // namespace galactic::bake::embree_columns_test
