// Distances to where a column grid says something else, against all boxes that its columns are.
#include "column_grid/grid_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "support/oracles/resting_oracle.h"
#include "support/packs/grid_builder.h"

namespace galactic::test::grid_distance_test {
namespace {

using detail::Directions;
using detail::GridDistance;
using detail::SignedDistance;

constexpr std::uint32_t kSeed = 83;
/// Heights keep clear of contacts by so much in a grid of 32 m; the rest is rounding.
constexpr double kTolerance = 1e-4;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// More than a block along either axis, and not whole blocks.
GridSpec specOf(Span heights) {
  return {.spacing = 0.25F,
          .min_x = -3,
          .min_z = 2,
          .heights = heights,
          .columns_x = 29,
          .columns_z = 19};
}

double beyond(double at, double lo, double hi) { return std::max({lo - at, at - hi, 0.0}); }

/// The columns as boxes, in double precision; all of them are looked at.
class AllBoxes {
 public:
  explicit AllBoxes(const TestGrid& grid) : spec_(grid.spec), columns_(grid.columns) {}

  [[nodiscard]] bool isFree(const Point3& p) const {
    return distance(p, true, Directions::kAll) == 0;
  }
  /// To the nearest place that is free, or is not.
  [[nodiscard]] double distance(const Point3& p, bool free, Directions directions) const {
    double nearest = free ? kInfinity : edgeDistance(p);
    for (std::uint32_t k = 0; k < spec_.columns_z; ++k) {
      for (std::uint32_t i = 0; i < spec_.columns_x; ++i) {
        const double x = beyond(p[0], edge(spec_.min_x, i), edge(spec_.min_x, i + 1));
        const double z = beyond(p[2], edge(spec_.min_z, k), edge(spec_.min_z, k + 1));
        const auto& spans = columns_[std::size_t{k} * spec_.columns_x + i];
        const double y = free ? toFree(spans, p[1]) : toBlocked(spans, p[1]);
        if (directions == Directions::kLevel && y > 0) continue;
        nearest = std::min(nearest, std::hypot(x, y, z));
      }
    }
    return nearest;
  }

 private:
  [[nodiscard]] double edge(float min, std::uint32_t n) const {
    return static_cast<double>(min) + static_cast<double>(spec_.spacing) * n;
  }
  [[nodiscard]] double edgeDistance(const Point3& p) const {
    return std::max(
        0.0, std::min({p[0] - edge(spec_.min_x, 0), edge(spec_.min_x, spec_.columns_x) - p[0],
                       p[2] - edge(spec_.min_z, 0), edge(spec_.min_z, spec_.columns_z) - p[2]}));
  }
  static double toFree(const std::vector<Span>& spans, double y) {
    double nearest = kInfinity;
    for (const Span& span : spans) {
      nearest =
          std::min(nearest, beyond(y, static_cast<double>(span.lo), static_cast<double>(span.hi)));
    }
    return nearest;
  }
  static double toBlocked(const std::vector<Span>& spans, double y) {
    for (const Span& span : spans) {
      const double down = y - static_cast<double>(span.lo);
      const double up = static_cast<double>(span.hi) - y;
      if (down >= 0 && up >= 0) return std::min(down, up);
    }
    return 0;
  }

  GridSpec spec_;
  std::vector<std::vector<Span>> columns_;
};

/// In a grid and a little around it.
Vec3 randomPlace(const GridSpec& spec, std::mt19937& random) {
  constexpr float kAround = 0.4F;
  const float width = spec.spacing * static_cast<float>(spec.columns_x);
  const float depth = spec.spacing * static_cast<float>(spec.columns_z);
  return {uniformIn(random, spec.min_x - kAround, spec.min_x + width + kAround),
          uniformIn(random, spec.heights.lo - kAround, spec.heights.hi + kAround),
          uniformIn(random, spec.min_z - kAround, spec.min_z + depth + kAround)};
}

/// How a grid's answers compare with those of all boxes.
class Comparison {
 public:
  Comparison(TestGrid grid, float most)
      : grid_(std::move(grid)), most_(most), boxes_(grid_), distance_(grid_.view()) {}

  void compare(const Vec3& center, Directions directions) {
    const Point3 p = toPoint3(center);
    const bool is_free = boxes_.isFree(p);
    const double expected = (is_free ? 1 : -1) * std::min(boxes_.distance(p, !is_free, directions),
                                                          static_cast<double>(most_));
    const SignedDistance found = distance_.at(center, most_, directions);
    ASSERT_NEAR(static_cast<double>(found.distance), expected, kTolerance)
        << center.x << " " << center.y << " " << center.z;
    // Consistent with queries, bit for bit.
    ASSERT_EQ(std::signbit(found.distance), grid_.view().clearance(center) != Clearance::kFree);
    ++(is_free ? free : blocked);
    if (std::abs(expected) > static_cast<double>(most_) - kTolerance) {
      ++far;
      return;
    }
    if (std::abs(expected) > kTolerance) expectToLeadThere(p, found, directions);
  }

  int free = 0;
  int blocked = 0;
  int far = 0;

 private:
  /// Against the gradient, the nearest point is as far as the distance says.
  void expectToLeadThere(const Point3& p, const SignedDistance& found, Directions directions) {
    const Point3 gradient = toPoint3(found.gradient);
    ASSERT_NEAR(std::hypot(gradient[0], gradient[1], gradient[2]), 1, 1e-5);
    if (directions == Directions::kLevel) {
      ASSERT_EQ(found.gradient.y, 0);
    }
    Point3 there = p;
    for (std::size_t n = 0; n < 3; ++n)
      there[n] -= gradient[n] * static_cast<double>(found.distance);
    const bool is_free = found.distance > 0;
    EXPECT_LT(boxes_.distance(there, !is_free, Directions::kAll), kTolerance);
  }

  TestGrid grid_;
  float most_;
  AllBoxes boxes_;
  GridDistance distance_;
};

class GridDistances : public testing::TestWithParam<Span> {};

TEST_P(GridDistances, AreThoseToTheNearestOfAllBoxes) {
  constexpr int kGrids = 6;
  constexpr int kPlaces = 150;
  std::mt19937 random(kSeed);
  for (const Directions directions : {Directions::kAll, Directions::kLevel}) {
    int free = 0;
    int blocked = 0;
    int far = 0;
    for (int n = 0; n < kGrids; ++n) {
      const GridSpec spec = specOf(GetParam());
      Comparison comparison(roomyGrid(spec, random), n % 2 == 0 ? 0.3F : 2.0F);
      for (int place = 0; place < kPlaces; ++place) {
        comparison.compare(randomPlace(spec, random), directions);
        if (HasFatalFailure()) return;
      }
      free += comparison.free;
      blocked += comparison.blocked;
      far += comparison.far;
    }
    // Both sides, near and far.
    constexpr int kAll = kGrids * kPlaces;
    EXPECT_GT(std::min(free, blocked), kAll / 10);
    EXPECT_GT(std::min(far, kAll - far), kAll / 50);
  }
}

// One range of codes for all heights, and a base for each tile.
INSTANTIATE_TEST_SUITE_P(FlatAndTall, GridDistances, testing::Values(Span{0, 8}, Span{-12, 20}));

TEST(GridDistance, OfACenterInTheMiddleOfNothingIsTheMost) {
  GridSpec spec = specOf({0, 8});
  GridBuilder builder(spec);
  for (std::uint32_t k = 0; k < spec.columns_z; ++k) {
    for (std::uint32_t i = 0; i < spec.columns_x; ++i) builder.column(i, k, {spec.heights});
  }
  const TestGrid grid = builder.build();
  const GridDistance distance(grid.view());
  const Vec3 middle{0.5F, 4, 4.5F};
  const SignedDistance near = distance.at(middle, 1, Directions::kAll);
  EXPECT_EQ(near.distance, 1);
  EXPECT_EQ(near.gradient, Vec3{});
  // However far it may look, it ends at the edge of the grid.
  const SignedDistance far = distance.at(middle, 1e6F, Directions::kLevel);
  EXPECT_NEAR(far.distance, 2.25F, 1e-5F);
  EXPECT_EQ(far.gradient, (Vec3{0, 0, -1}));
  // Far away there is nothing either.
  const SignedDistance outside = distance.at({1e6F, 0, -1e6F}, 1, Directions::kAll);
  EXPECT_EQ(outside.distance, -1);
  EXPECT_EQ(outside.gradient, Vec3{});
}

}  // namespace
}  // namespace galactic::test::grid_distance_test
