// The layout of baked render meshes, and what of a source stays in it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <set>

#include "bake/render/render_helpers.h"
#include "support/test_meshes.h"

namespace galactic::test::render_baker_test {
namespace {

constexpr double kFinest = kFinestStep;

bake::BakedRenderMeshes bakedMeshes(const SourceBuilder& builder, double error = 0,
                                    unsigned threads = 1) {
  auto meshes = bake::bakeRenderMeshes(
      builder.source(), {.error = error, .lighting = bake::Lighting::kNone}, threads);
  EXPECT_TRUE(meshes) << meshes.error().text();
  return meshes ? std::move(*meshes) : bake::BakedRenderMeshes{};
}

bake::SourceMesh soup(std::uint32_t seed, int count, float extent = 1) {
  return meshOf(MeshBuilder()
                    .soup(seed, count, {{-extent, 0, -extent}, {extent, extent, extent}}, 0.05F)
                    .build());
}

/// A wavy sheet of n x n squares, with texture coordinates over it.
bake::SourceMesh sheet(std::uint32_t n, float size) {
  bake::SourceMesh mesh;
  mesh.name = "sheet";
  for (std::uint32_t z = 0; z <= n; ++z) {
    for (std::uint32_t x = 0; x <= n; ++x) {
      const float u = static_cast<float>(x) / static_cast<float>(n);
      const float v = static_cast<float>(z) / static_cast<float>(n);
      mesh.positions.push_back({u * size, 0.02F * std::sin(9 * u) * std::cos(7 * v), v * size});
      mesh.uvs.push_back({3 * u - 1, 2 * v});
    }
  }
  for (std::uint32_t z = 0; z < n; ++z) {
    for (std::uint32_t x = 0; x < n; ++x) {
      const std::uint32_t a = z * (n + 1) + x;
      mesh.triangles.push_back({a, a + n + 1, a + 1});
      mesh.triangles.push_back({a + 1, a + n + 1, a + n + 2});
    }
  }
  return mesh;
}

TEST(RenderBaker, KeepsEachTriangleOfASoupWithinHalfAStep) {
  constexpr std::uint32_t kSeed = 5;
  RecordProperty("seed", static_cast<int>(kSeed));
  const bake::SourceMesh mesh = soup(kSeed, 300);
  SourceBuilder builder;
  const std::uint32_t material = builder.material(true);
  // A soup has no two triangles that touch, so nothing is simplified.
  const auto meshes = bakedMeshes(builder.place(mesh, material), 0.01);
  const auto triangles = drawnTriangles(meshes.view(), 0);
  ASSERT_EQ(triangles.size(), mesh.triangles.size());
  EXPECT_EQ(meshes.models[0].step, static_cast<float>(kFinest));
  // Each drawn triangle has a source triangle with all corners within half a step, and none twice.
  std::set<std::size_t> found;
  for (const DrawnTriangle& drawn : triangles) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      for (std::size_t turn = 0; turn < 3; ++turn) {
        double worst = 0;
        for (std::size_t n = 0; n < 3; ++n) {
          const Vec3& p = mesh.positions[mesh.triangles[t][(n + turn) % 3]];
          const auto& q = drawn.corners[n].position;
          worst = std::max({worst, std::abs(q[0] - static_cast<double>(p.x)),
                            std::abs(q[1] - static_cast<double>(p.y)),
                            std::abs(q[2] - static_cast<double>(p.z))});
        }
        if (worst <= kFinest / 2) found.insert(t);
      }
    }
  }
  EXPECT_EQ(found.size(), mesh.triangles.size());
}

TEST(RenderBaker, TakesACoarserLatticeForALargeTriangle) {
  SourceBuilder builder;
  const std::uint32_t material = builder.material(true);
  builder.place(meshOf(MeshBuilder().floor({0, 0, 0}, {9.7F, 0, 6}, 0).build()), material);
  const auto meshes = bakedMeshes(builder);
  // 9.7 m in at most 65,535 steps: 2^-14 m reaches 4 m, 2^-12 m reaches 16 m.
  EXPECT_EQ(meshes.models[0].step, 0x1p-12F);
  EXPECT_NEAR(meshes.models[0].bounds_max.x, 9.7F, 0x1p-13F);
}

TEST(RenderBaker, StoresByEightWithZeroesBehind) {
  SourceBuilder builder;
  const std::uint32_t material = builder.material(true);
  const auto meshes = bakedMeshes(builder.place(soup(6, 901, 2), material));
  const RenderMeshes view = meshes.view();
  ASSERT_GT(view.clusters.size(), 7U);
  std::size_t vertex = 0;
  std::size_t triangle = 0;
  for (const RenderCluster& cluster : view.clusters) {
    EXPECT_EQ(cluster.first_vertex, vertex);
    EXPECT_EQ(cluster.first_triangle, triangle);
    EXPECT_LE(cluster.vertex_count, kMostInCluster);
    EXPECT_LE(cluster.triangle_count, kMostInCluster);
    for (std::size_t n = cluster.vertex_count; n < wholeLanes(cluster.vertex_count); ++n) {
      for (std::size_t row = 0; row < kVertexRows; ++row) {
        EXPECT_EQ(vertexValue(view, vertex + n, row), 0U);
      }
    }
    vertex += wholeLanes(cluster.vertex_count);
    triangle += wholeLanes(cluster.triangle_count);
  }
  EXPECT_EQ(view.vertices.size(), vertex * kVertexRows);
  EXPECT_EQ(view.triangles.size(), triangle * kTriangleRows);
  EXPECT_EQ(view.cluster_bounds.size(), wholeLanes(view.clusters.size()) * kBoundsRows);
  for (std::size_t lane = view.clusters.size(); lane < wholeLanes(view.clusters.size()); ++lane) {
    EXPECT_EQ(boundsValue(view, lane, kRadiusRow), kNoCluster);
    EXPECT_EQ(boundsValue(view, lane, kHalfExtentRow), kNoCluster);
    EXPECT_EQ(boundsValue(view, lane, kConeCutoffRow), 0);
  }
}

TEST(RenderBaker, BoundsHoldTheirClustersAndConesFaceAwayWhereTrianglesDo) {
  SourceBuilder builder;
  const std::uint32_t material = builder.material(true);
  builder.place(meshOf(MeshBuilder().sphere({0.3F, 0.4F, 0.5F}, 0.5F, 48).build()), material);
  const auto meshes = bakedMeshes(builder, 0.0001);
  const RenderMeshes view = meshes.view();
  const auto triangles = drawnTriangles(view, 0);
  std::mt19937 random(7);
  std::size_t away = 0;
  std::size_t asked = 0;
  std::size_t first = 0;
  for (std::size_t c = 0; c < view.clusters.size(); ++c) {
    const auto bound = [&](std::size_t row) {
      return static_cast<double>(boundsValue(view, c, row));
    };
    const std::size_t count = view.clusters[c].triangle_count;
    for (int eye = 0; eye < 40; ++eye) {
      std::array<double, 3> at{};
      for (double& value : at) value = 4 * static_cast<double>(random()) / 4294967296.0 - 2;
      double along = 0;
      double squared = 0;
      for (std::size_t n = 0; n < 3; ++n) {
        const double to_center = bound(kCenterRow + n) - at[n];
        along += to_center * bound(kConeAxisRow + n);
        squared += to_center * to_center;
      }
      ++asked;
      const bool faces_away =
          along >= bound(kConeCutoffRow) * std::sqrt(squared) + bound(kRadiusRow);
      if (!faces_away) continue;
      ++away;
      for (std::size_t t = first; t < first + count; ++t) {
        const auto& a = triangles[t].corners[0].position;
        const auto& b = triangles[t].corners[1].position;
        const auto& d = triangles[t].corners[2].position;
        const std::array<double, 3> p{b[0] - a[0], b[1] - a[1], b[2] - a[2]};
        const std::array<double, 3> q{d[0] - a[0], d[1] - a[1], d[2] - a[2]};
        const double side = (p[1] * q[2] - p[2] * q[1]) * (a[0] - at[0]) +
                            (p[2] * q[0] - p[0] * q[2]) * (a[1] - at[1]) +
                            (p[0] * q[1] - p[1] * q[0]) * (a[2] - at[2]);
        EXPECT_GE(side, 0);
      }
    }
    for (std::size_t t = first; t < first + count; ++t) {
      for (const DrawnCorner& corner : triangles[t].corners) {
        double squared = 0;
        for (std::size_t n = 0; n < 3; ++n) {
          const double off = std::abs(corner.position[n] - bound(kCenterRow + n));
          EXPECT_LE(off, bound(kHalfExtentRow + n));
          squared += off * off;
        }
        EXPECT_LE(std::sqrt(squared), bound(kRadiusRow));
      }
    }
    first += count;
  }
  EXPECT_GT(away, asked / 10);
  EXPECT_LT(away, asked * 9 / 10);
}

TEST(RenderBaker, KeepsTextureCoordinatesUpToWholeImages) {
  SourceBuilder builder;
  const std::uint32_t material = builder.material(true, true);
  const bake::SourceMesh mesh = sheet(20, 1);
  const auto meshes = bakedMeshes(builder.place(mesh, material));
  const auto triangles = drawnTriangles(meshes.view(), 0);
  ASSERT_FALSE(triangles.empty());
  ASSERT_FALSE(meshes.clusters.empty());
  // Source coordinates by position; the sheet is flat seen from above.
  for (const DrawnTriangle& triangle : triangles) {
    double u_shift = 0;
    double v_shift = 0;
    for (std::size_t n = 0; n < 3; ++n) {
      const DrawnCorner& corner = triangle.corners[n];
      const double u = 3 * corner.position[0] - 1;
      const double v = 1 - 2 * corner.position[2];
      if (n == 0) {
        u_shift = std::round(u - corner.uv[0]);
        v_shift = std::round(v - corner.uv[1]);
      }
      // Half a step of the lattice, three times, and half a step of the cluster's range.
      EXPECT_NEAR(u - u_shift, corner.uv[0], 3 * kFinest / 2 + 3.0 / 65535);
      EXPECT_NEAR(v - v_shift, corner.uv[1], 2 * kFinest / 2 + 2.0 / 65535);
    }
  }
  for (const RenderCluster& cluster : meshes.clusters) {
    EXPECT_GE(cluster.u_minimum, 0);
    EXPECT_LE(cluster.u_minimum, 1);
    EXPECT_GE(cluster.v_minimum, 0);
  }
}

TEST(RenderBaker, ForgetsTextureCoordinatesWhereThereIsNoTexture) {
  SourceBuilder builder;
  const std::uint32_t material = builder.material(true);
  const auto meshes = bakedMeshes(builder.place(sheet(4, 1), material));
  ASSERT_FALSE(meshes.clusters.empty());
  for (const RenderCluster& cluster : meshes.clusters) {
    EXPECT_EQ(cluster.u_step, 0);
    EXPECT_EQ(cluster.v_step, 0);
  }
}

TEST(RenderBaker, BringsVertexColorsAsScreensWantThemAndNotTheirAlpha) {
  SourceBuilder builder;
  const std::uint32_t material = builder.material(true);
  bake::SourceMesh red = meshOf(MeshBuilder().triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}).build());
  red.colors = {{1, 0.2158605F, 0, 0}, {1, 0.2158605F, 0, 0.5F}, {1, 0.2158605F, 0, 1}};
  bake::SourceMesh plain = meshOf(MeshBuilder().triangle({0, 0, 5}, {1, 0, 5}, {0, 1, 5}).build());
  const auto meshes = bakedMeshes(builder.place(red, material).place(plain, material));
  std::multiset<std::uint32_t> colors;
  for (const DrawnTriangle& triangle : drawnTriangles(meshes.view(), 0)) {
    for (const DrawnCorner& corner : triangle.corners) colors.insert(corner.color);
  }
  // Linear 0.21586 is sRGB 128 of 255 (IEC 61966-2-1).
  EXPECT_EQ(colors.count(0xFF0080FFU), 3U);
  EXPECT_EQ(colors.count(0xFFFFFFFFU), 3U);
}

TEST(RenderBaker, HasNoColorsWhereNoMeshHasAny) {
  SourceBuilder builder;
  const std::uint32_t material = builder.material(true);
  EXPECT_TRUE(bakedMeshes(builder.place(soup(8, 10), material)).colors.empty());
}

TEST(RenderBaker, KeepsMaterialsAndSemanticsApart) {
  SourceBuilder builder;
  const std::uint32_t first = builder.material(true);
  const std::uint32_t second = builder.material(false);
  const std::uint32_t chair = builder.semantic("chair");
  builder.place(soup(9, 5), first).place(soup(10, 7), second, movedBy(3, 0, 0), chair);
  std::map<std::pair<int, int>, int> counts;
  for (const DrawnTriangle& triangle : drawnTriangles(bakedMeshes(builder).view(), 0)) {
    ++counts[{triangle.material, triangle.semantic}];
    EXPECT_EQ(triangle.two_sided, triangle.material == first);
  }
  EXPECT_THAT(counts, testing::ElementsAre(testing::Pair(std::pair(0, 0), 5),
                                           testing::Pair(std::pair(1, 1), 7)));
}

TEST(RenderBaker, DropsTrianglesWithoutAreaAndTwins) {
  SourceBuilder builder;
  const std::uint32_t material = builder.material(true);
  bake::SourceMesh mesh = meshOf(MeshBuilder()
                                     .triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0})
                                     .triangle({1, 0, 0}, {0, 1, 0}, {0, 0, 0})
                                     .triangle({2, 2, 2}, {2, 2, 2}, {3, 2, 2})
                                     .triangle({-0.0F, 0, 0}, {0, 0, 0}, {0, 0, 1})
                                     .build());
  const auto meshes = bakedMeshes(builder.place(mesh, material));
  EXPECT_EQ(meshes.models[0].triangles, 1U);
  EXPECT_EQ(meshes.models[0].source_triangles, 4U);
}

TEST(RenderBaker, OfNothingIsAModelWithoutClusters) {
  SourceBuilder builder;
  const std::uint32_t material = builder.material(true);
  bake::SourceMesh nothing;
  nothing.name = "nothing";
  const auto meshes = bakedMeshes(builder.place(nothing, material));
  ASSERT_EQ(meshes.models.size(), 1U);
  EXPECT_EQ(meshes.models[0].cluster_count, 0U);
  EXPECT_FALSE(meshes.view().modelOf(0));
}

TEST(RenderBaker, GivesTheSameForAnyNumberOfJobs) {
  SourceBuilder builder;
  const std::uint32_t textured = builder.material(true, true);
  const std::uint32_t plain = builder.material(true);
  builder.place(sheet(60, 2), textured).place(soup(11, 400), plain);
  builder.place(meshOf(MeshBuilder().sphere({0, 1, 0.1F}, 0.4F, 30).build()), plain);
  builder.part(3).place(sheet(33, 0.4F), textured).part(7).place(soup(12, 50), plain);
  const auto once = bakedMeshes(builder, 0.003, 1);
  for (const unsigned threads : {2U, 3U, 16U}) {
    const auto again = bakedMeshes(builder, 0.003, threads);
    EXPECT_EQ(once.vertices, again.vertices);
    EXPECT_EQ(once.triangles, again.triangles);
    EXPECT_EQ(once.cluster_bounds, again.cluster_bounds);
    ASSERT_EQ(once.clusters.size(), again.clusters.size());
    EXPECT_EQ(std::memcmp(once.clusters.data(), again.clusters.data(),
                          once.clusters.size() * sizeof(RenderCluster)),
              0);
  }
  ASSERT_EQ(once.models.size(), 3U);
  EXPECT_EQ(once.models[1].part, 3U);
  EXPECT_EQ(once.models[2].part, 7U);
}

bake::SourceMesh smallCube(float x) {
  return meshOf(MeshBuilder().box({x, 0.001F, 0}, {x + 0.012F, 0.013F, 0.012F}).build());
}

TEST(RenderBaker, KeepsTheFinestLatticeForThingsThatStandFarApart) {
  SourceBuilder builder;
  const std::uint32_t material = builder.material(true);
  for (const float x : {-300.0F, -299.0F, 0.0F, 20.0F, 300.0F}) {
    builder.place(smallCube(x), material);
  }
  const auto meshes = bakedMeshes(builder, 0.005);
  EXPECT_EQ(meshes.models[0].step, static_cast<float>(kFinest));
  EXPECT_EQ(meshes.models[0].triangles, 60U);
  EXPECT_EQ(meshes.models[0].largest_error, 0);
  EXPECT_EQ(meshes.clusters.size(), 4U);
}

TEST(RenderBaker, TellsWhatALatticeMovesThatALargeTriangleMakesCoarse) {
  const auto meshesOn = [](float ground) {
    SourceBuilder builder;
    const std::uint32_t material = builder.material(true);
    builder.place(smallCube(0.1F), material);
    builder.place(meshOf(MeshBuilder()
                             .floor({-ground / 2, 0, -ground / 2}, {ground / 2, 0, ground / 2}, 0)
                             .build()),
                  material);
    return bakedMeshes(builder, 0.005);
  };
  const auto some = meshesOn(100);
  EXPECT_NEAR(some.models[0].largest_error, 32 * kFinest * std::sqrt(3.0) / 2, 1e-6);
  EXPECT_THAT(some.warnings, testing::IsEmpty());
  const auto much = meshesOn(400);
  EXPECT_NEAR(much.models[0].largest_error, 128 * kFinest * std::sqrt(3.0) / 2, 1e-6);
  EXPECT_THAT(much.warnings,
              testing::ElementsAre("render meshes: a triangle of more than 256 m makes corners of "
                                   "all of them move by up to 6.8 mm, expected 5.0 mm; cut it into "
                                   "smaller ones, or leave it out"));
}

TEST(RenderBaker, RefusesWhatLiesTooFarOff) {
  for (const float far :
       {801.0F, std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
    SourceBuilder builder;
    const std::uint32_t material = builder.material(true);
    builder.place(meshOf(MeshBuilder().triangle({0, 0, 0}, {far, 0, 0}, {0, 1, 0}).build(), "far"),
                  material);
    const auto meshes = bake::bakeRenderMeshes(builder.source(), {});
    ASSERT_FALSE(meshes);
    EXPECT_EQ(meshes.error().code, ErrorCode::kInvalidInput);
    EXPECT_EQ(meshes.error().where, "mesh 'far'");
    EXPECT_THAT(meshes.error().message, testing::HasSubstr("at most 800 m are possible"));
  }
}

TEST(RenderBaker, RefusesAMaterialThatIsNotThere) {
  SourceBuilder builder;
  builder.material(true);
  const auto meshes = bake::bakeRenderMeshes(builder.place(soup(13, 1), 4).source(), {});
  ASSERT_FALSE(meshes);
  EXPECT_EQ(meshes.error().message,
            "has material 4 of 1 and semantic 0 of 1; export the file again");
}

TEST(RenderBaker, MergesPacksWithTheirTexturesStoredOnce) {
  const auto one = [](const char* name, int extra_textures) {
    SourceBuilder builder;
    for (int n = 0; n < extra_textures; ++n) builder.material(true, true);
    const std::uint32_t material = builder.material(true, true);
    builder.source().semantics = {name};
    return bakedMeshes(builder.place(sheet(9, 0.3F), material));
  };
  bake::BakedRenderMeshes merged;
  const auto cup = one("cup", 0);
  const auto bowl = one("bowl", 1);
  append(merged, bowl, 0);
  append(merged, cup, 1);
  // The texture of the cup is byte for byte the first of the bowl.
  EXPECT_EQ(merged.materials.textures.size(), 2U);
  EXPECT_EQ(merged.materials.materials.size(), 3U);
  EXPECT_THAT(merged.semantics, testing::ElementsAre("bowl", "cup"));
  const RenderMeshes view = merged.view();
  const auto of_bowl = drawnTriangles(view, 0);
  const auto of_cup = drawnTriangles(view, 1);
  ASSERT_EQ(of_bowl.size(), of_cup.size());
  for (std::size_t n = 0; n < of_cup.size(); ++n) {
    EXPECT_EQ(of_cup[n].corners[0].at, of_bowl[n].corners[0].at);
    EXPECT_EQ(of_cup[n].semantic, 1U);
    EXPECT_EQ(view.materials[of_cup[n].material].texture, 0);
    EXPECT_EQ(view.materials[of_bowl[n].material].texture, 1);
  }
}

// Room made for one mesh after the other moves a terabyte.
TEST(RenderBaker, TakesManyThousandPlacesOfOneMesh) {
  constexpr std::size_t kPlaces = 200'000;
  SourceBuilder builder;
  const std::uint32_t material = builder.material(false);
  builder.place(soup(1, 1), material);
  bake::RenderSource& source = builder.source();
  source.parts.front().meshes.resize(kPlaces, source.parts.front().meshes.front());
  const bake::BakedRenderMeshes meshes = bakedMeshes(builder);
  EXPECT_EQ(meshes.statistics().source_triangles, kPlaces);
  EXPECT_EQ(meshes.statistics().triangles, 1U);
}

}  // namespace
}  // namespace galactic::test::render_baker_test
