// One wrong value per field of render meshes in a pack whose hash is right: each has its own
// message.
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "galactic/pack.h"
#include "galactic/render_meshes.h"
#include "runtime/check/pack_damage.h"
#include "runtime/check/pack_offence.h"
#include "support/oracles/render_mesh_reader.h"
#include "support/packs/object_pack_builder.h"
#include "support/packs/robot_pack_builder.h"
#include "support/packs/scene_pack_builder.h"

namespace galactic::test::render_check_test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

using Offence = PackOffence<ObjectPackFields>;
using Change = std::function<void(RenderMeshesFields&)>;

/// Both objects of the set can be seen.
ObjectPackFields visibleObjects() {
  ObjectPackFields fields = smallObjects();
  fields.render_meshes = smallRenderMeshes({0, 1});
  return fields;
}

/// An offence somewhere in the render meshes; `field` begins with a dot or an index.
Offence in(const std::string& field, const std::string& message, Change change) {
  return {"objects.render_meshes." + field, message,
          [change = std::move(change)](ObjectPackFields& f) { change(*f.render_meshes); }};
}

/// An offence of the second model's square: cluster 3, lane 9.
Offence inSquare(const std::string& field, const std::string& message,
                 std::function<void(RenderCluster&)> change) {
  return in("clusters[3]." + field, message,
            [change = std::move(change)](RenderMeshesFields& f) { change(f.clusters[3]); });
}

/// A wrong number in the square's bounds.
Offence inBounds(const std::string& message, std::size_t row, float value) {
  return in("clusters[3].bounds", message,
            [row, value](RenderMeshesFields& f) { f.bound(9, row) = value; });
}

void refuse(const std::vector<Offence>& offences) { expectRefused(visibleObjects(), offences); }

TEST(RenderCheck, AcceptsThePackThatTheOffencesBelowStartFrom) {
  const AlignedBytes bytes = buildPack(visibleObjects());
  const Result<PackFile> pack = PackFile::view(bytes.bytes(), "made.pack");
  ASSERT_TRUE(pack.has_value()) << pack.error().text();
}

TEST(RenderCheck, AcceptsAPartWithoutClustersAndAPackWithoutModels) {
  ObjectPackFields fields = smallObjects();
  fields.render_meshes = smallRenderMeshes({0});
  RenderModelFields& empty = fields.render_meshes->models.emplace_back();
  empty.part = 1;
  empty.first_cluster = 2;
  empty.first_block = 1;
  for (const bool any : {true, false}) {
    if (!any) {
      fields.render_meshes = RenderMeshesFields{};
      fields.render_meshes->semantics = {"nothing"};
    }
    const AlignedBytes bytes = buildPack(fields);
    const Result<PackFile> pack = PackFile::view(bytes.bytes(), "made.pack");
    ASSERT_TRUE(pack.has_value()) << pack.error().text();
  }
}

TEST(RenderCheck, RefusesWrongSizes) {
  refuse({
      in("semantics", "has 0 names, expected 1 to 65536",
         [](RenderMeshesFields& f) { f.semantics.clear(); }),
      in("cluster_bounds", "has 175 elements, expected blocks of 88",
         [](RenderMeshesFields& f) { f.bounds.pop_back(); }),
      in("vertices", "has 161 elements, expected blocks of 40",
         [](RenderMeshesFields& f) { f.vertices.push_back(0); }),
      in("triangles", "has 95 elements, expected blocks of 24",
         [](RenderMeshesFields& f) { f.triangles.pop_back(); }),
      in("colors", "has 31 elements, expected 32, one per vertex, or none",
         [](RenderMeshesFields& f) { f.colors.pop_back(); }),
      in("clusters", "has 5 elements, expected the 4 of the models",
         [](RenderMeshesFields& f) { f.clusters.emplace_back(); }),
      in("cluster_bounds", "has 3 blocks, expected the 2 of the models",
         [](RenderMeshesFields& f) { f.bounds.resize(f.bounds.size() + 88); }),
      in("vertices", "has 200 elements, expected the 160 of the clusters",
         [](RenderMeshesFields& f) {
           f.vertices.resize(200);
           f.colors.resize(40);
         }),
      in("triangles", "has 120 elements, expected the 96 of the clusters",
         [](RenderMeshesFields& f) { f.triangles.resize(120); }),
  });
}

TEST(RenderCheck, RefusesWrongTexturesAndMaterials) {
  refuse({
      in("textures[0].size", "is 3, expected a power of two up to 4096",
         [](RenderMeshesFields& f) { f.textures[0].size = 3; }),
      in("textures[0].size", "is 0, expected a power of two up to 4096",
         [](RenderMeshesFields& f) { f.textures[0].size = 0; }),
      in("textures[0].size", "is 8192, expected a power of two up to 4096",
         [](RenderMeshesFields& f) { f.textures[0].size = 8192; }),
      in("textures[0].format", "is 2, expected a value up to 1",
         [](RenderMeshesFields& f) { f.textures[0].format = 2; }),
      in("textures[0].first_byte", "is 4, expected a multiple of 32",
         [](RenderMeshesFields& f) { f.textures[0].first_byte = 4; }),
      in("textures[0].first_byte",
         "is 0 with 20 bytes from there on, expected within the 19 of texels",
         [](RenderMeshesFields& f) { f.texels.pop_back(); }),
      in("textures[0].first_byte",
         "is 4294967264 with 20 bytes from there on, expected within the 20 of texels",
         [](RenderMeshesFields& f) { f.textures[0].first_byte = 0xFFFFFFE0; }),
      in("textures[1].first_byte", "is 0, expected 20 or more, behind the texture before",
         [](RenderMeshesFields& f) { f.textures.push_back(f.textures[0]); }),
      in("materials[1].texture", "is 1, expected one of the 1 textures, or -1",
         [](RenderMeshesFields& f) { f.materials[1].texture = 1; }),
      in("materials[0].texture", "is -2, expected one of the 1 textures, or -1",
         [](RenderMeshesFields& f) { f.materials[0].texture = -2; }),
      in("materials[1].alpha_cutoff", "is 1.5, expected 0 to 1",
         [](RenderMeshesFields& f) { f.materials[1].alpha_cutoff = 1.5F; }),
      in("materials[0].alpha_cutoff", "is nan, expected 0 to 1",
         [](RenderMeshesFields& f) { f.materials[0].alpha_cutoff = kNan; }),
  });
}

TEST(RenderCheck, RefusesWrongModels) {
  const std::string step = ", expected a power of two over 9.536743e-07 and at most 1 m";
  refuse({
      in("models[1].part", "is 0 after 0, expected ascending numbers under 2",
         [](RenderMeshesFields& f) { f.models[1].part = 0; }),
      in("models[1].part", "is 2 after 0, expected ascending numbers under 2",
         [](RenderMeshesFields& f) { f.models[1].part = 2; }),
      in("models[0].step", "is 0.003 m" + step,
         [](RenderMeshesFields& f) { f.models[0].step = 0.003F; }),
      in("models[0].step", "is 2 m" + step, [](RenderMeshesFields& f) { f.models[0].step = 2; }),
      in("models[0].step", "is 0 m" + step, [](RenderMeshesFields& f) { f.models[0].step = 0; }),
      in("models[0].step", "is -0.5 m" + step,
         [](RenderMeshesFields& f) { f.models[0].step = -0.5F; }),
      in("models[0].step", "is nan m" + step,
         [](RenderMeshesFields& f) { f.models[0].step = kNan; }),
      in("models[1].first_cluster", "is 3, expected 2, behind the model before",
         [](RenderMeshesFields& f) { f.models[1].first_cluster = 3; }),
      in("models[1].cluster_count", "is 3, expected at most the 2 that are left",
         [](RenderMeshesFields& f) { f.models[1].cluster_count = 3; }),
      in("models[1].first_block", "is 0, expected 1, behind the model before",
         [](RenderMeshesFields& f) { f.models[1].first_block = 0; }),
      in("models[1].cluster_count",
         "is 2, expected no more than the 0 blocks of bounds that are left hold",
         [](RenderMeshesFields& f) { f.bounds.resize(88); }),
      in("models[0].bounds", "are missing, expected the mesh's bounds",
         [](RenderMeshesFields& f) { f.models[0].has_bounds = false; }),
      in("models[0].largest_error", "is inf m, expected 0 to 800 m",
         [](RenderMeshesFields& f) { f.models[0].largest_error = kInfinity; }),
      in("models[0].largest_error", "is -1 m, expected 0 to 800 m",
         [](RenderMeshesFields& f) { f.models[0].largest_error = -1; }),
      in("models[1].triangles", "is 7, expected the 6 of its clusters",
         [](RenderMeshesFields& f) { f.models[1].triangles = 7; }),
  });
}

TEST(RenderCheck, RefusesWrongNumbersOfClusters) {
  refuse({
      inSquare("origin", "is -16777217 steps, expected -16777216 to 16711680",
               [](RenderCluster& c) { c.origin_x = -16777217; }),
      inSquare("origin", "is 16711681 steps, expected -16777216 to 16711680",
               [](RenderCluster& c) { c.origin_z = 16711681; }),
      inSquare("uv_minimum", "is -0.5, expected 0 to 1",
               [](RenderCluster& c) { c.u_minimum = -0.5F; }),
      inSquare("uv_minimum", "is nan, expected 0 to 1",
               [](RenderCluster& c) { c.v_minimum = kNan; }),
      inSquare("uv_step", "is 1, expected 0 to 0.5", [](RenderCluster& c) { c.u_step = 1; }),
      inSquare("uv_step", "is nan, expected 0 to 0.5", [](RenderCluster& c) { c.v_step = kNan; }),
      inSquare("material", "is 2, expected one of the 2 materials",
               [](RenderCluster& c) { c.material = 2; }),
      inSquare("semantic", "is 2, expected one of the 2 semantics",
               [](RenderCluster& c) { c.semantic = 2; }),
      inSquare("two_sided", "is 2, expected 0 or 1", [](RenderCluster& c) { c.two_sided = 2; }),
      inSquare("reserved", "is 1, expected 0", [](RenderCluster& c) { c.reserved = 1; }),
      inSquare("vertex_count", "is 0, expected 1 to 128",
               [](RenderCluster& c) { c.vertex_count = 0; }),
      inSquare("vertex_count", "is 129, expected 1 to 128",
               [](RenderCluster& c) { c.vertex_count = 129; }),
      inSquare("triangle_count", "is 0, expected 1 to 128",
               [](RenderCluster& c) { c.triangle_count = 0; }),
      inSquare("triangle_count", "is 129, expected 1 to 128",
               [](RenderCluster& c) { c.triangle_count = 129; }),
      inSquare("first_vertex", "is 16, expected 24, behind the cluster before",
               [](RenderCluster& c) { c.first_vertex = 16; }),
      inSquare("first_triangle", "is 25, expected 24, behind the cluster before",
               [](RenderCluster& c) { c.first_triangle = 25; }),
      inSquare("vertex_count", "is 9 from 24 on, expected no more than the 32 in the pool",
               [](RenderCluster& c) { c.vertex_count = 9; }),
      inSquare("triangle_count", "is 9 from 24 on, expected no more than the 32 in the pool",
               [](RenderCluster& c) { c.triangle_count = 9; }),
  });
}

TEST(RenderCheck, RefusesWrongVerticesAndTriangles) {
  const std::string padding = "are not 0 in the padding behind the last of them";
  refuse({
      in("clusters[3].vertices", padding,
         [](RenderMeshesFields& f) { f.vertices[pooledAt(28, kVertexV, kVertexRows)] = 1; }),
      in("clusters[3].vertices", padding, [](RenderMeshesFields& f) { f.colors[31] = 1; }),
      in("clusters[3].triangles", padding,
         [](RenderMeshesFields& f) { f.triangles[pooledAt(26, 2, kTriangleRows)] = 1; }),
      in("clusters[3].triangles", "have corner 4, expected one of the 4 vertices",
         [](RenderMeshesFields& f) { f.triangles[pooledAt(25, 1, kTriangleRows)] = 4; }),
      in("clusters[3].vertices",
         "reach from 0.1953125 to 0.2578125 m, expected within the model's -0.009765625 to 0.25 m",
         [](RenderMeshesFields& f) { f.models[1].bounds_max.x = 0.25F; }),
  });
}

TEST(RenderCheck, RefusesWrongBoundsOfClusters) {
  refuse({
      inBounds("are nan in row 0, expected up to 3200", kCenterRow, kNan),
      inBounds("are inf in row 6, expected up to 3200", kRadiusRow, kInfinity),
      inBounds("reach from 0.1796875 to 0.2421875 m, expected around all vertices: 0.1953125 to "
               "0.2578125 m",
               kCenterRow, 0.2109375F),
      inBounds("have a radius of 0.03125 m, expected 0.04419417382415922 m, to the farthest vertex",
               kRadiusRow, 0.03125F),
      inBounds("have a radius of -1 m, expected 0.04419417382415922 m, to the farthest vertex",
               kRadiusRow, -1),
      inBounds("have a cone's cutoff of 1.5, expected 0 to 1, or 2 for none", kConeCutoffRow, 1.5F),
      inBounds("have a cone's cutoff of -0.5, expected 0 to 1, or 2 for none", kConeCutoffRow,
               -0.5F),
      inBounds("have a cone's axis of length 0.5, expected 1", kConeAxisRow + 1, 0.5F),
      inBounds("have a cone's axis of length 1, expected 0 without a cone", kConeCutoffRow, 2),
      inBounds("have a cone of normals that triangle 0 is not in", kConeAxisRow + 1, -1),
      in("clusters[3].bounds",
         "have a cone although the cluster is seen from both sides, expected none",
         [](RenderMeshesFields& f) { f.clusters[3].two_sided = 1; }),
      in("cluster_bounds[1]", "has 0 in row 3 of a lane without a cluster, expected -1e+30",
         [](RenderMeshesFields& f) { f.bound(10, kHalfExtentRow) = 0; }),
      in("cluster_bounds[1]", "has 1 in row 10 of a lane without a cluster, expected 0",
         [](RenderMeshesFields& f) { f.bound(15, kConeCutoffRow) = 1; }),
  });
}

TEST(RenderCheck, RefusesTheSameInARobot) {
  const RobotPackFields robot = [] {
    RobotPackFields fields = smallRobotPack();
    fields.render_meshes = smallRenderMeshes({0, 1});
    return fields;
  }();
  ASSERT_TRUE(PackFile::view(buildPack(robot).bytes(), "made.pack").has_value());
  expectRefused(robot, std::vector<PackOffence<RobotPackFields>>{
                           {"robot.render_meshes.models[1].part",
                            "is 8 after 0, expected ascending numbers under 8",
                            [](RobotPackFields& f) { f.render_meshes->models[1].part = 8; }}});
}

TEST(RenderCheck, RefusesTheSameInAScene) {
  const ScenePackFields scene = [] {
    ScenePackFields fields = smallScene();
    fields.render_meshes = smallRenderMeshes();
    return fields;
  }();
  expectRefused(scene, std::vector<PackOffence<ScenePackFields>>{
                           {"scene.render_meshes.models[0].part",
                            "is 1 after -1, expected ascending numbers under 1",
                            [](ScenePackFields& f) { f.render_meshes->models[0].part = 1; }}});
}

TEST(RenderCheck, RefusesAPackFullOfBitsTurnedOverOrCutOff) {
  expectEachTruncationRefused(buildPack(visibleObjects()));
  expectEachBitFlipRefused(buildPack(visibleObjects()));
}

void drawEverything(const PackFile& pack) {
  const auto meshes = renderMeshesOf(pack);
  ASSERT_TRUE(meshes.has_value());
  if (!*meshes) return;
  const char* offence = drawingOffence(**meshes);
  ASSERT_EQ(offence, nullptr) << offence;
}

TEST(RenderCheck, OfAPackWithARecomputedHashRefusesItOrItIsSafeToDraw) {
  ObjectPackFields fields = visibleObjects();
  fields.objects.resize(1);
  fields.render_meshes = smallRenderMeshes({0});
  expectFlipsWithARightHashRefusedOrUsable(buildPack(fields), PackKind::kObjects, drawEverything);
}

}  // namespace
}  // namespace galactic::test::render_check_test
