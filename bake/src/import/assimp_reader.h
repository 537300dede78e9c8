#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "galactic/bake/mesh_import.h"

namespace galactic::bake {

/// Where the reader is, so that a crash can be blamed on the right code.
enum class ReadStage : std::uint32_t { kThirdPartyReader = 0, kConversion = 1 };

/// What the reader hands over while it works.
struct ReaderCallbacks {
  std::function<void(const SourceMesh&)> on_mesh;
  std::function<void(ReadStage)> on_stage;
};

/// Whether some reader knows files of this name, judged by the extension.
[[nodiscard]] bool hasReader(const std::filesystem::path& path);

/// Extensions with a reader, for an error message: ".dae .fbx .glb ...".
[[nodiscard]] std::string readableExtensions();

/// Reads `path` in this process, which third-party readers may crash on broken files: see
/// isolated_process.h. Each mesh goes to `on_mesh` and is freed; the returned asset has no meshes,
/// its files are named but not hashed, its textures are not looked for. Nothing is validated except
/// what cannot be expressed in a SourceAsset.
[[nodiscard]] Result<SourceAsset> readWithAssimp(const std::filesystem::path& path,
                                                 const MeshImportOptions& options,
                                                 const ReaderCallbacks& callbacks);

}  // namespace galactic::bake
