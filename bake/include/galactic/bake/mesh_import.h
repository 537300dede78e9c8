#pragma once
#include <chrono>
#include <filesystem>
#include <optional>

#include "galactic/bake/source_asset.h"
#include "galactic/error.h"

namespace galactic::bake {

/// Which axis points up in a source file.
enum class UpAxis { kX, kY, kZ, kMinusX, kMinusY, kMinusZ };

/// How to read a mesh file. Defaults come from the file or its format.
struct MeshImportOptions {
  /// Overrides the up axis of the file (glTF, DAE, FBX) or of the format (OBJ: Y; PLY, STL: Z).
  std::optional<UpAxis> up{};
  /// Meters per unit of the file; overrides the file's own unit.
  std::optional<double> scale{};
  /// Applied last, to points that are already Y up and in meters.
  std::optional<Affine> transform{};
  /// Smaller meshes cause a warning that asks about their unit. Meters; the default is for scenes;
  /// 0: never.
  double smallest_size = 0.5;
  /// Whether files that a file names may lie anywhere. Otherwise they must lie below its folder;
  /// textures may also lie below the folder above.
  bool allow_outside = false;
  /// The file reader runs in a process of its own, which is stopped if it runs longer or uses more
  /// memory (bytes) than this. A broken file therefore causes an error message and does not end the
  /// bake.
  std::chrono::seconds time_limit{600};
  std::uint64_t memory_limit = std::uint64_t{16} << 30U;

  friend bool operator==(const MeshImportOptions&, const MeshImportOptions&) = default;
};

/// Reads any format that assimp reads (GLB, glTF, OBJ, PLY, STL, DAE and more). Axes and unit are
/// converted to Y up and meters, node transforms and instances are kept, and materials and textures
/// are named. Throws ErrorException if the system kills the reading process, which says nothing
/// about the file. Fails with kIo (missing or unreadable file), kUnsupported (no reader for its
/// format) or kInvalidInput (broken file, no triangles, a triangle with a NaN or infinite vertex,
/// an index out of range, or a reader that crashed or ran too long).
[[nodiscard]] Result<SourceAsset> importMesh(const std::filesystem::path& path,
                                             const MeshImportOptions& options = {});

}  // namespace galactic::bake
