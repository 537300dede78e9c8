#include "sphere_set/solid/exterior_solid.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "sphere_set/shapes.h"
#include "support/random_points.h"

namespace galactic::bake::sphere_set::exterior_solid_test {
namespace {

using test::KnownSolid;
using test::MeshBuilder;

constexpr std::uint32_t kSeed = 20250402;
constexpr double kSmallestRadius = 0.015;

/// Of points further from the surface than `clear`, how many the solid judges other than the
/// closed form; fails unless both sides were asked often.
int wrongSides(const ExteriorSolid& solid, const KnownSolid& known, double clear) {
  int inside = 0;
  int outside = 0;
  int wrong = 0;
  for (const Vec3d& p : test::randomPoints(kSeed, known.mesh.bounds, 0.02F, 4000)) {
    const double distance = known.distance({p.x, p.y, p.z});
    if (std::fabs(distance) < clear) continue;
    ++(distance < 0 ? inside : outside);
    wrong += (solid.distance(p).distance < 0) != (distance < 0) ? 1 : 0;
  }
  EXPECT_GT(inside, (inside + outside) / 10) << "seed " << kSeed;
  EXPECT_GT(outside, (inside + outside) / 10) << "seed " << kSeed;
  return wrong;
}

/// GCC 12 loses conversions to float and back in vectorised code.
TEST(StoredPoints, AreFloatsAndTheNearestOnes) {
  for (const Vec3d& p : test::randomPoints(kSeed, {{-2, -2, -2}, {2, 2, 2}}, 0, 1000)) {
    const Vec3d stored = asStored(p);
    const Vec3 as_float = narrow(p);
    EXPECT_EQ(narrow(stored), as_float);
    for (const auto& [value, rounded] :
         {std::pair{stored.x, as_float.x}, std::pair{stored.y, as_float.y},
          std::pair{stored.z, as_float.z}}) {
      const volatile float seen = rounded;
      EXPECT_EQ(value, static_cast<double>(seen));
    }
  }
}

TEST(ExteriorSolid, KnowsInsideFromOutside) {
  for (const KnownSolid& known :
       {test::ball(0.05), test::box(0.1, 0.06, 0.2), test::cylinder(0.04, 0.15)}) {
    const ExteriorSolid solid(known.mesh, kSmallestRadius, 1);
    EXPECT_EQ(wrongSides(solid, known, 0.0005), 0);
    EXPECT_EQ(solid.facets().size(), known.mesh.triangles.size());
  }
}

TEST(ExteriorSolid, MeasuresSignedDistances) {
  const KnownSolid known = test::box(0.1, 0.06, 0.2);
  const ExteriorSolid solid(known.mesh, kSmallestRadius, 1);
  for (const Vec3d& p : test::randomPoints(kSeed, known.mesh.bounds, 0.02F, 1000)) {
    const double truth = known.distance({p.x, p.y, p.z});
    // Right at the surface the sign is not certain.
    EXPECT_NEAR(solid.distance(p).distance, truth, std::fabs(truth) < 0.0005 ? 0.001 : 1e-6);
  }
}

TEST(ExteriorSolid, DoesNotCareAboutWinding) {
  KnownSolid known = test::cylinder(0.04, 0.15);
  for (std::size_t t = 0; t < known.mesh.triangles.size(); t += 3) {
    std::swap(known.mesh.triangles[t][0], known.mesh.triangles[t][1]);
  }
  const ExteriorSolid solid(known.mesh, kSmallestRadius, 1);
  EXPECT_EQ(wrongSides(solid, known, 0.0005), 0);
}

TEST(ExteriorSolid, ClosesHolesThatTheProbeDoesNotPass) {
  KnownSolid known = test::cylinder(0.04, 0.15);
  // 96 facets around, 24 rows: single missing facets are some 6 by 3 mm.
  std::vector<Triangle> kept;
  for (std::size_t t = 0; t < known.mesh.triangles.size(); ++t) {
    if (t % 101 != 50) kept.push_back(known.mesh.triangles[t]);
  }
  ASSERT_LT(kept.size(), known.mesh.triangles.size() - 40);
  known.mesh.triangles = kept;
  const ExteriorSolid solid(known.mesh, kSmallestRadius, 1);
  EXPECT_EQ(wrongSides(solid, known, 0.002), 0);
}

TEST(ExteriorSolid, DropsShellsAndRibsInside) {
  const KnownSolid known = test::box(0.1, 0.06, 0.2);
  MeshBuilder builder;
  builder.box({-0.05F, -0.03F, -0.1F}, {0.05F, 0.03F, 0.1F});
  builder.box({-0.045F, -0.025F, -0.095F}, {0.045F, 0.025F, 0.095F});
  builder.floor({-0.045F, 0, -0.095F}, {0.045F, 0, 0.095F}, 0.001F);
  KnownSolid nested = known;
  nested.mesh = builder.build();
  const ExteriorSolid solid(nested.mesh, kSmallestRadius, 1);
  EXPECT_EQ(wrongSides(solid, known, 0.0005), 0);
  EXPECT_EQ(solid.facets().size(), 12U);
  EXPECT_NEAR(solid.area(), 2 * (0.1 * 0.06 + 0.1 * 0.2 + 0.06 * 0.2), 1e-6);
}

TEST(ExteriorSolid, CutsFacetsThatAreHiddenInPart) {
  // Two crossing bars: the middle of each face is inside the other bar.
  MeshBuilder builder;
  builder.box({-0.2F, -0.03F, -0.03F}, {0.2F, 0.03F, 0.03F});
  builder.box({-0.03F, -0.03F, -0.2F}, {0.03F, 0.03F, 0.2F});
  const ExteriorSolid solid(builder.build(), kSmallestRadius, 1);
  // In the middle only the top and bottom are near.
  EXPECT_NEAR(solid.distance({0, 0, 0}).distance, -0.03, 0.001);
  // The probe does not get into the corner at (0.03, 0.03), which is 7 mm away: it stops about
  // where it touches both faces, 7.5 mm from the corner.
  EXPECT_NEAR(solid.distance({0.025, 0, 0.025}).distance, -0.0095, 0.0025);
  EXPECT_FALSE(solid.reachable({0.03, 0, 0}));
  EXPECT_TRUE(solid.reachable({0.03, 0, 0.1}));
}

TEST(ExteriorSolid, KeepsItsMemoryForAnythingUpToTenMeters) {
  MeshBuilder builder;
  builder.box({-5, -5, -5}, {5, 5, 5});
  const ExteriorSolid solid(builder.build(), kSmallestRadius, 1);
  EXPECT_TRUE(solid.contains({0, 0, 0}));
  EXPECT_TRUE(solid.contains({4.9, 4.9, 4.9}));
  EXPECT_FALSE(solid.contains({5.05, 0, 0}));
}

}  // namespace
}  // namespace galactic::bake::sphere_set::exterior_solid_test
