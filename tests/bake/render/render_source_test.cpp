// What the render bake makes of scenes, objects and robots, from importer's output to pack.
#include "render/render_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bake/render/render_helpers.h"
#include "support/source_asset.h"
#include "support/test_meshes.h"

namespace galactic::test::render_source_test {
namespace {

using bake::SourceAsset;

SourceAsset cubeAsset(const std::string& name) {
  return sourceAssetOf(MeshBuilder().box({0, 0, 0}, {0.1F, 0.1F, 0.1F}).build(), name);
}

TEST(RenderSource, OfASceneHasANameForEachNode) {
  SourceAsset scene = cubeAsset("room");
  scene.instances[0].name = "table";
  scene.instances.push_back({"chair", 0, movedBy(1, 0, 0)});
  scene.instances.push_back({"table", 0, movedBy(2, 0, 0)});
  scene.instances.push_back({"", 0, movedBy(3, 0, 0)});
  const auto source = bake::sceneRenderSource(scene, {}, {});
  ASSERT_TRUE(source);
  EXPECT_THAT(source->semantics, testing::ElementsAre("table", "chair", "room"));
  ASSERT_EQ(source->parts.size(), 1U);
  ASSERT_EQ(source->parts[0].meshes.size(), 4U);
  EXPECT_EQ(source->parts[0].meshes[2].semantic, 0U);
  EXPECT_EQ(source->materials.size(), 1U);
  EXPECT_EQ(source->baked.materials.size(), 1U);
}

TEST(RenderSource, OfAnObjectHasItsName) {
  SourceAsset object = cubeAsset("cup");
  object.instances[0].name = "node";
  const auto source = bake::objectRenderSource(object, {}, {});
  ASSERT_TRUE(source);
  EXPECT_THAT(source->semantics, testing::ElementsAre("cup"));
}

TEST(RenderSource, TakesUsedMaterialsOnceAndTextureOnlyWithCoordinates) {
  SourceAsset scene = cubeAsset("room");
  scene.materials.resize(3);
  scene.materials[2].base_color_texture = "wood.png";
  scene.meshes[0].material = 2;
  scene.meshes.push_back(scene.meshes[0]);
  scene.meshes[1].uvs.assign(scene.meshes[1].positions.size(), {0.5F, 0.5F});
  scene.instances.push_back({"with", 1, kHere});
  scene.instances.push_back({"again", 1, kHere});
  const auto source = bake::sceneRenderSource(scene, "nowhere", {});
  ASSERT_TRUE(source);
  ASSERT_EQ(source->materials.size(), 2U);
  EXPECT_EQ(source->materials[0].base_color_texture, "");
  EXPECT_EQ(source->materials[1].base_color_texture, "wood.png");
  EXPECT_EQ(source->parts[0].meshes[2].material, 1U);
}

/// A robot of two links: a primitive each, and meshes on the second.
bake::SourceRobot robot() {
  bake::SourceRobot made;
  made.name = "robot";
  made.links.resize(3);
  made.links[0].name = "base";
  made.links[1].name = "nothing";
  made.links[1].parent = 0;
  made.links[2].name = "arm";
  made.links[2].parent = 0;
  made.links[0].visuals.push_back({.geometry = bake::BoxShape{{0.4, 0.2, 0.3}},
                                   .link_from_shape = movedBy(0, 0.1, 0),
                                   .color = {{1, 0, 0, 1}}});
  made.links[2].visuals.push_back({.geometry = bake::CylinderShape{.radius = 0.05, .length = 0.4},
                                   .link_from_shape = kHere,
                                   .color = {}});
  made.meshes.push_back(cubeAsset("gray"));
  made.meshes.push_back(cubeAsset("painted"));
  made.meshes[0].materials[0].name = "DefaultMaterial";
  made.meshes[1].materials[0].name = "paint";
  for (const std::uint32_t mesh : {0U, 1U}) {
    made.links[2].visuals.push_back({.geometry = bake::MeshShape{mesh},
                                     .link_from_shape = movedBy(0.5 + mesh, 0, 0),
                                     .color = {{0, 0, 1, 1}}});
  }
  made.links[2].collisions.push_back(
      {.geometry = bake::SphereShape{2}, .link_from_shape = kHere, .color = {}});
  return made;
}

TEST(RenderSource, OfARobotHasAPartForEachLinkThatIsSeen) {
  const bake::SourceRobot made = robot();
  const auto source = bake::robotRenderSource(made, {}, {});
  ASSERT_TRUE(source);
  EXPECT_THAT(source->semantics, testing::ElementsAre("base", "nothing", "arm"));
  ASSERT_EQ(source->parts.size(), 2U);
  EXPECT_EQ(source->parts[0].part, 0U);
  EXPECT_EQ(source->parts[1].part, 2U);
  ASSERT_EQ(source->parts[1].meshes.size(), 3U);
  const auto colorOf = [&](const bake::PlacedMesh& placed) {
    return source->baked.materials[placed.material].color;
  };
  EXPECT_EQ(colorOf(source->parts[0].meshes[0]), 0xFF0000FFU);
  // The URDF's blue is for the mesh that has no color of its own.
  EXPECT_EQ(colorOf(source->parts[1].meshes[0]), 0xFFFF0000U);
  EXPECT_EQ(colorOf(source->parts[1].meshes[1]), 0xFFFFFFFFU);
}

TEST(RenderSource, OfARobotThatHidesLooksHasItsColorsAndImages) {
  bake::SourceRobot made = robot();
  auto& visuals = made.links[2].visuals;
  for (bake::LinkShape& shape : visuals) {
    shape.hides_looks = true;
    shape.texture = "wood.png";
  }
  made.meshes[1].meshes[0].uvs.assign(made.meshes[1].meshes[0].positions.size(), {0.5F, 0.5F});
  visuals.push_back(visuals.back());
  visuals.back().texture.clear();
  const auto source = bake::robotRenderSource(made, "nowhere", {});
  ASSERT_TRUE(source);
  const auto& meshes = source->parts[1].meshes;
  ASSERT_EQ(meshes.size(), 4U);
  // Without texture coordinates, with them, and without an image.
  EXPECT_EQ(source->materials[meshes[0].material].base_color_texture, "");
  EXPECT_EQ(source->baked.materials[meshes[0].material].color, 0xFFFF0000U);
  EXPECT_EQ(source->materials[meshes[1].material].base_color_texture, "wood.png");
  EXPECT_EQ(source->baked.materials[meshes[2].material].color, 0xFFFF0000U);
}

TEST(RenderSource, OfALinkThatLostItsVisualsIsItsCollisionGeometryInGray) {
  bake::SourceRobot made = robot();
  for (bake::SourceLink& link : made.links) {
    link.visuals.clear();
    link.collisions = {
        {.geometry = bake::SphereShape{0.1}, .link_from_shape = kHere, .color = {}},
        {.geometry = bake::MeshShape{1}, .link_from_shape = movedBy(0.5, 0, 0), .color = {}}};
  }
  made.meshes[1].materials[0].base_color = {1, 0, 0, 1};
  made.links[1].visuals_are_lost = true;
  const auto source = bake::robotRenderSource(made, {}, {});
  ASSERT_TRUE(source);
  ASSERT_EQ(source->parts.size(), 1U);
  EXPECT_EQ(source->parts[0].part, 1U);
  ASSERT_EQ(source->parts[0].meshes.size(), 2U);
  const auto meshes = bake::bakeRenderMeshes(*source, {.error = 0.002});
  ASSERT_TRUE(meshes);
  EXPECT_NEAR(meshes->models[0].bounds_min.x, -0.1F, 0.003F);
  EXPECT_NEAR(meshes->models[0].bounds_max.x, 0.6F, 0.003F);
  for (const bake::PlacedMesh& placed : source->parts[0].meshes) {
    const std::uint32_t color = source->baked.materials[placed.material].color;
    EXPECT_EQ(color & 0xFFU, (color >> 8U) & 0xFFU);
    EXPECT_LT(color & 0xFFU, 0xF0U);
    EXPECT_EQ(placed.semantic, 1U);
  }
}

TEST(RenderSource, OfARobotIsBakedInTheFramesOfItsLinks) {
  const bake::SourceRobot made = robot();
  const auto source = bake::robotRenderSource(made, {}, {});
  ASSERT_TRUE(source);
  const auto meshes = bake::bakeRenderMeshes(*source, {.error = 0.002});
  ASSERT_TRUE(meshes);
  ASSERT_EQ(meshes->models.size(), 2U);
  constexpr float kRounding = 1e-4F;
  EXPECT_NEAR(meshes->models[0].bounds_min.x, -0.2F, kRounding);
  EXPECT_NEAR(meshes->models[0].bounds_max.y, 0.2F, kRounding);
  EXPECT_NEAR(meshes->models[1].bounds_max.x, 1.6F, kRounding);
  const auto triangles = drawnTriangles(meshes->view(), 0);
  EXPECT_EQ(twoSidedCount(triangles), 0U);
  EXPECT_NEAR(enclosedVolume(triangles), 0.024, 1e-4);
}

TEST(RenderSource, OfASceneAloneMayHoldLight) {
  EXPECT_TRUE(bake::sceneRenderSource(cubeAsset("room"), {}, {})->may_hold_light);
  EXPECT_FALSE(bake::objectRenderSource(cubeAsset("cup"), {}, {})->may_hold_light);
  EXPECT_FALSE(bake::robotRenderSource(robot(), {}, {})->may_hold_light);
}

}  // namespace
}  // namespace galactic::test::render_source_test
