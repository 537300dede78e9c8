// Any bytes as a mesh file: the first byte picks the format, the others are the file. The import
// has to give an error or a sound mesh; a crash of a third-party reader is an error like others, a
// crash of our own conversion (reported as internal) is a finding.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>

#include "finding.h"
#include "galactic/bake/mesh_import.h"
#include "galactic/bake/triangle_mesh.h"
#include "support/scratch_folder.h"

namespace {

using galactic::test::expectGoodError;
using galactic::test::reportFinding;

constexpr std::array<std::string_view, 8> kNames{"a.obj",  "a.ply", "a.stl", "a.glb",
                                                 "a.gltf", "a.dae", "a.fbx", "a.off"};

void checkMesh(const galactic::bake::TriangleMesh& mesh) {
  if (mesh.triangles.empty()) reportFinding("a mesh without triangles");
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t vertex : triangle) {
      if (vertex >= mesh.vertices.size()) reportFinding("an index out of range");
      const galactic::Vec3& v = mesh.vertices[vertex];
      const float farthest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
      const bool sound = std::isfinite(v.x + v.y + v.z) &&
                         farthest <= static_cast<float>(galactic::bake::kMaxCoordinate);
      if (!sound) reportFinding("a vertex out of bounds");
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  static const galactic::test::ScratchFolder folder;
  const std::string_view content(reinterpret_cast<const char*>(data) + 1, size - 1);
  const auto path = folder.write(kNames[data[0] % kNames.size()], content);
  const galactic::bake::MeshImportOptions options{.up = {},
                                                  .scale = {},
                                                  .transform = {},
                                                  .time_limit = std::chrono::seconds(5),
                                                  .memory_limit = std::uint64_t{1} << 30U};
  const auto asset = galactic::bake::importMesh(path, options);
  if (!asset) {
    expectGoodError(asset.error());
    return 0;
  }
  const auto clean = galactic::bake::placeAndClean(*asset);
  if (clean) {
    checkMesh(clean->mesh);
  } else {
    expectGoodError(clean.error());
  }
  return 0;
}
