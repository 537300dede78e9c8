// How far simplification moves surfaces, measured without the simplifier's own measured.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "bake/render/render_helpers.h"
#include "distance/triangle_tree.h"
#include "render/simplify_within.h"
#include "support/oracles/distance_oracle.h"
#include "support/test_meshes.h"

namespace galactic::test::simplification_test {
namespace {

/// Corners and middles of triangles are measured by the bake; points between them move further.
constexpr double kBetweenTolerance = 1.25;

struct Outcome {
  std::vector<DrawnTriangle> triangles;
  double measured = 0;
};

Outcome simplified(const bake::SourceMesh& mesh, double error, bool textured = false) {
  SourceBuilder builder;
  const std::uint32_t material = builder.material(true, textured);
  const auto meshes = bake::bakeRenderMeshes(builder.place(mesh, material).source(),
                                             {.error = error, .lighting = bake::Lighting::kNone});
  EXPECT_TRUE(meshes);
  return {drawnTriangles(meshes->view(), 0), static_cast<double>(meshes->models[0].largest_error)};
}

/// Largest distance from points spread over `from` to `to`, meters; `reach` at most.
double deviation(const bake::TriangleMesh& from, const bake::TriangleMesh& to, double reach) {
  const DistanceOracle oracle(to, reach);
  std::mt19937 random(17);
  const auto uniform = [&] { return static_cast<double>(random()) / 4294967296.0; };
  double worst = 0;
  for (const bake::Triangle& triangle : from.triangles) {
    for (int n = 0; n < 8; ++n) {
      double a = uniform();
      double b = uniform();
      if (a + b > 1) {
        a = 1 - a;
        b = 1 - b;
      }
      bake::Point point{};
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const double share = corner == 0 ? 1 - a - b : corner == 1 ? a : b;
        const Vec3& at = from.vertices[triangle[corner]];
        point[0] += share * static_cast<double>(at.x);
        point[1] += share * static_cast<double>(at.y);
        point[2] += share * static_cast<double>(at.z);
      }
      worst = std::max(worst, oracle.distance(point));
    }
  }
  return worst;
}

/// A bumpy landscape: everything in it can be simplified a little.
bake::TriangleMesh landscape() {
  MeshBuilder builder;
  constexpr int kSquares = 70;
  constexpr float kEdge = 0.02F;
  const auto at = [](int x, int z) {
    const float u = static_cast<float>(x) * kEdge;
    const float v = static_cast<float>(z) * kEdge;
    return Vec3{u, 0.5F + 0.05F * std::sin(6 * u) * std::cos(5 * v) + 0.004F * std::sin(40 * v), v};
  };
  for (int z = 0; z < kSquares; ++z) {
    for (int x = 0; x < kSquares; ++x) {
      builder.quad({at(x, z), at(x, z + 1), at(x + 1, z + 1), at(x + 1, z)});
    }
  }
  bake::TriangleMesh mesh = builder.build();
  mesh.bounds = {{0, 0.4F, 0}, {kSquares * kEdge, 0.6F, kSquares * kEdge}};
  return mesh;
}

TEST(Simplification, MovesALandscapeNoFurtherThanItSays) {
  const bake::TriangleMesh source = landscape();
  for (const double error : {0.0005, 0.002, 0.005, 0.02}) {
    const Outcome outcome = simplified(meshOf(source), error);
    const bake::TriangleMesh drawn = asMesh(outcome.triangles);
    EXPECT_LE(outcome.measured, error);
    EXPECT_GT(outcome.measured, error / 10);
    const double reach = 4 * error;
    const double moved = std::max(deviation(source, drawn, reach), deviation(drawn, source, reach));
    const double rounding = kFinestStep;
    EXPECT_LE(moved, kBetweenTolerance * outcome.measured + rounding) << "allowed " << error;
    EXPECT_LT(drawn.triangles.size(), source.triangles.size());
  }
}

/// The one piece that a mesh is, corners welded.
bake::PartMesh pieceOf(const bake::TriangleMesh& mesh) {
  const bake::ByteNumbers numbers = bake::numberValues(mesh.vertices);
  bake::PartMesh piece;
  for (const Vec3& position : bake::distinctValues(mesh.vertices, numbers)) {
    bake::RenderVertex& vertex = piece.vertices.emplace_back();
    vertex.position = position;
  }
  for (const bake::Triangle& t : mesh.triangles) {
    piece.triangles.push_back(
        {numbers.number_of[t[0]], numbers.number_of[t[1]], numbers.number_of[t[2]]});
  }
  return piece;
}

/// Of all corners and middles of triangles, from the nearest triangle of `surface`, meters.
double largestDistance(const bake::PartMesh& piece, const std::vector<bake::Triangle>& surface) {
  const auto cornersOf = [&](const bake::Triangle& t) {
    return bake::Facet{piece.vertices[t[0]].position, piece.vertices[t[1]].position,
                       piece.vertices[t[2]].position};
  };
  double largest = 0;
  for (const bake::Triangle& triangle : piece.triangles) {
    const auto corners = cornersOf(triangle);
    const auto [a, b, c] =
        std::array{bake::widen(corners[0]), bake::widen(corners[1]), bake::widen(corners[2])};
    for (const bake::Vec3d& point : {a, b, c, (a + b + c) * (1.0 / 3)}) {
      double nearest = 1;
      for (const bake::Triangle& other : surface) {
        const bake::Vec3d on = bake::nearestOnFacet(point, cornersOf(other));
        nearest = std::min(nearest, norm(on - point));
      }
      largest = std::max(largest, nearest);
    }
  }
  return largest;
}

TEST(Simplification, MeasuresTheLargestDistanceAndSearchesForFewOfThem) {
  const bake::PartMesh piece = pieceOf(landscape());
  for (const double error : {0.002, 0.005}) {
    const bake::MeasuredSimplified simplified = bake::simplifyWithin(piece, error);
    EXPECT_LT(simplified.surface.triangles.size(), piece.triangles.size());
    constexpr double kRounding = 1e-12;
    EXPECT_NEAR(simplified.surface.error, largestDistance(piece, simplified.surface.triangles),
                kRounding);
    // A search of its own for each point is what took nine tenths of the time.
    EXPECT_GT(simplified.comparisons, piece.triangles.size());
    EXPECT_LT(simplified.searches, simplified.comparisons / 2) << "allowed " << error;
  }
}

/// Leaves of a scan: triangles that touch nothing, of all sizes, some with two corners close to
/// each other.
bake::TriangleMesh leaves(std::uint32_t seed) {
  MeshBuilder builder;
  std::mt19937 random(seed);
  const auto uniform = [&](float most) {
    return most * static_cast<float>(random()) / 4294967296.0F;
  };
  constexpr int kLeaves = 150;
  for (int n = 0; n < kLeaves; ++n) {
    const Vec3 a{uniform(0.1F), uniform(0.1F), uniform(0.1F)};
    const float reach = uniform(0.02F);
    const Vec3 b = a + Vec3{uniform(reach), uniform(reach), uniform(reach)};
    const Vec3 c = b + Vec3{uniform(0.004F), uniform(0.004F), uniform(0.004F)};
    builder.quad({a, b, c, a + (c - a) * uniform(1)});
  }
  return builder.build();
}

TEST(Simplification, MovesNothingFurtherThanAllowedWhereCornersOfSmallPartsAreKept) {
  constexpr double kAllowed = 0.005;
  int simplified = 0;
  for (std::uint32_t seed = 1; seed <= 40; ++seed) {
    const bake::PartMesh piece = pieceOf(leaves(seed));
    const bake::MeasuredSimplified result = bake::simplifyWithin(piece, kAllowed);
    EXPECT_LE(result.surface.error, kAllowed) << "seed " << seed;
    EXPECT_LE(largestDistance(piece, result.surface.triangles), kAllowed + 1e-9) << "seed " << seed;
    if (result.surface.triangles.size() < piece.triangles.size()) ++simplified;
  }
  EXPECT_GT(simplified, 20);
}

TEST(Simplification, OfAFlatFloorLeavesTwoTriangles) {
  MeshBuilder builder;
  for (int z = 0; z < 12; ++z) {
    for (int x = 0; x < 12; ++x) {
      const float u = 0.25F * static_cast<float>(x);
      const float v = 0.25F * static_cast<float>(z);
      builder.floor({u, 0, v}, {u + 0.25F, 0, v + 0.25F}, 0.5F);
    }
  }
  EXPECT_EQ(simplified(meshOf(builder.build()), 0.005).triangles.size(), 2U);
}

/// A tube along x without caps.
bake::TriangleMesh tube(float radius, float length) {
  MeshBuilder builder;
  constexpr int kAround = 16;
  constexpr int kAlong = 50;
  const auto at = [&](int along, int around) {
    const double turn = 2 * std::numbers::pi * (around % kAround) / kAround;
    return Vec3{length * static_cast<float>(along) / kAlong,
                0.5F + radius * static_cast<float>(std::cos(turn)),
                0.5F + radius * static_cast<float>(std::sin(turn))};
  };
  for (int along = 0; along < kAlong; ++along) {
    for (int around = 0; around < kAround; ++around) {
      builder.quad({at(along, around), at(along, around + 1), at(along + 1, around + 1),
                    at(along + 1, around)});
    }
  }
  return builder.build();
}

TEST(Simplification, LeavesACableItsWidth) {
  constexpr float kRadius = 0.003F;
  const Outcome outcome = simplified(meshOf(tube(kRadius, 1)), 0.005);
  ASSERT_GE(outcome.triangles.size(), 4U);
  EXPECT_LT(outcome.triangles.size(), 400U);
  double low = 1;
  double high = 0;
  double area = 0;
  for (const DrawnTriangle& t : outcome.triangles) {
    for (const DrawnCorner& corner : t.corners) {
      low = std::min(low, corner.position[1]);
      high = std::max(high, corner.position[1]);
    }
    const auto& a = t.corners[0].position;
    const auto& b = t.corners[1].position;
    const auto& c = t.corners[2].position;
    const std::array<double, 3> p{b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    const std::array<double, 3> q{c[0] - a[0], c[1] - a[1], c[2] - a[2]};
    area += std::hypot(p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2],
                       p[0] * q[1] - p[1] * q[0]) /
            2;
  }
  EXPECT_GT(high - low, static_cast<double>(kRadius));
  // A square tube in place of the round one still has 0.9 of its area.
  EXPECT_GT(area, 0.5 * 2 * std::numbers::pi * static_cast<double>(kRadius));
}

TEST(Simplification, NeverLosesAKnob) {
  for (const float size : {0.0005F, 0.002F, 0.01F}) {
    const auto knob = MeshBuilder().sphere({0.3F, 0.4F, 0.5F}, size, 12).build();
    const Outcome outcome = simplified(meshOf(knob), 0.02);
    EXPECT_GE(outcome.triangles.size(), 4U) << size;
    EXPECT_EQ(openEdges(outcome.triangles), 0U);
  }
}

TEST(Simplification, KeepsTheSeamsOfTexturesClosedAndStraight) {
  // A tube whose texture begins again at a seam: two vertices at each position there.
  bake::SourceMesh mesh;
  constexpr std::uint32_t kAround = 32;
  constexpr std::uint32_t kAlong = 40;
  for (std::uint32_t along = 0; along <= kAlong; ++along) {
    for (std::uint32_t around = 0; around <= kAround; ++around) {
      const double turn = 2 * std::numbers::pi * (around % kAround) / kAround;
      mesh.positions.push_back({0.02F * static_cast<float>(along),
                                0.5F + 0.1F * static_cast<float>(std::cos(turn)),
                                0.5F + 0.1F * static_cast<float>(std::sin(turn))});
      mesh.uvs.push_back(
          {static_cast<float>(around) / kAround, static_cast<float>(along) / kAlong});
    }
  }
  for (std::uint32_t along = 0; along < kAlong; ++along) {
    for (std::uint32_t around = 0; around < kAround; ++around) {
      const std::uint32_t a = along * (kAround + 1) + around;
      const std::uint32_t b = a + kAround + 1;
      mesh.triangles.push_back({a, a + 1, b + 1});
      mesh.triangles.push_back({a, b + 1, b});
    }
  }
  const Outcome outcome = simplified(mesh, 0.003, true);
  EXPECT_LT(outcome.triangles.size(), mesh.triangles.size() / 4);
  std::size_t at_seam = 0;
  for (const DrawnTriangle& triangle : outcome.triangles) {
    // No triangle spans the seam: over the texture it is no wider than on the tube.
    double lowest = 2;
    double highest = -1;
    for (const DrawnCorner& corner : triangle.corners) {
      lowest = std::min(lowest, corner.uv[0]);
      highest = std::max(highest, corner.uv[0]);
      double turn = std::atan2(corner.position[2] - 0.5, corner.position[1] - 0.5);
      if (turn < -1e-3) turn += 2 * std::numbers::pi;
      const double u = turn / (2 * std::numbers::pi);
      const double off = std::abs(corner.uv[0] - u);
      EXPECT_LT(std::min(off, 1 - off), 2e-3);
      if (corner.uv[0] < 1e-4 || corner.uv[0] > 1 - 1e-4) ++at_seam;
    }
    EXPECT_LT(highest - lowest, 0.5);
  }
  EXPECT_GT(at_seam, 2U);
  // Open at the two rims only.
  std::size_t rim = 0;
  for (const DrawnTriangle& triangle : outcome.triangles) {
    for (std::size_t n = 0; n < 3; ++n) {
      const double a = triangle.corners[n].position[0];
      const double b = triangle.corners[(n + 1) % 3].position[0];
      const bool left = a < 1e-3 && b < 1e-3;
      const bool right = a > 0.799 && b > 0.799;
      if (left || right) ++rim;
    }
  }
  EXPECT_EQ(openEdges(outcome.triangles), rim);
}

TEST(Simplification, OpensNoCrackBetweenMaterials) {
  const bake::SourceMesh whole = meshOf(MeshBuilder().sphere({0.3F, 0.4F, 0.5F}, 0.4F, 40).build());
  SourceBuilder builder;
  std::vector<bake::SourceMesh> parts(3, whole);
  for (bake::SourceMesh& part : parts) part.triangles.clear();
  // Stripes and patches.
  for (std::size_t t = 0; t < whole.triangles.size(); ++t) {
    parts[t / 100 % 3].triangles.push_back(whole.triangles[t]);
  }
  for (bake::SourceMesh& part : parts) builder.place(part, builder.material(true, true));
  const auto meshes =
      bake::bakeRenderMeshes(builder.source(), {.error = 0.005, .lighting = bake::Lighting::kNone});
  ASSERT_TRUE(meshes);
  const auto triangles = drawnTriangles(meshes->view(), 0);
  EXPECT_LT(triangles.size(), whole.triangles.size());
  EXPECT_EQ(openEdges(triangles), 0U);
  EXPECT_EQ(twoSidedCount(triangles), 0U);
}

}  // namespace
}  // namespace galactic::test::simplification_test
