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
struct DrawnGltf {
  /// In place of the file.
  std::string file;
  /// In place of kTextureCoordinatesFile, which lies beside it for the reader alone.
  std::string texture_coordinates;
};

inline constexpr std::string_view kTextureCoordinatesFile = "galactic-texture-coordinates.bin";

/// The glTF 2.0 file `path` (its bytes are `file`) with every primitive's TEXCOORD_0 being where
/// its color texture is drawn: the set that the material names (`texCoord`), moved as
/// KHR_texture_transform says, as floats. Readers take set 0 as it stands, and integers of it for
/// floats. None where all is so already, or where the file is none that such a reader takes. Other
/// buffers are looked for in the file's folder, as far as `reach` allows.
[[nodiscard]] std::optional<DrawnGltf> drawnGltf(const std::filesystem::path& path,
                                                 std::span<const std::byte> file, Reach reach);

}  // namespace galactic::bake
