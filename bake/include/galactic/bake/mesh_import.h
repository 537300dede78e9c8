#pragma once
#include <chrono>
#include <filesystem>
#include <optional>

#include "galactic/bake/source_asset.h"
#include "galactic/error.h"

namespace galactic::bake {

/// Which way is up in a source file.
enum class UpAxis { kX, kY, kZ, kMinusX, kMinusY, kMinusZ };

/// How to read a mesh file. Everything has a default from the file or its format.
struct MeshImportOptions {
  /// Overrides the up axis of the file (glTF, DAE, FBX) or of the format (OBJ: Y; PLY, STL: Z).
  std::optional<UpAxis> up{};
  /// Meters per unit of the file; overrides the file's own unit.
  std::optional<double> scale{};
  /// Applied last, to points that are already Y up and in meters.
  std::optional<Affine> transform{};
  /// Smaller files draw a question about their unit (a warning). Meters; the default is for scenes,
  /// 0 asks never.
  double smallest_size = 0.5;
  /// Whether what a file names is read wherever it points: without it, files below its folder, and
  /// textures below the folder above, too.
  bool allow_outside = false;
  /// The file reader runs in a process of its own, which is stopped after this long and when it
  /// uses more memory than this; so a broken file costs one error message, not the bake.
  std::chrono::seconds time_limit{600};
  std::uint64_t memory_limit = std::uint64_t{16} << 30U;

  friend bool operator==(const MeshImportOptions&, const MeshImportOptions&) = default;
};

/// Reads anything assimp reads (GLB, glTF, OBJ, PLY, STL, DAE and more): axes and unit converted to
/// Y up and meters, node transforms and instances kept, materials and textures named.
/// Throws ErrorException where the system kills the process that reads, which says nothing of the
/// file. Fails with kIo (missing or unreadable file), kUnsupported (no reader for it) or
/// kInvalidInput (broken, no triangles, NaN or infinite vertex that a triangle uses, index out of
/// range, reader crashed or ran too long).
[[nodiscard]] Result<SourceAsset> importMesh(const std::filesystem::path& path,
                                             const MeshImportOptions& options = {});

}  // namespace galactic::bake
