// Sphere sets of solids whose best covers and signed distances are known.
#include <gtest/gtest.h>

#include <vector>

#include "galactic/bake/sphere_set.h"
#include "sphere_set/shapes.h"

namespace galactic::bake::known_solids_test {
namespace {

using test::KnownSolid;

constexpr std::uint32_t kSeed = 20250401;
/// Float rounding of stored centers.
constexpr double kRounding = 1e-6;
/// Points this near to the surface count as outside, wherever they are, when protrusion is
/// measured.
constexpr double kSignMargin = 0.0003;

SphereSetOptions tolerances(float eps, float tau) {
  SphereSetOptions options;
  options.eps = eps;
  options.tau = tau;
  return options;
}

/// A solid, its tolerances, and the fewest spheres that can do: by hand, n spheres along an edge or
/// axis of length L each cover at most 2 sqrt((r + eps)^2 - d^2) of it, d being the distance of
/// their centers from it, which tau bounds from below.
struct KnownCover {
  std::string name;
  KnownSolid solid;
  float eps = 0;
  float tau = 0;
  std::size_t best = 0;
  /// What the solver may need: `best` where it is known to be reached.
  std::size_t most = 0;
};

std::vector<KnownCover> knownCovers() {
  return {
      {"ball of the smallest radius", test::ball(0.015), 0.01F, 0.01F, 1, 1},
      {"ball of the middle radius", test::ball(0.05), 0.01F, 0.01F, 1, 1},
      {"ball of the largest radius", test::ball(0.12), 0.01F, 0.01F, 1, 1},
      {"capsule", test::capsule(0.05, 0.2), 0.01F, 0.01F, 4, 4},
      {"cylinder", test::cylinder(0.05, 0.3), 0.015F, 0.015F, 4, 4},
      {"rod", test::cylinder(0.005, 0.3), 0.01F, 0.01F, 7, 7},
      {"box", test::box(0.08, 0.08, 0.24), 0.02F, 0.02F, 3, 3},
      // 25: the density of the best cover of a plane by discs. It is for an endless plane.
      {"plate", test::box(0.2, 0.003, 0.2), 0.01F, 0.01F, 25, 36},
  };
}

/// Gaps and protrusions on points that neither the solver nor its own measure knows, in closed
/// form.
TEST(SphereSetOfAKnownSolid, NeedsNoMoreSpheresThanTheBestCoverAndKeepsItsGuarantees) {
  std::size_t near_eps = 0;
  std::size_t covered = 0;
  for (const KnownCover& known : knownCovers()) {
    SCOPED_TRACE(known.name);
    const SphereSetOptions options = tolerances(known.eps, known.tau);
    const auto set = fitSphereSet(known.solid.mesh, options);
    ASSERT_TRUE(set) << set.error().message;
    EXPECT_GE(set->spheres.size(), known.best);
    EXPECT_LE(set->spheres.size(), known.most) << test::countsOf(*set, 3);
    double largest_gap = 0;
    for (const Point& p : test::randomSurfacePoints(known.solid.mesh, kSeed, 20'000)) {
      const double gap = test::gapOf(p, set->spheres, options.radii);
      largest_gap = std::max(largest_gap, gap);
      ++(gap > 0 ? near_eps : covered);
    }
    EXPECT_LE(largest_gap, set->guaranteed_gap);
    EXPECT_LE(set->guaranteed_gap, 1.25 * static_cast<double>(options.eps));
    EXPECT_NEAR(set->quality.gap.max, largest_gap, 1e-3);
    double largest_protrusion = 0;
    for (const Point& p : test::randomSpherePoints(set->spheres, options.radii, kSeed, 4000)) {
      largest_protrusion = std::max(largest_protrusion, known.solid.distance(p));
    }
    EXPECT_LE(largest_protrusion, set->guaranteed_protrusion + known.solid.error + kRounding);
    EXPECT_LE(set->quality.protrusion.max, set->guaranteed_protrusion + kSignMargin);
    if (set->quality.thin_points == 0) {
      EXPECT_LE(set->guaranteed_protrusion, static_cast<double>(options.tau));
      EXPECT_TRUE(set->meets_tolerances);
    }
  }
  EXPECT_GT(near_eps, (near_eps + covered) / 10) << "seed " << kSeed;
  EXPECT_GT(covered, (near_eps + covered) / 10) << "seed " << kSeed;
}

TEST(SphereSetOfAKnownSolid, HasTheVolumeAndAreaOfTheSolid) {
  const auto set = fitSphereSet(test::ball(0.05).mesh, tolerances(0.01F, 0.01F));
  ASSERT_TRUE(set);
  EXPECT_NEAR(set->quality.volume_ratio, 1, 0.05);
  EXPECT_NEAR(set->quality.area, 4 * std::numbers::pi * 0.05 * 0.05, 1e-4);
  EXPECT_GT(set->quality.samples, 3000U);
}

TEST(SphereSetOfAThinPlate, CoversItWithTheLeastProtrusionAndSaysSo) {
  const KnownSolid plate = test::box(0.2, 0.003, 0.2);
  const auto set = fitSphereSet(plate.mesh, tolerances(0.01F, 0.005F));
  ASSERT_TRUE(set);
  EXPECT_FALSE(set->meets_tolerances);
  EXPECT_GT(set->quality.thin_points, set->quality.samples / 2);
  EXPECT_LE(set->quality.gap.max, set->guaranteed_gap);
  // A ball of 15 mm in the middle of 3 mm sticks out by 13.5 mm; rims and the search's slack add.
  EXPECT_GT(set->guaranteed_protrusion, 0.0134);
  EXPECT_LE(set->guaranteed_protrusion, 0.0170);
}

}  // namespace
}  // namespace galactic::bake::known_solids_test
