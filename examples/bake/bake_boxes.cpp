// Bakes a scene and an object from meshes in memory. Usage: bake_boxes SCENE OBJECT
#include <array>
#include <cstdint>
#include <cstdio>

#include "galactic/bake/object_baker.h"
#include "galactic/bake/packs.h"
#include "galactic/bake/scene_baker.h"
#include "galactic/object_set.h"
#include "galactic/pack.h"
#include "galactic/scene.h"

namespace {

using namespace galactic;

/// A box in the world frame: y up, meters; triangles counter-clockwise, seen from outside.
bake::SourceAsset boxOf(const Vec3& low, const Vec3& high) {
  bake::SourceMesh mesh;
  for (std::uint32_t corner = 0; corner < 8; ++corner) {
    mesh.positions.push_back({(corner & 1U) != 0 ? high.x : low.x,
                              (corner & 2U) != 0 ? high.y : low.y,
                              (corner & 4U) != 0 ? high.z : low.z});
  }
  mesh.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
  bake::SourceAsset asset;
  asset.name = "box";
  asset.materials.emplace_back();
  asset.meshes.push_back(mesh);
  asset.instances.push_back({"box", 0, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}});
  return asset;
}

int refuse(const Error& error) {
  std::fprintf(stderr, "%s: %s\n", error.where.c_str(), error.message.c_str());
  return static_cast<int>(error.code);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: bake_boxes SCENE OBJECT\n");
    return kExitUsage;
  }
  const bake::Provenance provenance{
      .tool = "bake_boxes", .tool_version = "1", .options = {}, .sources = {}, .warnings = {}};
  // The inside of a box is a room.
  bake::SceneBakeOptions options;
  options.radii = {0.05F, 0.12F};
  bake::StageTimes times;
  const auto scene = bake::bakeScene(boxOf({0, 0, 0}, {4, 2.5F, 3}), options, times,
                                     [](std::string_view, double) {});
  if (!scene) return refuse(scene.error());
  const auto scene_bytes = bake::writeScenePack(argv[1], *scene, provenance);
  if (!scene_bytes) return refuse(scene_bytes.error());

  bake::ObjectBakeOptions shape;
  shape.spheres.radii = options.radii;
  auto object = bake::bakeObject(boxOf({0, 0, 0}, {0.3F, 0.2F, 0.2F}), shape);
  if (!object) return refuse(object.error());
  const auto object_bytes =
      bake::writeObjectPack(argv[2], {options.radii, {std::move(*object)}}, provenance);
  if (!object_bytes) return refuse(object_bytes.error());

  // As any program opens them.
  const auto room = PackFile::open(argv[1]);
  if (!room) return refuse(room.error());
  const auto box = PackFile::open(argv[2]);
  if (!box) return refuse(box.error());
  std::printf("%zu grids, %zu object\n", Scene::from(*room)->grids().size(),
              ObjectSet::from(*box)->objects().size());
  return kExitOk;
}
