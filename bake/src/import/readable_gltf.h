#pragma once
#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

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
/// file's folder, as far as `reach` allows.
[[nodiscard]] std::optional<ReadableGltf> readableGltf(const std::filesystem::path& path,
                                                       std::span<const std::byte> file,
                                                       Reach reach);

}  // namespace galactic::bake
