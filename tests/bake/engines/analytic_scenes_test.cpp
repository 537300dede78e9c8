// Scenes whose free heights are known, for both sphere-casting engines.
#include <gtest/gtest.h>

#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include "bake/engines/engine_scenes.h"
#include "galactic/bake/column_engines.h"

namespace galactic::bake::analytic_scenes_test {
namespace {

using test::MeshBuilder;

/// Storage of heights as floats, with room.
constexpr float kEmbreeTolerance = 1e-5F;
/// What Bullet's convex cast leaves between a sphere and the surface when it calls them in contact.
constexpr float kBulletTolerance = 5e-4F;

struct EngineUnderTest {
  std::string name;
  Columns (*columns)(const TriangleMesh&, const GridFrame&, unsigned);
  float tolerance;
};

std::ostream& operator<<(std::ostream& out, const EngineUnderTest& engine) {
  return out << engine.name;
}

class AnalyticScene : public testing::TestWithParam<EngineUnderTest> {
 protected:
  /// Free spans of the column at (x, z).
  static std::vector<Span> freeAt(const TriangleMesh& mesh, float x, float z, float radius) {
    const Columns columns = GetParam().columns(mesh, test::frameAround(x, z, radius, kHeights), 1);
    const auto spans = columns.column(columns.index(1, 1));
    return {spans.begin(), spans.end()};
  }

  static void expectSpans(const std::vector<Span>& found, const std::vector<Span>& expected,
                          float tolerance = GetParam().tolerance) {
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_NEAR(found[i].lo, expected[i].lo, tolerance) << "span " << i;
      EXPECT_NEAR(found[i].hi, expected[i].hi, tolerance) << "span " << i;
    }
  }

  static constexpr Span kHeights{-1.5F, 3.5F};
  static constexpr float kBottom = kHeights.lo;
  static constexpr float kTop = kHeights.hi;
};

TEST_P(AnalyticScene, HasAllHeightsFreeBesideTheMesh) {
  const TriangleMesh mesh = MeshBuilder().box({-1, -1, -1}, {1, 1, 1}).build();
  expectSpans(freeAt(mesh, 1.2F, 0, 0.12F), {{kBottom, kTop}});
}

TEST_P(AnalyticScene, IsFreeAboveAndBelowAFloorSlab) {
  // Thin enough, or the ball so big, that none fits inside.
  const TriangleMesh mesh = MeshBuilder().box({-2, -0.2F, -2}, {2, 0, 2}).build();
  expectSpans(freeAt(mesh, 0.1F, 0.2F, 0.12F), {{kBottom, -0.32F}, {0.12F, kTop}});
}

TEST_P(AnalyticScene, IsFreeInsideAHollowBoxOnAFloor) {
  const TriangleMesh mesh = MeshBuilder()
                                .floor({-2, 0, -2}, {2, 0, 2}, 0)
                                .box({-0.5F, 0, -0.5F}, {0.5F, 1, 0.5F})
                                .build();
  expectSpans(freeAt(mesh, 0.1F, 0.2F, 0.05F), {{kBottom, -0.05F}, {0.05F, 0.95F}, {1.05F, kTop}});
  expectSpans(freeAt(mesh, 1.0F, 0.2F, 0.05F), {{kBottom, -0.05F}, {0.05F, kTop}});
}

TEST_P(AnalyticScene, SeesTheRoundedEdgeOfABox) {
  // The ball's center is 3 cm outside the wall: it rests on the edge, 4 cm above it.
  const TriangleMesh mesh = MeshBuilder().box({-0.5F, 0, -0.5F}, {0.5F, 1, 0.5F}).build();
  expectSpans(freeAt(mesh, 0.53F, 0, 0.05F), {{kBottom, -0.04F}, {1.04F, kTop}});
}

TEST_P(AnalyticScene, TouchesTheTopOfASphereAtItsPole) {
  const TriangleMesh mesh = MeshBuilder().sphere({0.3F, 1, 0.4F}, 0.5F, 48).build();
  const std::vector<Span> found = freeAt(mesh, 0.3F, 0.4F, 0.12F);
  ASSERT_EQ(found.size(), 3U);
  EXPECT_NEAR(found[0].hi, 0.38F, GetParam().tolerance);
  EXPECT_NEAR(found[2].lo, 1.62F, GetParam().tolerance);
  // A mesh of a sphere is hollow: a ball fits inside. There it rests on the flat triangles round
  // the pole, which slope by 1/96 of a half turn: 0.12 * (1 / cos(pi / 96) - 1) = 0.064 mm.
  constexpr float kFacets = 7e-5F;
  EXPECT_NEAR(found[1].lo, 0.62F, kFacets + GetParam().tolerance);
  EXPECT_NEAR(found[1].hi, 1.38F, kFacets + GetParam().tolerance);
}

TEST_P(AnalyticScene, FollowsTheFlankOfASphere) {
  // The flat triangles lie up to 0.5 * (1 - cos(pi / 96)) = 0.27 mm inside the sphere, and the ball
  // meets them at a slope.
  constexpr float kFacets = 5e-4F;
  const TriangleMesh mesh = MeshBuilder().sphere({0, 1, 0}, 0.5F, 48).build();
  for (const float aside : {0.1F, 0.2F, 0.3F}) {
    const float outer = std::sqrt(0.55F * 0.55F - aside * aside);
    const float inner = std::sqrt(0.45F * 0.45F - aside * aside);
    expectSpans(freeAt(mesh, aside, 0, 0.05F),
                {{kBottom, 1 - outer}, {1 - inner, 1 + inner}, {1 + outer, kTop}},
                kFacets + GetParam().tolerance);
  }
}

TEST_P(AnalyticScene, KeepsTheRadiusFromAnInclinedPlane) {
  const TriangleMesh mesh =
      MeshBuilder().quad({Vec3{-1, -1, -2}, {-1, -1, 2}, {1, 1, 2}, {1, 1, -2}}).build();
  const float off = 0.05F * std::sqrt(2.0F);
  for (const float x : {-0.4F, 0.0F, 0.55F}) {
    expectSpans(freeAt(mesh, x, 0.3F, 0.05F), {{kBottom, x - off}, {x + off, kTop}});
  }
}

TEST_P(AnalyticScene, ClosesASlabOfTwoSheetsFiveMillimetersApart) {
  const TriangleMesh mesh = MeshBuilder()
                                .floor({-1, 0, -1}, {1, 0, 1}, 1.0F)
                                .floor({-1, 0, -1}, {1, 0, 1}, 0.995F)
                                .build();
  expectSpans(freeAt(mesh, 0.1F, 0.2F, 0.015F), {{kBottom, 0.98F}, {1.015F, kTop}});
}

TEST_P(AnalyticScene, IsBlockedByNeedles) {
  // A meter long, ten micrometers wide.
  const TriangleMesh mesh =
      MeshBuilder().triangle({-0.5F, 1, 0}, {0.5F, 1, 0}, {0.1F, 1, 1e-5F}).build();
  expectSpans(freeAt(mesh, 0.2F, 0, 0.05F), {{kBottom, 0.95F}, {1.05F, kTop}});
}

Columns columnsByEmbree(const TriangleMesh& mesh, const GridFrame& frame, unsigned threads) {
  return embreeColumns(mesh, frame, threads).value();
}

INSTANTIATE_TEST_SUITE_P(
    Engines, AnalyticScene,
    testing::Values(EngineUnderTest{"Embree", columnsByEmbree, kEmbreeTolerance},
                    EngineUnderTest{"Bullet", bulletColumns, kBulletTolerance}),
    [](const auto& engine) { return engine.param.name; });

}  // namespace
}  // namespace galactic::bake::analytic_scenes_test
