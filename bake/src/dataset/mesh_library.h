#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>

#include "galactic/bake/mesh_import.h"
#include "galactic/bake/source_asset.h"
#include "galactic/bake/source_robot.h"
#include "galactic/error.h"

namespace galactic::bake {

/// Mesh files and URDFs that many scenes share, each read once while it is in use or there is room
/// for it. Thread-safe: several threads may ask for one file, one of them reads it, the others
/// wait.
class MeshLibrary {
 public:
  /// `options` are for all files; at most about `memory_limit` bytes of meshes that nobody uses are
  /// kept.
  explicit MeshLibrary(MeshImportOptions options,
                       std::uint64_t memory_limit = std::uint64_t{1} << 30U);
  ~MeshLibrary();
  MeshLibrary(const MeshLibrary&) = delete;
  MeshLibrary& operator=(const MeshLibrary&) = delete;

  /// Fails with the errors of importMesh, the same each time.
  [[nodiscard]] Result<std::shared_ptr<const SourceAsset>> load(const std::filesystem::path& file);

  /// Furniture with joints, read by importRobot as Y up, meshes that are missing allowed; the same
  /// otherwise. `options` do not apply.
  [[nodiscard]] Result<std::shared_ptr<const SourceRobot>> loadFurniture(
      const std::filesystem::path& urdf);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace galactic::bake
