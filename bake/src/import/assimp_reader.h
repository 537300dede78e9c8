#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "galactic/bake/mesh_import.h"

namespace galactic::bake {

/// The part of the code that is running, so that a crash is blamed on the right one.
enum class ReadStage : std::uint32_t { kThirdPartyReader = 0, kConversion = 1 };

/// Called by the reader while it works.
struct ReaderCallbacks {
  std::function<void(const SourceMesh&)> on_mesh;
  std::function<void(ReadStage)> on_stage;
};

/// Whether there is a reader for files of this name, judged by the extension.
[[nodiscard]] bool hasReader(const std::filesystem::path& path);

/// Extensions with a reader, for an error message: ".dae .fbx .glb ...".
[[nodiscard]] std::string readableExtensions();

/// Reads `path` in this process, which broken files may crash inside third-party readers: see
/// isolated_process.h. Passes each mesh to `on_mesh` and frees it. The returned asset has no
/// meshes, its files are named but not hashed, and its textures have not been looked for. Validates
/// nothing except what a SourceAsset cannot express.
[[nodiscard]] Result<SourceAsset> readWithAssimp(const std::filesystem::path& path,
                                                 const MeshImportOptions& options,
                                                 const ReaderCallbacks& callbacks);

}  // namespace galactic::bake
