// Render meshes in packs: what the writers write is what the run reads, and it passes all checks.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bake/render/render_helpers.h"
#include "galactic/bake/packs.h"
#include "galactic/pack.h"
#include "render/render_source.h"
#include "support/aligned_bytes.h"
#include "support/packs/pack_parts.h"
#include "support/packs/scene_pack_builder.h"
#include "support/source_asset.h"
#include "support/test_meshes.h"

namespace galactic::test::render_pack_test {
namespace {

bake::Provenance provenance() {
  bake::Provenance made;
  made.tool_version = "0.1.0";
  return made;
}

bake::BakedRenderMeshes meshesOf(const bake::SourceAsset& asset) {
  const auto source = bake::objectRenderSource(asset, {}, {});
  EXPECT_TRUE(source);
  auto meshes = bake::bakeRenderMeshes(*source, {.error = 0.002});
  EXPECT_TRUE(meshes);
  return std::move(*meshes);
}

bake::SourceAsset ball(const std::string& name, float radius) {
  return sourceAssetOf(MeshBuilder().sphere({0.1F, 0.3F, 0.2F}, radius, 24).build(), name);
}

bake::BakedObject objectOf(const bake::SourceAsset& asset) {
  bake::ObjectBakeOptions options;
  options.spheres.radii = {0.05F, 0.12F};
  options.spheres.eps = 0.05F;
  options.spheres.tau = 0.1F;
  auto object = bake::bakeObject(asset, options);
  EXPECT_TRUE(object) << object.error().message;
  object->render_meshes = meshesOf(asset);
  return std::move(*object);
}

void expectSame(const std::vector<DrawnTriangle>& read, const std::vector<DrawnTriangle>& baked) {
  ASSERT_EQ(read.size(), baked.size());
  for (std::size_t n = 0; n < read.size(); ++n) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      ASSERT_EQ(read[n].corners[corner].at, baked[n].corners[corner].at);
      ASSERT_EQ(read[n].corners[corner].uv, baked[n].corners[corner].uv);
    }
    ASSERT_EQ(read[n].two_sided, baked[n].two_sided);
  }
}

TEST(RenderPack, OfObjectsHasAModelForEachInTheOrderOfNames) {
  bake::BakedObjectSet set{.radii = {0.05F, 0.12F}, .objects = {}};
  set.objects.push_back(objectOf(ball("marble", 0.15F)));
  set.objects.push_back(objectOf(ball("apple", 0.2F)));
  const auto payload = bake::encodeObjectPack(set, provenance());
  ASSERT_TRUE(payload);
  const AlignedBytes file = packFile(PackKind::kObjects, *payload);
  const auto pack = PackFile::view(file.bytes(), "made.pack");
  ASSERT_TRUE(pack) << pack.error().text();
  const auto meshes = renderMeshesOf(*pack);
  ASSERT_TRUE(meshes && *meshes);
  EXPECT_THAT((*meshes)->semantics, testing::ElementsAre("apple", "marble"));
  ASSERT_EQ((*meshes)->models.size(), 2U);
  ASSERT_EQ((*meshes)->modelOf(1), 1U);
  expectSame(drawnTriangles(**meshes, 0), drawnTriangles(set.objects[1].render_meshes->view(), 0));
  expectSame(drawnTriangles(**meshes, 1), drawnTriangles(set.objects[0].render_meshes->view(), 0));
  EXPECT_EQ(drawingOffence(**meshes), nullptr);
}

TEST(RenderPack, OfASceneHasOneModel) {
  bake::SourceAsset asset =
      sourceAssetOf(MeshBuilder().box({0, 0, 0}, {2, 2, 2}).sphere({1, 1, 1}, 0.3F, 16).build());
  bake::StageTimes times;
  bake::SceneBakeOptions options;
  options.radii = {0.12F};
  options.spacing = 0.2F;
  options.check_columns = 0;
  auto scene = bake::bakeScene(asset, options, times, [](std::string_view, double) {});
  ASSERT_TRUE(scene) << scene.error().message;
  scene->render_meshes = meshesOf(asset);
  const auto payload = bake::encodeScenePack(*scene, provenance());
  ASSERT_TRUE(payload);
  const AlignedBytes file = packFile(PackKind::kScene, *payload);
  const auto pack = PackFile::view(file.bytes(), "made.pack");
  ASSERT_TRUE(pack) << pack.error().text();
  const auto meshes = renderMeshesOf(*pack);
  ASSERT_TRUE(meshes && *meshes);
  expectSame(drawnTriangles(**meshes, 0), drawnTriangles(scene->render_meshes->view(), 0));
}

}  // namespace
}  // namespace galactic::test::render_pack_test
