#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace galactic::bake {

/// What a glTF 2.0 file (JSON or GLB) requires (`extensionsRequired`) and the mesh reader ignores.
struct GltfRequirements {
  /// The first extension that changes shapes, such as Draco and meshopt compression.
  std::optional<std::string> unsupported;
  /// One sentence for each extension whose images cannot be read.
  std::vector<std::string> warnings;
};

/// Whether the file is a GLB: JSON and buffers in one.
[[nodiscard]] bool isGlb(std::span<const std::byte> file);

/// The JSON of a glTF file: the whole file, or the first chunk of a GLB.
[[nodiscard]] std::span<const std::byte> gltfJson(std::span<const std::byte> file);

/// Nothing also when `file` is no glTF: the reader then says why.
[[nodiscard]] GltfRequirements gltfRequirements(std::span<const std::byte> file);

}  // namespace galactic::bake
