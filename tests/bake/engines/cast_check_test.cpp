#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "bake/engines/engine_scenes.h"
#include "galactic/bake/column_engines.h"

namespace galactic::bake::cast_check_test {
namespace {

using test::MeshBuilder;

constexpr std::uint32_t kSeed = 31;

TriangleMesh furnishedRoom() {
  return MeshBuilder()
      .box({0, -0.1F, 0}, {2, 0, 2})
      .box({0, 2, 0}, {2, 2.1F, 2})
      .box({0.5F, 0, 0.5F}, {1, 0.75F, 1.2F})
      .sphere({1.4F, 1, 1.4F}, 0.3F, 16)
      .quad({Vec3{1.2F, 0, 0.2F}, {1.8F, 0.6F, 0.2F}, {1.8F, 0.6F, 0.8F}, {1.2F, 0, 0.8F}})
      .build();
}

/// All columns of the grid, changed column by column.
Columns edited(const Columns& columns, const std::function<void(std::vector<Span>& spans)>& edit) {
  Columns result;
  result.frame = columns.frame;
  result.first.push_back(0);
  for (std::size_t c = 0; c < columns.frame.columnCount(); ++c) {
    const auto spans = columns.column(c);
    std::vector<Span> copy(spans.begin(), spans.end());
    edit(copy);
    result.spans.insert(result.spans.end(), copy.begin(), copy.end());
    result.first.push_back(static_cast<std::uint32_t>(result.spans.size()));
  }
  return result;
}

class CastCheckOfARoom : public testing::TestWithParam<float> {
 protected:
  CastCheckOfARoom()
      : mesh_(furnishedRoom()),
        columns_(embreeColumns(mesh_, test::frameOver(mesh_, GetParam(), 0.03F), 2).value()),
        caster_(mesh_) {}

  [[nodiscard]] CastCheck check(const Columns& columns) const {
    return checkWithCasts(mesh_, columns, caster_, {.columns = kColumns});
  }

  static constexpr std::uint32_t kColumns = 96;
  TriangleMesh mesh_;
  Columns columns_;
  BulletColumnCaster caster_;
};

TEST_P(CastCheckOfARoom, FindsNoErrorInARightGrid) {
  const CastCheck result = check(columns_);
  EXPECT_EQ(result.errors, 0);
  EXPECT_EQ(result.columns, kColumns);
  const Span heights = columns_.frame.heights;
  EXPECT_NEAR(result.compared, kColumns * static_cast<double>(heights.hi - heights.lo), 1e-3);
  EXPECT_GT(result.columns_differing, 0U) << "the method's own errors should show";
  EXPECT_LT(result.method, 0.1 * result.compared);
}

TEST_P(CastCheckOfARoom, GivesTheSameAnswerTwice) {
  const CastCheck one = check(columns_);
  const CastCheck two = check(columns_);
  EXPECT_EQ(one.method, two.method);
  EXPECT_EQ(one.ties, two.ties);
}

TEST_P(CastCheckOfARoom, DoesNotDependOnTheNumberOfThreads) {
  const CastCheck one = check(columns_);
  for (const unsigned threads : {2U, 5U}) {
    const CastCheck many = checkWithCasts(mesh_, columns_, caster_, {.columns = kColumns}, threads);
    EXPECT_EQ(one.columns, many.columns);
    EXPECT_EQ(one.columns_differing, many.columns_differing);
    EXPECT_EQ(one.compared, many.compared);
    EXPECT_EQ(one.method, many.method);
    EXPECT_EQ(one.ties, many.ties);
    EXPECT_EQ(one.errors, many.errors);
    EXPECT_EQ(one.longest, many.longest);
    EXPECT_EQ(one.longest_tie, many.longest_tie);
  }
}

TEST_P(CastCheckOfARoom, SeesAMissingSpan) {
  const CastCheck result = check(edited(columns_, [](std::vector<Span>& spans) {
    if (spans.size() > 1) spans.erase(spans.begin() + 1);
  }));
  EXPECT_GT(result.errors, 1);
}

TEST_P(CastCheckOfARoom, SeesAnAddedSpan) {
  // Free where it is blocked: the gap between the first two spans is filled up.
  const CastCheck result = check(edited(columns_, [](std::vector<Span>& spans) {
    if (spans.size() < 2) return;
    spans[1].lo = spans[0].lo;
    spans.erase(spans.begin());
  }));
  EXPECT_GT(result.errors, 0.5);
}

TEST_P(CastCheckOfARoom, SeesAnEndMovedByAMillimeter) {
  const auto move = [](float Span::*end, float by) {
    return [end, by](std::vector<Span>& spans) {
      if (!spans.empty()) spans.back().*end += by;
    };
  };
  const double moved = 1e-3 * kColumns;
  // In most columns by what was moved; where the surface slopes the ball is further away.
  EXPECT_GT(check(edited(columns_, move(&Span::lo, 1e-3F))).errors, 0.5 * moved);
  EXPECT_GT(check(edited(columns_, move(&Span::lo, -1e-3F))).errors, 0.5 * moved);
}

INSTANTIATE_TEST_SUITE_P(Radii, CastCheckOfARoom, testing::Values(0.015F, 0.05F, 0.12F));

TEST(CastCheck, FindsNoErrorInTheExactColumnsOfRandomTriangles) {
  RecordProperty("seed", static_cast<int>(kSeed));
  const TriangleMesh mesh = test::randomSoup(kSeed, 400);
  const BulletColumnCaster caster(mesh);
  for (const float radius : {0.015F, 0.05F, 0.12F}) {
    const Columns columns = embreeColumns(mesh, test::frameOver(mesh, radius, 0.03F), 2).value();
    const CastCheck result = checkWithCasts(mesh, columns, caster, {.columns = 256});
    EXPECT_EQ(result.errors, 0) << radius;
    EXPECT_GT(result.method, 0) << radius;
  }
}

/// A large ball among many triangles meets most of them at each of its steps.
TEST(CastCheck, ReplaysFewerColumnsWhereManyTrianglesAreWithinReach) {
  RecordProperty("seed", static_cast<int>(kSeed));
  const TriangleMesh mesh = test::randomSoup(kSeed, 4000);
  const BulletColumnCaster caster(mesh);
  const auto replayed = [&](float radius, std::uint32_t wanted) {
    const Columns columns = exactColumns(mesh, test::frameOver(mesh, radius, 0.03F)).columns;
    const CastCheck result = checkWithCasts(mesh, columns, caster, {.columns = wanted});
    EXPECT_EQ(result.errors, 0) << radius;
    const Span heights = columns.frame.heights;
    EXPECT_NEAR(result.compared, result.columns * static_cast<double>(heights.hi - heights.lo),
                1e-3);
    return result.columns;
  };
  EXPECT_EQ(replayed(0.05F, 24), 24U);
  const std::uint32_t few = replayed(0.3F, 24);
  EXPECT_GT(few, 4U);
  EXPECT_LT(few, 18U);
  // Who asks for more gets more.
  EXPECT_GT(replayed(0.3F, 48), few);
  EXPECT_EQ(replayed(0.3F, 2), 2U);
}

/// Both methods agree on nonsense: only the distance can tell.
TEST(CastCheck, SeesAnErrorThatTheCastsShare) {
  const TriangleMesh seen = MeshBuilder().box({0, 0, 0}, {1, 1, 1}).build();
  const TriangleMesh real =
      MeshBuilder().box({0, 0, 0}, {1, 1, 1}).floor({0, 0, 0}, {1, 0, 1}, 2).build();
  const Columns columns = embreeColumns(seen, test::frameOver(real, 0.05F, 0.03F), 1).value();
  const CastCheck result = checkWithCasts(real, columns, BulletColumnCaster(seen), {.columns = 64});
  EXPECT_GT(result.errors, 0);
}

TEST(CastCheck, PutsAGapNarrowerThanTheSearchStepDownToTheMethod) {
  const TriangleMesh mesh = MeshBuilder()
                                .floor({-1, 0, -1}, {1, 0, 1}, 1.0F)
                                .floor({-1, 0, -1}, {1, 0, 1}, 0.892F)
                                .build();
  const Columns columns =
      embreeColumns(mesh, test::frameAround(0, 0, 0.05F, {0.5F, 1.5F}), 1).value();
  ASSERT_EQ(columns.spans.size(), 27U);
  const CastCheck result = checkWithCasts(mesh, columns, BulletColumnCaster(mesh));
  EXPECT_EQ(result.columns, 9U);
  EXPECT_EQ(result.columns_differing, 9U);
  EXPECT_NEAR(result.method, 9 * 0.008, 1e-4);
  EXPECT_LT(result.ties, 1e-4);
  EXPECT_EQ(result.errors, 0);
}

TEST(CastCheck, CallsAWallAtExactlyTheRadiusATie) {
  // The wall stands at x = 0.05 to the last bit of the column's position.
  GridFrame frame = test::frameAround(0, 0, 0.0625F, {0, 3});
  frame.spacing = 0.03125F;
  frame.min_x = -0.015625F;
  frame.columns_x = 1;
  const TriangleMesh mesh =
      MeshBuilder()
          .quad({Vec3{0.0625F, -1, -1}, {0.0625F, -1, 1}, {0.0625F, 4, 1}, {0.0625F, 4, -1}})
          .build();
  Columns columns;
  columns.frame = frame;
  columns.first = {0, 1, 2, 3};
  columns.spans = {{0, 3}, {0, 3}, {0, 3}};
  const CastCheck result = checkWithCasts(mesh, columns, BulletColumnCaster(mesh));
  EXPECT_EQ(result.columns_differing, 3U);
  EXPECT_NEAR(result.ties, 9, 1e-3);
  EXPECT_NEAR(result.longest_tie, 3, 1e-3);
  EXPECT_EQ(result.method, 0);
  EXPECT_EQ(result.longest, 0);
  EXPECT_EQ(result.errors, 0);
}

TEST(CastCheck, OfAGridWithoutSpansComparesNothing) {
  const TriangleMesh mesh = MeshBuilder().box({0, 0, 0}, {1, 1, 1}).build();
  Columns columns;
  columns.frame = test::frameOver(mesh, 0.05F, 0.03F);
  columns.first.assign(columns.frame.columnCount() + 1, 0);
  const CastCheck result = checkWithCasts(mesh, columns, BulletColumnCaster(mesh));
  EXPECT_EQ(result.columns, 0U);
  EXPECT_EQ(result.compared, 0);
}

}  // namespace
}  // namespace galactic::bake::cast_check_test
