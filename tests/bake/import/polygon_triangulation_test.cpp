// Polygons against an oracle: the triangles of a simple polygon cover it once, whatever its shape.
#include "import/polygon_triangulation.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

namespace galactic::test::polygon_triangulation_test {
namespace {

using bake::Triangle;
using bake::triangulatePolygon;

constexpr std::uint64_t kPlenty = 1'000'000;

/// Signed area, positive counter-clockwise, of a triangle in the (x, z) plane seen from above: z
/// points down in that view.
double areaFromAbove(const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto d = [](float to, float from) {
    return static_cast<double>(to) - static_cast<double>(from);
  };
  return 0.5 * (d(b.z, a.z) * d(c.x, a.x) - d(b.x, a.x) * d(c.z, a.z));
}

bool covers(const std::vector<Vec3>& corners, const Triangle& t, const Vec3& p) {
  const double ab = areaFromAbove(corners[t[0]], corners[t[1]], p);
  const double bc = areaFromAbove(corners[t[1]], corners[t[2]], p);
  const double ca = areaFromAbove(corners[t[2]], corners[t[0]], p);
  return ab > 0 && bc > 0 && ca > 0;
}

/// Even-odd rule: an independent answer to "is p inside the polygon".
bool inside(const std::vector<Vec3>& corners, const Vec3& p) {
  bool odd = false;
  for (std::size_t i = 0, j = corners.size() - 1; i < corners.size(); j = i++) {
    const Vec3& a = corners[i];
    const Vec3& b = corners[j];
    if ((a.z > p.z) == (b.z > p.z)) continue;
    const float crossing = a.x + (p.z - a.z) / (b.z - a.z) * (b.x - a.x);
    if (p.x < crossing) odd = !odd;
  }
  return odd;
}

std::vector<Triangle> triangulated(const std::vector<Vec3>& corners) {
  std::vector<std::uint32_t> order(corners.size());
  std::iota(order.begin(), order.end(), 0U);
  std::vector<Triangle> triangles;
  std::uint64_t comparisons_left = kPlenty;
  EXPECT_TRUE(triangulatePolygon(order, corners, comparisons_left, triangles));
  return triangles;
}

TEST(PolygonTriangulation, CoversStarsOnceAndNothingElse) {
  constexpr unsigned kSeed = 11;
  constexpr int kPolygons = 200;
  constexpr int kPoints = 50;
  SCOPED_TRACE(fmt::format("seed {}", kSeed));
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<float> radius(0.2F, 2);
  std::uniform_real_distribution<float> place(-2, 2);
  int within = 0;
  int concave = 0;
  for (int n = 0; n < kPolygons; ++n) {
    const auto size = 3 + random() % 12;
    std::vector<Vec3> corners;
    for (unsigned i = 0; i < size; ++i) {
      // Counter-clockwise seen from above (x to -z), slightly out of plane.
      const float angle =
          2 * std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(size);
      const float r = radius(random);
      corners.push_back({r * std::cos(angle), 0.01F * place(random), -r * std::sin(angle)});
    }
    const auto triangles = triangulated(corners);
    ASSERT_EQ(triangles.size(), corners.size() - 2);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const auto& next = corners[(i + 1) % corners.size()];
      concave += areaFromAbove(corners[i], next, corners[(i + 2) % corners.size()]) < 0 ? 1 : 0;
    }
    for (int k = 0; k < kPoints; ++k) {
      const Vec3 p{place(random), 0, place(random)};
      const auto hits = std::count_if(triangles.begin(), triangles.end(),
                                      [&](const Triangle& t) { return covers(corners, t, p); });
      const bool expected = inside(corners, p);
      within += expected ? 1 : 0;
      EXPECT_EQ(hits, expected ? 1 : 0) << "polygon " << n << " at (" << p.x << ", " << p.z << ")";
    }
  }
  EXPECT_GE(within, kPolygons * kPoints / 10);
  EXPECT_LE(within, kPolygons * kPoints * 9 / 10);
  EXPECT_GE(concave, kPolygons) << "too few notches to mean anything";
}

/// A circle, or a comb whose teeth hide one another's roots.
std::vector<Vec3> manyCorners(std::size_t count, bool comb) {
  std::vector<Vec3> corners;
  for (std::size_t n = 0; n < count; ++n) {
    const float share = static_cast<float>(n) / static_cast<float>(count);
    const float angle = 2 * std::numbers::pi_v<float> * share;
    corners.push_back(comb ? Vec3{n % 2 == 0 ? 0.0F : 1 - share, 0, share}
                           : Vec3{std::cos(angle), 0, -std::sin(angle)});
  }
  if (comb) corners.push_back({-1, 0, 0.5F});
  return corners;
}

TEST(PolygonTriangulation, EndsWhereItTakesMoreComparisonsThanAllowed) {
  for (const bool comb : {false, true}) {
    SCOPED_TRACE(comb ? "comb" : "circle");
    for (const std::size_t count : {100U, 2000U}) {
      const std::vector<Vec3> corners = manyCorners(count, comb);
      std::vector<std::uint32_t> order(corners.size());
      std::iota(order.begin(), order.end(), 0U);
      // Enough for the small one, and a small share of what the large one takes.
      std::uint64_t left = 200'000;
      std::vector<Triangle> triangles;
      EXPECT_EQ(triangulatePolygon(order, corners, left, triangles), count == 100);
      EXPECT_EQ(left == 0, count != 100);
      EXPECT_EQ(triangles.size() == corners.size() - 2, count == 100);
    }
  }
}

TEST(PolygonTriangulation, KeepsTheWindingInEveryPlane) {
  const std::array<std::array<float, 2>, 6> ell{{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}};
  for (int plane = 0; plane < 3; ++plane) {
    for (const bool reversed : {false, true}) {
      std::vector<Vec3> corners;
      for (const auto& [u, v] : ell) {
        const std::array<Vec3, 3> placed{Vec3{u, v, 5}, Vec3{5, u, v}, Vec3{v, 5, u}};
        corners.push_back(placed[static_cast<std::size_t>(plane)]);
      }
      if (reversed) std::reverse(corners.begin(), corners.end());
      double area = 0;
      for (const Triangle& t : triangulated(corners)) {
        const std::array<double, 3> a{static_cast<double>(corners[t[0]].x),
                                      static_cast<double>(corners[t[0]].y),
                                      static_cast<double>(corners[t[0]].z)};
        const std::array<double, 3> b{static_cast<double>(corners[t[1]].x),
                                      static_cast<double>(corners[t[1]].y),
                                      static_cast<double>(corners[t[1]].z)};
        const std::array<double, 3> c{static_cast<double>(corners[t[2]].x),
                                      static_cast<double>(corners[t[2]].y),
                                      static_cast<double>(corners[t[2]].z)};
        const auto u = static_cast<std::size_t>(plane);
        const std::size_t v = (u + 1) % 3;
        const double signed_area =
            0.5 * ((b[u] - a[u]) * (c[v] - a[v]) - (b[v] - a[v]) * (c[u] - a[u]));
        EXPECT_GT(reversed ? -signed_area : signed_area, 0);
        area += std::abs(signed_area);
      }
      EXPECT_EQ(area, 3) << "the L has an area of 3, its convex hull 3.5";
    }
  }
}

TEST(PolygonTriangulation, EndsOnPolygonsThatCrossThemselvesOrHaveNoArea) {
  EXPECT_EQ(triangulated({{0, 0, 0}, {1, 0, 1}, {1, 0, 0}, {0, 0, 1}}).size(), 2U);
  EXPECT_EQ(triangulated({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {1, 0, 0}}).size(), 3U);
  EXPECT_EQ(triangulated(std::vector<Vec3>(6)).size(), 4U);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(triangulated({{0, 0, 0}, {nan, 0, 0}, {2, 0, 0}, {3, nan, 0}, {1, 0, 0}}).size(), 3U);
}

TEST(PolygonTriangulation, LeavesCornersOutOfRangeForTheChecks) {
  const std::vector<Vec3> positions(3);
  std::vector<Triangle> triangles;
  std::uint64_t comparisons_left = kPlenty;
  EXPECT_TRUE(triangulatePolygon(std::vector<std::uint32_t>{0, 1, 2, 9}, positions,
                                 comparisons_left, triangles));
  EXPECT_THAT(triangles, testing::ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 9}));
  EXPECT_TRUE(
      triangulatePolygon(std::vector<std::uint32_t>{0, 1}, positions, comparisons_left, triangles));
  EXPECT_EQ(triangles.size(), 2U) << "points and lines have no triangles";
}

}  // namespace
}  // namespace galactic::test::polygon_triangulation_test
