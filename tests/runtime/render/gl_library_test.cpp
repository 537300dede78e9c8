// What is made of a library before any of it reaches a graphics processor.
#include <gtest/gtest.h>

#include <set>

#include "render/gl/library_geometry.h"
#include "render/gl/library_textures.h"
#include "render/gl/view_lists.h"
#include "runtime/render/gl_scene.h"

namespace galactic::render::gl::gl_library_test {
namespace {

/// A library of textures alone.
struct TextureShelf {
  std::vector<std::vector<std::uint8_t>> texels;
  RenderMeshes meshes;

  void add(std::uint32_t size, TexelFormat format) {
    texels.emplace_back(textureBytes(size, format));
    meshes.textures.push_back({"texture", size, format, texels.back()});
  }
  [[nodiscard]] RenderLibrary library() const {
    RenderLibrary library;
    library.add(meshes);
    return library;
  }
};

TEST(TexturePlan, PutsTexturesOfOneSizeAndFormatIntoOneArray) {
  TextureShelf shelf;
  shelf.add(64, TexelFormat::kRgba8);
  shelf.add(32, TexelFormat::kRgba8);
  shelf.add(64, TexelFormat::kBc1);
  shelf.add(64, TexelFormat::kRgba8);
  const RenderLibrary library = shelf.library();
  const Result<TexturePlan> plan = planTextures(library, {});
  ASSERT_TRUE(plan.has_value());
  ASSERT_EQ(plan->arrays.size(), 3U);
  EXPECT_EQ(plan->slots[0],
            (std::vector<std::uint32_t>{textureSlot(0, 0, 6), textureSlot(1, 0, 5),
                                        textureSlot(2, 0, 6), textureSlot(0, 1, 6)}));
  const Result<TexturePlan> decoded = planTextures(library, {.bc1 = false});
  ASSERT_TRUE(decoded.has_value());
  EXPECT_EQ(decoded->arrays.size(), 2U);
  EXPECT_EQ(decoded->arrays[0].layers.size(), 3U);
}

TEST(TexturePlan, BeginsAnotherArrayWhereOneIsFullAndDecodesWhenThereAreTooMany) {
  TextureShelf shelf;
  for (int i = 0; i < 5; ++i) shelf.add(8, TexelFormat::kRgba8);
  shelf.add(8, TexelFormat::kBc1);
  const RenderLibrary library = shelf.library();
  EXPECT_EQ(planTextures(library, {.layers = 2})->arrays.size(), 4U);
  EXPECT_EQ(planTextures(library, {.arrays = 3, .layers = 2})->arrays.size(), 3U);
  const Result<TexturePlan> none = planTextures(library, {.arrays = 2, .layers = 2});
  ASSERT_FALSE(none.has_value());
  EXPECT_EQ(none.error().code, ErrorCode::kUnsupported);
  EXPECT_EQ(none.error().message,
            "the textures of the library need 3 arrays; the driver has 2 of up to 2 layers: bake "
            "textures in fewer sizes, or use the soft backend");
}

TEST(TexturePlan, GivesPacksThatShareATextureOneLayer) {
  TextureShelf shelf;
  shelf.add(64, TexelFormat::kRgba8);
  shelf.add(64, TexelFormat::kRgba8);
  RenderLibrary library = shelf.library();
  library.add(shelf.meshes);
  const Result<TexturePlan> plan = planTextures(library, {});
  ASSERT_TRUE(plan.has_value());
  ASSERT_EQ(plan->arrays.size(), 1U);
  EXPECT_EQ(plan->arrays[0].layers.size(), 2U);
  EXPECT_EQ(plan->slots[0], plan->slots[1]);
}

/// The triangles of a model as world positions and semantics, in no order.
using Triangles = std::multiset<std::vector<float>>;

Triangles storedTriangles(const RenderMeshes& meshes, const RenderModel& model) {
  Triangles triangles;
  for (std::uint32_t c = 0; c < model.cluster_count; ++c) {
    const RenderCluster& cluster = meshes.clusters[model.first_cluster + c];
    for (std::size_t t = 0; t < cluster.triangle_count; ++t) {
      const std::size_t at = cluster.first_triangle + t;
      std::vector<float> corners{static_cast<float>(cluster.material),
                                 static_cast<float>(cluster.two_sided)};
      for (std::size_t n = 0; n < 3; ++n) {
        const std::size_t vertex =
            cluster.first_vertex + meshes.triangles[at / 8 * 24 + 8 * n + at % 8];
        const auto row = [&](std::size_t r) {
          return meshes.vertices[vertex / 8 * 40 + 8 * r + vertex % 8];
        };
        corners.push_back(static_cast<float>(cluster.origin_x + row(0)) * model.step);
        corners.push_back(static_cast<float>(cluster.origin_y + row(1)) * model.step);
        corners.push_back(static_cast<float>(cluster.origin_z + row(2)) * model.step);
      }
      triangles.insert(corners);
    }
  }
  return triangles;
}

TEST(LibraryGeometry, KeepsEveryTriangleAndOrdersClustersByClass) {
  test::GlHome home;
  const RenderMeshes& meshes = home.library().packs()[0];
  const std::vector<std::vector<std::uint32_t>> slots{{7, 8, 9}};
  const LibraryGeometry geometry = gatherGeometry(home.library(), slots);
  ASSERT_EQ(geometry.models.size(), meshes.models.size());
  std::array<std::size_t, kDrawClasses> found{};
  for (std::size_t m = 0; m < geometry.models.size(); ++m) {
    Triangles triangles;
    for (std::size_t kind = 0; kind < kDrawClasses; ++kind) {
      for (std::uint32_t c = geometry.models[m].first[kind]; c < geometry.models[m].first[kind + 1];
           ++c) {
        ++found[kind];
        const GpuBounds& bounds = geometry.bounds[c];
        // Indices of neighbors follow each other, so that runs of clusters are one draw.
        const std::uint32_t next = c + 1 < geometry.bounds.size()
                                       ? geometry.bounds[c + 1].first_index
                                       : static_cast<std::uint32_t>(geometry.indices.size());
        EXPECT_EQ(bounds.first_index + bounds.index_count, next);
        for (std::uint32_t i = 0; i < bounds.index_count; i += 3) {
          std::vector<float> corners;
          for (std::uint32_t n = 0; n < 3; ++n) {
            const GpuVertex& vertex =
                geometry.vertices[geometry.indices[bounds.first_index + i + n]];
            EXPECT_EQ(vertex.alpha_cutoff > 0, kind >= 2);
            corners.insert(corners.end(), {vertex.x, vertex.y, vertex.z});
          }
          triangles.insert(corners);
        }
      }
    }
    Triangles wanted;
    for (const std::vector<float>& stored : storedTriangles(meshes, meshes.models[m])) {
      wanted.insert(std::vector<float>(stored.begin() + 2, stored.end()));
    }
    EXPECT_EQ(triangles, wanted) << "model " << m;
  }
  for (std::size_t kind = 0; kind < kDrawClasses; ++kind) EXPECT_GT(found[kind], 0U) << kind;
}

TEST(ViewLists, WriteWhatTheyCounted) {
  test::GlHome home;
  const std::vector<std::vector<std::uint32_t>> slots{{7, 8, 9}};
  const LibraryGeometry geometry = gatherGeometry(home.library(), slots);
  const std::vector<RenderView> views = home.views(5);
  const SliceCounts counts = countSlice(views, geometry.models);
  EXPECT_EQ(counts.instances, 5U * 21U);
  std::vector<GpuInstance> instances(counts.instances);
  std::vector<GpuChunk> chunks(counts.allChunks());
  listSlice(views, geometry.models, 1, {counts, instances, chunks});
  std::uint64_t clusters = 0;
  std::size_t chunk = 0;
  for (std::size_t kind = 0; kind < kDrawClasses; ++kind) {
    for (std::uint32_t i = 0; i < counts.chunks[kind]; ++i, ++chunk) {
      clusters += chunks[chunk].count;
      EXPECT_GT(chunks[chunk].count, 0U);
      EXPECT_LE(chunks[chunk].count, 32U);
      if (i > 0) {
        EXPECT_LE(chunks[chunk - 1].instance, chunks[chunk].instance);
      }
    }
  }
  EXPECT_EQ(clusters, counts.clusters);
  EXPECT_EQ(instances.front().layer, 0U);
  EXPECT_EQ(instances.back().layer, 4U);
}

}  // namespace
}  // namespace galactic::render::gl::gl_library_test
