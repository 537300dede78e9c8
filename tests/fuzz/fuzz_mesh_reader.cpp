// Any bytes as a mesh file, as fuzz_mesh_import, but read in the fuzzer's own process: it sees the
// checks of counts before the third-party readers, and the conversion of what these read. Their own
// crashes end this target, so it searches by hand only, where they are passed over (README.md).
#include <array>
#include <cstdint>
#include <filesystem>
#include <new>
#include <string_view>
#include <utility>
#include <vector>

#include "finding.h"
#include "import/assimp_reader.h"
#include "import/checks/asset_check.h"
#include "support/scratch_folder.h"

// What the readers leak ends with the process in which they run.
extern "C" const char* __lsan_default_suppressions();  // NOLINT(bugprone-reserved-identifier)
extern "C" const char* __lsan_default_suppressions() { return "leak:libassimp"; }

namespace {

using galactic::test::expectGoodError;
using galactic::test::reportFinding;

constexpr std::array<std::string_view, 8> kNames{"a.obj",  "a.ply", "a.stl", "a.glb",
                                                 "a.gltf", "a.dae", "a.fbx", "a.off"};

/// Elsewhere the process tells its parent that it ran out of memory.
galactic::Result<galactic::bake::SourceAsset> readMesh(
    const std::filesystem::path& path, const galactic::bake::ReaderCallbacks& callbacks) {
  try {
    return galactic::bake::readWithAssimp(path, {}, callbacks);
  } catch (const std::bad_alloc&) {
    return galactic::fail(galactic::ErrorCode::kInvalidInput, path.string(), "out of memory");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  static const galactic::test::ScratchFolder folder;
  const std::string_view content(reinterpret_cast<const char*>(data) + 1, size - 1);
  const auto path = folder.write(kNames[data[0] % kNames.size()], content);
  std::vector<galactic::bake::SourceMesh> meshes;
  const galactic::bake::ReaderCallbacks callbacks{
      .on_mesh = [&](const auto& mesh) { meshes.push_back(mesh); },
      .on_stage = [](auto) {},
  };
  auto asset = readMesh(path, callbacks);
  if (!asset) {
    expectGoodError(asset.error());
    return 0;
  }
  asset->meshes = std::move(meshes);
  if (const auto sound = checkAsset(*asset, "a"); !sound) {
    expectGoodError(sound.error());
    return 0;
  }
  for (const auto& mesh : asset->meshes) {
    for (const auto& triangle : mesh.triangles) {
      for (const std::uint32_t corner : triangle) {
        if (corner >= mesh.positions.size()) reportFinding("a corner that is not there");
      }
    }
    if (!mesh.uvs.empty() && mesh.uvs.size() != mesh.positions.size()) {
      reportFinding("texture coordinates of no vertices");
    }
  }
  return 0;
}
