// Every option of sphere sets, and what is said about wrong ones.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "galactic/bake/sphere_set.h"
#include "sphere_set/shapes.h"

namespace galactic::bake::options_test {
namespace {

constexpr std::uint32_t kSeed = 20250405;
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

TriangleMesh someBox() { return test::box(0.1, 0.06, 0.2).mesh; }
/// Needs many spheres, and has a small surface: sets of it are found in a second.
TriangleMesh slenderCylinder() { return test::cylinder(0.02, 0.3).mesh; }

double largestGap(const TriangleMesh& mesh, const SphereSet& set, const SphereSetOptions& options) {
  double largest = 0;
  for (const Point& p : test::randomSurfacePoints(mesh, kSeed, 5000)) {
    if (options.support && p[1] < static_cast<double>(options.support->offset)) continue;
    largest = std::max(largest, test::gapOf(p, set.spheres, options.radii));
  }
  return largest;
}

struct WrongOption {
  SphereSetOptions options;
  std::string where;
  std::string message;
};

std::vector<WrongOption> wrongOptions() {
  const auto with = [](auto change) {
    SphereSetOptions options;
    change(options);
    return options;
  };
  return {
      {with([](auto& o) { o.radii.clear(); }), "radii",
       "0 radii were given; give 1 to 8, in meters, ascending"},
      {with([](auto& o) { o.radii.assign(9, 0.1F); }), "radii",
       "9 radii were given; give 1 to 8, in meters, ascending"},
      {with([](auto& o) { o.radii = {-1}; }), "radii[0]",
       "the radius -1 m is out of range; give 0.0001 to 10 m"},
      {with([](auto& o) {
         o.radii = {0.1F, kNaN};
       }),
       "radii[1]", "the radius nan m is out of range; give 0.0001 to 10 m"},
      {with([](auto& o) {
         o.radii = {0.1F, 0.1F};
       }),
       "radii[1]", "0.1 m comes after 0.1 m; list each radius once, ascending"},
      {with([](auto& o) { o.eps = 0; }), "eps",
       "a tolerance of 0 m was given; give 0.0001 to 10 m"},
      {with([](auto& o) { o.tau = -0.5F; }), "tau",
       "a tolerance of -0.5 m was given; give 0 to 10 m"},
      {with([](auto& o) {
         o.support = HalfSpace{{0, 2, 0}, 0};
       }),
       "support.normal", "(0, 2, 0) has the length 2; give a unit vector"},
      {with([](auto& o) {
         o.support = HalfSpace{{0, 1, 0}, kNaN};
       }),
       "support.offset", "the distance nan is not valid; give meters along the normal"},
      {with([](auto& o) {
         o.support = HalfSpace{{0, 1, 0}, 3};
       }),
       "support",
       "all of the reachable surface is beyond the plane, so there is nothing to cover; check its "
       "normal and offset"},
  };
}

TEST(SphereSetOptions, ThatAreWrongAreRefusedByName) {
  for (const WrongOption& wrong : wrongOptions()) {
    SCOPED_TRACE(wrong.message);
    const auto set = fitSphereSet(someBox(), wrong.options);
    ASSERT_FALSE(set);
    EXPECT_EQ(set.error().code, ErrorCode::kInvalidInput);
    EXPECT_EQ(set.error().where, wrong.where);
    EXPECT_EQ(set.error().message, wrong.message);
    auto curve = SphereCurve::begin(someBox(), wrong.options);
    // That nothing needs cover is known when it is to be covered.
    const auto refined = curve ? curve->refine(1) : Result<void>(tl::unexpected(curve.error()));
    ASSERT_FALSE(refined);
    EXPECT_EQ(refined.error().message, wrong.message);
  }
}

TEST(SphereSetOptions, MeshesThatCannotBeCoveredAreRefused) {
  const auto empty = fitSphereSet({}, {});
  ASSERT_FALSE(empty);
  EXPECT_EQ(empty.error().message, "it has no triangles; give a surface to cover with spheres");
  TriangleMesh broken = someBox();
  broken.vertices[3].y = kNaN;
  const auto not_finite = fitSphereSet(broken, {});
  ASSERT_FALSE(not_finite);
  EXPECT_EQ(not_finite.error().message, "vertex 3 is not finite; repair the file");
  const auto large = fitSphereSet(test::box(100, 60, 200).mesh, {});
  ASSERT_FALSE(large);
  EXPECT_EQ(large.error().code, ErrorCode::kUnsupported);
  EXPECT_EQ(large.error().message,
            "its extents are 100 x 60 x 200 m, and sphere sets are made for up to 10 m; is its "
            "unit the centimeter or the millimeter? Give the scale, or cut it");
}

TEST(MeasureSphereSet, RefusesSpheresThatAreNoneOfTheWorkingSet) {
  const auto none = measureSphereSet(someBox(), {}, {});
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().message, "is empty; give at least one sphere");
  const auto unknown = measureSphereSet(someBox(), {{{0, 0, 0}, 3}}, {});
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().where, "spheres[0].radius_index");
  EXPECT_EQ(unknown.error().message, "3 is not in the working set of 3 radii; give its index");
  const auto not_finite = measureSphereSet(someBox(), {{{0, kNaN, 0}, 0}}, {});
  ASSERT_FALSE(not_finite);
  EXPECT_EQ(not_finite.error().where, "spheres[0].center");
}

/// Lattices through a solid of meters are too coarse to find a sphere on the plane for each sample.
TEST(MeasureSphereSet, FindsNothingThinInALargeBox) {
  SphereSetOptions options;
  options.support = HalfSpace{{0, 1, 0}, -1};
  const auto quality = measureSphereSet(test::box(2, 2, 2).mesh, {{{0, 0, 0}, 0}}, options);
  ASSERT_TRUE(quality);
  EXPECT_GT(quality->gap.max, 1);
  EXPECT_EQ(quality->thin_points, 0U);
}

/// One ball in the middle of a box: all lengths are known.
TEST(MeasureSphereSet, MeasuresHandMadeSpheres) {
  const auto quality = measureSphereSet(someBox(), {{{0, 0, 0}, 1}}, {});
  ASSERT_TRUE(quality);
  const double corner = std::hypot(0.05, 0.03, 0.1);
  EXPECT_NEAR(quality->gap.max, corner - 0.05, 0.003);
  EXPECT_LE(quality->gap.max, corner - 0.05 + 1e-6);
  EXPECT_NEAR(quality->protrusion.max, 0.02, 0.0005);
  EXPECT_NEAR(quality->volume_ratio, 4.0 / 3 * std::numbers::pi * 0.05 * 0.05 * 0.05 / 0.0012,
              0.02);
  EXPECT_NEAR(quality->area, 0.076, 1e-6);
  EXPECT_EQ(quality->thin_points, 0U);
  EXPECT_GT(quality->gap.p95, quality->gap.mean);
  EXPECT_GT(quality->gap.max, quality->gap.p95);
}

TEST(SphereSetSupport, KeepsSpheresAboveThePlane) {
  for (const float offset : {-0.03F, 0.0F}) {
    SCOPED_TRACE(offset);
    SphereSetOptions options;
    options.support = HalfSpace{{0, 1, 0}, offset};
    const auto set = fitSphereSet(someBox(), options);
    ASSERT_TRUE(set);
    for (const SetSphere& sphere : set->spheres) {
      EXPECT_GE(sphere.center.y, options.radii[sphere.radius_index] + offset - 1e-6F);
    }
    EXPECT_LE(largestGap(someBox(), *set, options), set->guaranteed_gap);
    EXPECT_TRUE(set->meets_tolerances) << set->guaranteed_gap << ' ' << set->guaranteed_protrusion;
  }
}

TEST(SphereSetSupport, MayBeTilted) {
  SphereSetOptions options;
  options.support = HalfSpace{{0.6F, 0.8F, 0}, -0.054F};
  const auto set = fitSphereSet(someBox(), options);
  ASSERT_TRUE(set);
  for (const SetSphere& sphere : set->spheres) {
    EXPECT_GE(0.6F * sphere.center.x + 0.8F * sphere.center.y,
              options.radii[sphere.radius_index] - 0.054F - 1e-6F);
  }
}

TEST(SphereSetRadii, MayBeOneToEight) {
  const TriangleMesh mesh = test::box(0.08, 0.05, 0.12).mesh;
  std::vector<float> radii;
  for (int count = 1; count <= 8; ++count) {
    SCOPED_TRACE(count);
    radii.push_back(0.012F + 0.006F * static_cast<float>(radii.size()));
    SphereSetOptions options;
    options.radii = radii;
    const auto set = fitSphereSet(mesh, options);
    ASSERT_TRUE(set);
    EXPECT_TRUE(set->meets_tolerances) << set->guaranteed_gap << ' ' << set->guaranteed_protrusion;
    EXPECT_LE(largestGap(mesh, *set, options), set->guaranteed_gap);
    for (const SetSphere& sphere : set->spheres) EXPECT_LT(sphere.radius_index, radii.size());
  }
}

TEST(SphereSetRadii, ThatAreAllTooLargeStillCover) {
  SphereSetOptions options;
  options.radii = {0.12F, 0.3F};
  const auto set = fitSphereSet(someBox(), options);
  ASSERT_TRUE(set);
  EXPECT_FALSE(set->meets_tolerances);
  EXPECT_LE(largestGap(someBox(), *set, options), set->guaranteed_gap);
  EXPECT_GT(set->guaranteed_protrusion, 0.05);
}

TEST(SphereSetLimit, IsKeptAndCostsGap) {
  const TriangleMesh mesh = slenderCylinder();
  SphereSetOptions options;
  options.eps = 0.008F;
  options.tau = 0.01F;
  const auto all = fitSphereSet(mesh, options);
  ASSERT_TRUE(all);
  ASSERT_GT(all->spheres.size(), 8U);
  double previous = HUGE_VAL;
  for (const std::uint32_t most : {1U, 3U, 8U}) {
    SCOPED_TRACE(most);
    options.max_spheres = most;
    const auto set = fitSphereSet(mesh, options);
    ASSERT_TRUE(set);
    EXPECT_LE(set->spheres.size(), most);
    EXPECT_GE(set->spheres.size(), 1U);
    EXPECT_FALSE(set->meets_tolerances);
    EXPECT_LE(largestGap(mesh, *set, options), set->guaranteed_gap);
    EXPECT_LE(set->quality.gap.max, previous);
    previous = set->quality.gap.max;
  }
  options.max_spheres = static_cast<std::uint32_t>(all->spheres.size());
  EXPECT_EQ(fitSphereSet(mesh, options)->spheres, all->spheres);
}

/// A curve with all its points.
Result<SphereCurve> wholeCurve(const TriangleMesh& mesh, const SphereSetOptions& options,
                               unsigned threads) {
  auto curve = SphereCurve::begin(mesh, options);
  while (curve && !curve->complete()) EXPECT_TRUE(curve->refine(threads));
  return curve;
}

TEST(SphereCurve, HasASetForEachNumberOfSpheresWithASmallerError) {
  const TriangleMesh mesh = slenderCylinder();
  SphereSetOptions options;
  options.eps = 0.008F;
  options.tau = 0.01F;
  auto curve = wholeCurve(mesh, options, 1);
  ASSERT_TRUE(curve);
  const std::vector<CurvePoint>& points = curve->points();
  ASSERT_GE(points.size(), 5U);
  for (std::size_t at = 0; at < points.size(); ++at) {
    EXPECT_EQ(points[at].spheres, at + 1);
    EXPECT_LT(points[at].error, at > 0 ? points[at - 1].error : HUGE_VAL);
    const SphereSet set = curve->take(at);
    EXPECT_EQ(set.spheres.size(), points[at].spheres);
    // Judged from outside: by points and distances of our own.
    EXPECT_LE(largestGap(mesh, set, options), set.guaranteed_gap);
    EXPECT_LE(set.quality.protrusion.max, set.guaranteed_protrusion);
    constexpr double kLooserTau = 1.6;
    EXPECT_LE(set.guaranteed_protrusion, kLooserTau * static_cast<double>(options.tau) + 1e-6);
  }
  EXPECT_FALSE(curve->take(0).meets_tolerances);
  EXPECT_GT(curve->take(0).quality.gap.max, 2 * curve->take(points.size() - 1).quality.gap.max);
  options.max_spheres = 3;
  EXPECT_EQ(wholeCurve(mesh, options, 1)->points().size(), 3U);
}

TEST(SphereCurve, FinishedHasOneSetThatMeetsTheTolerances) {
  auto curve = SphereCurve::begin(slenderCylinder(), {});
  ASSERT_TRUE(curve);
  ASSERT_TRUE(curve->refine(1));
  ASSERT_TRUE(curve->finish(1));
  EXPECT_TRUE(curve->complete());
  ASSERT_EQ(curve->points().size(), 1U);
  EXPECT_TRUE(curve->take(0).meets_tolerances);
}

TEST(SphereCurve, IsTheSameForAnyNumberOfJobsAndStaysCompleteOnceItIs) {
  const TriangleMesh mesh = test::cylinder(0.05, 0.1).mesh;
  auto one = wholeCurve(mesh, {}, 1);
  auto three = wholeCurve(mesh, {}, 3);
  ASSERT_TRUE(one && three);
  ASSERT_EQ(one->points().size(), three->points().size());
  for (std::size_t at = 0; at < one->points().size(); ++at) {
    EXPECT_EQ(one->points()[at].error, three->points()[at].error);
    EXPECT_EQ(one->take(at).spheres, three->take(at).spheres);
  }
  const std::size_t points = one->points().size();
  ASSERT_TRUE(one->refine(1));
  EXPECT_EQ(one->points().size(), points);
}

TEST(SphereSetResult, IsSorted) {
  const auto set = fitSphereSet(test::box(0.3, 0.06, 0.2).mesh, {});
  ASSERT_TRUE(set);
  ASSERT_GT(set->spheres.size(), 3U);
  EXPECT_TRUE(std::is_sorted(
      set->spheres.begin(), set->spheres.end(), [](const SetSphere& a, const SetSphere& b) {
        return std::tuple(b.radius_index, a.center.x, a.center.y, a.center.z) <
               std::tuple(a.radius_index, b.center.x, b.center.y, b.center.z);
      }));
}

TEST(SphereSetResult, DependsOnNothingButItsInput) {
  const TriangleMesh mesh = test::capsule(0.03, 0.06).mesh;
  SphereSetOptions options;
  options.eps = 0.006F;
  options.tau = 0.008F;
  const auto first = fitSphereSet(mesh, options);
  ASSERT_TRUE(first);
  ASSERT_GT(first->spheres.size(), 8U);
  for (const unsigned threads : {1U, 2U, 5U}) {
    const auto again = fitSphereSet(mesh, options, threads);
    ASSERT_TRUE(again);
    EXPECT_EQ(again->spheres, first->spheres) << threads << " threads";
    EXPECT_EQ(again->quality.gap.mean, first->quality.gap.mean);
    EXPECT_EQ(again->quality.protrusion.mean, first->quality.protrusion.mean);
    EXPECT_EQ(again->quality.volume_ratio, first->quality.volume_ratio);
    EXPECT_EQ(again->guaranteed_gap, first->guaranteed_gap);
  }
}

}  // namespace
}  // namespace galactic::bake::options_test
