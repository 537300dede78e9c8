#pragma once
#include <string>

#include "galactic/bake/source_asset.h"
#include "galactic/bake/triangle_mesh.h"

namespace galactic::test {

/// A mesh as an importer would hand it over, placed where it is.
inline bake::SourceAsset sourceAssetOf(const bake::TriangleMesh& mesh,
                                       const std::string& name = "room") {
  bake::SourceAsset asset;
  asset.name = name;
  asset.format = "test mesh";
  bake::SourceMesh& source = asset.meshes.emplace_back();
  source.name = name;
  source.positions = mesh.vertices;
  source.triangles = mesh.triangles;
  asset.materials.emplace_back();
  asset.instances.push_back({name, 0, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}});
  asset.read.files.push_back({name + ".glb", 1234, 0x0123456789abcdefU, 0xfedcba9876543210U});
  return asset;
}

}  // namespace galactic::test
