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

/// What a reader gets in place of a glTF file.
struct ReadableGltf {
  /// In place of the file.
  std::string file;
  /// In place of kGltfFloatsFile, which lies beside it for the reader alone.
  std::string floats;
};

inline constexpr std::string_view kGltfFloatsFile = "galactic-floats.bin";

/// The glTF 2.0 file `path` (its bytes are `file`) without what readers take otherwise than it is
/// meant. Every primitive's TEXCOORD_0 is where its color texture is drawn: the set that the
/// material names (`texCoord`), moved as KHR_texture_transform says. Positions and texture
/// coordinates in integers, also those of KHR_mesh_quantization, are floats. There are no skins:
/// they may lack their inverseBindMatrices, at which the reader crashes. None where all is so
/// already, or where the file is none that such a reader takes. Other buffers are looked for in the
/// file's folder, as far as `reach` allows; what names one that is not there stays, so that the
/// reader tells. `file` has passed checkGltfRanges. Fails with kInvalidInput where an accessor's
/// elements are not in its buffer, or sparse ones not in the accessor.
[[nodiscard]] Result<std::optional<ReadableGltf>> readableGltf(const std::filesystem::path& path,
                                                               std::span<const std::byte> file,
                                                               Reach reach);

}  // namespace galactic::bake
