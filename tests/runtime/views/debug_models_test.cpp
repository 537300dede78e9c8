#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <vector>

#include "galactic/debug_views.h"
#include "support/homes/box_room.h"
#include "support/homes/small_home.h"
#include "views/grid_surface.h"
#include "views/merge_squares.h"
#include "views/shapes.h"

namespace galactic::views::debug_models_test {
namespace {

using testing::HasSubstr;

/// What a surface encloses, where every edge has two sides; m3.
double volumeOf(const RenderSurface& surface) {
  double six_times = 0;
  for (std::size_t n = 0; n < surface.corners.size(); n += 3) {
    const auto at = [&](std::size_t c) {
      return surface.vertices[surface.corners[n + c]].position;
    };
    six_times += static_cast<double>(dot(at(0), cross(at(1), at(2))));
  }
  return six_times / 6;
}

TEST(MergeSquares, CoversEachSquareOnceAndNothingElse) {
  constexpr std::uint32_t kSeed = 11;
  SCOPED_TRACE(fmt::format("seed {}", kSeed));
  std::mt19937 random(kSeed);
  for (int round = 0; round < 50; ++round) {
    std::set<KeyedSquare> squares;
    for (int n = 0; n < 150; ++n) {
      squares.insert({{static_cast<std::int32_t>(random() % 2), 0, 0, 0},
                      static_cast<std::int32_t>(random() % 12),
                      static_cast<std::int32_t>(random() % 12)});
    }
    std::set<KeyedSquare> covered;
    std::size_t count = 0;
    for (const KeyedRectangle& r : mergeSquares({squares.begin(), squares.end()})) {
      for (std::int32_t row = r.first_row; row < r.end_row; ++row) {
        for (std::int32_t column = r.first_column; column < r.end_column; ++column) {
          covered.insert({r.key, row, column});
          ++count;
        }
      }
    }
    EXPECT_EQ(covered, squares);
    EXPECT_EQ(count, squares.size());
  }
}

TEST(MergeSquares, MakesOneRectangleOfARectangle) {
  std::vector<KeyedSquare> squares;
  for (std::int32_t row = 3; row < 9; ++row) {
    for (std::int32_t column = 2; column < 7; ++column) squares.push_back({{5}, row, column});
  }
  std::ranges::reverse(squares);
  const auto merged = mergeSquares(squares);
  ASSERT_EQ(merged.size(), 1U);
  EXPECT_EQ(merged[0], (KeyedRectangle{{5}, 2, 7, 3, 9}));
}

TEST(DebugShapes, ASphereHasItsCornersOnTheBallAndNearlyItsVolume) {
  constexpr float kRadius = 0.12F;
  const RenderSurface sphere = sphereSurface(kRadius, 0xFF00FF00);
  EXPECT_EQ(sphere.corners.size(), 3U * 320);
  for (const RenderVertex& vertex : sphere.vertices) {
    EXPECT_NEAR(std::sqrt(dot(vertex.position, vertex.position)), kRadius, 1e-6F);
  }
  const double ball = 4.0 / 3 * std::numbers::pi * std::pow(static_cast<double>(kRadius), 3);
  // 320 flat faces enclose a little less.
  EXPECT_GT(volumeOf(sphere), 0.95 * ball);
  EXPECT_LT(volumeOf(sphere), ball);
}

TEST(DebugShapes, ABoxEnclosesItsVolumeWhereItStands) {
  const OrientedBox box{{{1, 2, 3}, {0, std::sin(0.3F), 0, std::cos(0.3F)}}, {0.1F, 0.2F, 0.4F}};
  // The float sum of tetrahedra from an origin meters away.
  EXPECT_NEAR(volumeOf(boxSurface(box, 0xFF0000FF)), 8 * 0.1 * 0.2 * 0.4, 1e-5);
}

TEST(DebugShapes, AFrameHasTwelveBeamsAroundTheEdges) {
  const OrientedBox box{{}, {0.1F, 0.2F, 0.4F}};
  const RenderSurface frame = boxFrameSurface(box, 0xFF0000FF);
  EXPECT_EQ(frame.corners.size(), 12U * 36);
  const double thick = 2 * static_cast<double>(kBeamHalfThickness);
  const double lengths = 4 * (0.2 + 0.4 + 0.8) + 12 * thick;
  EXPECT_NEAR(volumeOf(frame), lengths * thick * thick, 1e-7);
}

/// The volume of free space in cells of `grid`, with heights rounded as the surface rounds them.
double freeVolume(const ColumnGrid& grid) {
  const auto rounded = [](float height) {
    return std::round(static_cast<double>(height) / kHeightStep) * kHeightStep;
  };
  double heights = 0;
  std::vector<Span> spans;
  for (std::uint32_t k = 0; k < grid.columnsZ(); ++k) {
    for (std::uint32_t i = 0; i < grid.columnsX(); ++i) {
      spans.resize(grid.spanCount(i, k));
      grid.spans(i, k, spans);
      for (const Span& span : spans) heights += rounded(span.hi) - rounded(span.lo);
    }
  }
  const auto edge = static_cast<double>(grid.spacing());
  return heights * edge * edge;
}

/// A closed room of walls around a table: nothing free touches the end of the grid's knowledge.
test::BoxRoom closedRoom() {
  constexpr float kEnd = test::BoxRoom::kSize;
  return test::BoxRoom({{{0, -0.5F, 0}, {kEnd, 0, kEnd}},
                        {{0, 2, 0}, {kEnd, 3, kEnd}},
                        {{0, 0, 0}, {0.2F, 2, kEnd}},
                        {{kEnd - 0.2F, 0, 0}, {kEnd, 2, kEnd}},
                        {{0, 0, 0}, {kEnd, 2, 0.2F}},
                        {{0, 0, kEnd - 0.2F}, {kEnd, 2, kEnd}},
                        {{1, 0.6F, 1}, {2, 0.7F, 2}},
                        {{1.2F, 0, 1.2F}, {1.4F, 0.6F, 1.4F}}});
}

TEST(GridSurface, EnclosesTheFreeSpaceSeenFromInside) {
  const test::BoxRoom room = closedRoom();
  ASSERT_FALSE(room.scene().grids().empty());
  for (const ColumnGrid& grid : room.scene().grids()) {
    const RenderSurface surface = gridSurface(grid);
    const double free = freeVolume(grid);
    EXPECT_GT(free, 1);
    // Faces look into the free space: the volume counts negative.
    EXPECT_NEAR(volumeOf(surface), -free, 1e-3 * free) << grid.radius();
  }
}

TEST(GridSurface, LevelGroundCostsFewTriangles) {
  const test::BoxRoom room(std::vector<test::Block>{{{0, -0.5F, 0}, {3, 0, 3}}});
  const RenderSurface surface = gridSurface(room.scene().grids()[0]);
  ASSERT_EQ(surface.corners.size(), 6U);
  for (const RenderVertex& vertex : surface.vertices) {
    EXPECT_NEAR(vertex.position.y, 0.015F, 1e-6F);
  }
  // 96 x 96 columns with a table in the middle.
  const test::BoxRoom furnished({{{0, -0.5F, 0}, {3, 0, 3}}, {{1, 0, 1}, {2, 0.7F, 2}}});
  EXPECT_LT(gridSurface(furnished.scene().grids()[0]).corners.size() / 3, 100U);
}

TEST(DebugModels, NumbersModelsByWhatTheyShow) {
  const test::SmallHome home;
  const auto models = DebugModels::from(home.world(), {});
  ASSERT_TRUE(models) << models.error().message;
  const RenderLibrary& library = models->library();
  // One scene, two spheres of three radii, two boxes, two targets and two goals.
  EXPECT_EQ(library.modelCount(), 1U + 6 + 2 + 2 + 2);
  EXPECT_EQ(models->sceneModel(0), 0U);
  for (std::uint32_t n = 0; n < 3; ++n) {
    const float radius = home.world().radii()[n];
    for (const DebugSpheres whose : {DebugSpheres::kRobot, DebugSpheres::kHeld}) {
      const RenderModel& sphere = library.model(models->sphereModel(whose, n));
      // Half a step of the lattice.
      EXPECT_NEAR(sphere.bounds_max.y, radius, 4e-5F);
      EXPECT_EQ(sphere.triangles, 320U);
    }
  }
  const RenderModel& box = library.model(models->boxModel(1));
  EXPECT_NEAR(box.bounds_max.y, 0.1F, 4e-5F);
  EXPECT_EQ(box.triangles, 12U);
  EXPECT_EQ(library.model(models->targetModel(1)).bounds_max.y, box.bounds_max.y);
  EXPECT_EQ(library.model(models->targetModel(1)).triangles, 12U);
  EXPECT_EQ(library.model(models->goalModel(1)).triangles, 144U);
  EXPECT_EQ(library.semanticNames()[1], "grid");
}

TEST(DebugModels, TheGridIsThatOfTheRadius) {
  const test::SmallHome home;
  const auto small = DebugModels::from(home.world(), {});
  const auto large = DebugModels::from(home.world(), {.radius = 0.12F});
  ASSERT_TRUE(small && large);
  // The floor is a slab of 25 cm: below it, too, is free space.
  EXPECT_NEAR(small->library().model(0).bounds_min.y, -0.25F - 0.016F, kHeightStep);
  EXPECT_NEAR(large->library().model(0).bounds_min.y, -0.25F - 0.12F, kHeightStep);
  const auto none = DebugModels::from(home.world(), {.radius = 0.3F});
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message,
              HasSubstr("found a radius of 0.3 m; expected one of the world's: "
                        "0.016, 0.05, 0.12"));
}

}  // namespace
}  // namespace galactic::views::debug_models_test
