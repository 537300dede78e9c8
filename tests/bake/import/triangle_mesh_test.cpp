// Placing and cleaning, against a plain quadratic twin.
#include "galactic/bake/triangle_mesh.h"

#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "bake/import/import_helpers.h"

namespace galactic::test::triangle_mesh_test {
namespace {

using bake::Affine;
using bake::placeAndClean;
using bake::SourceAsset;
using bake::SourceMesh;

constexpr Affine kIdentity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

SourceAsset assetOf(std::vector<Vec3> positions, std::vector<bake::Triangle> triangles) {
  SourceAsset asset;
  asset.name = "test";
  SourceMesh& mesh = asset.meshes.emplace_back();
  mesh.positions = std::move(positions);
  mesh.triangles = std::move(triangles);
  asset.instances.push_back({.name = "node", .mesh = 0, .world_from_mesh = kIdentity});
  return asset;
}

TEST(TriangleMesh, CountsTrianglesWithTheSameCornersInAnyOrderAsDuplicates) {
  const auto clean =
      placeAndClean(assetOf({{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {0, 0, 0}, {1, 0, 0}, {0, 0, 1}},
                            {{0, 1, 2}, {1, 2, 0}, {2, 1, 0}, {3, 4, 5}, {5, 1, 3}}));
  ASSERT_TRUE(clean.has_value());
  EXPECT_EQ(clean->counts.read, 5U);
  EXPECT_EQ(clean->counts.duplicate, 4U);
  EXPECT_EQ(clean->counts.degenerate, 0U);
  EXPECT_EQ(clean->mesh.triangles.size(), 1U);
  EXPECT_EQ(clean->mesh.vertices.size(), 3U) << "vertices of dropped triangles are dropped";
}

TEST(TriangleMesh, TakesMinusZeroForZero) {
  const auto clean = placeAndClean(
      assetOf({{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {-0.F, -0.F, -0.F}}, {{0, 1, 2}, {3, 1, 2}}));
  ASSERT_TRUE(clean.has_value());
  EXPECT_EQ(clean->counts.duplicate, 1U);
}

TEST(TriangleMesh, DropsTrianglesLowerThanTheLimitAndKeepsHigherOnes) {
  const auto low = static_cast<float>(0.9 * bake::kDegenerateHeight);
  const auto high = static_cast<float>(1.1 * bake::kDegenerateHeight);
  const auto clean =
      placeAndClean(assetOf({{0, 0, 0}, {1, 0, 0}, {0.5F, low, 0}, {0.5F, high, 0}, {2, 0, 0}},
                            {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}, {0, 0, 1}, {1, 1, 1}}));
  ASSERT_TRUE(clean.has_value());
  EXPECT_EQ(clean->counts.degenerate, 4U);
  ASSERT_EQ(clean->mesh.triangles.size(), 1U);
  EXPECT_EQ(clean->mesh.bounds.max.y, high);
  EXPECT_EQ(clean->mesh.bounds.max.x, 1) << "bounds are those of the kept triangles";
}

TEST(TriangleMesh, FailsWhenEveryTriangleIsDegenerate) {
  const auto clean = placeAndClean(assetOf({{0, 0, 0}, {1, 0, 0}}, {{0, 1, 1}, {0, 0, 1}}));
  ASSERT_FALSE(clean.has_value());
  EXPECT_EQ(clean.error().code, ErrorCode::kInvalidInput);
  EXPECT_EQ(clean.error().message,
            "all of its 2 triangles are degenerate (lower than 1e-07 m); if its unit is not the "
            "meter, give `scale`");
}

TEST(TriangleMesh, RefusesBrokenReferencesInsteadOfReadingThem) {
  SourceAsset vertex = assetOf({{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}, {{0, 1, 3}});
  EXPECT_EQ(placeAndClean(vertex).error().code, ErrorCode::kInvalidInput);
  SourceAsset mesh = assetOf({{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}, {{0, 1, 2}});
  mesh.instances[0].mesh = 1;
  EXPECT_EQ(placeAndClean(mesh).error().code, ErrorCode::kInvalidInput);
}

TEST(TriangleMesh, NamesTheVertexThatOverflowsInTheWorld) {
  SourceAsset asset = assetOf({{0, 0, 0}, {1e30F, 0, 0}, {0, 0, 1}}, {{0, 1, 2}});
  asset.instances[0].world_from_mesh[0] = 1e30;
  const auto clean = placeAndClean(asset);
  ASSERT_FALSE(clean.has_value());
  EXPECT_EQ(clean.error().where, "test: node 'node', mesh ''");
  EXPECT_THAT(clean.error().message, testing::HasSubstr("vertex 1 lies at"));
}

TEST(TriangleMesh, RefusesMoreTrianglesThanItCanHold) {
  // Instances of instances are how a small file becomes an endless scene.
  SourceAsset asset =
      assetOf({{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}, std::vector<bake::Triangle>(1U << 16U, {0, 1, 2}));
  asset.instances.resize((1U << 11U) + 1, asset.instances[0]);
  const auto clean = placeAndClean(asset);
  ASSERT_FALSE(clean.has_value());
  EXPECT_EQ(clean.error().message, "it places more than 134217728 triangles; split or simplify it");
}

TEST(TriangleMesh, RoundsPlacedVerticesOnlyOnce) {
  // In float, 0.1f + 100 loses digits before the shift back; in double it does not.
  SourceAsset asset = assetOf({{0.1F, 0.2F, 0.3F}, {1, 0, 0}, {0, 0, 1}}, {{0, 1, 2}});
  asset.instances[0].world_from_mesh = {1e-3, 0, 0, 100, 0, 1e-3, 0, 0, 0, 0, 1e-3, 0};
  const auto clean = placeAndClean(asset);
  ASSERT_TRUE(clean.has_value());
  EXPECT_EQ(clean->mesh.vertices[0].x, static_cast<float>(1e-3 * static_cast<double>(0.1F) + 100));
  EXPECT_EQ(clean->mesh.vertices[0].z, static_cast<float>(1e-3 * static_cast<double>(0.3F)));
}

/// Twice the area over the longest edge by Heron's formula in extended precision: another way than
/// the cross product.
double altitude(const std::array<Vec3, 3>& t) {
  const auto length = [](const Vec3& a, const Vec3& b) {
    const long double x = static_cast<long double>(a.x) - static_cast<long double>(b.x);
    const long double y = static_cast<long double>(a.y) - static_cast<long double>(b.y);
    const long double z = static_cast<long double>(a.z) - static_cast<long double>(b.z);
    return sqrtl(x * x + y * y + z * z);
  };
  std::array<long double, 3> e{length(t[0], t[1]), length(t[1], t[2]), length(t[2], t[0])};
  std::sort(e.begin(), e.end());
  if (e[2] == 0) return 0;
  const long double s = (e[2] + (e[1] + e[0])) * (e[0] - (e[2] - e[1])) * (e[0] + (e[2] - e[1])) *
                        (e[2] + (e[1] - e[0]));
  return static_cast<double>(sqrtl(std::max(s, 0.0L)) / 2 / e[2]);
}

TEST(TriangleMesh, DropsExactlyWhatAPlainQuadraticSearchDrops) {
  constexpr unsigned kSeed = 7;
  constexpr std::size_t kTriangles = 2000;
  SCOPED_TRACE(fmt::format("seed {}", kSeed));
  std::mt19937 random(kSeed);
  // Few positions on a coarse lattice, so that equal and flat triangles are common.
  std::vector<Vec3> positions;
  positions.reserve(60);
  for (int i = 0; i < 60; ++i) {
    positions.push_back({static_cast<float>(random() % 3), static_cast<float>(random() % 3),
                         static_cast<float>(random() % 3)});
  }
  std::vector<bake::Triangle> triangles(kTriangles);
  const auto any = [&] { return static_cast<std::uint32_t>(random() % positions.size()); };
  for (auto& t : triangles) t = {any(), any(), any()};

  using Key = std::array<std::array<float, 3>, 3>;
  std::vector<Key> kept;
  std::uint64_t degenerate = 0;
  std::uint64_t duplicate = 0;
  for (const auto& t : triangles) {
    const std::array<Vec3, 3> corners{positions[t[0]], positions[t[1]], positions[t[2]]};
    Key key{};
    for (std::size_t c = 0; c < 3; ++c) key[c] = {corners[c].x, corners[c].y, corners[c].z};
    std::sort(key.begin(), key.end());
    if (altitude(corners) < bake::kDegenerateHeight) {
      ++degenerate;
    } else if (std::find(kept.begin(), kept.end(), key) != kept.end()) {
      ++duplicate;
    } else {
      kept.push_back(key);
    }
  }
  for (const std::uint64_t count : {degenerate, duplicate, std::uint64_t{kept.size()}}) {
    EXPECT_GE(count, kTriangles / 10);
    EXPECT_LE(count, kTriangles * 9 / 10);
  }

  const auto clean = placeAndClean(assetOf(positions, triangles));
  ASSERT_TRUE(clean.has_value());
  EXPECT_EQ(clean->counts.degenerate, degenerate);
  EXPECT_EQ(clean->counts.duplicate, duplicate);
  ASSERT_EQ(clean->mesh.triangles.size(), kept.size());
  for (std::size_t i = 0; i < kept.size(); ++i) {
    Key key{};
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3& v = clean->mesh.vertices[clean->mesh.triangles[i][c]];
      key[c] = {v.x, v.y, v.z};
    }
    std::sort(key.begin(), key.end());
    EXPECT_EQ(key, kept[i]) << "the first of equal triangles is kept, in order";
  }
}

}  // namespace
}  // namespace galactic::test::triangle_mesh_test
