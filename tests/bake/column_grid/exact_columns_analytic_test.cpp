// The exact engine on shapes whose free heights are known in closed form.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "column_grid/triangle_interval.h"
#include "galactic/bake/column_engines.h"
#include "support/test_meshes.h"

namespace galactic::bake::exact_columns_analytic_test {
namespace {

using test::MeshBuilder;
using Blocked = std::vector<HeightInterval>;

/// Ends are floats computed in float arithmetic relative to the triangle.
constexpr double kEndTolerance = 1e-5;
/// Columns whose surface is this close to the radius are ties; meters.
constexpr double kTie = 2e-6;
constexpr float kSpacing = 0.03F;
constexpr float kRadii[] = {0.015F, 0.05F, 0.12F};

/// Where a column stands and the radius asked for.
struct Line {
  double x = 0;
  double z = 0;
  double radius = 0;
};

/// Blocked heights in closed form, in any order, overlapping or not; adds nothing where the line
/// touches nothing. Returns false on lines that it cannot answer for.
using ClosedForm = std::function<bool(const Line& line, Blocked& blocked)>;

std::vector<HeightInterval> freeHeights(Blocked blocked, const Span& heights) {
  std::sort(blocked.begin(), blocked.end(),
            [](const auto& a, const auto& b) { return a.lo < b.lo; });
  std::vector<HeightInterval> free;
  auto reached = static_cast<double>(heights.lo);
  for (const HeightInterval& interval : blocked) {
    if (interval.lo - reached > static_cast<double>(kMergeTolerance)) {
      free.push_back({reached, interval.lo});
    }
    reached = std::max(reached, interval.hi);
  }
  free.push_back({reached, static_cast<double>(heights.hi)});
  return free;
}

/// How many columns had an obstacle in them, and how many had a closed form.
struct Compared {
  int touching = 0;
  int all = 0;
};

Compared compare(const TriangleMesh& mesh, float radius, const ClosedForm& closed_form) {
  const GridFrame frame = makeGridFrame(mesh.bounds, radius, kSpacing).value();
  const Columns columns = exactColumns(mesh, frame).columns;
  EXPECT_EQ(columns.first.size(), frame.columnCount() + 1);
  Compared compared;
  for (std::uint32_t k = 0; k < frame.columns_z; ++k) {
    for (std::uint32_t i = 0; i < frame.columns_x; ++i) {
      Blocked blocked;
      const Line line{frame.centerX(i), frame.centerZ(k), static_cast<double>(radius)};
      if (!closed_form(line, blocked)) continue;
      ++compared.all;
      compared.touching += blocked.empty() ? 0 : 1;
      const auto expected = freeHeights(blocked, frame.heights);
      const auto found = columns.column(columns.index(i, k));
      EXPECT_EQ(found.size(), expected.size()) << "column " << line.x << ", " << line.z;
      if (found.size() != expected.size()) return compared;
      for (std::size_t s = 0; s < found.size(); ++s) {
        EXPECT_NEAR(static_cast<double>(found[s].lo), expected[s].lo, kEndTolerance);
        EXPECT_NEAR(static_cast<double>(found[s].hi), expected[s].hi, kEndTolerance);
      }
    }
  }
  return compared;
}

void expectClosedForm(const TriangleMesh& mesh, const ClosedForm& closed_form) {
  for (const float radius : kRadii) {
    SCOPED_TRACE(testing::Message() << "radius " << radius);
    const Compared compared = compare(mesh, radius, closed_form);
    EXPECT_GT(compared.touching, compared.all / 20);
    EXPECT_GT(compared.all, 100);
  }
}

/// Half height of a ball's vertical chord at distance `aside` from its center; 0 beyond the radius.
double halfChord(double radius, double aside) {
  return aside < radius ? std::sqrt(radius * radius - aside * aside) : 0;
}

/// The shell of an axis-aligned box.
bool boxShell(const Vec3& min, const Vec3& max, const Line& line, Blocked& blocked) {
  const double left = static_cast<double>(min.x) - line.x;
  const double right = line.x - static_cast<double>(max.x);
  const double front = static_cast<double>(min.z) - line.z;
  const double back = line.z - static_cast<double>(max.z);
  const auto lo = static_cast<double>(min.y);
  const auto hi = static_cast<double>(max.y);
  const double inside = std::max({left, right, front, back});
  if (inside < 0) {
    if (std::abs(-inside - line.radius) < kTie) return false;
    if (-inside < line.radius) {
      blocked.push_back({lo - line.radius, hi + line.radius});
      return true;
    }
    blocked.push_back({lo - line.radius, lo + line.radius});
    blocked.push_back({hi - line.radius, hi + line.radius});
    return true;
  }
  const double aside = std::hypot(std::max({left, right, 0.0}), std::max({front, back, 0.0}));
  if (std::abs(aside - line.radius) < kTie) return false;
  if (aside < line.radius) {
    const double half = halfChord(line.radius, aside);
    blocked.push_back({lo - half, hi + half});
  }
  return true;
}

TEST(ExactColumns, OfAFloorSlabEndAtTheRadiusFromItsFaces) {
  const Vec3 min{0.013F, -0.1F, 0.007F};
  const Vec3 max{1.5F, 0, 1.2F};
  expectClosedForm(MeshBuilder().box(min, max).build(), [&](const Line& line, Blocked& blocked) {
    return boxShell(min, max, line, blocked);
  });
}

TEST(ExactColumns, OfABoxKnowItsHollowInside) {
  const Vec3 min{-0.71F, 0.3F, 1.107F};
  const Vec3 max{0.12F, 1.4F, 1.9F};
  expectClosedForm(MeshBuilder().box(min, max).build(), [&](const Line& line, Blocked& blocked) {
    return boxShell(min, max, line, blocked);
  });
}

TEST(ExactColumns, OfABeamOverAFloorHaveOneSpanBelowAndOneAbove) {
  const Vec3 floor_min{0.011F, -0.2F, 0.003F};
  const Vec3 floor_max{1.21F, 0, 1.17F};
  const Vec3 beam_min{-0.2F, 2.2F, 0.512F};
  const Vec3 beam_max{1.4F, 2.31F, 0.633F};
  const TriangleMesh mesh = MeshBuilder().box(floor_min, floor_max).box(beam_min, beam_max).build();
  expectClosedForm(mesh, [&](const Line& line, Blocked& blocked) {
    return boxShell(floor_min, floor_max, line, blocked) &&
           boxShell(beam_min, beam_max, line, blocked);
  });
}

/// A square of two triangles in a plane that rises along x, seen where its border is out of reach.
TEST(ExactColumns, OfATiltedPlaneEndAtTheRadiusOverItsCosine) {
  for (const double slope : {0.0, 0.02, 0.5, 1.0, 3.0, 12.0}) {
    SCOPED_TRACE(testing::Message() << "slope " << slope);
    const auto height = [&](float x) { return static_cast<float>(slope * static_cast<double>(x)); };
    const TriangleMesh mesh = MeshBuilder()
                                  .quad({Vec3{-1, height(-1), -1},
                                         {-1, height(-1), 1},
                                         {1, height(1), 1},
                                         {1, height(1), -1}})
                                  .build();
    expectClosedForm(mesh, [&](const Line& line, Blocked& blocked) {
      if (std::max(std::abs(line.x), std::abs(line.z)) > 1 - 1.01 * line.radius) return false;
      const double half = line.radius * std::sqrt(1 + slope * slope);
      blocked.push_back({slope * line.x - half, slope * line.x + half});
      return true;
    });
  }
}

TEST(ExactColumns, OfASphereEndAtTheSumOfBothRadii) {
  constexpr double kSphereRadius = 0.5;
  constexpr int kRings = 100;
  // The mesh lies inside its sphere, by no more than this.
  const double sagitta = kSphereRadius * (1 - std::cos(std::numbers::pi / kRings));
  const TriangleMesh mesh =
      MeshBuilder().sphere({0.01F, 0.5F, 0.02F}, static_cast<float>(kSphereRadius), kRings).build();
  for (const float radius : kRadii) {
    const auto r = static_cast<double>(radius);
    const GridFrame frame = makeGridFrame(mesh.bounds, radius, kSpacing).value();
    const Columns columns = exactColumns(mesh, frame).columns;
    for (std::uint32_t k = 0; k < frame.columns_z; ++k) {
      for (std::uint32_t i = 0; i < frame.columns_x; ++i) {
        const double aside = std::hypot(frame.centerX(i) - 0.01, frame.centerZ(k) - 0.02);
        const auto spans = columns.column(columns.index(i, k));
        if (aside > kSphereRadius + r) {
          EXPECT_EQ(spans.size(), 1U);
          continue;
        }
        // The height of a steep surface says little of its distance.
        if (aside > 0.7 * (kSphereRadius - r)) continue;
        ASSERT_EQ(spans.size(), 3U) << "radius " << radius;
        const double outer = halfChord(kSphereRadius + r, aside);
        const double inner = halfChord(kSphereRadius - r, aside);
        const double slack = 2 * sagitta;
        EXPECT_NEAR(static_cast<double>(spans[0].hi), 0.5 - outer, slack);
        EXPECT_NEAR(static_cast<double>(spans[1].lo), 0.5 - inner, slack);
        EXPECT_NEAR(static_cast<double>(spans[1].hi), 0.5 + inner, slack);
        EXPECT_NEAR(static_cast<double>(spans[2].lo), 0.5 + outer, slack);
        EXPECT_GE(static_cast<double>(spans[0].hi), 0.5 - outer - kEndTolerance);
        EXPECT_LE(static_cast<double>(spans[2].lo), 0.5 + outer + kEndTolerance);
      }
    }
  }
}

/// Two sheets that share no vertex: what lies between them is free only from twice the radius on.
TEST(ExactColumns, OfTwoSheetsHoldASpanOnlyWhereTheSphereFitsBetween) {
  for (const double gap : {0.005, 0.0301, 0.1001, 0.2401, 0.5}) {
    SCOPED_TRACE(testing::Message() << "gap " << gap);
    const Vec3 min{-0.5F, 0, -0.5F};
    const Vec3 max{0.5F, 0, 0.5F};
    const auto upper = static_cast<float>(1 + gap);
    const TriangleMesh mesh = MeshBuilder().floor(min, max, 1).floor(min, max, upper).build();
    expectClosedForm(mesh, [&](const Line& line, Blocked& blocked) {
      if (std::max(std::abs(line.x), std::abs(line.z)) > 0.5) return false;
      blocked.push_back({1 - line.radius, 1 + line.radius});
      const auto top = static_cast<double>(upper);
      blocked.push_back({top - line.radius, top + line.radius});
      return true;
    });
  }
}

/// Distance to the side of the wall's rectangle in the ground plane, a segment along z.
double besideSegment(const Line& line, double x, double from, double to) {
  return std::hypot(line.x - x, std::max({from - line.z, line.z - to, 0.0}));
}

TEST(ExactColumns, OfAVerticalWallAreBlockedFromBelowItToAboveIt) {
  const float x = 0.204F;
  const TriangleMesh mesh =
      MeshBuilder()
          .quad({Vec3{x, 0, -0.4F}, {x, 0, 0.7F}, {x, 2.5F, 0.7F}, {x, 2.5F, -0.4F}})
          .build();
  expectClosedForm(mesh, [&](const Line& line, Blocked& blocked) {
    const double aside = besideSegment(line, static_cast<double>(x), static_cast<double>(-0.4F),
                                       static_cast<double>(0.7F));
    if (std::abs(aside - line.radius) < kTie) return false;
    if (aside < line.radius) {
      const double half = halfChord(line.radius, aside);
      blocked.push_back({-half, 2.5 + half});
    }
    return true;
  });
}

/// Thin to the eye, level, and too thin for a normal in floats.
TEST(ExactColumns, OfANeedleAreThoseOfASegment) {
  for (const float width : {1e-3F, 1e-5F, 2e-7F}) {
    SCOPED_TRACE(testing::Message() << "width " << width);
    TriangleMesh mesh =
        MeshBuilder().triangle({0.3F, 1, -0.9F}, {0.3F, 1, 0.9F}, {0.3F + width, 1, 0}).build();
    // So that columns stand on its near side within the smallest radius too.
    mesh.bounds.min.x -= 0.01F;
    for (const float radius : kRadii) {
      const Compared compared = compare(mesh, radius, [&](const Line& line, Blocked& blocked) {
        const double aside = besideSegment(line, static_cast<double>(0.3F),
                                           static_cast<double>(-0.9F), static_cast<double>(0.9F));
        // The needle's own width moves the ends on its far side.
        const double near_end = std::abs(aside - line.radius);
        if (near_end < 0.1 * line.radius || line.x > 0.3) return false;
        if (aside < line.radius) {
          const double half = halfChord(line.radius, aside);
          blocked.push_back({1 - half, 1 + half});
        }
        return true;
      });
      EXPECT_GT(compared.touching, 20);
    }
  }
}

}  // namespace
}  // namespace galactic::bake::exact_columns_analytic_test
