#pragma once
#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "galactic/error.h"
#include "import/source_files.h"

namespace galactic::bake {

/// What the reader gets in place of a glTF file.
struct ReadableGltf {
  /// Replaces the file itself.
  std::string file;
  /// Content of kGltfFloatsFile, which only the reader sees beside the file.
  std::string floats;
};

inline constexpr std::string_view kGltfFloatsFile = "galactic-floats.bin";

/// The glTF 2.0 file `path`, whose bytes are `file`, rewritten so that readers do not misinterpret
/// it:
/// - TEXCOORD_0 of each primitive is what its color texture is drawn with: the set that the
///   material names (`texCoord`), transformed by KHR_texture_transform.
/// - Positions and texture coordinates in integers, including those of KHR_mesh_quantization,
///   become floats.
/// - Skins are removed: the reader crashes if they lack inverseBindMatrices.
/// None if nothing needs to change, or if the file is not one for such a reader. Looks for other
/// buffers in the file's folder, as far as `reach` allows; references to buffers that do not exist
/// stay, so that the reader reports them. `file` must have passed checkGltfRanges. Fails with
/// kInvalidInput if an accessor's elements are not in its buffer, or sparse elements not in the
/// accessor.
[[nodiscard]] Result<std::optional<ReadableGltf>> readableGltf(const std::filesystem::path& path,
                                                               std::span<const std::byte> file,
                                                               Reach reach);

}  // namespace galactic::bake
