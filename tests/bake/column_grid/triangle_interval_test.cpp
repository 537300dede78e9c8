#include "column_grid/triangle_interval.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace galactic::bake::triangle_interval_test {
namespace {

using Triangle = std::array<Point, 3>;

constexpr unsigned kSeed = 20240611;
/// Rounding of double arithmetic on coordinates of one meter, with room for a few hundred
/// operations; grows with the size of the triangle.
constexpr double kRounding = 1e-12;

/// Which random triangles to draw.
enum class Shape {
  kAny,
  kHorizontal,
  kVertical,
  kVerticalEdge,
  kCollinear,
  kNeedle,
  kSteep,
  kTiny,
  kHuge,
  kCount
};

struct Question {
  Triangle triangle{};
  double x = 0;
  double z = 0;
  double radius = 0;
  /// Size of the numbers involved, at least 1.
  double scale = 1;
};

class QuestionSource {
 public:
  explicit QuestionSource(unsigned seed) : random_(seed) {}

  /// A triangle of the given shape and a column near its border, inside or out.
  Question next(Shape shape) {
    Question q;
    const double size = sizeOf(shape);
    const Point middle{number(-5, 5), number(-5, 5), number(-5, 5)};
    for (Point& corner : q.triangle) {
      for (std::size_t c = 0; c < 3; ++c) corner[c] = middle[c] + size * number(-0.5, 0.5);
    }
    deform(shape, size, q.triangle);
    q.radius = std::array{0.015, 0.05, 0.12}[random_() % 3];
    const double a = number(0, 1);
    const double b = number(0, 1 - a);
    const double spread = 1.5 * q.radius;
    q.x = mix(q.triangle, 0, a, b) + number(-spread, spread);
    q.z = mix(q.triangle, 2, a, b) + number(-spread, spread);
    q.scale = std::max(1.0, size);
    return q;
  }

  double number(double lo, double hi) {
    return std::uniform_real_distribution<double>(lo, hi)(random_);
  }

 private:
  double sizeOf(Shape shape) {
    if (shape == Shape::kTiny) return std::pow(10.0, number(-6, -3));
    if (shape == Shape::kHuge) return std::pow(10.0, number(1, 3));
    return std::pow(10.0, number(-2, 0.5));
  }

  void deform(Shape shape, double size, Triangle& t) {
    switch (shape) {
      case Shape::kHorizontal:
        t[1][1] = t[2][1] = t[0][1];
        break;
      case Shape::kVertical:
        t[1][0] = t[2][0] = t[0][0];
        break;
      case Shape::kVerticalEdge:
        t[1][0] = t[0][0];
        t[1][2] = t[0][2];
        break;
      case Shape::kCollinear:
      case Shape::kNeedle: {
        // The third corner on the line through the others, or a little aside.
        const double part = number(-0.5, 1.5);
        const double aside = shape == Shape::kNeedle ? size * std::pow(10.0, number(-12, -2)) : 0.0;
        for (std::size_t c = 0; c < 3; ++c) {
          t[2][c] = t[0][c] + part * (t[1][c] - t[0][c]) + aside * number(-1, 1);
        }
        break;
      }
      case Shape::kSteep:
        for (Point& corner : t) corner[0] = t[0][0] + 1e-6 * (corner[0] - t[0][0]);
        break;
      default:
        break;
    }
  }

  static double mix(const Triangle& t, std::size_t c, double a, double b) {
    return t[0][c] + a * (t[1][c] - t[0][c]) + b * (t[2][c] - t[0][c]);
  }

  std::mt19937_64 random_;
};

double distanceAt(const Question& q, double height) {
  return std::sqrt(squaredDistance({q.x, height, q.z}, q.triangle));
}

/// The heights to search: beyond them a ball cannot touch.
HeightInterval searchRange(const Question& q) {
  const auto [lo, hi] = std::minmax({q.triangle[0][1], q.triangle[1][1], q.triangle[2][1]});
  return {lo - 2 * q.radius, hi + 2 * q.radius};
}

/// The height of least distance: it is a convex function of the height.
double nearestHeight(const Question& q) {
  auto [lo, hi] = searchRange(q);
  for (int i = 0; i < 56; ++i) {
    const double a = lo + (hi - lo) / 3;
    const double b = hi - (hi - lo) / 3;
    if (distanceAt(q, a) < distanceAt(q, b)) {
      hi = b;
    } else {
      lo = a;
    }
  }
  return 0.5 * (lo + hi);
}

/// The height between `touching` and `clear` at which the distance passes the radius.
double bisect(const Question& q, double touching, double clear) {
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (touching + clear);
    (distanceAt(q, middle) < q.radius ? touching : clear) = middle;
  }
  return 0.5 * (touching + clear);
}

std::string describe(Shape shape, int index) {
  return "seed " + std::to_string(kSeed) + ", shape " + std::to_string(static_cast<int>(shape)) +
         ", case " + std::to_string(index);
}

TEST(TriangleInterval, AgreesWithTheDistanceOnAllShapesOfTriangles) {
  RecordProperty("seed", static_cast<int>(kSeed));
  constexpr int kCases = 200'000;
  // Where a ball passes the surface at a shallower angle than this, the height of contact is badly
  // conditioned: there the distance at the end is compared, not the end.
  constexpr double kLeastSlope = 0.1;
  QuestionSource source(kSeed);
  int touching = 0;
  int ends_compared = 0;
  for (int i = 0; i < kCases; ++i) {
    const auto shape = static_cast<Shape>(i % static_cast<int>(Shape::kCount));
    const Question q = source.next(shape);
    const double tolerance = kRounding * q.scale;
    const double nearest = nearestHeight(q);
    const double least = distanceAt(q, nearest);
    const auto found = touchingHeights(q.triangle, q.x, q.z, q.radius);
    touching += found ? 1 : 0;
    if (std::abs(least - q.radius) > tolerance) {
      ASSERT_EQ(found.has_value(), least < q.radius) << describe(shape, i) << ": " << least;
    }
    if (!found) continue;
    for (const double end : {found->lo, found->hi}) {
      ASSERT_NEAR(distanceAt(q, end), q.radius, tolerance) << describe(shape, i);
    }
    if (least > q.radius - 1e-3) continue;
    const HeightInterval range = searchRange(q);
    for (const auto& [end, clear] :
         {std::pair{found->lo, range.lo}, std::pair{found->hi, range.hi}}) {
      const double expected = bisect(q, nearest, clear);
      const double slope =
          std::abs(distanceAt(q, expected + 1e-6) - distanceAt(q, expected - 1e-6)) / 2e-6;
      if (slope < kLeastSlope) continue;
      ++ends_compared;
      ASSERT_NEAR(end, expected, tolerance / kLeastSlope) << describe(shape, i);
    }
  }
  EXPECT_GT(touching, kCases / 10);
  EXPECT_LT(touching, kCases * 9 / 10);
  EXPECT_GT(ends_compared, kCases / 10);
}

TEST(TriangleInterval, IsOneIntervalAtEveryHeight) {
  constexpr int kCases = 3000;
  constexpr int kHeights = 100;
  QuestionSource source(kSeed + 1);
  int inside = 0;
  for (int i = 0; i < kCases; ++i) {
    const auto shape = static_cast<Shape>(i % static_cast<int>(Shape::kCount));
    const Question q = source.next(shape);
    const HeightInterval range = searchRange(q);
    const auto found = touchingHeights(q.triangle, q.x, q.z, q.radius);
    for (int k = 0; k < kHeights; ++k) {
      const double height = source.number(range.lo, range.hi);
      const double distance = distanceAt(q, height);
      if (std::abs(distance - q.radius) < kRounding * q.scale) continue;
      const bool expected = found && found->lo < height && height < found->hi;
      inside += expected ? 1 : 0;
      ASSERT_EQ(distance < q.radius, expected) << describe(shape, i) << " at " << height;
    }
  }
  EXPECT_GT(inside, kCases * kHeights / 10);
  EXPECT_LT(inside, kCases * kHeights * 9 / 10);
}

TEST(TriangleInterval, OfTheFaceOfAHorizontalTriangleIsTheRadiusUpAndDown) {
  const Triangle t{Point{0, 1, 0}, {1, 1, 0}, {0, 1, 1}};
  const auto found = touchingHeights(t, 0.25, 0.25, 0.12);
  ASSERT_TRUE(found);
  EXPECT_DOUBLE_EQ(found->lo, 0.88);
  EXPECT_DOUBLE_EQ(found->hi, 1.12);
}

TEST(TriangleInterval, IsNoneJustBeyondTheRadiusOfAWall) {
  const Triangle wall{Point{0, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  EXPECT_FALSE(touchingHeights(wall, 0.125 + kRounding, 0.25, 0.125));
  EXPECT_TRUE(touchingHeights(wall, 0.125 - kRounding, 0.25, 0.125));
}

/// A face whose true normal is tilted by rounding when it is the cross product of two edges.
TEST(TriangleInterval, HoldsOnALongSliver) {
  const Triangle t{Point{-700, 3, -700}, {700, 3.5, 700}, {1e-4, 3.25, -1e-4}};
  const auto found = touchingHeights(t, 350.00001, 350.0, 0.05);
  ASSERT_TRUE(found);
  const Question q{t, 350.00001, 350.0, 0.05};
  EXPECT_NEAR(distanceAt(q, found->lo), 0.05, 1e-9);
  EXPECT_NEAR(distanceAt(q, found->hi), 0.05, 1e-9);
}

/// Extreme ends over a square of centers by zooming in on the best of a grid.
class SquareSearch {
 public:
  SquareSearch(const Question& q, double half) : q_(q), half_(half) {}

  [[nodiscard]] std::optional<HeightInterval> run() const {
    std::optional<HeightInterval> hull;
    Best low;
    Best high;
    scan({q_.x, q_.z, half_}, hull, low, high);
    if (!hull) return hull;
    double half = half_;
    for (int zoom = 0; zoom < 8; ++zoom) {
      half /= kPoints / 3.0;
      const Best from_low = low;
      const Best from_high = high;
      scan({from_low.x, from_low.z, half}, hull, low, high);
      scan({from_high.x, from_high.z, half}, hull, low, high);
    }
    return hull;
  }

 private:
  static constexpr int kPoints = 24;

  struct Window {
    double x = 0;
    double z = 0;
    double half = 0;
  };
  struct Best {
    double x = 0;
    double z = 0;
  };

  void scan(const Window& window, std::optional<HeightInterval>& hull, Best& low,
            Best& high) const {
    for (int i = 0; i <= kPoints; ++i) {
      for (int k = 0; k <= kPoints; ++k) {
        const double x = std::clamp(window.x + window.half * (2.0 * i / kPoints - 1), q_.x - half_,
                                    q_.x + half_);
        const double z = std::clamp(window.z + window.half * (2.0 * k / kPoints - 1), q_.z - half_,
                                    q_.z + half_);
        const auto found = touchingHeights(q_.triangle, x, z, q_.radius);
        if (!found) continue;
        if (!hull || found->lo < hull->lo) low = {x, z};
        if (!hull || found->hi > hull->hi) high = {x, z};
        if (!hull) hull = found;
        hull->lo = std::min(hull->lo, found->lo);
        hull->hi = std::max(hull->hi, found->hi);
      }
    }
  }

  const Question& q_;
  double half_;
};

TEST(TriangleIntervalOverCell, EqualsTheHullOverAFineSquareOfCenters) {
  RecordProperty("seed", static_cast<int>(kSeed + 2));
  constexpr int kCases = 1500;
  constexpr double kHalf = 0.015;
  // What the search leaves: its last window is a billionth of the cell, but its first may zoom in
  // on the second best of two summits of nearly the same height.
  constexpr double kSearchLeaves = 1e-5;
  QuestionSource source(kSeed + 2);
  int touching = 0;
  for (int i = 0; i < kCases; ++i) {
    const auto shape = static_cast<Shape>(i % static_cast<int>(Shape::kCount));
    const Question q = source.next(shape);
    const auto found = touchingHeightsOverCell(CellTriangle(q.triangle), q.x, q.z, kHalf, q.radius);
    const auto expected = SquareSearch(q, kHalf).run();
    touching += found ? 1 : 0;
    if (expected) {
      ASSERT_TRUE(found) << describe(shape, i);
      ASSERT_LE(found->lo, expected->lo + kRounding * q.scale) << describe(shape, i);
      ASSERT_GE(found->hi, expected->hi - kRounding * q.scale) << describe(shape, i);
      ASSERT_GE(found->lo, expected->lo - kSearchLeaves) << describe(shape, i);
      ASSERT_LE(found->hi, expected->hi + kSearchLeaves) << describe(shape, i);
    } else if (found) {
      // The search's first grid may step over a graze.
      ASSERT_LT(found->hi - found->lo, q.radius) << describe(shape, i);
    }
  }
  EXPECT_GT(touching, kCases / 10);
  EXPECT_LT(touching, kCases * 95 / 100);
}

/// Least value of a convex function on [0, 1].
template <class Function>
double leastOf(const Function& function) {
  double lo = 0;
  double hi = 1;
  for (int i = 0; i < 70; ++i) {
    const double a = lo + (hi - lo) / 3;
    const double b = hi - (hi - lo) / 3;
    if (function(a) < function(b)) {
      hi = b;
    } else {
      lo = a;
    }
  }
  return std::min({function(0.5 * (lo + hi)), function(0.0), function(1.0)});
}

/// Least distance by searching the triangle's points: no projection, no edge, no normal.
double searchedDistance(const Point& point, const Triangle& t) {
  return std::sqrt(leastOf([&](double a) {
    return leastOf([&](double part) {
      const double b = part * (1 - a);
      double squared = 0;
      for (std::size_t c = 0; c < 3; ++c) {
        const double d = t[0][c] + a * (t[1][c] - t[0][c]) + b * (t[2][c] - t[0][c]) - point[c];
        squared += d * d;
      }
      return squared;
    });
  }));
}

TEST(TriangleDistance, AgreesWithSearchingTheTriangle) {
  RecordProperty("seed", static_cast<int>(kSeed + 3));
  // The squared distance is flat about its least value: the search ends where it stops changing.
  constexpr double kSearchLeaves = 1e-7;
  QuestionSource source(kSeed + 3);
  for (int i = 0; i < 900; ++i) {
    const auto shape = static_cast<Shape>(i % static_cast<int>(Shape::kCount));
    const Question q = source.next(shape);
    const HeightInterval range = searchRange(q);
    const Point point{q.x, source.number(range.lo, range.hi), q.z};
    ASSERT_NEAR(std::sqrt(squaredDistance(point, q.triangle)), searchedDistance(point, q.triangle),
                kSearchLeaves * q.scale)
        << describe(shape, i);
  }
}

}  // namespace
}  // namespace galactic::bake::triangle_interval_test
