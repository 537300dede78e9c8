#include "layout/render_mesh_builder.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <string>
#include <vector>

namespace galactic::render_mesh_builder_test {
namespace {

using testing::HasSubstr;

constexpr double kHalfFinestStep = 0.5 / (1 << 14);

RenderMeshSource sourceOf(std::vector<RenderPart> parts) {
  RenderMeshSource source;
  source.parts = std::move(parts);
  source.materials = {{.name = "paint"}};
  source.semantics = {"thing"};
  return source;
}

/// A sphere of `rings` x 2 `rings` quads, radius `radius`, with texture coordinates and colors.
RenderSurface sphereSurface(std::uint32_t rings, double radius, bool with_colors) {
  RenderSurface surface;
  const std::uint32_t columns = 2 * rings;
  for (std::uint32_t ring = 0; ring <= rings; ++ring) {
    for (std::uint32_t column = 0; column <= columns; ++column) {
      const double a = std::numbers::pi * ring / rings;
      const double b = 2 * std::numbers::pi * (column % columns) / columns;
      const Vec3 p{static_cast<float>(radius * std::sin(a) * std::cos(b)),
                   static_cast<float>(radius * std::cos(a)),
                   static_cast<float>(radius * std::sin(a) * std::sin(b))};
      const std::uint32_t color = with_colors ? 0xFF000000U + ring * 1000 + column : 0xFFFFFFFFU;
      surface.vertices.push_back({p, static_cast<float>(column) / 8 - 3.5F,
                                  static_cast<float>(ring) / 16 + 20.25F, color});
    }
  }
  for (std::uint32_t ring = 0; ring < rings; ++ring) {
    for (std::uint32_t column = 0; column < columns; ++column) {
      const std::uint32_t a = ring * (columns + 1) + column;
      const std::uint32_t b = a + columns + 1;
      surface.corners.insert(surface.corners.end(), {a, a + 1, b + 1, a, b + 1, b});
    }
  }
  return surface;
}

RenderSurface triangleSurface(const Vec3& a, const Vec3& b, const Vec3& c) {
  RenderSurface surface;
  surface.vertices = {{a}, {b}, {c}};
  surface.corners = {0, 1, 2};
  return surface;
}

/// A vertex as a renderer reads it.
struct ReadVertex {
  std::array<double, 3> position{};
  double u = 0;
  double v = 0;
  std::uint32_t color = 0;
};

/// What a renderer reads, by the words of schema/render.fbs.
class Reader {
 public:
  Reader(const RenderMeshes& meshes, const RenderModel& model) : meshes_(meshes), model_(model) {}

  ReadVertex vertex(const RenderCluster& cluster, std::size_t n) const {
    const std::size_t number = cluster.first_vertex + n;
    const auto row = [&](std::size_t r) {
      return meshes_.vertices[number / 8 * 40 + r * 8 + number % 8];
    };
    const auto step = static_cast<double>(model_.step);
    ReadVertex read;
    read.position = {step * (cluster.origin_x + row(0)), step * (cluster.origin_y + row(1)),
                     step * (cluster.origin_z + row(2))};
    read.u = static_cast<double>(cluster.u_minimum) + static_cast<double>(cluster.u_step) * row(3);
    read.v = static_cast<double>(cluster.v_minimum) + static_cast<double>(cluster.v_step) * row(4);
    read.color = meshes_.colors.empty() ? 0xFFFFFFFFU : meshes_.colors[number];
    return read;
  }
  std::array<std::size_t, 3> corners(const RenderCluster& cluster, std::size_t n) const {
    const std::size_t number = cluster.first_triangle + n;
    const auto row = [&](std::size_t r) {
      return meshes_.triangles[number / 8 * 24 + r * 8 + number % 8];
    };
    return {row(0), row(1), row(2)};
  }
  float bound(std::size_t cluster, std::size_t row) const {
    return meshes_.cluster_bounds[(model_.first_block + cluster / 8) * 88 + row * 8 + cluster % 8];
  }
  std::span<const RenderCluster> clusters() const {
    return meshes_.clusters.subspan(model_.first_cluster, model_.cluster_count);
  }

 private:
  const RenderMeshes& meshes_;
  const RenderModel& model_;
};

std::array<double, 3> wide(const Vec3& p) { return {double{p.x}, double{p.y}, double{p.z}}; }

double distance(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

TEST(RenderMeshBuilder, ATriangleBecomesOneClusterInTheWordsOfTheSchema) {
  RenderSurface surface = triangleSurface({1, 0, 0}, {1, 0.5F, 0}, {1, 0, -2});
  surface.vertices[1].u = 2.5F;
  const auto built = buildRenderMeshes(sourceOf({{.part = 3, .surfaces = {surface}}}));
  ASSERT_TRUE(built) << built.error().message;
  const RenderMeshes meshes = built->view();
  ASSERT_EQ(meshes.models.size(), 1U);
  EXPECT_EQ(meshes.models[0].part, 3U);
  EXPECT_EQ(meshes.models[0].triangles, 1U);
  EXPECT_EQ(meshes.models[0].step, 1.0F / 16384);
  EXPECT_EQ(meshes.models[0].bounds_min, (Vec3{1, 0, -2}));
  EXPECT_EQ(meshes.models[0].bounds_max, (Vec3{1, 0.5F, 0}));
  ASSERT_EQ(meshes.clusters.size(), 1U);
  EXPECT_EQ(meshes.clusters[0].origin_x, 16384);
  EXPECT_EQ(meshes.clusters[0].origin_z, -32768);
  EXPECT_EQ(meshes.vertices.size(), 40U);
  EXPECT_EQ(meshes.vertices[8 + 1], 8192);
  EXPECT_EQ(meshes.triangles.size(), 24U);
  EXPECT_THAT(std::vector<int>(meshes.triangles.begin(), meshes.triangles.begin() + 9),
              testing::ElementsAre(0, 0, 0, 0, 0, 0, 0, 0, 1));
  EXPECT_TRUE(meshes.colors.empty());
  const Reader reader(meshes, meshes.models[0]);
  EXPECT_NEAR(reader.vertex(meshes.clusters[0], 1).u, 2.5, 1e-4);
  // It looks along +X where its corners go counter-clockwise: (0, .5, 0) x (0, 0, -2).
  EXPECT_EQ(reader.bound(0, 7), -1.0F);
  EXPECT_LT(reader.bound(0, 10), 0.01F);
  // A lane without a cluster.
  EXPECT_EQ(reader.bound(1, 3), -1e30F);
  EXPECT_EQ(reader.bound(1, 6), -1e30F);
  EXPECT_EQ(reader.bound(1, 10), 0.0F);
}

TEST(RenderMeshBuilder, EveryTriangleOfALargeSurfaceIsThereOnceWithinHalfAStep) {
  const RenderSurface surface = sphereSurface(40, 1.7, true);
  const auto built = buildRenderMeshes(sourceOf({{.surfaces = {surface}}}));
  ASSERT_TRUE(built) << built.error().message;
  const RenderMeshes meshes = built->view();
  const Reader reader(meshes, meshes.models[0]);
  // Colors number the vertices.
  std::map<std::uint32_t, RenderVertex> by_color;
  for (const RenderVertex& vertex : surface.vertices) by_color[vertex.color] = vertex;
  using Key = std::array<std::uint32_t, 3>;
  std::map<Key, int> wanted;
  for (std::size_t n = 0; n < surface.corners.size(); n += 3) {
    ++wanted[{surface.vertices[surface.corners[n]].color,
              surface.vertices[surface.corners[n + 1]].color,
              surface.vertices[surface.corners[n + 2]].color}];
  }
  std::map<Key, int> found;
  for (const RenderCluster& cluster : reader.clusters()) {
    EXPECT_LE(cluster.vertex_count, kMostInCluster);
    EXPECT_LE(cluster.triangle_count, kMostInCluster);
    EXPECT_EQ(cluster.first_vertex % 8, 0U);
    EXPECT_EQ(cluster.first_triangle % 8, 0U);
    for (std::size_t n = 0; n < cluster.vertex_count; ++n) {
      const ReadVertex read = reader.vertex(cluster, n);
      const RenderVertex& vertex = by_color.at(read.color);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(read.position[axis], wide(vertex.position)[axis], kHalfFinestStep);
      }
      // Whole numbers do not matter: images repeat.
      const double u = read.u - double{vertex.u};
      const double v = read.v - double{vertex.v};
      EXPECT_NEAR(u, std::round(u), 1e-4);
      EXPECT_NEAR(v, std::round(v), 1e-4);
      EXPECT_GE(cluster.u_minimum, 0.0F);
      EXPECT_LT(cluster.u_minimum, 1.0F);
    }
    for (std::size_t n = 0; n < cluster.triangle_count; ++n) {
      Key key{};
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t corner = reader.corners(cluster, n)[c];
        ASSERT_LT(corner, cluster.vertex_count);
        key[c] = reader.vertex(cluster, corner).color;
      }
      ++found[key];
    }
  }
  EXPECT_EQ(found, wanted);
  EXPECT_EQ(meshes.models[0].triangles, surface.corners.size() / 3);
  // Splitting along a curve leaves few clusters half empty.
  EXPECT_LE(meshes.clusters.size(), 3 * surface.corners.size() / 3 / kMostInCluster);
}

TEST(RenderMeshBuilder, BoundsHoldWhatIsDrawn) {
  const auto built = buildRenderMeshes(sourceOf(
      {{.part = 0, .surfaces = {sphereSurface(23, 0.9, false)}},
       {.part = 1, .surfaces = {}},
       {.part = 2, .surfaces = {sphereSurface(9, 7.3, false), sphereSurface(5, 2, false)}}}));
  ASSERT_TRUE(built) << built.error().message;
  const RenderMeshes meshes = built->view();
  EXPECT_EQ(meshes.modelOf(1), std::nullopt);
  EXPECT_EQ(meshes.modelOf(2), 2U);
  for (const RenderModel& model : meshes.models) {
    const Reader reader(meshes, model);
    for (std::size_t c = 0; c < model.cluster_count; ++c) {
      const RenderCluster& cluster = reader.clusters()[c];
      const std::array<double, 3> center{double{reader.bound(c, 0)}, double{reader.bound(c, 1)},
                                         double{reader.bound(c, 2)}};
      for (std::size_t n = 0; n < cluster.vertex_count; ++n) {
        const std::array<double, 3> p = reader.vertex(cluster, n).position;
        EXPECT_LE(distance(p, center), double{reader.bound(c, 6)});
        for (std::size_t axis = 0; axis < 3; ++axis) {
          EXPECT_LE(std::abs(p[axis] - center[axis]), double{reader.bound(c, 3 + axis)});
          EXPECT_GE(p[axis], wide(model.bounds_min)[axis]);
          EXPECT_LE(p[axis], wide(model.bounds_max)[axis]);
        }
      }
    }
  }
}

/// Whether any triangle of the cluster shows its outside to an eye.
bool facesAny(const Reader& reader, const RenderCluster& cluster,
              const std::array<double, 3>& eye) {
  for (std::size_t n = 0; n < cluster.triangle_count; ++n) {
    std::array<std::array<double, 3>, 3> p{};
    for (std::size_t c = 0; c < 3; ++c) {
      p[c] = reader.vertex(cluster, reader.corners(cluster, n)[c]).position;
    }
    double volume = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      const std::size_t b = (a + 1) % 3;
      const std::size_t d = (a + 2) % 3;
      volume += (eye[a] - p[0][a]) * ((p[1][b] - p[0][b]) * (p[2][d] - p[0][d]) -
                                      (p[1][d] - p[0][d]) * (p[2][b] - p[0][b]));
    }
    if (volume > 0) return true;
  }
  return false;
}

TEST(RenderMeshBuilder, AConeNeverHidesATriangleThatFacesTheEye) {
  constexpr std::uint32_t kSeed = 7;
  SCOPED_TRACE(fmt::format("seed {}", kSeed));
  std::mt19937 random(kSeed);
  const auto built = buildRenderMeshes(sourceOf({{.surfaces = {sphereSurface(30, 1, false)}}}));
  ASSERT_TRUE(built) << built.error().message;
  const RenderMeshes meshes = built->view();
  const Reader reader(meshes, meshes.models[0]);
  std::size_t hidden = 0;
  std::size_t cases = 0;
  for (int round = 0; round < 400; ++round) {
    std::array<double, 3> eye{};
    for (double& e : eye) e = static_cast<double>(random() % 8001) / 1000 - 4;
    for (std::size_t c = 0; c < reader.clusters().size(); ++c) {
      const std::array<double, 3> d{double{reader.bound(c, 0)} - eye[0],
                                    double{reader.bound(c, 1)} - eye[1],
                                    double{reader.bound(c, 2)} - eye[2]};
      const double along = d[0] * double{reader.bound(c, 7)} + d[1] * double{reader.bound(c, 8)} +
                           d[2] * double{reader.bound(c, 9)};
      const bool is_hidden = along >= double{reader.bound(c, 10)} * std::hypot(d[0], d[1], d[2]) +
                                          double{reader.bound(c, 6)};
      ++cases;
      if (!is_hidden) continue;
      ++hidden;
      EXPECT_FALSE(facesAny(reader, reader.clusters()[c], eye));
    }
  }
  const double share = static_cast<double>(hidden) / static_cast<double>(cases);
  EXPECT_GT(share, 0.1);
  EXPECT_LT(share, 0.9);
}

TEST(RenderMeshBuilder, TwoSidedClustersHaveNoCone) {
  RenderSurface surface = triangleSurface({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  surface.two_sided = true;
  const auto built = buildRenderMeshes(sourceOf({{.surfaces = {surface}}}));
  ASSERT_TRUE(built);
  EXPECT_EQ(built->clusters[0].two_sided, 1);
  EXPECT_EQ(built->cluster_bounds[10 * 8], 2.0F);
}

TEST(RenderMeshBuilder, AStepGrowsUntilTheLargestClusterFits) {
  // 4 m are 65,536 of the finest steps, one more than sixteen bits hold.
  const struct {
    float size;
    float step;
  } cases[] = {{3.99F, 1.0F / 16384}, {4.0F, 1.0F / 8192}, {100, 1.0F / 512}, {60000, 1}};
  for (const auto& [size, step] : cases) {
    const auto built = buildRenderMeshes(
        sourceOf({{.surfaces = {triangleSurface({0, 0, 0}, {size, 0, 0}, {0, 0, 1})}}}));
    ASSERT_TRUE(built) << built.error().message;
    EXPECT_EQ(built->models[0].step, step) << size;
  }
}

TEST(RenderMeshBuilder, AStepGrowsFarFromTheOrigin) {
  // At the finest step, 2 km are 2^25 steps, which floats cannot tell apart.
  for (const float far : {-2000.0F, 2000.0F}) {
    const auto built = buildRenderMeshes(
        sourceOf({{.surfaces = {triangleSurface({far, 0, 0}, {far, 0, 1}, {far, 1, 0})}}}));
    ASSERT_TRUE(built) << built.error().message;
    EXPECT_EQ(built->models[0].step, 1.0F / 8192);
    EXPECT_EQ(built->models[0].bounds_min.x, far);
  }
}

TEST(RenderMeshBuilder, EqualPositionsStayEqualAcrossClusters) {
  // Two clusters with other origins share two corners that lie between lattice points.
  const Vec3 a{0.123456F, 0.9876543F, -0.3333333F};
  const Vec3 b{0.7777777F, -1.2345678F, 0.1111111F};
  const auto built =
      buildRenderMeshes(sourceOf({{.surfaces = {triangleSurface(a, b, {-2.2F, 0, 0}),
                                                triangleSurface(b, a, {3.141F, 0.2F, 0.3F})}}}));
  ASSERT_TRUE(built);
  const RenderMeshes meshes = built->view();
  const Reader reader(meshes, meshes.models[0]);
  EXPECT_EQ(reader.vertex(meshes.clusters[0], 0).position,
            reader.vertex(meshes.clusters[1], 1).position);
  EXPECT_EQ(reader.vertex(meshes.clusters[0], 1).position,
            reader.vertex(meshes.clusters[1], 0).position);
  EXPECT_NE(meshes.clusters[0].origin_x, meshes.clusters[1].origin_x);
}

TEST(RenderMeshBuilder, TexturesAndMaterialsAreCopied) {
  RenderMeshSource source = sourceOf({});
  const std::vector<std::uint8_t> small(textureBytes(1, TexelFormat::kRgba8), 7);
  const std::vector<std::uint8_t> blocks(textureBytes(4, TexelFormat::kBc1), 9);
  source.textures = {{"small", 1, TexelFormat::kRgba8, small},
                     {"blocks", 4, TexelFormat::kBc1, blocks}};
  source.materials = {{"a", 0x11223344, 1, 0.5F}};
  const auto built = buildRenderMeshes(source);
  ASSERT_TRUE(built) << built.error().message;
  const RenderMeshes meshes = built->view();
  EXPECT_EQ(built->textures[1].first_byte, 32U);
  EXPECT_TRUE(std::ranges::equal(meshes.textures[0].texels, small));
  EXPECT_TRUE(std::ranges::equal(meshes.textures[1].texels, blocks));
  EXPECT_EQ(meshes.materials[0].name, "a");
  EXPECT_EQ(meshes.materials[0].color, 0x11223344U);
  EXPECT_EQ(meshes.materials[0].texture, 1);
  EXPECT_EQ(meshes.materials[0].alpha_cutoff, 0.5F);
}

TEST(RenderMeshBuilder, VectorsBeginAtMultiplesOf32Bytes) {
  const auto built = buildRenderMeshes(sourceOf({{.surfaces = {sphereSurface(12, 1, true)}}}));
  ASSERT_TRUE(built);
  const auto isAligned = [](const void* p) {
    return reinterpret_cast<std::uintptr_t>(p) % 32 == 0;
  };
  EXPECT_TRUE(isAligned(built->clusters.data()));
  EXPECT_TRUE(isAligned(built->cluster_bounds.data()));
  EXPECT_TRUE(isAligned(built->vertices.data()));
  EXPECT_TRUE(isAligned(built->colors.data()));
  EXPECT_TRUE(isAligned(built->triangles.data()));
}

TEST(RenderMeshBuilder, WhatCannotBeStoredIsRefusedByName) {
  const auto refused = [](const RenderSurface& surface) {
    const auto built = buildRenderMeshes(sourceOf({{.surfaces = {surface}}}));
    return built ? std::string() : built.error().text();
  };
  const RenderSurface good = triangleSurface({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  EXPECT_EQ(refused(good), "");
  RenderSurface bad = good;
  bad.corners.pop_back();
  EXPECT_EQ(refused(bad),
            "render meshes: parts[0].surfaces[0]: found 2 corners, expected three per triangle");
  bad = good;
  bad.corners[1] = 3;
  EXPECT_THAT(refused(bad), HasSubstr("found corner 3 of 3 vertices"));
  bad = good;
  bad.material = 1;
  EXPECT_THAT(refused(bad), HasSubstr("found material 1 of 1"));
  bad = good;
  bad.semantic = 9;
  EXPECT_THAT(refused(bad), HasSubstr("found semantic 9 of 1"));
  bad = good;
  bad.vertices[2].position.y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(refused(bad), HasSubstr("found a vertex 2 that is not finite"));
  bad = good;
  bad.vertices[1].u = std::numeric_limits<float>::infinity();
  EXPECT_THAT(refused(bad), HasSubstr("found a vertex 1 that is not finite"));
  bad = good;
  bad.vertices[1].v = 20000;
  EXPECT_THAT(refused(bad), HasSubstr("found texture coordinates (0, 20000) at vertex 1"));
  bad = good;
  bad.vertices[1].position.x = -70000;
  EXPECT_THAT(refused(bad), HasSubstr("found a vertex 1 farther than 65536 m"));
  bad = triangleSurface({-60000, 0, 0}, {60000, 0, 0}, {0, 1, 0});
  EXPECT_THAT(refused(bad), HasSubstr("found a cluster longer than 65535 m"));
}

TEST(RenderMeshBuilder, PartsTexturesAndMaterialsAreChecked) {
  RenderMeshSource source = sourceOf({{.part = 2}, {.part = 2}});
  EXPECT_EQ(buildRenderMeshes(source).error().message,
            "found part 2 after part 2, expected them to ascend");
  source = sourceOf({});
  source.textures = {{"t", 3, TexelFormat::kRgba8, {}}};
  EXPECT_EQ(buildRenderMeshes(source).error().message,
            "found a size of 3, expected a power of two");
  source.textures = {{"t", 2, TexelFormat::kRgba8, {}}};
  EXPECT_EQ(buildRenderMeshes(source).error().message, "found 0 bytes of texels, expected 20");
  source.textures.clear();
  source.materials[0].texture = 0;
  EXPECT_EQ(buildRenderMeshes(source).error().message, "found texture 0 of 0");
}

}  // namespace
}  // namespace galactic::render_mesh_builder_test
