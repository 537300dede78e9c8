#pragma once
#include <cstdint>
#include <string>

#include "galactic/bake/source_asset.h"
#include "galactic/bake/triangle_mesh.h"

namespace galactic::bake {

/// What the importer read of a mesh and what cleaning left, for the pack.
struct ImportStatistics {
  /// Format of the main input, for example "glTF 2.0".
  std::string format;
  std::uint32_t meshes = 0;
  std::uint32_t instances = 0;
  CleaningCounts counts;
  /// Triangles that remain.
  std::uint64_t triangles = 0;
};

[[nodiscard]] inline ImportStatistics importStatisticsOf(const SourceAsset& asset,
                                                         const CleanMesh& cleaned) {
  return {.format = asset.format,
          .meshes = static_cast<std::uint32_t>(asset.meshes.size()),
          .instances = static_cast<std::uint32_t>(asset.instances.size()),
          .counts = cleaned.counts,
          .triangles = cleaned.mesh.triangles.size()};
}

}  // namespace galactic::bake
